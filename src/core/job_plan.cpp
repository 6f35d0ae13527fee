#include "flute_grinder/core/job_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace flute_grinder {

namespace {

/// Computes the statistics of a stream of setpoints.
class StatisticsAccumulator {
 public:
  StatisticsAccumulator(const GrindProgram& program, core::PathStatistics& statistics)
      : program_(program), period_(program.machine().period), s_(statistics) {}

  void add(const Setpoint& p, const LimitCheck& check) {
    if (s_.setpoints++ == 0) return;  // the first setpoint is the start of the job: nothing has moved yet
    ++cycles_[static_cast<std::size_t>(p.move)];
    s_.max_velocity = s_.max_velocity.max(check.velocity().abs());
    largest_change_ = largest_change_.max((check.velocity() - last_velocity_).abs());
    last_velocity_ = check.velocity();
    if (p.cycle % 2 == 0) {
      s_.max_acceleration = s_.max_acceleration.max(check.acceleration().abs());
      s_.max_jerk = s_.max_jerk.max(check.jerk().abs());
    }
    if (p.step != StepKind::kNone) addStroke(p);
    if (p.cycle % 2 == 0) end_x_ = p.position[kX];
  }

  double deviation() const { return deviation_; }

  void finish() {
    for (std::size_t i = 0; i < cycles_.size(); ++i) s_.move_duration[i] = static_cast<double>(cycles_[i]) * period_;
    s_.duration = static_cast<double>(s_.setpoints - 1) * period_;
    s_.ripple_acceleration = largest_change_ / period_;
  }

 private:
  void addStroke(const Setpoint& p) {
    const ConicalCutter& cutter = program_.cutter(p.tooth);
    const double error = std::abs(p.path_error);
    double& max_error = p.step == StepKind::kOdd ? s_.max_odd_error : s_.max_even_error;
    max_error = std::max(max_error, error);
    deviation_ = error * cutter.radius(p.position[kX]) * cutter.cosHelixToGeneratrix();
    s_.max_deviation = std::max(s_.max_deviation, deviation_);
    if (p.step == StepKind::kEven && p.at_feed) {
      const double feed = std::abs(p.position[kX] - end_x_) / (2 * period_) * cutter.edgePerTravel();
      s_.max_feed = std::max(s_.max_feed, feed);
      s_.min_feed = s_.min_feed == 0 ? feed : std::min(s_.min_feed, feed);
    }
  }

  const GrindProgram& program_;
  double period_;
  core::PathStatistics& s_;
  std::array<std::uint64_t, kMoveKindCount> cycles_{};
  Axes last_velocity_ = Axes::Zero();
  Axes largest_change_ = Axes::Zero();  ///< of the velocity, from one cycle to the next
  double end_x_ = 0;
  double deviation_ = 0;
};

/// Collects the violations of a plan: the worst of each kind, and the number of its setpoints.
class ViolationCollector {
 public:
  ViolationCollector(double tolerance, JobPlan& plan) : plan_(plan) {
    deviation_.kind = core::ReasonKind::kTolerance;
    deviation_.unit = Unit::kDeviationMetre;
    deviation_.limit = tolerance;
    deviation_.has_place = true;
  }

  void add(const LimitViolation& v) {
    if (plan_.good()) plan_.fault = PlanFault::kLimit;
    const auto excess = [](const LimitViolation& w) {
      return w.quantity == LimitedQuantity::kPosition ? std::abs(w.value - w.limit) : std::abs(w.value);
    };
    const auto same = [&](const Limit& l) {
      return l.worst.axis == v.axis && l.worst.quantity == v.quantity && l.worst.move == v.move;
    };
    auto it = std::find_if(limits_.begin(), limits_.end(), same);
    if (it == limits_.end()) it = limits_.insert(it, {v, 0});
    if (excess(v) > excess(it->worst)) it->worst = v;
    ++it->count;
  }

  void addDeviation(const Setpoint& p, double deviation) {
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

  void write() {
    for (const Limit& l : limits_) {
      plan_.reasons.push_back(reasonOf(l.worst));
      plan_.reasons.back().count = l.count;
    }
    if (deviation_.count > 0) plan_.reasons.push_back(deviation_);
  }

 private:
  struct Limit {
    LimitViolation worst;
    std::uint64_t count;
  };

  JobPlan& plan_;
  std::vector<Limit> limits_;
  core::Reason deviation_;  ///< the largest, if there is one
};

/// The factor by which the feed override may increase the deviations over those at the job's feed. They grow with the
/// square of the step length. The schedule keeps them within the tolerance at any override, except with the published
/// rule, whose even points drift.
double overrideFactor(const GrindProgram& program) {
  double factor = 1;
  if (program.job().interpolation.even_step != EvenStepRule::kPublished) return factor;
  for (const Helix& helix : program.helices()) {
    factor = std::max(factor, std::pow(helix.schedule.limits().velocity / helix.schedule.feedSpeed(), 2));
  }
  return factor;
}

void refuse(JobPlan& plan, PlanFault fault, core::Reason reason) {
  plan.fault = fault;
  plan.reasons.push_back(std::move(reason));
}

/// @param least lower bound of the duration [s]; 0 if it is unknown.
void refuseAsTooLong(JobPlan& plan, const GrindJob& job, const Machine& machine, double least) {
  core::Reason reason;
  reason.kind = core::ReasonKind::kTooLong;
  reason.unit = Unit::kSecond;
  reason.value = least;
  reason.limit = machine.max_job_duration;
  reason.count = job.tooth_angles.size() * passDepths(job.process).size();
  refuse(plan, PlanFault::kTooLong, std::move(reason));
}

/// Lower bound of the time for all plunges and strokes at the job's feed [s].
double leastDuration(const GrindJob& job, const ToothPass& first) {
  const double travel = job.cutter.flute_length + job.process.overtravel_end + job.process.overtravel_shank;
  const auto teeth = static_cast<double>(job.tooth_angles.size());
  double edge = std::numeric_limits<double>::infinity();  // per travel, the shortest of all teeth
  for (int i = 0; i < static_cast<int>(job.tooth_angles.size()); ++i) {
    edge = std::min(edge, ConicalCutter(cutterOf(job, i)).edgePerTravel());
  }
  const double way = job.process.clearance + travel * edge;
  const auto passes = static_cast<double>(passDepths(job.process).size());
  const double before = job.process.order == GrindOrder::kToothMajor ? first.tooth * passes + first.pass
                                                                     : first.pass * teeth + first.tooth;
  return std::max(0.0, teeth * passes - before) * way / job.process.feed;
}

/// Checks periodically whether the job is too long and whether the plan is still wanted.
class Supervisor {
 public:
  Supervisor(const PlanWatch& watch, JobPlan& plan)
      : watch_(watch),
        plan_(plan),
        last_(static_cast<std::uint64_t>(plan.program->machine().max_job_duration / plan.program->machine().period)) {}

  /// @return whether to continue after a setpoint.
  bool goOn(const Setpoint& p) { return p.cycle < next_look_ || look(p); }

 private:
  static constexpr std::uint64_t kSetpointsPerLook = 4096;  ///< a few tenths of a millisecond

  bool look(const Setpoint& p) {
    const GrindProgram& program = *plan_.program;
    if (p.cycle > last_) {
      refuseAsTooLong(plan_, program.job(), program.machine(), 0);
      return false;
    }
    next_look_ = std::min(p.cycle + kSetpointsPerLook, last_ + 1);
    const double done = (p.move_index + p.move_fraction) / static_cast<double>(program.moves().size());
    if (!watch_ || watch_(done)) return true;
    core::Reason reason;
    reason.kind = core::ReasonKind::kGivenUp;
    refuse(plan_, PlanFault::kGivenUp, std::move(reason));
    return false;
  }

  const PlanWatch& watch_;
  JobPlan& plan_;
  std::uint64_t last_;  ///< longest allowed job in cycles
  std::uint64_t next_look_ = 0;
};

void runThrough(SetpointStream& stream, JobPlan& plan, const std::function<void(const Setpoint&)>& visit,
                Supervisor& supervisor) {
  const GrindProgram& program = stream.program();
  const double tolerance = program.job().interpolation.tolerance;
  const double factor = overrideFactor(program);
  LimitCheck check(program.machine().limits, program.machine().period);
  StatisticsAccumulator accumulator(program, plan.statistics);
  ViolationCollector violations(tolerance, plan);
  plan.move_ends.assign(program.moves().size(), 0);
  Setpoint p;
  while (stream.next(p)) {
    if (check.check(p, program.machine().work_offset)) {
      std::for_each(check.begin(), check.end(), [&](const auto& v) { violations.add(v); });
      if (!p.position.isFinite().all()) break;
    }
    accumulator.add(p, check);
    plan.move_ends[p.move_index] = p.cycle;
    if (visit) visit(p);
    const double deviation = accumulator.deviation() * factor;
    if (p.step != StepKind::kNone && !(deviation <= tolerance)) violations.addDeviation(p, deviation);
    if (!supervisor.goOn(p)) break;
  }
  // A move of zero length has no setpoints of its own.
  for (std::size_t i = 1; i < plan.move_ends.size(); ++i) {
    plan.move_ends[i] = std::max(plan.move_ends[i], plan.move_ends[i - 1]);
  }
  accumulator.finish();
  violations.write();
}

}  // namespace

JobPlan planJob(const GrindJob& job, const Machine& machine, const Axes& start, const ToothPass& first,
                const std::function<void(const Setpoint&)>& visit, const PlanWatch& watch) {
  JobPlan plan;
  plan.reasons = validate(job);
  if (!plan.reasons.empty()) {
    plan.fault = PlanFault::kInvalidJob;
    return plan;
  }
  const double least = leastDuration(job, first);
  if (least > machine.max_job_duration) {
    refuseAsTooLong(plan, job, machine, least);
    return plan;
  }
  try {
    plan.program = std::make_shared<const GrindProgram>(job, machine, start, first);
  } catch (const core::ReasonError& error) {
    refuse(plan, PlanFault::kInvalidJob, error.reason());
    return plan;
  } catch (const std::invalid_argument& error) {
    core::Reason reason;
    reason.kind = core::ReasonKind::kOther;
    reason.detail = error.what();
    refuse(plan, PlanFault::kInvalidJob, std::move(reason));
    return plan;
  }
  for (const Helix& helix : plan.program->helices()) {
    const std::vector<core::FeedLimit>& limits = helix.schedule.feedLimits();
    plan.statistics.feed_limits.insert(plan.statistics.feed_limits.end(), limits.begin(), limits.end());
  }
  SetpointStream stream(plan.program);
  Supervisor supervisor(watch, plan);
  runThrough(stream, plan, visit, supervisor);
  return plan;
}

}  // namespace flute_grinder
