#include "flute_grinder/collision/job_collision.h"

#include "flute_grinder/geometry/ground_job.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace flute_grinder {

namespace {

constexpr double kBow = 1e-6;  ///< between a bent stroke and its legs [m]

/// Of the ends of infeeds and strokes, the one at the shank, and there the deepest.
Axes strokeEndOf(const GrindProgram& program) {
  const Move* end = nullptr;
  for (const Move& move : program.moves()) {
    if (!isAtFeed(move.kind)) continue;
    const bool nearer = !end || move.to[kX] > end->to[kX];
    if (nearer || (move.to[kX] == end->to[kX] && move.to[kY] < end->to[kY])) end = &move;
  }
  return end->to;
}

core::Reason reasonOf(const ClosestPlace& place, const GrindProgram& program) {
  const Move& move = program.moves()[place.leg];
  core::Reason reason;
  reason.kind = core::ReasonKind::kCollision;
  reason.detail = place.first + " and " + place.second;
  reason.unit = Unit::kMetre;
  reason.value = place.distance;
  reason.limit = program.machine().collision_clearance;
  reason.has_place = true;
  reason.move = move.kind;
  reason.tooth = move.tooth;
  reason.pass = move.pass;
  reason.x = place.axes[kX];
  return reason;
}

}  // namespace

ProgramPath pathOf(const GrindProgram& program) {
  ProgramPath path{{program.start()}, {}};
  for (std::size_t i = 0; i < program.moves().size(); ++i) {
    const Move& move = program.moves()[i];
    const Helix& helix = program.helix(move.tooth);
    const Axes from = path.points.back();
    const Axes way = move.to - from;
    const double bend = move.kind == MoveKind::kStroke ? helix.z_correction.bounds().second : 0;
    const double legs = std::max(1.0, std::ceil(std::abs(way[kX]) * std::sqrt(bend / (8 * kBow))));
    for (double leg = 1; leg < legs; ++leg) {
      Axes at = from + way * (leg / legs);
      at[kZ] = helix.z(at[kX]);
      path.points.push_back(at);
    }
    path.points.push_back(move.to);
    path.moves.resize(path.points.size() - 1, i);
  }
  return path;
}

CollisionJob collisionJobOf(const GrindProgram& program) {
  const GrindJob& job = program.job();
  const bool has_neck = job.cutter.neck_length > 0;
  return {wheelOf(job).worn(job.process.wheel_wear),
          job.process.wheel_diameter / 2,
          setupOf(job),
          job.cutter,
          job.cutter.shank_diameter,
          has_neck ? std::optional<double>(job.cutter.flute_length + job.cutter.neck_length) : std::nullopt,
          strokeEndOf(program),
          program.machine().collision_clearance,
          program.machine().work_offset[kX]};
}

void checkCollision(JobPlan& plan, const MachineShapes& machine) {
  if (!plan.program || plan.fault == PlanFault::kGivenUp) return;
  core::Reason reason;
  try {
    const ProgramPath path = pathOf(*plan.program);
    plan.closest = CollisionCheck(machine, collisionJobOf(*plan.program)).closest(path.points);
    plan.closest->leg = path.moves.at(plan.closest->leg);
    const double distance = plan.closest->distance;
    if (distance > 0 && distance >= plan.program->machine().collision_clearance) return;
    reason = reasonOf(*plan.closest, *plan.program);
  } catch (const std::invalid_argument& error) {
    reason.kind = core::ReasonKind::kOther;
    reason.detail = error.what();
  }
  if (plan.good()) plan.fault = PlanFault::kCollision;
  plan.reasons.push_back(std::move(reason));
}

}  // namespace flute_grinder
