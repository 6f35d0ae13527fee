#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/feed_schedule.h"
#include "flute_grinder/core/grind_job.h"
#include "flute_grinder/core/setpoint.h"

#include <vector>

namespace flute_grinder {

/// One move of a job, from the end of the previous move.
struct Move {
  MoveKind kind = MoveKind::kLift;
  std::uint16_t tooth = 0;
  std::uint16_t pass = 0;
  Axes to = Axes::Zero();  ///< [m], A [rad]
};

/// The ordered moves of all teeth and passes of a job. If the wheel is lower than the park position, it first rises to
/// that height. Then, for each pass: A is indexed, the wheel moves to above the start, descends to the clearance,
/// plunges at feed, makes its stroke with overtravel, and retracts radially. At the end the wheel returns to the park
/// position. The plunge compensates for wheel wear, so the compensation never changes within a pass.
class GrindProgram {
 public:
  /// @param job a job that validate() accepts.
  /// @param machine the machine that runs the job.
  /// @param start the position of the axes at the start [m], A [rad].
  /// @param first first pass to grind.
  /// @throw std::invalid_argument if `first` is not a pass of the job, or if the feed would have to be reduced below
  ///        kMinFeed.
  GrindProgram(const GrindJob& job, const Machine& machine, const Axes& start, const ToothPass& first = {});

  const GrindJob& job() const noexcept { return job_; }
  const Machine& machine() const noexcept { return machine_; }
  const ConicalCutter& cutter() const noexcept { return cutter_; }
  const Axes& start() const noexcept { return start_; }
  const std::vector<Move>& moves() const noexcept { return moves_; }

  /// The feed schedule of the stroke, the same for all teeth and passes.
  const FeedSchedule& schedule() const noexcept { return schedule_; }
  double strokeFrom() const noexcept { return stroke_.from; }  ///< X [m]
  double strokeTo() const noexcept { return stroke_.to; }      ///< X [m]

  /// Y at which the wheel is clear of the workpiece over the whole stroke [m].
  double clearanceHeight() const noexcept { return clearance_y_; }

 private:
  void append(MoveKind kind, const ToothPass& pass, const Axes& to);
  void appendPass(const ToothPass& pass, double infeed, Axes& at);

  GrindJob job_;
  Machine machine_;
  ConicalCutter cutter_;
  Axes start_;
  FeedSchedule::Stroke stroke_;
  FeedSchedule schedule_;
  double clearance_y_;
  std::vector<Move> moves_;
};

}  // namespace flute_grinder
