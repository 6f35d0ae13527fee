#pragma once

#include <QKeyEvent>
#include <QPushButton>

namespace grinder {

/// A push button of the panel or of one of its dialogs, which the mouse alone presses: the focus may have come to it
/// from elsewhere, and a key that was meant for another would start the spindle. A default button of a dialog is still
/// pressed by Enter.
class PanelButton : public QPushButton {
 public:
  PanelButton(const QString& name, const QString& text, const QString& hint) : QPushButton(text) {
    setObjectName(name);
    setToolTip(hint);
    setFocusPolicy(Qt::NoFocus);
    setAutoDefault(false);
    setMinimumWidth(10);  // so that the columns of a grid are alike
  }

 protected:
  void keyPressEvent(QKeyEvent* event) override { event->ignore(); }
};

}  // namespace grinder
