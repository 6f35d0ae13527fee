#include "panel/wheel_guard.h"

#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QEvent>
#include <QScrollBar>

namespace grinder {

namespace {

class WheelGuard : public QObject {
 public:
  using QObject::QObject;

  bool eventFilter(QObject* watched, QEvent* event) override {
    const bool stray = event->type() == QEvent::Wheel && !static_cast<QWidget*>(watched)->hasFocus();
    if (stray) event->ignore();
    return stray;
  }
};

bool hasValue(QWidget* widget) {
  const bool slides = qobject_cast<QAbstractSlider*>(widget) && !qobject_cast<QScrollBar*>(widget);
  return slides || qobject_cast<QAbstractSpinBox*>(widget) || qobject_cast<QComboBox*>(widget);
}

}  // namespace

void guardFromWheel(QWidget& parent) {
  auto* guard = new WheelGuard(&parent);
  for (QWidget* widget : parent.findChildren<QWidget*>()) {
    if (!hasValue(widget)) continue;
    widget->setFocusPolicy(Qt::StrongFocus);
    widget->installEventFilter(guard);
  }
}

}  // namespace grinder
