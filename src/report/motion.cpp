#include "report/motion.h"

#include <algorithm>
#include <limits>

namespace grinder {

namespace {

constexpr std::int64_t kUnknown = std::numeric_limits<std::int64_t>::min() / 2;

}  // namespace

MotionOfRows::MotionOfRows(const BagRun& run) : period_(run.period()) {
  // A job starts at rest; if its beginning was not recorded, the motion before is unknown.
  const RowSummary& all = run.summary();
  for (std::size_t i = 0; i < before_.size(); ++i) {
    before_[i] = {all.first_cycle == 0 ? -1 - static_cast<std::int64_t>(i) : kUnknown, all.first};
  }
}

AxisMotion MotionOfRows::add(const RunRow& row) {
  const Point now{static_cast<std::int64_t>(row.setpoint.cycle), row.setpoint.position};
  AxisMotion motion;
  if (now.cycle - before_[0].cycle == 1) {
    motion.speed = (now.position - before_[0].position) / period_;
    if (row.actual.allFinite()) motion.following_error = before_[0].position - row.actual;
  }
  if (now.cycle % 2 == 0 && now.cycle - before_[3].cycle == 4) {
    const double pair = 2 * period_;
    motion.acceleration = (now.position - 2 * before_[1].position + before_[3].position) / (pair * pair);
  }
  std::rotate(before_.begin(), before_.end() - 1, before_.end());
  before_[0] = now;
  return motion;
}

}  // namespace grinder
