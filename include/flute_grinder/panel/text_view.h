#pragma once

#include <QPlainTextEdit>
#include <QString>

namespace flute_grinder {

/// A field for text to be read, which scrolls where it has more lines than there is room for.
inline QPlainTextEdit* textView(const char* name, int lines) {
  auto* view = new QPlainTextEdit;
  view->setObjectName(name);
  view->setReadOnly(true);
  view->setTabChangesFocus(true);
  view->setWordWrapMode(QTextOption::WrapAtWordBoundaryOrAnywhere);
  view->setMinimumHeight(lines * view->fontMetrics().lineSpacing() + 12);
  return view;
}

/// @param good whether it is no bad news, which is red.
inline void showText(QPlainTextEdit& view, const QString& text, bool good) {
  view.setStyleSheet(good ? "" : "color: #b00020;");
  view.setPlainText(text);
}

}  // namespace flute_grinder
