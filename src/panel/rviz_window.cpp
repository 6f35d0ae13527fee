#include "panel/rviz_window.h"

#include "panel/beside.h"

#include <rviz/panel_dock_widget.h>
#include <QAction>
#include <QEvent>
#include <QMenu>
#include <QMenuBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace grinder {

namespace {

constexpr int kQuestionLines = 6, kQuestionWidth = 360;
constexpr const char* kQuit = "Quit";  ///< name in rviz's menu *File*

bool isQuit(const QAction& action) { return action.text().remove('&') == kQuit; }

}  // namespace

RvizWindow::RvizWindow(QWidget& panel)
    : QObject(&panel),
      panel_(panel),
      dialog_(new QDialog(&panel)),
      question_(new Question("end_rviz", kQuestionLines)) {
  dialog_->setObjectName("end_rviz_dialog");
  dialog_->setWindowTitle("End rviz?");
  auto* layout = new QVBoxLayout(dialog_);
  layout->addWidget(question_);
  dialog_->setFixedWidth(kQuestionWidth);
  question_->setFixedHeight(question_->minimumSizeHint().height());
  connect(question_, &Question::answered, dialog_, &QDialog::hide);
}

void RvizWindow::keepPanel(const QString& why) {
  why_ = why;
  if (!window_) watch();
  if (!window_ || !dock_) return;
  if (!fits_ && window_->isVisible()) fitScreen();
  if (why.isEmpty()) return unlock();
  lock();
}

void RvizWindow::watch() {
  dock_ = qobject_cast<rviz::PanelDockWidget*>(panel_.parentWidget());
  // A floating dock still has the window as its parent.
  window_ = dock_ ? qobject_cast<QMainWindow*>(dock_->parentWidget()) : nullptr;
  if (!window_) return;
  dock_->installEventFilter(this);
  window_->installEventFilter(this);
}

/// Fits the window to the screen: rviz takes its size from the configuration.
void RvizWindow::fitScreen() {
  fits_ = true;
  const QRect screen = window_->windowHandle()->screen()->availableGeometry();
  const QRect frame = window_->frameGeometry();
  window_->resize(window_->size().boundedTo(screen.size() - frame.size() + window_->size()));
  const QPoint last = screen.bottomRight() - window_->frameGeometry().bottomRight() + frame.topLeft();
  window_->move(std::clamp(frame.x(), screen.x(), std::max(screen.x(), last.x())),
                std::clamp(frame.y(), screen.y(), std::max(screen.y(), last.y())));
}

void RvizWindow::lock() {
  // The features first, because changing them also changes the dock's own action.
  dock_->setFeatures(dock_->features() & ~QDockWidget::DockWidgetClosable);
  for (auto* box : dock_->titleBarWidget()->findChildren<QToolButton*>()) switchOff(box);
  for (auto* fold : window_->centralWidget()->findChildren<QToolButton*>(QString(), Qt::FindDirectChildrenOnly)) {
    switchOff(fold);
  }
  for (const QAction* title : window_->menuBar()->actions()) {
    for (QAction* action : title->menu() ? title->menu()->actions() : QList<QAction*>()) {
      if (!isQuit(*action)) switchOff(action);
    }
  }
  showPanel();
}

void RvizWindow::switchOff(QObject* item) {
  if (!item->property("enabled").toBool()) return;
  item->setProperty("enabled", false);
  off_.emplace_back(item);
}

/// Shows the panel, even if it was hidden when the motion began.
void RvizWindow::showPanel() {
  if (!dock_->isHidden()) return;
  dock_->overrideVisibility(false);
  dock_->setCollapsed(false);
  dock_->show();
  dock_->raise();
}

void RvizWindow::unlock() {
  dialog_->hide();
  if (off_.empty()) return;
  dock_->setFeatures(dock_->features() | QDockWidget::DockWidgetClosable);
  for (const auto& item : off_) {
    if (item) item->setProperty("enabled", true);
  }
  off_.clear();
}

bool RvizWindow::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::Close || why_.isEmpty() || ends_) return false;
  event->ignore();
  if (watched == window_) ask();
  return true;
}

void RvizWindow::ask() {
  if (dialog_->isVisible()) return dialog_->raise();
  question_->ask(why_ +
                     " It goes on without this panel, and then only a terminal ('grind hold', 'grind cancel') and the "
                     "emergency stop stop it. End rviz all the same?",
                 {}, {{"end_rviz", "End rviz", "The grinder goes on, without its panel", true, [this] {
                         ends_ = true;
                         window_->close();
                         ends_ = false;
                       }}});
  moveBeside(*dialog_, panel_);
  dialog_->show();
}

}  // namespace grinder
