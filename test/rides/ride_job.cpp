#include "ride_job.h"

#include "face_opinion.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grinder::test_support {

namespace {

Machine randomMachine(Random& random) {
  Machine m;
  m.limits.min_position << -1, -1, -1, -1e5;
  m.limits.max_position << 1, 1, 1, 1e5;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const bool rotary = axis == kA;
    m.limits.max_velocity[axis] = acrossDecades(random, rotary ? 10 : 0.1, rotary ? 60 : 0.5);
    m.limits.max_acceleration[axis] = acrossDecades(random, rotary ? 50 : 0.5, rotary ? 1000 : 10);
    m.limits.max_jerk[axis] = acrossDecades(random, rotary ? 1000 : 10, rotary ? 1e5 : 1000);
  }
  m.period = 1 / between(random, 500, 2000);
  return m;
}

CutterGeometry randomCutter(Random& random) {
  CutterGeometry c;
  c.end_diameter = acrossDecades(random, 2e-3, 25e-3);
  c.cone_angle = flip(random, 0.2) ? 0 : between(random, -0.05, 0.3);
  c.spiral_angle = flip(random, 0.1) ? 0 : between(random, -0.8, 0.8);
  c.rake_angle = between(random, -0.2, 0.4);
  c.cut = flip(random, 0.5) ? CutDirection::kRightHand : CutDirection::kLeftHand;
  c.flute_length = acrossDecades(random, 0.5e-3, 10e-3);
  c.rake_tolerance = c.spiral_tolerance = c.chordal_rake_tolerance = 0.01;
  c.core_tolerance = 0.1e-3;
  c.shank_diameter = c.end_diameter + 2 * c.flute_length * std::max(0.0, std::tan(c.cone_angle));
  c.core_diameter = c.core_diameter_end = c.end_diameter / 2;
  return c;
}

GrindProcess randomProcess(Random& random, const CutterGeometry& cutter) {
  GrindProcess p;
  p.feed = acrossDecades(random, 2e-3, 60e-3);
  p.depth = cutter.end_diameter / 2 * between(random, 0.05, 0.3);
  p.depth_end = flip(random, 0.5) ? 0 : p.depth * between(random, 0.7, 1.2);
  p.infeed = p.deepest() / between(random, 0.9, 3);
  p.spark_out = flip(random, 0.3) ? 1 : 0;
  if (flip(random, 0.2)) p.finish_infeed = p.infeed / 10;
  p.clearance = between(random, 0.1e-3, 2e-3);
  p.overtravel_end = between(random, 0, 1e-3);
  p.overtravel_shank = between(random, 0, 1e-3);
  p.order = std::array{GrindOrder::kToothMajor, GrindOrder::kPassMajor,
                       GrindOrder::kFinishTogether}[static_cast<std::size_t>(fraction(random) * 3)];
  if (flip(random, 0.2)) p.infeed = 0, p.roughing_passes = 1 + static_cast<int>(fraction(random) * 3);
  p.direction = flip(random, 0.5) ? StrokeDirection::kFromEnd : StrokeDirection::kToEnd;
  p.wheel_diameter = 100e-3;
  p.wheel_width = 8e-3;
  p.wheel_wear = flip(random, 0.5) ? 0 : between(random, 0, 1e-3);
  p.wheel_wear_per_pass = flip(random, 0.5) ? 0 : between(random, 0, 2e-6);
  p.setup_x_shift = flip(random, 0.5) ? 0 : between(random, -1e-3, 1e-3);
  return p;
}

GrindJob randomFlutes(Random& random) {
  GrindJob job;
  job.cutter = randomCutter(random);
  const int teeth = 1 + static_cast<int>(fraction(random) * 3);
  for (int i = 0; i < teeth; ++i) {
    job.tooth_angles.push_back(i == 0 ? 0 : job.tooth_angles.back() + between(random, 0.3, 2));
  }
  if (teeth > 1 && flip(random, 0.3)) {
    for (int i = 0; i < teeth; ++i)
      job.spiral_angles.push_back(job.cutter.spiral_angle * (i == 0 ? 1 : between(random, 0.8, 1)));
  }
  job.process() = randomProcess(random, job.cutter);
  if (flip(random, 0.2)) job.process().z_law = ZLaw::kConstantRake;
  job.interpolation.even_step = std::array{EvenStepRule::kPublished, EvenStepRule::kThirdOrder,
                                           EvenStepRule::kExact}[static_cast<std::size_t>(fraction(random) * 3)];
  job.interpolation.tolerance = acrossDecades(random, 0.2e-6, 20e-6);
  job.interpolation.rotary_scale = acrossDecades(random, 0.1e-3, 10e-3);
  return job;
}

/// Random edges under an operation that follows those of the flutes.
std::vector<EdgeHelix> randomEdges(Random& random, const ValidJob& flutes) {
  std::vector<EdgeHelix> edges;
  for (int i = 0; i < flutes.teeth(); ++i) {
    edges.push_back({flutes.cutterOf(i).spiral_angle * between(random, 0.98, 1.02), between(random, -0.01, 0.01)});
  }
  return edges;
}

/// Of a cutter's flutes, those or a relief behind them.
ValidJob withRelief(Random& random, GrindJob job) {
  CutterGeometry& c = job.cutter;
  c.clearance = between(random, 0.1, 0.25);
  c.clearance_tolerance = 0.02;
  const bool secondary = flip(random, 0.4);
  if (secondary) {
    c.land = between(random, 0.1e-3, 0.4e-3);
    c.second_clearance = c.clearance + between(random, 0.1, 0.25);
  }
  for (int i = 0; i < (secondary ? 2 : 1); ++i) {
    GrindProcess relief = job.process();
    relief.kind = i == 0 ? OperationKind::kPrimaryRelief : OperationKind::kSecondaryRelief;
    relief.depth = relief.depth_end = relief.overtravel_end = relief.overtravel_shank = relief.setup_x_shift = 0;
    relief.z_law = ZLaw::kPublished;
    relief.finish_infeed = 0;
    relief.infeed = relief.roughsByRemoval() ? 0 : between(random, 0.1e-3, 0.5e-3);
    relief.behind = 0;
    relief.setup_swivel = between(random, -0.2, 0.2);
    const double clearance = i == 0 ? c.clearance : c.second_clearance;
    relief.setup_height = ReliefPath::heightFor(
        ConicalCutter(c), {clearance, 1, 0}, {relief.wheel_diameter / 2, 0, relief.wheel_width, relief.setup_swivel, 0},
        between(random, -3e-3, 3e-3));
    job.operations.push_back(relief);
  }
  const ValidJob flutes(job.ofOperation(0));
  const int index = flip(random, 0.5) || !secondary ? 1 : 2;
  return ValidJob(job.ofOperation(index)).withEdges(flutes, randomEdges(random, flutes));
}

/// Of a cutter's flutes, an operation on its end.
ValidJob withEnd(Random& random, GrindJob job) {
  CutterGeometry& c = job.cutter;
  const bool left = c.cut == CutDirection::kLeftHand;
  c.end_clearance = between(random, 0.05, 0.25);
  c.end_second_clearance = c.end_clearance + between(random, 0.05, 0.25);
  c.end_land = c.end_diameter * between(random, 0.02, 0.1);
  c.end_dish = flip(random, 0.2) ? 0 : between(random, 0, 0.1);
  c.end_rake = flip(random, 0.2) ? 0 : between(random, -0.1, 0.2);
  c.end_clearance_tolerance = c.end_rake_tolerance = 0.01;
  c.chamfer_width = c.end_diameter * between(random, 0.01, 0.1);
  c.chamfer_angle = between(random, 0.3, 1.2);
  c.chamfer_clearance = between(random, 0.05, 0.3);
  GrindProcess p = job.process();
  p.depth = p.depth_end = p.overtravel_end = p.overtravel_shank = p.setup_x_shift = p.setup_height = 0;
  p.z_law = ZLaw::kPublished;
  // A chamfer is over the soonest, and so drawn less often.
  constexpr OperationKind kinds[]{OperationKind::kChamfer, OperationKind::kGash, OperationKind::kGash,
                                  OperationKind::kPrimaryEnd, OperationKind::kSecondaryEnd};
  p.kind = kinds[static_cast<std::size_t>(fraction(random) * 5)];
  p.roughing_passes = 0;
  p.wheel_diameter = between(random, 30e-3, 150e-3);
  p.wheel_width = between(random, 1e-3, 10e-3);
  p.stock = flip(random, 0.5) ? 0 : between(random, 0, 0.5e-3);
  if (p.kind == OperationKind::kGash) {
    p.gash_angle = between(random, 0.3, 1.2);
    p.gash_past = c.end_diameter * between(random, -0.3, 0.1);
  }
  if (job.spiral_angles.empty() && c.end_diameter > 10 * kEndGap && flip(random, 0.4)) {
    const int teeth = 2 + static_cast<int>(fraction(random) * 3);
    job.tooth_angles.assign(1, 0);
    for (int i = 1; i < teeth; ++i) job.tooth_angles.push_back((i + between(random, -0.2, 0.2)) * units::kTurn / teeth);
    c.end_center_teeth = teeth == 4 && flip(random, 0.7) ? 2 : 1;
    c.end_short_from = between(random, 5 * kEndGap, 0.45 * c.end_diameter);
    if (p.kind == OperationKind::kGash) {
      p.gash_short_angle = flip(random, 0.5) ? 0 : between(random, 0.3, 1.2);
      p.gash_short_past = c.end_diameter * between(random, -0.3, 0.1);
    }
  }
  if (isEndFlank(p.kind) && left) {
    p.wheel_profile = WheelShape::kCup;
    p.wheel_side = WheelFace::kLower;
    p.wheel_diameter = std::max(p.wheel_diameter, 3 * c.end_diameter);
    p.wheel_rim = c.end_diameter * between(random, 0.5, 0.9);
  }
  p.infeed = c.end_diameter * (p.kind == OperationKind::kGash ? between(random, 0.2, 0.6) : between(random, 0.05, 0.4));
  p.feed = acrossDecades(random, 10e-3, 150e-3);
  p.finish_infeed = flip(random, 0.2) ? p.infeed / 10 : 0;
  job.operations.push_back(p);
  job.operation = 1;
  job.process().setup_swivel = swivelOfPlane(job);
  const ValidJob flutes(job.ofOperation(0));
  const std::vector<EdgeHelix> edges = randomEdges(random, flutes);
  const double z = ValidJob(job).withEdges(flutes, edges).faceStroke(0, 0, 0).to[kZ];
  job.process().setup_height = z + between(random, -1e-3, 1e-3);
  return ValidJob(job).withEdges(flutes, edges);
}

/// Of a job whose roughing passes follow from what they remove, some.
ValidJob withRoughing(Random& random, const ValidJob& job) {
  const double deepest = job.deepest() - job->process().finish_infeed;
  std::vector<double> depths;
  for (int left = job->process().roughing_passes; left > 1; --left) {
    const double last = depths.empty() ? 0 : depths.back();
    depths.push_back(last + (deepest - last) * between(random, 0.2, 0.8));
  }
  depths.push_back(deepest);
  return job.withRoughing(std::move(depths));
}

ValidJob withCorrections(Random& random, const ValidJob& job) {
  const StrokeLaw& law = job.strokeLaw(0);
  ZCorrection c;
  c.from = std::min(law.from, law.to);
  c.pieces = 1 + static_cast<int>(fraction(random) * 6);
  c.piece = std::abs(law.to - law.from) / c.pieces;
  const double size = std::abs(law.to - law.from) * acrossDecades(random, 1e-3, 3e-2);
  for (int i = 0; i < c.coefficientCount(); ++i)
    c.coefficients[static_cast<std::size_t>(i)] = size * between(random, -1, 1);
  // Teeth with the same spiral angle have the same.
  return job.withZCorrections(std::vector<ZCorrection>(static_cast<std::size_t>(job.teeth()), c));
}

/// Of Z, limits that the bends of its correction come near, or beyond which they take some of the feed.
void limitBends(Random& random, const ValidJob& job, AxisLimits& limits) {
  const ZCorrection::Bounds bend = job.zCorrectionOf(0).bounds();
  const double speed = job->process().feed;
  const double acceleration = bend.second * speed * speed * acrossDecades(random, 0.1, 10);
  const double jerk = bend.third * speed * speed * speed * acrossDecades(random, 0.1, 10);
  limits.max_acceleration[kZ] = std::clamp(acceleration, 0.01, 10.0);
  limits.max_jerk[kZ] = std::clamp(jerk, 0.1, 1000.0);
}

/// What is asked of the end of a tool at one of its teeth.
second_opinion::Face faceOf(const ValidJob& job, int tooth) {
  using Kind = second_opinion::Face::Kind;
  const CutterGeometry& c = job->cutter;
  const GrindProcess& p = job->process();
  second_opinion::Face f;
  const bool secondary = p.kind == OperationKind::kSecondaryEnd;
  f.kind = p.kind == OperationKind::kGash      ? Kind::kGash
           : p.kind == OperationKind::kChamfer ? Kind::kChamfer
                                               : Kind::kEnd;
  f.left_hand = c.cut == CutDirection::kLeftHand;
  f.radius = second_opinion::Real(c.end_diameter) / 2;
  const std::vector<double>& angles = job->tooth_angles;
  const auto i = static_cast<std::size_t>(tooth);
  // Behind a right-hand edge is the next tooth, behind a left-hand one the tooth before.
  const std::size_t behind = (i + (f.left_hand ? angles.size() - 1 : 1)) % angles.size();
  const double way = f.left_hand ? angles[i] - angles[behind] : angles[behind] - angles[i];
  f.pitch = way > 0 ? way : way + units::kTurn;
  // The first tooth goes to the axis, and the one half of the teeth further if there are two. The rim of the only one
  // may pass the axis farther.
  const std::size_t every = angles.size() / static_cast<std::size_t>(std::max(c.end_center_teeth, 1));
  const auto is_short = [&](std::size_t one) { return c.end_center_teeth > 0 && one % every != 0; };
  f.behind_from = is_short(behind) ? c.end_short_from : 0;
  f.past_axis = f.behind_from / (angles.size() > 2 ? 4 : 2);
  if (f.past_axis > 0 && (is_short(i) || c.end_center_teeth > 1)) f.past_axis = kEndGap;
  f.a = angles[i] + job.edges()[i].at_end;
  f.dish = c.end_dish;
  f.rake = c.end_rake;
  f.clearance = f.kind == Kind::kChamfer ? c.chamfer_clearance : secondary ? c.end_second_clearance : c.end_clearance;
  f.first_clearance = c.end_clearance;
  f.land = secondary ? c.end_land : 0;
  f.width = c.chamfer_width;
  f.angle = f.kind != Kind::kGash                   ? c.chamfer_angle
            : is_short(i) && p.gash_short_angle > 0 ? p.gash_short_angle
                                                    : p.gash_angle;
  f.spiral = (f.left_hand ? -1 : 1) * std::tan(second_opinion::Real(c.spiral_angle));
  f.hook = std::max(0.0, std::tan(c.rake_angle));
  f.past = is_short(i) ? p.gash_short_past : p.gash_past;
  f.swivel = p.setup_swivel;
  f.height = p.setup_height;
  f.wheel_radius = second_opinion::Real(p.wheel_diameter) / 2;
  f.wheel_width = p.wheel_width;
  f.rim = p.wheel_rim;
  f.gap = kEndGap;
  f.clear = p.clearance;
  f.stock = p.stock;
  return f;
}

/// The passes of straight strokes, each of which is judged.
std::vector<second_opinion::Pass> straightPassesOf(const ValidJob& job) {
  std::vector<second_opinion::Pass> passes;
  for (const JobPass& pass : job.passes()) {
    const FaceStroke stroke = job.faceStroke(pass.place.tooth, pass.depth, pass.wear);
    second_opinion::Pass one{pass.place.tooth, pass.place.pass};
    Axes::Map(one.from.data()) = stroke.from;
    Axes::Map(one.to.data()) = stroke.to;
    one.stock = second_opinion::Real(job.deepest()) - pass.depth;
    const second_opinion::Real worn =
        second_opinion::Real(passes.size()) * second_opinion::Real(job->process().wheel_wear_per_pass);
    const bool by_rim = job->process().kind == OperationKind::kGash;
    one.wear = job->process().wheel_wear + (by_rim ? worn : 0);
    one.face_wear = by_rim ? 0 : worn;
    judge(faceOf(job, one.tooth), one);
    passes.push_back(one);
  }
  return passes;
}

second_opinion::Asked askedOf(const ValidJob& job, const Machine& machine, const Axes& offset) {
  second_opinion::Asked asked;
  using second_opinion::Real;
  asked.straight = job.isStraight();
  if (asked.straight) {
    asked.teeth.resize(static_cast<std::size_t>(job.teeth()));
    asked.passes = straightPassesOf(job);
    asked.round_work = isEndFlank(job->process().kind) && job->cutter.cut == CutDirection::kLeftHand;
    asked.clear_x = std::numeric_limits<Real>::infinity();
    for (const second_opinion::Pass& pass : asked.passes) asked.clear_x = std::min<Real>(asked.clear_x, pass.from[0]);
  }
  for (int i = 0; i < job.teeth() && !asked.straight; ++i) {
    const StrokeLaw& law = job.strokeLaw(i);
    const Cone& c = law.cutter;
    second_opinion::Tooth tooth;
    tooth.growth = std::tan(Real(c.cone_angle));
    tooth.b = 2 * tooth.growth / Real(c.end_diameter);
    tooth.k = 2 * std::tan(Real(c.spiral_angle)) / Real(c.end_diameter);
    tooth.x_shift = law.x_shift;
    tooth.a = law.a;
    tooth.z_per_y = (c.cut == CutDirection::kLeftHand ? -1 : 1) * std::sin(Real(c.rake_angle));
    const ZCorrection& z = job.zCorrectionOf(i);
    tooth.from = z.from;
    tooth.piece = z.pieces == 0 ? 1 : z.piece;
    tooth.coefficients.assign(z.coefficients.begin(), z.coefficients.begin() + z.coefficientCount());
    asked.teeth.push_back(tooth);
  }
  for (const JobPass& pass : job.passes()) {
    if (asked.straight) break;
    const DepthLaw law = job.depthLaw(pass.place.tooth, pass.depth, pass.wear);
    asked.passes.push_back({pass.place.tooth, pass.place.pass, law.at_end, law.taper});
  }
  if (!asked.straight) {
    asked.from = job.strokeLaw(0).from;
    asked.to = job.strokeLaw(0).to;
  }
  asked.clearance = job->process().clearance;
  asked.offset_x = offset[kX];
  asked.offset_y = offset[kY];
  asked.deviation = job->interpolation.tolerance;
  asked.radius = Real(job->cutter.end_diameter) / 2;
  asked.feed = kMaxFeedOverride * Real(job->process().feed);
  asked.period = machine.period;
  for (int i = 0; i < kAxisCount; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    asked.velocity[axis] = machine.limits.max_velocity[i];
    asked.acceleration[axis] = machine.limits.max_acceleration[i];
    asked.jerk[axis] = machine.limits.max_jerk[i];
  }
  return asked;
}

/// Cycles that no run of a program goes below: each move from rest to rest by one limit of an axis, or at the feed.
double minCycles(const GrindProgram& program) {
  const AxisLimits& limits = program.machine().limits;
  double time = 0;
  Axes at = program.start();
  for (const Move& move : program.moves()) {
    const Axes way = (move.to - at).abs();
    double at_feed = 0;
    if (move.kind == MoveKind::kStroke) {
      at_feed =
          program.isStraight() ? way.head<3>().matrix().norm() : way[kX] * program.cutter(move.tooth).edgePerTravel();
    }
    if (move.kind == MoveKind::kInfeed) at_feed = way[kY];
    const Axes least = (way / limits.max_velocity)
                           .max(2 * (way / limits.max_acceleration).sqrt())
                           .max((32 * way / limits.max_jerk).pow(1.0 / 3));
    time += std::max(at_feed / program.job()->process().feed, least.maxCoeff());
    at = move.to;
  }
  return time / program.machine().period;
}

/// Gives the machine limits of positions that hold the job.
/// @return whether a plan accepts it: no point off the curve by more than its tolerance with the most feed override, in
///         ride.cycles at most.
bool limitToPath(Random& random, RideJob& ride) {
  SetpointStream stream(GrindProgram(ride.job, ride.machine, RunStart(ride.machine.park, {}, ride.offset)));
  if (minCycles(stream.program()) > ride.cycles) return false;
  const second_opinion::Watch watch(ride.asked);
  AxisLimits& limits = ride.machine.limits;
  limits.min_position = limits.max_position = ride.machine.park;
  // With the published rule even points drift, by the square of their steps.
  const bool drifts = ride.job->interpolation.even_step == EvenStepRule::kPublished;
  const double most_by_override = drifts ? kMaxFeedOverride * kMaxFeedOverride : 1;
  Setpoint p;
  for (double cycles = 0; stream.next(p); ++cycles) {
    if (cycles > ride.cycles) return false;
    limits.min_position = limits.min_position.min(p.position + ride.offset);
    limits.max_position = limits.max_position.max(p.position + ride.offset);
    if (p.step == StepKind::kNone) continue;
    const auto deviation = [&](double a) { return watch.deviation(ride.asked.teeth[p.tooth], p.position[kX], a); };
    const auto off = deviation(p.position[kA]);
    if (!(std::abs(off) * most_by_override <= ride.asked.deviation)) return false;
    if (std::abs(p.position[kX] - ride.asked.to) > 1e-9) continue;
    // A plan leaves the tolerance between the end of a stroke, which may be begun again, and the limit.
    const auto per_radian = deviation(p.position[kA] + 1) - off;
    for (const auto way : {-ride.asked.deviation, ride.asked.deviation}) {
      const double a = p.position[kA] + static_cast<double>((way - off) / per_radian) + ride.offset[kA];
      limits.min_position[kA] = std::min(limits.min_position[kA], a);
      limits.max_position[kA] = std::max(limits.max_position[kA], a);
    }
  }
  // Without the reference, a lift is as long again once the power was off, and higher.
  limits.max_position[kY] += 0.5;
  if (ride.asked.round_work) limits.min_position[kX] -= 0.5;
  // As a plan does, for what Z's bends rise between two setpoints.
  const double rise = limits.max_acceleration[kZ] * ride.machine.period * ride.machine.period / 8;
  const Axes least(0, 0, ride.asked.teeth[0].coefficients.empty() ? 0 : rise, 0);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const auto& [limit, way] : {std::pair(&limits.min_position, -1), {&limits.max_position, 1}}) {
      (*limit)[axis] += way * (least[axis] + (flip(random, 0.2) ? 0 : acrossDecades(random, 1e-6, 0.1)));
    }
  }
  Axes::Map(ride.asked.low.data()) = limits.min_position;
  Axes::Map(ride.asked.high.data()) = limits.max_position;
  return stream.rest() == Rest::kEnd;
}

/// The highest Y of the surface along the strokes.
double surfaceOf(const ValidJob& job) {
  if (job.isStraight()) return 0;
  const double growth = std::tan(job->cutter.cone_angle);
  const StrokeLaw& law = job.strokeLaw(0);
  return std::max(law.from * growth, law.to * growth);
}

std::optional<RideJob> draw(Random& random) {
  GrindJob flutes = randomFlutes(random);
  ValidJob job = flip(random, 0.3)   ? withRelief(random, flutes)
                 : flip(random, 0.5) ? withEnd(random, flutes)
                                     : ValidJob(flutes);
  if (job->process().z_law == ZLaw::kConstantRake) job = withCorrections(random, job);
  if (!job.hasPasses()) job = withRoughing(random, job);
  Machine machine = randomMachine(random);
  if (job->process().z_law == ZLaw::kConstantRake) limitBends(random, job, machine.limits);
  const double clear = surfaceOf(job) + job->process().clearance;
  Axes offset = Axes::Zero();
  if (flip(random, 0.5))
    offset << between(random, -0.5, 0.5), between(random, -0.3, 0.3), between(random, -0.5, 0.5),
        between(random, -3, 3);
  machine.park << between(random, -0.02, 0.02), clear + between(random, 0, 5e-3), between(random, -1e-3, 1e-3), 0;
  machine.park += offset;
  RideJob ride{job, machine, offset, acrossDecades(random, 800, 8000), askedOf(job, machine, offset)};
  if (!limitToPath(random, ride)) return std::nullopt;
  return ride;
}

}  // namespace

double fraction(Random& random) { return static_cast<double>(random() >> 11) / 9007199254740992.0; }
double between(Random& random, double low, double high) { return low + (high - low) * fraction(random); }
double acrossDecades(Random& random, double low, double high) {
  return std::exp(between(random, std::log(low), std::log(high)));
}
bool flip(Random& random, double chance) { return fraction(random) < chance; }

RideJob randomJob(Random& random) {
  for (int i = 0; i < 1000; ++i) {
    try {
      if (const std::optional<RideJob> ride = draw(random)) return *ride;
    } catch (const std::invalid_argument&) {  // what the product refuses is not ridden
    }
  }
  throw std::runtime_error("no job within 1000 draws");
}

}  // namespace grinder::test_support
