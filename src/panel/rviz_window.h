#pragma once

#include "panel/question.h"

#include <QDialog>
#include <QMainWindow>
#include <QObject>
#include <QPointer>
#include <QString>

#include <vector>

namespace rviz {
class PanelDockWidget;
}

namespace grinder {

/// rviz's window around a panel. It fits the window to the screen, and keeps the panel in sight while the grinder
/// moves: rviz's menus except *Quit*, the button that closes the panel and the arrows that fold it away are disabled,
/// and rviz asks before it ends. Without rviz it does nothing.
class RvizWindow : public QObject {
  Q_OBJECT

 public:
  explicit RvizWindow(QWidget& panel);

  /// To be called often, because rviz enables its menus again. @param why text on what moves; empty if nothing does.
  void keepPanel(const QString& why);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void watch();
  void fitScreen();
  void lock();
  void unlock();
  void switchOff(QObject* item);
  void showPanel();
  void ask();

  QWidget& panel_;
  QPointer<rviz::PanelDockWidget> dock_;
  QPointer<QMainWindow> window_;
  QString why_;
  std::vector<QPointer<QObject>> off_;  ///< actions and buttons disabled by this object
  bool fits_ = false;                   ///< the window was fitted to the screen once
  bool ends_ = false;                   ///< the operator has confirmed the end of rviz
  QDialog* dialog_;                     ///< dialog with the question
  Question* question_;
};

}  // namespace grinder
