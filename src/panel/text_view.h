#pragma once

#include <QPlainTextEdit>
#include <QString>

namespace flute_grinder {

constexpr const char* kWrong = "#b00020";  ///< colour of what is not as it should be

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

/// @param good false shows it in red.
inline void showText(QPlainTextEdit& view, const QString& text, bool good) {
  view.setStyleSheet(good ? "" : QString("color: %1;").arg(kWrong));
  view.setPlainText(text);
}

}  // namespace flute_grinder
