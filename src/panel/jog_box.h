#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/base/axes.h"
#include "panel/number_box.h"

#include <QComboBox>
#include <QElapsedTimer>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

#include <array>
#include <optional>

namespace grinder {

/// Buttons that jog the axes: by a step with each click, or for as long as a button is pressed. A continuous jog ends
/// when the button is released, hidden or disabled, or loses the focus. It also ends if this program or the display
/// hangs for longer than the grinder's jog_timeout, when a release may be on its way; the button must be pressed anew.
class JogBox : public QWidget {
  Q_OBJECT

 public:
  explicit JogBox(QWidget* parent = nullptr);

  /// @param timeout longest time between the messages of a continuous jog; 0 if unknown [s].
  /// @param has_services whether requests with an answer can be sent; a continuous jog does not need them.
  void refresh(const std::optional<flute_grinder::GrinderState>& state, double timeout, bool has_services);

 Q_SIGNALS:
  void stepWanted(int axis, double distance, double speed);  ///< [m] and [m/s], A [rad] and [rad/s]
  void continuousWanted(int axis, double velocity);          ///< [m/s], A [rad/s]; 0 stops

 private:
  struct Button {
    QPushButton* button;
    int axis;
    int direction;  ///< direction of the jog, +1 or -1
  };

  QPushButton* addButton(int axis, int direction);
  void click(const Button& button);
  void press(const Button& button);
  void repeat();
  bool isContinuous() const;
  const NumberBox& speedBoxOf(int axis) const { return axis == kA ? *rotary_speed_ : *linear_speed_; }
  double speed(int axis) const;

  QComboBox* step_;
  NumberBox* linear_speed_;  ///< speed of X, Y and Z [mm/min]
  NumberBox* rotary_speed_;  ///< speed of A [deg/min]
  std::array<Button, std::size_t{2} * kAxisCount> buttons_{};
  std::optional<Button> pressed_;  ///< button of the continuous jog in progress
  QElapsedTimer since_message_;
  double timeout_ = 0;  ///< longest time between messages [s]
  QTimer repeat_;
};

}  // namespace grinder
