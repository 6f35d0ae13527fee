#pragma once

#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/core/limit_check.h"
#include "flute_grinder/core/setpoint_stream.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace flute_grinder {

namespace core {

/// Statistics of the setpoints of a job.
struct PathStatistics {
  std::uint64_t setpoints = 0;
  double duration = 0;                                 ///< [s]
  std::array<double, kMoveKindCount> move_duration{};  ///< per MoveKind [s]
  double max_odd_error = 0;                            ///< |theory - commanded| of A at odd points [rad]
  double max_even_error = 0;                           ///< the same at even points [rad]
  double max_deviation = 0;                            ///< normal to the helix at the cutter's surface [m]
  double min_feed = 0, max_feed = 0;                   ///< pair by pair while at feed; 0 where it never is [m/s]
  Axes max_velocity = Axes::Zero();                    ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();                ///< at pair ends [m/s^2], A [rad/s^2]
  Axes max_jerk = Axes::Zero();                        ///< at pair ends [m/s^3], A [rad/s^3]
  Axes ripple_acceleration = Axes::Zero();             ///< over single cycles: the odd-even steps' [m/s^2], A [rad/s^2]
  std::vector<FeedLimit> feed_limits;                  ///< what holds the feed below the one asked for, and where
};

}  // namespace core

/// Why a plan is refused.
enum class PlanFault {
  kNone,
  kInvalidJob,
  kLimit,
  kTolerance,
  kTooLong,  ///< longer than Machine::max_job_duration
  kGivenUp,  ///< by the watch
};

/// Watches a plan that is being made, every millisecond or so.
/// @param done part of the job that is generated and checked, 0..1.
/// @return false to give the plan up.
using PlanWatch = std::function<bool(double done)>;

/// A job that was generated and checked as a whole.
struct JobPlan {
  PlanFault fault = PlanFault::kNone;
  std::vector<core::Reason> reasons;  ///< why not, one for each field, axis and kind of limit
  core::PathStatistics statistics;
  std::vector<std::uint64_t> move_ends;         ///< last cycle of every move of the program
  std::shared_ptr<const GrindProgram> program;  ///< null where the job's numbers are refused

  bool good() const { return fault == PlanFault::kNone; }
};

/// Generates and checks every setpoint of a job, just as the machine would get them, up to the machine's
/// max_job_duration. Whatever the job and the machine, the answer is a good plan or one with reasons.
/// @param job the job; its numbers are checked too.
/// @param machine what it is to run on.
/// @param start where the axes stand [m], A [rad].
/// @param first first pass to grind.
/// @param visit called with every setpoint, if given; all of them are finite.
/// @param watch may give the plan up, if given.
JobPlan planJob(const GrindJob& job, const Machine& machine, const Axes& start, const ToothPass& first = {},
                const std::function<void(const Setpoint&)>& visit = {}, const PlanWatch& watch = {});

}  // namespace flute_grinder
