#pragma once

#include "flute_grinder/report/bag_run.h"

#include <array>
#include <optional>

namespace grinder {

/// The commanded motion of the axes at a row; nothing where unknown [m, A rad; per s and per s^2].
struct AxisMotion {
  std::optional<Axes> speed;            ///< speed since the previous cycle
  std::optional<Axes> acceleration;     ///< acceleration between the ends of odd-even pairs, as checked by the plan
  std::optional<Axes> following_error;  ///< command of the previous cycle less the position read
};

/// Computes the motion from the rows of a file; nothing where cycles are missing.
class MotionOfRows {
 public:
  explicit MotionOfRows(const BagRun& run);

  /// Adds a row. @param row the next row.
  AxisMotion add(const RunRow& row);

 private:
  struct Point {
    std::int64_t cycle;
    Axes position;
  };

  const double period_;
  std::array<Point, 4> before_;  ///< previous points, the newest first
};

}  // namespace grinder
