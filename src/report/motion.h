#pragma once

#include "flute_grinder/report/bag_run.h"

#include <array>
#include <optional>

namespace grinder {

/// What the axes do at a row; nothing where it is not known. Commanded [m, A rad; per s and per s^2].
struct AxisMotion {
  std::optional<Axes> speed;            ///< from the cycle before
  std::optional<Axes> acceleration;     ///< between the ends of odd-even pairs, as the plan checks it
  std::optional<Axes> following_error;  ///< command of the cycle before less the position read
};

/// Follows the rows of a file. Where cycles are missing there is no motion.
class MotionOfRows {
 public:
  explicit MotionOfRows(const BagRun& run);

  /// @param row the next one.
  AxisMotion add(const RunRow& row);

 private:
  struct Point {
    std::int64_t cycle;
    Axes position;
  };

  const double period_;
  std::array<Point, 4> before_;  ///< the newest first
};

}  // namespace grinder
