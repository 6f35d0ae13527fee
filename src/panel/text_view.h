#pragma once

#include <QLabel>
#include <QPlainTextEdit>
#include <QString>

namespace grinder {

constexpr const char* kWrong = "#b00020";  ///< colour of faults
constexpr const char* kGreen = "#1e7d34";
constexpr const char* kAmber = "#9a5b00";

/// @param name by which tests find it.
inline QLabel* namedLabel(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  return label;
}

/// A read-only text field that scrolls if there are more lines than fit.
inline QPlainTextEdit* textView(const char* name, int lines) {
  auto* view = new QPlainTextEdit;
  view->setObjectName(name);
  view->setReadOnly(true);
  view->setTabChangesFocus(true);
  view->setWordWrapMode(QTextOption::WrapAtWordBoundaryOrAnywhere);
  view->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  view->setMinimumHeight(lines * view->fontMetrics().lineSpacing() + 12);
  return view;
}

/// @param good false shows the text in red.
inline void showText(QPlainTextEdit& view, const QString& text, bool good) {
  view.setStyleSheet(good ? "" : QString("color: %1;").arg(kWrong));
  view.setPlainText(text);
}

/// A name in a room [px]: without `.yaml` if it does not fit, then shortened in its middle.
inline QString nameFor(const QFontMetrics& metrics, const QString& name, int room) {
  const bool fits = metrics.horizontalAdvance(name) <= room;
  const QString suffix = ".yaml";
  const QString shown = !fits && name.endsWith(suffix) ? name.chopped(suffix.size()) : name;
  return metrics.elidedText(shown, Qt::ElideMiddle, room);
}

/// Shows a name in the room that the label has beside `rest`.
inline void showName(QLabel& label, const QString& name, const QString& rest = "") {
  const QFontMetrics metrics = label.fontMetrics();
  label.setText(nameFor(metrics, name, label.width() - metrics.horizontalAdvance(rest)) + rest);
}

}  // namespace grinder
