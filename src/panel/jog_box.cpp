#include "panel/jog_box.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/machine/machine_state.h"
#include "panel/panel_button.h"

#include <QApplication>
#include <QCursor>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>

namespace grinder {

namespace {

/// Period of the messages of a continuous jog, at most half of the shortest jog_timeout [ms].
constexpr int kRepeatInterval = 25;

/// Sizes with which a hurried hand hits a button and not its neighbour [px].
constexpr int kButtonHeight = 40, kApart = 8, kOppositesApart = 20;

constexpr double kContinuous = 0;                                 ///< entry for a continuous jog among the steps
constexpr std::array<double, 5> kSteps{0.001, 0.01, 0.1, 1, 10};  ///< steps [mm], A [deg]

/// Initial speeds; the operator's changes are not saved.
constexpr double kLinearSpeed = 600;   ///< speed of X, Y and Z [mm/min]
constexpr double kRotarySpeed = 1800;  ///< speed of A [deg/min]
constexpr double kMaxSpeed = 99999;
constexpr int kSpeedDecimals = 3;

NumberBox* speedBox(const char* name, const QString& unit, double value) {
  auto* box = new NumberBox(name, kSpeedDecimals);
  box->setRange(1, kMaxSpeed);
  box->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  box->setSuffix(" " + unit);
  box->setToolTip("Speed of the jog");
  box->setValue(value);
  return box;
}

}  // namespace

JogBox::JogBox(QWidget* parent)
    : QWidget(parent),
      step_(new QComboBox),
      linear_speed_(speedBox("jog_speed", "mm/min", kLinearSpeed)),
      rotary_speed_(speedBox("jog_speed_a", "deg/min", kRotarySpeed)) {
  step_->setObjectName("jog_step");
  for (const double step : kSteps) step_->addItem(QString("%1 mm, deg").arg(step), step);
  step_->addItem("while pressed", kContinuous);
  auto* speeds = new QHBoxLayout;
  speeds->setSpacing(6);
  speeds->addWidget(linear_speed_);
  speeds->addWidget(rotary_speed_);
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(kApart);
  layout->setVerticalSpacing(2);
  layout->setRowMinimumHeight(2, kApart);
  layout->setRowMinimumHeight(4, kOppositesApart);
  layout->setRowMinimumHeight(6, kApart);
  layout->addWidget(new QLabel("Step"), 0, 0);
  layout->addWidget(step_, 0, 1, 1, 3);
  layout->addLayout(speeds, 1, 0, 1, 4);
  std::size_t place = 0;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const int direction : {1, -1}) {
      const Button button{addButton(axis, direction), axis, direction};
      layout->addWidget(button.button, direction > 0 ? 3 : 5, axis);
      connect(button.button, &QPushButton::clicked, this, [this, button] { click(button); });
      connect(button.button, &QPushButton::pressed, this, [this, button] { press(button); });
      connect(button.button, &QPushButton::released, this, &JogBox::repeat);
      buttons_[place++] = button;
    }
    layout->setColumnStretch(axis, 1);
  }
  connect(&repeat_, &QTimer::timeout, this, &JogBox::repeat);
}

QPushButton* JogBox::addButton(int axis, int direction) {
  const QChar name = axisLetter(axis);
  const bool up = direction > 0;
  auto* button = new PanelButton(QString("jog_%1_%2").arg(name.toLower()).arg(up ? "plus" : "minus"),
                                 QString("%1 %2").arg(name).arg(up ? "+" : QString::fromUtf8("\xe2\x88\x92")),
                                 QString("Jog axis %1").arg(name));
  // The jog ends when the button loses the focus, for instance to another window.
  button->setFocusPolicy(Qt::ClickFocus);
  button->setMinimumHeight(kButtonHeight);
  button->setEnabled(false);
  return button;
}

bool JogBox::isContinuous() const { return step_->currentData().toDouble() == kContinuous; }

double JogBox::speed(int axis) const { return speedBoxOf(axis).value() * shopScale(unitOf(axis, 0)) / 60; }

void JogBox::click(const Button& button) {
  if (isContinuous()) return;
  const double step = button.direction * step_->currentData().toDouble();
  Q_EMIT stepWanted(button.axis, step * shopScale(unitOf(button.axis, 0)), speed(button.axis));
}

void JogBox::press(const Button& button) {
  if (!isContinuous()) return;
  pressed_ = button;
  since_message_.start();
  repeat_.start(kRepeatInterval);
  repeat();
}

void JogBox::repeat() {
  if (!pressed_) return;
  const QPushButton& button = *pressed_->button;
  // A menu or a dialog may take the mouse, so that the button does not see its release.
  const bool covered = QApplication::activePopupWidget() || QApplication::activeModalWidget();
  const bool pressed = button.isDown() && button.isEnabled() && button.isVisible() && !covered;
  // QCursor::pos() waits for an answer of the X server, so that no message is sent while the display hangs.
  if (pressed) QCursor::pos();
  const bool goes_on = pressed && since_message_.restart() <= timeout_ * 1e3;
  const int axis = pressed_->axis;
  const double velocity = goes_on ? pressed_->direction * speed(axis) : 0;
  if (!goes_on) {
    pressed_.reset();
    repeat_.stop();
  }
  Q_EMIT continuousWanted(axis, velocity);
}

void JogBox::refresh(const std::optional<flute_grinder::GrinderState>& state, double timeout, bool has_services) {
  timeout_ = timeout;
  const bool allowed = state && after(static_cast<MachineState>(state->state), MachineEvent::kJog) && state->homed != 0;
  const bool reached = isContinuous() ? timeout > 0 : has_services;
  for (const Button& button : buttons_) {
    const bool out = state && (state->wheel_backs_off ? button.axis == kX && button.direction < 0
                                                      : button.axis == kY && button.direction > 0);
    const bool safe = state && (!state->wheel_in_work || out);
    button.button->setEnabled(allowed && reached && safe && speedBoxOf(button.axis).isGood());
  }
}

}  // namespace grinder
