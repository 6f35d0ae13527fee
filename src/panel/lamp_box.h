#pragma once

#include "panel/grinder_link.h"

#include <QLabel>
#include <QWidget>

namespace grinder {

/// Lamps for the spindle, the coolant and the probe, in a line: what is commanded is told from what the drive reports,
/// in words, and by a circle that is empty, half full or full. A machine that lacks one has no lamp for it.
class LampBox : public QWidget {
  Q_OBJECT

 public:
  explicit LampBox(QWidget* parent = nullptr);
  void show(const GrinderView& view);

 private:
  QLabel* spindle_;
  QLabel* coolant_;
  QLabel* probe_;
};

}  // namespace grinder
