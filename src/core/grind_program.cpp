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
  const double feed = schedule.feedSpeed() * rate * cutter.edgePerTravel();
  if (feed >= kMinFeed * (1 - 1e-9)) return;
  std::ostringstream text;
  text << "process.feed: " << (schedule.cuts().empty() ? "it" : schedule.cuts().back().cause) << " allows " << feed
       << " m/s (" << feed / units::kMillimetrePerMinute << " mm/min); the slowest feed is " << kMinFeed << " m/s ("
       << kMinFeed / units::kMillimetrePerMinute << " mm/min)";
  throw std::invalid_argument(text.str());
}

void requireParkClear(const Machine& machine, double clearance_y) {
  if (machine.park[kY] >= clearance_y) return;
  std::ostringstream text;
  text << "park position axis_y = " << machine.park[kY] << " m; allowed for this job: at least " << clearance_y
       << " m, clear of the work";
  throw std::invalid_argument(text.str());
}

}  // namespace

GrindProgram::GrindProgram(const GrindJob& job, const Machine& machine, const Axes& start, const ToothPass& first)
    : job_(job),
      machine_(checked(machine, start)),
      cutter_(job.cutter),
      start_(start),
      stroke_(strokeOf(job)),
      schedule_(cutter_, stroke_, machine),
      clearance_y_(std::max(cutter_.y(stroke_.from), cutter_.y(stroke_.to)) + job.process.clearance) {
  requireGrindableFeed(schedule_, cutter_);
  requireParkClear(machine, clearance_y_);
  const std::vector<ToothPass> order = passOrder(job);
  const auto is_first = [&](const ToothPass& p) { return p.tooth == first.tooth && p.pass == first.pass; };
  const auto begin = std::find_if(order.begin(), order.end(), is_first);
  if (begin == order.end()) {
    std::ostringstream text;
    text << "first_tooth = " << first.tooth << ", first_pass = " << first.pass << "; allowed: 0 to "
         << order.back().tooth << " and 0 to " << order.back().pass;
    throw std::invalid_argument(text.str());
  }

  const std::vector<double> depths = passDepths(job.process);
  Axes at = start;
  // The wheel may stand in another cutter's flute, after a job that did not end: only the park position clears them
  // all.
  if (at[kY] < machine.park[kY]) {
    at[kY] = machine.park[kY];
    append(MoveKind::kLift, first, at);
  }
  for (auto pass = begin; pass != order.end(); ++pass) {
    const auto passes_before = static_cast<double>(pass - order.begin());
    const double wear = job.process.wheel_wear + passes_before * job.process.wheel_wear_per_pass;
    appendPass(*pass, depths[static_cast<std::size_t>(pass->pass)] + wear, at);
  }
  append(MoveKind::kReturn, order.back(), machine.park);
}

void GrindProgram::append(MoveKind kind, const ToothPass& pass, const Axes& to) {
  moves_.push_back({kind, static_cast<std::uint16_t>(pass.tooth), static_cast<std::uint16_t>(pass.pass), to});
}

void GrindProgram::appendPass(const ToothPass& pass, double infeed, Axes& at) {
  const LogCurve curve(cutter_);
  const double tooth_angle = job_.tooth_angles[static_cast<std::size_t>(pass.tooth)];
  const auto go = [&](MoveKind kind) { append(kind, pass, at); };
  at[kA] = tooth_angle + curve.a(stroke_.from);
  go(MoveKind::kIndex);
  at[kX] = stroke_.from;
  at[kZ] = cutter_.z(stroke_.from);
  go(MoveKind::kPosition);
  at[kY] = cutter_.y(stroke_.from) + job_.process.clearance;
  go(MoveKind::kApproach);
  at[kY] = cutter_.y(stroke_.from) - infeed;
  go(MoveKind::kInfeed);
  at << stroke_.to, cutter_.y(stroke_.to) - infeed, cutter_.z(stroke_.to), tooth_angle + curve.a(stroke_.to);
  go(MoveKind::kStroke);
  at[kY] = clearance_y_;
  go(MoveKind::kRetract);
}

}  // namespace flute_grinder
