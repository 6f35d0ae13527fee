#include "flute_grinder/check/job_collision.h"

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

constexpr double kBow = 1e-6;      ///< maximum distance between a curved stroke and its legs [m]
constexpr double kWorkPart = 0.5;  ///< fraction of the job's clearance; a cone that rises to the wheel uses some of it

/// The end at the shank of infeeds and strokes, at the greatest depth.
Axes strokeEndOf(const GrindProgram& program) {
  const Move* end = nullptr;
  for (const Move& move : program.moves()) {
    if (!isAtFeed(move.kind)) continue;
    const bool nearer = !end || move.to[kX] > end->to[kX];
    if (nearer || (move.to[kX] == end->to[kX] && move.to[kY] < end->to[kY])) end = &move;
  }
  return end->to;
}

/// The maximum radius of the work within the wheel's reach of a position [m].
double workRadiusNear(const GrindJob& job, const WheelProfile& wheel, double x) {
  const double reach = wheel.maxRadius() + wheel.upperFace() - wheel.lowerFace();
  const double flute_end = job.cutter.flute_length;
  const ConicalCutter cone(job.cutter);
  const auto radius = [&](double at) { return cone.radius(std::clamp(at, 0.0, flute_end)); };
  const double shank = x + reach < flute_end + job.cutter.neck_length ? 0 : job.cutter.shank_diameter / 2;
  return std::max({radius(x - reach), radius(x + reach), shank});
}

bool isUp(MoveKind kind) { return kind == MoveKind::kLift || kind == MoveKind::kRetract; }

/// Whether a move up leaves the work alone even if the wheel is in it, as after a stroke: over the whole width of the
/// wheel, everything above its lower side is within the wheel, because no work is higher than its spindle.
bool risesOut(const GrindProgram& program, const WheelProfile& wheel, const Axes& from) {
  const GrindJob& job = *program.job();
  const double spindle = job.cutter.end_diameter / 2 + job.process().wheel_diameter / 2 + from[kY];
  return spindle >= workRadiusNear(job, wheel, from[kX]);
}

/// Whether the wheel must keep off the work, for every leg.
std::vector<bool> outsideCut(const GrindProgram& program, const ProgramPath& path) {
  const WheelProfile wheel = wheelOf(*program.job());
  std::vector<bool> outside;
  outside.reserve(path.moves.size());
  for (std::size_t leg = 0; leg < path.moves.size(); ++leg) {
    const MoveKind kind = program.moves()[path.moves[leg]].kind;
    // A cup is in the cut until it has backed off along X.
    if (program.job()->comesAlongX()) {
      const bool backs_off = isUp(kind) && path.points[leg + 1][kX] < path.points[leg][kX];
      outside.push_back(!isAtFeed(kind) && !backs_off);
      continue;
    }
    outside.push_back(!isAtFeed(kind) && !(isUp(kind) && risesOut(program, wheel, path.points[leg])));
  }
  return outside;
}

/// Adds the legs of a stroke before the last one.
void addBend(std::vector<Axes>& points, const Move& stroke, const Helix& helix) {
  const Axes from = points.back(), way = stroke.to - from;
  const double bend = helix.z_correction.bounds().second;
  const double legs = std::max(1.0, std::ceil(std::abs(way[kX]) * std::sqrt(bend / (8 * kBow))));
  for (double leg = 1; leg < legs; ++leg) {
    Axes at = from + way * (leg / legs);
    at[kZ] = helix.z(at[kX]);
    points.push_back(at);
  }
}

/// X where the shank begins for the wheel: behind a neck; for strokes on the end, behind the flutes; otherwise where
/// the wheel leaves the work.
std::optional<double> shankFrom(const GrindProgram& program) {
  const CutterGeometry& c = program.job()->cutter;
  if (c.neck_length > 0 || program.isStraight()) return c.flute_length + c.neck_length;
  return std::nullopt;
}

/// The set-up; no laws of the flutes are in it, since only the wheel's place counts.
WheelSetup wheelSetupOf(const GrindJob& job) { return {job.process().setup_swivel, job.process().setup_height, 0}; }

/// See CollisionJob::work_clearance.
double workClearance(const GrindProgram& program) {
  return std::min(program.machine().collision_clearance, kWorkPart * program.job()->process().clearance);
}

Reason reasonOf(const ClosestPlace& place, const GrindProgram& program) {
  const Move& move = program.moves()[place.leg];
  Reason reason;
  reason.kind = ReasonKind::kCollision;
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

/// The reason for a wheel that comes too close to the work outside the cut.
Reason reasonInWork(const ClosestPlace& place, const GrindProgram& program) {
  Reason reason = reasonOf(place, program);
  if (isUp(reason.move)) return reason;  // another clearance would not change where the move begins
  reason.field = "process.clearance";
  reason.low = program.job()->process().clearance;
  reason.limit = workClearance(program);
  return reason;
}

}  // namespace

ProgramPath pathOf(const GrindProgram& program) {
  ProgramPath path{{program.start()}, {}};
  for (std::size_t i = 0; i < program.moves().size(); ++i) {
    const Move& move = program.moves()[i];
    if (move.kind == MoveKind::kStroke && !program.isStraight()) addBend(path.points, move, program.helix(move.tooth));
    path.points.push_back(move.to);
    path.moves.resize(path.points.size() - 1, i);
  }
  return path;
}

CollisionJob collisionJobOf(const GrindProgram& program) {
  const GrindJob& job = *program.job();
  return {wheelOf(job).worn(job.process().wheel_wear),
          job.process().wheel_diameter / 2,
          wheelSetupOf(job),
          job.cutter,
          job.cutter.shank_diameter,
          shankFrom(program),
          strokeEndOf(program),
          program.machine().collision_clearance,
          program.run().offset[kX],
          workClearance(program)};
}

CollisionResult checkCollision(const GrindProgram& program, const MachineShapes& machine) {
  try {
    const ProgramPath path = pathOf(program);
    const CollisionCheck check(machine, collisionJobOf(program));
    const auto on_move = [&](ClosestPlace place) {
      place.leg = path.moves.at(place.leg);
      return place;
    };
    const ClosestPlace closest = on_move(check.closest(path.points));
    if (!(closest.distance > 0 && closest.distance >= program.machine().collision_clearance)) {
      return {closest, reasonOf(closest, program)};
    }
    const auto in_work = check.tooCloseToWork(path.points, outsideCut(program, path));
    if (!in_work) return {closest, std::nullopt};
    const ClosestPlace in_work_move = on_move(*in_work);
    return {in_work_move, reasonInWork(in_work_move, program)};
  } catch (const std::invalid_argument& error) {
    return {std::nullopt, otherReason(error.what())};
  }
}

}  // namespace grinder
