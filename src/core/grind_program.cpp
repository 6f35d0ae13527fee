#include "flute_grinder/core/grind_program.h"

#include "flute_grinder/core/units.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace flute_grinder {

namespace {

FeedSchedule::Stroke strokeOf(const GrindJob& job) {
  FeedSchedule::Stroke stroke;
  stroke.from = -job.process.overtravel_end;
  stroke.to = job.cutter.flute_length + job.process.overtravel_shank;
  if (job.process.direction == StrokeDirection::kToEnd) std::swap(stroke.from, stroke.to);
  stroke.surface_feed = job.process.feed;
  // The published rule's even points drift away by up to as much again, on steep cutters.
  stroke.tolerance = job.interpolation.tolerance * (job.interpolation.even_step == EvenStepRule::kPublished ? 0.5 : 1);
  return stroke;
}

/// @throw std::invalid_argument unless the machine and the place where the axes stand are fit for motion.
const Machine& checked(const Machine& machine, const Axes& start) {
  const AxisLimits& l = machine.limits;
  const auto positive = [](const Axes& values) { return (values > 0).all() && values.isFinite().all(); };
  if (!(machine.period > 0 && machine.period <= 1))
    throw std::invalid_argument("machine: control period must be 0 to 1 s");
  if (!(positive(l.max_velocity) && positive(l.max_acceleration) && positive(l.max_jerk))) {
    throw std::invalid_argument("machine: velocity, acceleration and jerk limits must be finite and positive");
  }
  if (!((l.min_position < l.max_position).all() && l.min_position.isFinite().all() &&
        l.max_position.isFinite().all())) {
    throw std::invalid_argument("machine: position limits must be finite, the lower below the upper");
  }
  if (!(start.isFinite().all() && machine.park.isFinite().all())) {
    throw std::invalid_argument("machine: start and park position must be finite");
  }
  return machine;
}

void requireGrindableFeed(const FeedSchedule& schedule, const ConicalCutter& cutter) {
  const double rate = std::min(schedule.rate(0), schedule.rate(schedule.length()));
  const double feed = schedule.limits().velocity * rate * cutter.edgePerTravel();
  if (feed >= kMinFeed * (1 - 1e-9)) return;
  std::ostringstream text;
  text << "process.feed: " << schedule.limitedBy() << " allows " << feed << " m/s ("
       << feed / units::kMillimetrePerMinute << " mm/min); the slowest feed is " << kMinFeed << " m/s ("
       << kMinFeed / units::kMillimetrePerMinute << " mm/min)";
  throw std::invalid_argument(text.str());
}

}  // namespace

GrindProgram::GrindProgram(const GrindJob& job, const Machine& machine, const Axes& start, const JobStart& first)
    : job_(job),
      machine_(checked(machine, start)),
      cutter_(job.cutter),
      start_(start),
      stroke_(strokeOf(job)),
      schedule_(cutter_, stroke_, machine),
      clearance_y_(std::max(cutter_.y(stroke_.from), cutter_.y(stroke_.to)) + job.process.clearance) {
  requireGrindableFeed(schedule_, cutter_);
  const std::vector<double> depths = passDepths(job.process);
  const int teeth = static_cast<int>(job.tooth_angles.size());
  const int passes = static_cast<int>(depths.size());
  if (!(first.tooth >= 0 && first.tooth < teeth && first.pass >= 0 && first.pass < passes)) {
    std::ostringstream text;
    text << "first_tooth = " << first.tooth << ", first_pass = " << first.pass << "; allowed: 0 to " << teeth - 1
         << " and 0 to " << passes - 1;
    throw std::invalid_argument(text.str());
  }
  if (!(machine.park[kY] >= clearance_y_)) {
    std::ostringstream text;
    text << "park position axis_y = " << machine.park[kY] << " m; allowed for this job: at least " << clearance_y_
         << " m, clear of the work";
    throw std::invalid_argument(text.str());
  }

  const bool tooth_major = job.process.order == GrindOrder::kToothMajor;
  const int count = teeth * passes;
  Axes at = start;
  // The wheel may stand in another cutter's flute, after a job that did not end: only the park position clears them
  // all.
  if (at[kY] < machine.park[kY]) {
    at[kY] = machine.park[kY];
    append(MoveKind::kLift, first.tooth, first.pass, at);
  }
  for (int i = tooth_major ? first.tooth * passes + first.pass : first.pass * teeth + first.tooth; i < count; ++i) {
    const int tooth = tooth_major ? i / passes : i % teeth;
    const int pass = tooth_major ? i % passes : i / teeth;
    appendPass(tooth, pass, depths[static_cast<std::size_t>(pass)], at);
  }
  append(MoveKind::kReturn, moves_.back().tooth, moves_.back().pass, machine.park);
}

void GrindProgram::append(MoveKind kind, int tooth, int pass, const Axes& to) {
  moves_.push_back({kind, static_cast<std::uint16_t>(tooth), static_cast<std::uint16_t>(pass), to});
}

void GrindProgram::appendPass(int tooth, int pass, double depth, Axes& at) {
  const LogCurve curve(cutter_);
  const double tooth_angle = job_.tooth_angles[static_cast<std::size_t>(tooth)];
  const auto go = [&](MoveKind kind) { append(kind, tooth, pass, at); };
  at[kX] = stroke_.from;
  at[kZ] = cutter_.z(stroke_.from);
  at[kA] = tooth_angle + curve.a(stroke_.from);
  go(MoveKind::kPosition);
  at[kY] = cutter_.y(stroke_.from) + job_.process.clearance;
  go(MoveKind::kApproach);
  const double infeed = depth + job_.process.wheel_wear;
  at[kY] = cutter_.y(stroke_.from) - infeed;
  go(MoveKind::kInfeed);
  at << stroke_.to, cutter_.y(stroke_.to) - infeed, cutter_.z(stroke_.to), tooth_angle + curve.a(stroke_.to);
  go(MoveKind::kStroke);
  at[kY] = clearance_y_;
  go(MoveKind::kRetract);
}

}  // namespace flute_grinder
