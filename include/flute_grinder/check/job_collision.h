#pragma once

#include "flute_grinder/check/collision_check.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/motion/grind_program.h"

#include <optional>
#include <vector>

namespace grinder {

/// The path of a program from its start, with straight legs in X, Y and Z.
struct ProgramPath {
  std::vector<Axes> points;
  std::vector<std::size_t> moves;  ///< index of the program's move for every leg
};

/// The path of a program. Each move is a leg; a stroke with a correction of Z is curved, and split into legs within 1
/// um of it.
ProgramPath pathOf(const GrindProgram& program);

/// The data that a program's job adds to the machine's bodies, with the wheel at the start of the job.
CollisionJob collisionJobOf(const GrindProgram& program);

/// The smallest distance between wheel, machine and cutter.
struct CollisionResult {
  std::optional<ClosestPlace> closest;  ///< its leg is a move of the program
  std::optional<Reason> reason;         ///< why that distance is refused
};

/// Finds the closest place of a job, in a few milliseconds. There is a reason if bodies hit each other or come closer
/// than Machine::collision_clearance, if the wheel comes too close to the work outside the cut (closer than half of
/// GrindProcess::clearance, but at most collision_clearance), or if the wheel's corner radii do not fit.
CollisionResult checkCollision(const GrindProgram& program, const MachineShapes& machine);

}  // namespace grinder
