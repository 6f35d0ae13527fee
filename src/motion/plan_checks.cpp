#include "motion/plan_checks.h"

#include "flute_grinder/job/grind_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

/// The factor by which the feed override may increase the deviations above the deviations at the job's feed. They grow
/// with the square of the step length. The schedule keeps them within the tolerance at any override, except with the
/// published rule, whose even points drift.
double overrideFactor(const GrindProgram& program) {
  double factor = 1;
  if (program.job()->interpolation.even_step != EvenStepRule::kPublished) return factor;
  for (const Helix& helix : program.helices()) {
    factor = std::max(factor, std::pow(helix.schedule.limits().velocity / helix.schedule.feedSpeed(), 2));
  }
  return factor;
}

double sizeOf(const LimitViolation& v) {
  return v.quantity == LimitedQuantity::kPosition ? std::abs(v.value - v.limit) : std::abs(v.value);
}

}  // namespace

PlanChecks::PlanChecks(JobPlan& plan)
    : plan_(plan),
      program_(*plan.program),
      statistics_(plan.statistics),
      period_(program_.machine().period),
      deviation_factor_(overrideFactor(program_)),
      check_(program_.machine().limits, period_) {
  check_.restart(program_.terms());
  plan.move_ends.assign(program_.moves().size(), 0);
  deviation_.kind = ReasonKind::kTolerance;
  deviation_.unit = Unit::kDeviationMetre;
  deviation_.limit = program_.job()->interpolation.tolerance;
  deviation_.has_place = true;
}

bool PlanChecks::add(const Setpoint& p) {
  if (check_.check(p, program_.run().offset)) {
    std::for_each(check_.begin(), check_.end(), [&](const auto& v) { addViolation(v); });
    if (!p.position.isFinite().all()) return false;
  }
  count(p);
  measure(p);
  return true;
}

void PlanChecks::recall(const Setpoint& p) {
  check_.check(p, program_.run().offset);
  count(p);
  last_velocity_ = check_.velocity();
  if (p.cycle % 2 == 0) end_x_ = p.position[kX];
}

void PlanChecks::skip(MoveKind move, std::uint64_t cycles) {
  statistics_.setpoints += cycles;
  cycles_[static_cast<std::size_t>(move)] += cycles;
}

void PlanChecks::count(const Setpoint& p) {
  if (statistics_.setpoints++ > 0) ++cycles_[static_cast<std::size_t>(p.move)];
  plan_.move_ends[p.move_index] = p.cycle;
}

void PlanChecks::measure(const Setpoint& p) {
  statistics_.max_velocity = statistics_.max_velocity.max(check_.velocity().abs());
  max_change_ = max_change_.max((check_.velocity() - last_velocity_).abs());
  last_velocity_ = check_.velocity();
  if (p.cycle % 2 == 0) {
    statistics_.max_acceleration = statistics_.max_acceleration.max(check_.acceleration().abs());
    statistics_.max_jerk = statistics_.max_jerk.max(check_.jerk().abs());
  }
  if (p.step != StepKind::kNone) measureStroke(p);
  if (program_.isStraight() && p.at_feed) addFeed(p.feed);
  if (p.cycle % 2 == 0) end_x_ = p.position[kX];
}

void PlanChecks::measureStroke(const Setpoint& p) {
  const FormedEdge& edge = program_.helix(p.tooth).edge;
  const double error = std::abs(p.path_error);
  double& max_error = p.step == StepKind::kOdd ? statistics_.max_odd_error : statistics_.max_even_error;
  max_error = std::max(max_error, error);
  const double deviation = edge.deviation(p.position[kX], error);
  statistics_.max_deviation = std::max(statistics_.max_deviation, deviation);
  if (!(deviation * deviation_factor_ <= deviation_.limit)) addDeviation(p, deviation * deviation_factor_);
  checkBend(p);
  if (p.step == StepKind::kEven && p.at_feed) {
    addFeed(std::abs(p.position[kX] - end_x_) / (2 * period_) * edge.cutter.edgePerTravel());
  }
}

void PlanChecks::addFeed(double feed) {
  statistics_.max_feed = std::max(statistics_.max_feed, feed);
  statistics_.min_feed = statistics_.min_feed == 0 ? feed : std::min(statistics_.min_feed, feed);
}

void PlanChecks::addViolation(const LimitViolation& v) {
  if (plan_.good()) plan_.fault = PlanFault::kLimit;
  const auto same = [&](const Excess& e) {
    return e.worst.axis == v.axis && e.worst.quantity == v.quantity && e.worst.move == v.move;
  };
  auto it = std::find_if(excesses_.begin(), excesses_.end(), same);
  if (it == excesses_.end()) it = excesses_.insert(it, {v, 0});
  if (sizeOf(v) > sizeOf(it->worst)) it->worst = v;
  ++it->count;
}

void PlanChecks::addDeviation(const Setpoint& p, double deviation) {
  if (plan_.good()) plan_.fault = PlanFault::kTolerance;
  ++deviation_.count;
  if (deviation <= deviation_.value) return;
  deviation_.value = deviation;
  deviation_.move = p.move;
  deviation_.tooth = p.tooth;
  deviation_.pass = p.pass;
  deviation_.x = p.position[kX];
  deviation_.cycle = p.cycle;
}

/// Checks points between the plan's, since an interrupted stroke samples its path at other points.
/// @param place a point of the plan, with its axis and machine position.
/// @param room distance by which other points may lie farther out.
void PlanChecks::checkRoom(LimitViolation place, double room) {
  const AxisLimits& limits = program_.machine().limits;
  const double at = place.value;
  for (const auto& [limit, way] :
       {std::pair(limits.min_position[place.axis], -1), {limits.max_position[place.axis], 1}}) {
    const double past = way * (at - limit);
    // A point beyond the limit itself is reported elsewhere.
    if (past > 0 || past + room <= 0) continue;
    place.value = at + way * room;
    place.limit = limit;
    addViolation(place);
  }
}

/// Checks A at a stroke's end, which an interrupted stroke reaches to within the tolerance.
void PlanChecks::checkStrokeEnd(const Move& stroke, std::uint64_t cycle) {
  if (program_.isStraight()) return;
  const double at = stroke.to[kA] + program_.run().offset[kA];
  const double room = deviation_.limit / program_.helix(stroke.tooth).edge.deviation(stroke.to[kX], 1);
  checkRoom({kA, LimitedQuantity::kPosition, at, 0, cycle, stroke.to[kX], stroke.kind, stroke.tooth, stroke.pass},
            room);
}

/// Checks Z between two setpoints, where it bends outward by no more than its acceleration limit allows.
void PlanChecks::checkBend(const Setpoint& p) {
  if (program_.helix(p.tooth).z_correction.pieces == 0) return;
  const double at = p.position[kZ] + program_.run().offset[kZ];
  const double room = program_.machine().limits.max_acceleration[kZ] * period_ * period_ / 8;
  checkRoom({kZ, LimitedQuantity::kPosition, at, 0, p.cycle, p.position[kX], p.move, p.tooth, p.pass}, room);
}

void PlanChecks::finish() {
  // A move of zero length has no setpoints.
  for (std::size_t i = 1; i < plan_.move_ends.size(); ++i) {
    const Move& move = program_.moves()[i];
    if (move.kind == MoveKind::kStroke && plan_.move_ends[i] > 0) checkStrokeEnd(move, plan_.move_ends[i]);
    plan_.move_ends[i] = std::max(plan_.move_ends[i], plan_.move_ends[i - 1]);
  }
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    statistics_.move_duration[i] = static_cast<double>(cycles_[i]) * period_;
  }
  statistics_.duration = static_cast<double>(statistics_.setpoints - 1) * period_;
  statistics_.ripple_acceleration = max_change_ / period_;
  for (const Excess& e : excesses_) {
    plan_.reasons.push_back(reasonOf(e.worst));
    plan_.reasons.back().count = e.count;
  }
  if (deviation_.count > 0) plan_.reasons.push_back(deviation_);
}

}  // namespace grinder
