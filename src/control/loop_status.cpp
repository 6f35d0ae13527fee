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
  return {false, clear_y, program.clearanceHeight() - deepest};
}

Wheel unknownWheel(const AxisLimits& limits) {
  const double top = limits.max_position[kY];
  return {true, top, top - limits.min_position[kY], false, false};
}

}  // namespace grinder
