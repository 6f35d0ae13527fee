#pragma once

#include "panel/grinder_link.h"
#include "panel/number_box.h"

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QWidget>

#include <optional>

namespace flute_grinder {

/// Sets the work offset of an axis from where it stands, and shows the offset with who set it and when.
class TouchOffBox : public QWidget {
  Q_OBJECT

 public:
  explicit TouchOffBox(QWidget* parent = nullptr);

  /// @param has_services whether requests with an answer can be sent.
  void refresh(const GrinderView& view, bool has_services);

  /// Asks whether to set the offset although it changes by much; the next press of the button says so, unless the axis,
  /// its position or the value changes before.
  void askToConfirm();

 Q_SIGNALS:
  /// @param at the axis' work position; of Y the diameter of the blank that the wheel touches [m], of A [rad].
  /// @param confirmed the offset may change by any amount.
  void wanted(int axis, double at, bool confirmed);

 private:
  int axis() const { return axis_->currentIndex(); }
  void chooseAxis();
  void touch();
  void forgetQuestion();
  QString offsetText(const GrinderView& view) const;

  QComboBox* axis_;
  NumberBox* at_;  ///< [mm or deg]
  QPushButton* touch_;
  std::optional<double> asked_at_;  ///< machine position for which askToConfirm() asks [m], A [rad]
  double position_ = 0;             ///< of the axis, as last received [m], A [rad]
  QLabel* offset_;
};

}  // namespace flute_grinder
