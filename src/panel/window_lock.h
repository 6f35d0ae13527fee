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

/// Keeps a panel on the screen while its grinder moves: rviz's menus but for *Quit*, the box that closes the panel and
/// the arrows that fold it away are off, and rviz asks before it ends. Without rviz it does nothing.
class WindowLock : public QObject {
  Q_OBJECT

 public:
  explicit WindowLock(QWidget& panel);

  /// To be called often, since rviz enables its menus anew. @param why what moves, for people; empty if nothing does.
  void keep(const QString& why);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void watch();
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
  bool ends_ = false;                   ///< the operator has said so
  QDialog* dialog_;                     ///< with the question
  Question* question_;
};

}  // namespace grinder
