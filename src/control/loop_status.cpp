#include "flute_grinder/control/loop_status.h"

#include <algorithm>

namespace flute_grinder {

Wheel wheelOf(const GrindProgram& program) {
  double deepest = program.clearanceHeight();
  for (const Move& move : program.moves()) deepest = std::min(deepest, move.to[kY]);
  return {false, program.clearanceHeight(), program.clearanceHeight() - deepest};
}

}  // namespace flute_grinder
