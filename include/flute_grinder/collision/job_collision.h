#pragma once

#include "flute_grinder/collision/collision_check.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/motion/grind_program.h"

#include <optional>
#include <vector>

namespace grinder {

/// The path of a program, from its start on, with straight legs in X, Y and Z.
struct ProgramPath {
  std::vector<Axes> points;
  std::vector<std::size_t> moves;  ///< of every leg, the program's move
};

/// A move is a leg. A stroke whose Z is corrected is bent: it is so many legs that they are within 1 um of it.
ProgramPath pathOf(const GrindProgram& program);

/// What the job of a program adds to the machine's bodies. The wheel is that of the job's start.
CollisionJob collisionJobOf(const GrindProgram& program);

/// How close wheel, machine and cutter come to each other.
struct CollisionResult {
  std::optional<ClosestPlace> closest;  ///< its leg is a move of the program
  std::optional<Reason> reason;         ///< why that is refused
};

/// Finds the closest place of a job. Takes a few milliseconds. There is a reason if the bodies hit each other or come
/// closer than Machine::collision_clearance, if the wheel comes too close to the work outside the cut (closer than half
/// of GrindProcess::clearance, but no more than collision_clearance), or if the wheel's corner radii do not fit.
CollisionResult checkCollision(const GrindProgram& program, const MachineShapes& machine);

}  // namespace grinder
