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

/// rviz's window around a panel. It takes no more than the screen, and keeps the panel on it while the grinder moves:
/// then rviz's menus but for *Quit*, the box that closes the panel and the arrows that fold it away are off, and rviz
/// asks before it ends. Without rviz it does nothing.
class RvizWindow : public QObject {
  Q_OBJECT

 public:
  explicit RvizWindow(QWidget& panel);

  /// To be called often, since rviz enables its menus anew. @param why what moves, for people; empty if nothing does.
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
  std::vector<QPointer<QObject>> off_;  ///< actions and buttons that are enabled otherwise
  bool fits_ = false;                   ///< it has been made to, once
  bool ends_ = false;                   ///< the operator has said so
  QDialog* dialog_;                     ///< with the question
  Question* question_;
};

}  // namespace grinder
