#include "panel/click_guard.h"

#include <QAbstractButton>
#include <QApplication>
#include <QMouseEvent>

namespace grinder {

namespace {

constexpr unsigned long kDoubleClick = 500;  ///< longest time between its clicks, whatever the desktop's setting [ms]
constexpr int kSamePlace = 10;               ///< longest distance between its clicks [px]

/// An event filter of the whole application, because a click may close a dialog that lies over another button.
class ClickGuard : public QObject {
 public:
  ClickGuard(QWidget& parent, const std::set<QWidget*>& always) : QObject(&parent), always_(always) {}

  bool eventFilter(QObject* watched, QEvent* event) override {
    const bool press = event->type() == QEvent::MouseButtonPress || event->type() == QEvent::MouseButtonDblClick;
    if (!press || !watched->isWidgetType()) return false;
    const auto& mouse = static_cast<QMouseEvent&>(*event);
    // A press that a widget does not take goes on to its parent, with the same time.
    if (mouse.timestamp() != time_) {
      time_ = mouse.timestamp();
      second_ = time_ - first_ <= kDoubleClick && (mouse.globalPos() - place_).manhattanLength() <= kSamePlace;
      if (!second_) first_ = time_, place_ = mouse.globalPos();
    }
    auto* button = qobject_cast<QAbstractButton*>(watched);
    return second_ && button && isOurs(*button) && always_.count(button) == 0;
  }

 private:
  bool isOurs(const QObject& button) const {
    const QObject* above = &button;
    while (above && above != parent()) above = above->parent();
    return above;
  }

  const std::set<QWidget*> always_;
  unsigned long time_ = 0;   ///< time of the last click [ms]
  unsigned long first_ = 0;  ///< time of the last first click [ms]
  QPoint place_;             ///< place of the last first click
  bool second_ = false;      ///< the last click was the second of a double click
};

}  // namespace

void guardFromDoubleClicks(QWidget& parent, const std::set<QWidget*>& always) {
  QApplication::instance()->installEventFilter(new ClickGuard(parent, always));
}

}  // namespace grinder
