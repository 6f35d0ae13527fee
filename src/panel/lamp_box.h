#pragma once

#include "flute_grinder/client/grinder_client.h"

#include <QLabel>
#include <QWidget>

namespace grinder {

/// A line of lamps for the spindle, the coolant and the probe. Words, and a circle that is empty, half full or full,
/// tell the command from the drive's report. A device that the machine lacks has no lamp.
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
