#include "flute_grinder/control/loop_status.h"

#include <algorithm>

namespace grinder {

Wheel wheelOf(const GrindProgram& program) {
  double deepest = program.clearanceHeight();
  for (const Move& move : program.moves()) deepest = std::min(deepest, move.to[kY]);
  // The sum is rounded as in the command, so that the wheel counts as clear exactly where the program leaves it. At the
  // axis limit it may be rounded up, but no lift may exceed the limit.
  const double clear_y =
      std::min(program.clearanceHeight() + program.run().offset[kY], program.machine().limits.max_position[kY]);
  Wheel wheel{false, clear_y, program.clearanceHeight() - deepest};
  if (!program.job()->comesAlongX()) return wheel;
  double farthest = program.clearX();
  for (const Move& move : program.moves()) {
    if (move.kind == MoveKind::kStroke) farthest = std::max(farthest, move.to[kX]);
  }
  wheel.clear_x = std::max(program.clearX() + program.run().offset[kX], program.machine().limits.min_position[kX]);
  wheel.back = farthest - program.clearX();
  return wheel;
}

Wheel unknownWheel(const AxisLimits& limits, bool is_cup) {
  const double top = limits.max_position[kY], front = limits.min_position[kX];
  return {true, top, top - limits.min_position[kY], false, false, front, is_cup ? limits.max_position[kX] - front : 0};
}

}  // namespace grinder
