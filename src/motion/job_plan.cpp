#include "flute_grinder/motion/job_plan.h"

#include "motion/plan_checks.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

void refuse(JobPlan& plan, PlanFault fault, Reason reason) {
  plan.fault = fault;
  plan.reasons.push_back(std::move(reason));
}

/// @param min lower bound of the duration; 0 if it is unknown [s].
void refuseAsTooLong(JobPlan& plan, const ValidJob& job, const Machine& machine, double min) {
  Reason reason;
  reason.kind = ReasonKind::kTooLong;
  reason.unit = Unit::kSecond;
  reason.value = min;
  reason.limit = machine.max_job_duration;
  reason.count = job.passes().size();
  refuse(plan, PlanFault::kTooLong, std::move(reason));
}

/// Lower bound of the time for all plunges and strokes at the job's feed [s].
double minDuration(const ValidJob& job, const ToothPass& first) {
  double way = std::numeric_limits<double>::infinity();  // shortest of all teeth
  for (int i = 0; i < job.teeth(); ++i) {
    if (job.isStraight()) {
      const FaceStroke stroke = job.faceStroke(i, job.deepest(), 0);
      way = std::min(way, (stroke.to - stroke.from).head<3>().matrix().norm());
    } else {
      const double travel = std::abs(job.strokeLaw(i).to - job.strokeLaw(i).from);
      way = std::min(way, job->process().clearance + travel * ConicalCutter(job.cutterOf(i)).edgePerTravel());
    }
  }
  const std::vector<JobPass>& passes = job.passes();
  const auto is_first = [&](const JobPass& pass) { return pass.place == first; };
  const auto left = passes.end() - std::find_if(passes.begin(), passes.end(), is_first);
  return static_cast<double>(left) * way / job->process().feed;
}

/// Checks periodically whether the job is too long and whether the plan is still wanted.
class Supervisor {
 public:
  Supervisor(const PlanWatch& watch, JobPlan& plan)
      : watch_(watch),
        plan_(plan),
        last_(static_cast<std::uint64_t>(plan.program->machine().max_job_duration / plan.program->machine().period)) {}

  /// @return whether to continue after a setpoint.
  bool goOn(const Setpoint& p) {
    if (p.cycle > last_) {
      refuseAsTooLong(plan_, plan_.program->job(), plan_.program->machine(), 0);
      return false;
    }
    return setpoints_++ % kSetpointsPerLook != 0 || isWanted(p);
  }

 private:
  static constexpr std::uint64_t kSetpointsPerLook = 4096;  ///< setpoints between checks, some tenths of a millisecond

  bool isWanted(const Setpoint& p) {
    const double done = (p.move_index + p.move_fraction) / static_cast<double>(plan_.program->moves().size());
    if (!watch_ || watch_(done)) return true;
    refuse(plan_, PlanFault::kGivenUp, Reason{ReasonKind::kGivenUp});
    return false;
  }

  const PlanWatch& watch_;
  JobPlan& plan_;
  std::uint64_t last_;  ///< longest allowed job in cycles
  std::uint64_t setpoints_ = 0;
};

/// Generates and checks every setpoint of a plan's program.
void planAllSetpoints(JobPlan& plan, const std::function<void(const Setpoint&)>& visit, const PlanWatch& watch) {
  SetpointStream stream(plan.program);
  PlanChecks checks(plan);
  Supervisor supervisor(watch, plan);
  Setpoint p;
  while (stream.next(p) && checks.add(p)) {
    if (visit) visit(p);
    if (!supervisor.goOn(p)) break;
  }
  checks.finish();
}

/// Generates and checks the moves of a plan's program, but only the first of each shape completely. Of every other move
/// it generates the beginning and the end with the move's own offsets. In between, the move differs from the first only
/// by constant offsets, so velocity, acceleration, jerk and the errors are the same, and no position is farther out
/// than at the ends: all axes move in one direction, except Z in a stroke, which has no offset.
class ShapePlanner {
 public:
  ShapePlanner(JobPlan& plan, const PlanWatch& watch)
      : plan_(plan), stream_(plan.program), checks_(plan), supervisor_(watch, plan) {}

  /// @return whether the plan is now as planAllSetpoints() would make it, up to the rounding of the statistics; false
  ///        if something is not allowed, since the full list of reasons needs every setpoint.
  bool run() {
    Setpoint p;
    while (stream_.next(p)) {
      if (p.cycle == 1 || p.move_index != move_) beginMove(p);
      ++cycles_;
      if (to_recall_ > 0) {
        --to_recall_;
        checks_.recall(p);
      } else if (!checks_.add(p)) {
        return false;
      }
      if (!plan_.good()) return false;
      if (!supervisor_.goOn(p)) return plan_.fault == PlanFault::kGivenUp;
      if (p.cycle % 2 == 1) continue;
      if (known_) {
        skipToEnd(p);
      } else {
        skipCruise(p);
        keep();
      }
    }
    checks_.finish();
    return true;
  }

 private:
  /// The first move of a shape.
  struct Known {
    SetpointStream near_end;
    std::uint64_t cycles;  ///< cycles of the move up to near_end
  };

  /// Cycles of the preceding move that affect the jerk at a setpoint: three pairs.
  static constexpr std::uint64_t kReach = 6;
  /// Maximum number of cycles left out at a time, some microseconds' worth, so that planning a move of hours can be
  /// stopped and ends at the maximum duration.
  static constexpr std::uint64_t kMostSkipped = 4096;
  /// Cycles generated at the end of a move: setpoints to compare with, and as many to check.
  static constexpr double kEnd = 2 * kReach;

  void beginMove(const Setpoint& p) {
    move_ = p.move_index;
    cycles_ = 0;
    shape_ = stream_.shape();
    const auto found = moves_.find(shape_);
    known_ = found == moves_.end() ? nullptr : &found->second;
  }

  /// Jumps near the end of a known move once the previous move no longer affects the jerk.
  void skipToEnd(const Setpoint& p) {
    if (cycles_ != kReach) return;
    stream_.skip(known_->near_end, known_->cycles - cycles_);
    skipped(p, known_->cycles - cycles_);
  }

  void skipCruise(const Setpoint& p) {
    if (cycles_ <= kReach || to_recall_ > 0) return;
    const std::uint64_t count = stream_.skipCruise(kReach, kMostSkipped);
    if (count > 0) skipped(p, count);
  }

  void skipped(const Setpoint& p, std::uint64_t count) {
    checks_.skip(p.move, count);
    cycles_ += count;
    to_recall_ = kReach;
  }

  void keep() {
    const double left = stream_.timeLeft() / plan_.program->machine().period;
    if (cycles_ > kReach && left > kEnd && left <= kEnd + 2) moves_.emplace(shape_, Known{stream_, cycles_});
  }

  JobPlan& plan_;
  SetpointStream stream_;
  PlanChecks checks_;
  Supervisor supervisor_;
  std::map<MoveShape, Known> moves_;
  std::uint32_t move_ = 0;
  std::uint64_t cycles_ = 0;  ///< cycles of the move so far
  MoveShape shape_;           ///< shape of the move
  const Known* known_ = nullptr;
  std::uint64_t to_recall_ = 0;  ///< number of setpoints yet to be recalled
};

/// Generates and checks the setpoints of a plan's program, if possible only one move of each shape.
void planSetpoints(JobPlan& plan, const PlanWatch& watch) {
  JobPlan by_shapes = plan;
  const bool done = ShapePlanner(by_shapes, watch).run();
  if (done) {
    plan = std::move(by_shapes);
  } else {
    planAllSetpoints(plan, {}, watch);
  }
}

}  // namespace

JobPlan planJob(const ValidJob& job, const Machine& machine, const RunStart& run,
                const std::function<void(const Setpoint&)>& visit, const PlanWatch& watch) {
  JobPlan plan;
  const double min = minDuration(job, run.first);
  if (min > machine.max_job_duration) {
    refuseAsTooLong(plan, job, machine, min);
    return plan;
  }
  try {
    plan.program = std::make_shared<const GrindProgram>(job, machine, run);
  } catch (const ReasonError& error) {
    refuse(plan, PlanFault::kInvalidJob, error.reason());
    return plan;
  } catch (const std::invalid_argument& error) {
    refuse(plan, PlanFault::kInvalidJob, otherReason(error.what()));
    return plan;
  }
  for (const Helix& helix : plan.program->helices()) {
    const std::vector<FeedLimit>& limits = helix.schedule.feedLimits();
    plan.statistics.feed_limits.insert(plan.statistics.feed_limits.end(), limits.begin(), limits.end());
  }
  if (visit) {
    planAllSetpoints(plan, visit, watch);
  } else {
    planSetpoints(plan, watch);
  }
  return plan;
}

}  // namespace grinder
