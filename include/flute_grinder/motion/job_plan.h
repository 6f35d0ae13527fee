#pragma once

#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/limit_check.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <functional>
#include <memory>
#include <vector>

namespace grinder {

/// Statistics of a job's setpoints.
struct PathStatistics {
  std::uint64_t setpoints = 0;
  double duration = 0;                                 ///< [s]
  std::array<double, kMoveKindCount> move_duration{};  ///< per MoveKind [s]
  double max_odd_error = 0;                            ///< |theory - commanded| of A at odd points [rad]
  double max_even_error = 0;                           ///< |theory - commanded| of A at even points [rad]
  double max_deviation = 0;                            ///< deviation at the cutter's surface, normal to the helix [m]
  double min_feed = 0, max_feed = 0;                   ///< range of the feed of pairs at feed; 0 if never at feed [m/s]
  Axes max_velocity = Axes::Zero();                    ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();                ///< maximum at pair ends [m/s^2], A [rad/s^2]
  Axes max_jerk = Axes::Zero();                        ///< maximum at pair ends [m/s^3], A [rad/s^3]
  Axes ripple_acceleration = Axes::Zero();  ///< single-cycle acceleration of odd-even steps [m/s^2], A [rad/s^2]
  std::vector<FeedLimit> feed_limits;       ///< causes and places of feed limits
};

/// Why a plan was refused.
enum class PlanFault {
  kNone,
  kInvalidJob,
  kLimit,
  kTolerance,
  kTool,  ///< the ground cutter does not meet the job's requirements
  kCollision,
  kTooLong,  ///< the job takes longer than Machine::max_job_duration
  kGivenUp,  ///< PlanWatch returned false
};

/// Called about every millisecond while a plan is computed.
/// @param done fraction of the job generated and checked so far, 0..1.
/// @return false to give up planning.
using PlanWatch = std::function<bool(double done)>;

/// The setpoints of a job, generated and checked as a whole.
struct JobPlan {
  PlanFault fault = PlanFault::kNone;
  std::vector<Reason> reasons;  ///< reasons for refusing the plan: one for each field, axis and kind of limit
  PathStatistics statistics;
  std::vector<std::uint64_t> move_ends;         ///< last cycle of every move in the program
  std::shared_ptr<const GrindProgram> program;  ///< null if the job or its law of Z was refused

  bool good() const { return fault == PlanFault::kNone; }
};

/// Checks every setpoint of a job, up to the machine's max_job_duration. The setpoints are identical to those that the
/// machine would receive. For any job and machine, the result is either a good plan or one with reasons.
///
/// Moves that differ only by constant offsets of their axes, such as the strokes of all teeth and passes, are generated
/// completely only once, unless every setpoint is asked for or something is not allowed. The statistics of Y and A then
/// differ by rounding from the statistics of all setpoints; nothing else differs.
/// @param visit if given, every setpoint is generated and passed to it; all of them are finite.
/// @param watch if given, it may stop the planner.
JobPlan planJob(const ValidJob& job, const Machine& machine, const RunStart& run,
                const std::function<void(const Setpoint&)>& visit = {}, const PlanWatch& watch = {});

}  // namespace grinder
