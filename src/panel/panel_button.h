#pragma once

#include <QKeyEvent>
#include <QPushButton>

namespace grinder {

/// A push button of the panel or of its dialogs that only the mouse presses: with the focus on it, a key meant for
/// another widget could start the spindle. Enter still presses the default button of a dialog.
class PanelButton : public QPushButton {
 public:
  PanelButton(const QString& name, const QString& text, const QString& hint) : QPushButton(text) {
    setObjectName(name);
    setToolTip(hint);
    setFocusPolicy(Qt::NoFocus);
    setAutoDefault(false);
    setMinimumWidth(10);  // for grid columns of equal width
  }

 protected:
  void keyPressEvent(QKeyEvent* event) override { event->ignore(); }
};

}  // namespace grinder
