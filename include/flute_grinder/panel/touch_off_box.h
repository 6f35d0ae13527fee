#pragma once

#include "flute_grinder/panel/grinder_link.h"
#include "flute_grinder/panel/number_box.h"

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QWidget>

namespace flute_grinder {

/// Sets the work offset of an axis from where it stands, and shows the offset with who set it and when.
class TouchOffBox : public QWidget {
  Q_OBJECT

 public:
  explicit TouchOffBox(QWidget* parent = nullptr);

  /// @param has_services whether requests with an answer can be sent.
  void refresh(const GrinderView& view, bool has_services);

 Q_SIGNALS:
  /// @param at the axis' work position; of Y the diameter of the blank that the wheel touches [m], of A [rad].
  void wanted(int axis, double at);

 private:
  int axis() const { return axis_->currentIndex(); }
  void chooseAxis();
  QString offsetText(const GrinderView& view) const;

  QComboBox* axis_;
  NumberBox* at_;  ///< [mm or deg]
  QPushButton* touch_;
  QLabel* offset_;
};

}  // namespace flute_grinder
