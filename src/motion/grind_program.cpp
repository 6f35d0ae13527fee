#include "flute_grinder/motion/grind_program.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/motion/work_offsets.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace grinder {

namespace {

constexpr double kMinPeriod = 1e-6;  ///< minimum control cycle [s]

FeedSchedule::Stroke strokeOf(const ValidJob& job) {
  FeedSchedule::Stroke stroke;
  if (job.isStraight()) return stroke;
  stroke.from = job.strokeLaw(0).from;
  stroke.to = job.strokeLaw(0).to;
  stroke.surface_feed = job->process().feed;
  // With the published rule, the even points of steep cutters drift by up to the same amount again.
  stroke.tolerance =
      job->interpolation.tolerance * (job->interpolation.even_step == EvenStepRule::kPublished ? 0.5 : 1);
  return stroke;
}

/// @throw std::invalid_argument unless the machine's data, the start position and the offset are valid for motion.
const Machine& checked(const Machine& machine, const RunStart& run) {
  const AxisLimits& l = machine.limits;
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("machine: ") + what);
  };
  const auto place = [](const Axes& values) { return (values.abs() <= kMaxFigure).all(); };
  const auto limit = [&](const Axes& values) { return (values >= kMinFigure).all() && place(values); };
  require(machine.period >= kMinPeriod && machine.period <= 1, "control period must be 1e-6 to 1 s");
  require(limit(l.max_velocity) && limit(l.max_acceleration) && limit(l.max_jerk),
          "velocity, acceleration and jerk limits must be 1e-9 to 1e9, in SI units");
  require(place(l.min_position) && place(l.max_position) && (l.min_position < l.max_position).all(),
          "position limits must be within -1e9 to 1e9, the lower below the upper");
  require(place(run.at) && place(machine.park), "start and park position must be within -1e9 to 1e9");
  require((run.offset.abs() <= kMaxOffset).all(), "work offsets must be within -1000 to 1000 m or rad");
  require(machine.max_job_duration > 0 && machine.max_job_duration <= kMaxFigure,
          "max_job_duration must be more than 0, up to 1e9 s");
  return machine;
}

void requireGrindableFeed(const FeedSchedule& schedule, const ConicalCutter& cutter) {
  const double slowest = schedule.rate(0) < schedule.rate(schedule.length()) ? 0 : schedule.length();
  const double feed = schedule.feedSpeed() * schedule.rate(slowest) * cutter.edgePerTravel();
  if (feed >= kMinFeed * (1 - 1e-9)) return;
  Reason reason;
  reason.kind = ReasonKind::kFeedTooLow;
  reason.detail = schedule.feedLimits().empty() ? "it" : schedule.feedLimits().back().cause;
  reason.unit = Unit::kFeedMetrePerSecond;
  reason.value = feed;
  reason.limit = kMinFeed;
  reason.x = schedule.x(slowest);
  throw ReasonError(reason);
}

void requireSwivel(const Machine& machine, const ValidJob& job) {
  const double swivel = job->process().setup_swivel;
  if (swivel >= machine.swivel.from && swivel <= machine.swivel.to) return;
  throw ReasonError({ReasonKind::kOutOfRange, 0, "process.setup_swivel", "to which the machine swivels", Unit::kRadian,
                     swivel, machine.swivel.from, machine.swivel.to});
}

/// @param clearance_y clearance height in work coordinates [m].
/// @param park park position of Y [m].
/// @param offset work offset of Y, see RunStart [m].
void requireParkClear(double clearance_y, double park, double offset) {
  if (park - offset >= clearance_y) return;
  throw ReasonError({ReasonKind::kParkInWork, kY, "", "", Unit::kMetre, park, 0, clearance_y + offset});
}

std::size_t indexOf(const std::vector<Helix>& helices, double spiral_angle) {
  const auto same = [&](const Helix& h) { return h.edge.cutter.cone().spiral_angle == spiral_angle; };
  return static_cast<std::size_t>(std::find_if(helices.begin(), helices.end(), same) - helices.begin());
}

std::vector<Helix> helicesOf(const ValidJob& job, FeedSchedule::Stroke stroke, const Machine& machine) {
  std::vector<Helix> helices;
  if (job.isStraight()) return helices;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) {
    const StrokeLaw& law = job.strokeLaw(tooth);
    if (indexOf(helices, law.cutter.spiral_angle) < helices.size()) continue;
    const ConicalCutter cutter(law.cutter);
    stroke.x_shift = law.x_shift;
    stroke.taper = job.depthLaw(tooth, job.deepest(), job->process().wheel_wear).taper;
    stroke.z_correction = job.zCorrectionOf(tooth);
    helices.push_back({{cutter, stroke.x_shift},
                       LogCurve(cutter, stroke.x_shift),
                       stroke.z_correction,
                       FeedSchedule(cutter, stroke, machine)});
  }
  return helices;
}

Axes termsOf(const ValidJob& job, const std::vector<Helix>& helices, const FeedSchedule::Stroke& stroke) {
  Axes terms = Axes::Zero();
  const auto add = [&terms](int axis, double term) { terms[axis] = std::max(terms[axis], std::abs(term)); };
  for (const Helix& helix : helices) {
    add(kA, helix.curve.a(0));
    const ZCorrection::Bounds z = helix.z_correction.bounds();
    const double z_slope = std::max(std::abs(z.min_first), std::abs(z.max_first));
    // X is rounded, too.
    for (const double x : {stroke.from, stroke.to}) {
      add(kY, helix.edge.cutter.y(x));
      add(kZ, std::abs(helix.edge.cutter.z(x)) + std::abs(z_slope * x));
      add(kA, helix.curve.slope(x) * x);
    }
  }
  if (job.isStraight()) return terms;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) add(kA, job.strokeLaw(tooth).a);
  return terms;
}

/// Y at which the wheel is clear of the work all along the strokes.
double clearanceOf(const ValidJob& job, const std::vector<Helix>& helices, const FeedSchedule::Stroke& stroke) {
  if (helices.empty()) return job->process().clearance;
  const ConicalCutter& cutter = helices.front().edge.cutter;
  return std::max(cutter.y(stroke.from), cutter.y(stroke.to)) + job->process().clearance;
}

/// X before which the wheel of strokes along X is clear of the work.
double clearXOf(const ValidJob& job) {
  double x = std::numeric_limits<double>::infinity();
  if (!job->comesAlongX()) return x;
  // A face that has worn begins nearer to the work.
  const double wear = job.passes().front().wear;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) x = std::min(x, job.faceStroke(tooth, 0, wear).from[kX]);
  return x;
}

}  // namespace

GrindProgram::GrindProgram(const ValidJob& job, const Machine& machine, const RunStart& run)
    : job_(job),
      machine_(checked(machine, run)),
      run_(run),
      stroke_(strokeOf(job)),
      helices_(helicesOf(job, stroke_, machine)),
      helix_of_tooth_(helices_.empty() ? 0 : job->tooth_angles.size()),
      terms_(termsOf(job, helices_, stroke_)),
      clearance_y_(clearanceOf(job, helices_, stroke_)),
      clear_x_(clearXOf(job)) {
  for (std::size_t tooth = 0; tooth < helix_of_tooth_.size(); ++tooth) {
    helix_of_tooth_[tooth] = indexOf(helices_, job.strokeLaw(static_cast<int>(tooth)).cutter.spiral_angle);
  }
  for (const Helix& helix : helices_) requireGrindableFeed(helix.schedule, helix.edge.cutter);
  requireSwivel(machine, job);
  requireParkClear(clearance_y_, machine.park[kY], run.offset[kY]);
  const std::vector<JobPass>& passes = job.passes();
  const auto begin =
      std::find_if(passes.begin(), passes.end(), [&](const JobPass& pass) { return pass.place == run.first; });
  if (begin == passes.end()) {
    const ToothPass& last = passes.back().place;
    throw std::invalid_argument(format("first_tooth = %d, first_pass = %d; allowed: 0 to %d and 0 to %d",
                                       run.first.tooth, run.first.pass, last.tooth, last.pass));
  }

  constexpr std::ptrdiff_t moves_per_pass = 6;
  moves_.reserve(static_cast<std::size_t>((passes.end() - begin) * moves_per_pass + 3));
  const Axes park = machine.park - run.offset;
  Axes at = start();
  // After a job that did not finish, the wheel may be in a flute of a different cutter: only the park position is clear
  // of every cutter.
  if (at[kY] < park[kY]) {
    if (at[kX] > clear_x_) {
      at[kX] = clear_x_;
      append(MoveKind::kLift, run.first, at);
    }
    at[kY] = park[kY];
    append(MoveKind::kLift, run.first, at);
  }
  for (auto pass = begin; pass != passes.end(); ++pass) appendPass(*pass, at);
  append(MoveKind::kReturn, passes.back().place, park);
}

double GrindProgram::swivel() const noexcept { return job_->process().setup_swivel; }

void GrindProgram::append(MoveKind kind, const ToothPass& pass, const Axes& to, double wear, double taper) {
  moves_.push_back(
      {kind, static_cast<std::uint16_t>(pass.tooth), static_cast<std::uint16_t>(pass.pass), to, wear, taper});
}

void GrindProgram::appendStraightPass(const JobPass& pass, Axes& at) {
  const FaceStroke stroke = job_.faceStroke(pass.place.tooth, pass.depth, pass.wear);
  const auto go = [&](MoveKind kind) { append(kind, pass.place, at); };
  at[kA] = stroke.from[kA];
  go(MoveKind::kIndex);
  at[kX] = stroke.from[kX];
  at[kZ] = stroke.from[kZ];
  go(MoveKind::kPosition);
  at = stroke.from;
  go(MoveKind::kApproach);
  at = stroke.to;
  go(MoveKind::kStroke);
  if (at[kX] > clear_x_) {
    at[kX] = clear_x_;
    go(MoveKind::kRetract);
  }
  at[kY] = clearance_y_;
  go(MoveKind::kRetract);
}

void GrindProgram::appendPass(const JobPass& pass, Axes& at) {
  if (isStraight()) return appendStraightPass(pass, at);
  const Helix& helix = this->helix(pass.place.tooth);
  const ConicalCutter& cutter = helix.edge.cutter;
  const LogCurve& curve = helix.curve;
  const DepthLaw law = job_.depthLaw(pass.place.tooth, pass.depth, pass.wear);
  const auto y = [&](double x) { return cutter.y(x) + x * law.taper - law.at_end; };
  const double tooth_angle = job_.strokeLaw(pass.place.tooth).a;
  const auto go = [&](MoveKind kind) { append(kind, pass.place, at); };
  at[kA] = tooth_angle + curve.a(stroke_.from);
  go(MoveKind::kIndex);
  at[kX] = stroke_.from;
  at[kZ] = helix.z(stroke_.from);
  go(MoveKind::kPosition);
  at[kY] = cutter.y(stroke_.from) + job_->process().clearance;
  go(MoveKind::kApproach);
  at[kY] = y(stroke_.from);
  append(MoveKind::kInfeed, pass.place, at, pass.wear, law.taper);
  at << stroke_.to, y(stroke_.to), helix.z(stroke_.to), tooth_angle + curve.a(stroke_.to);
  append(MoveKind::kStroke, pass.place, at, pass.wear, law.taper);
  at[kY] = clearance_y_;
  go(MoveKind::kRetract);
}

}  // namespace grinder
