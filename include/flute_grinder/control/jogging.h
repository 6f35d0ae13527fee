#pragma once

#include "flute_grinder/control/job_run.h"
#include "flute_grinder/control/jog.h"

#include <cstdint>

namespace grinder {

/// The jog in progress, and the clients that must keep it going. Its motion is LoopState::axis_move. Real-time safe.
class Jogging {
 public:
  /// @param now state of the loop. @param box where clients report. @param job the loop's job. All must outlive this
  /// object.
  Jogging(LoopState& now, const RequestBox& box, const JobRun& job) noexcept
      : now_(now), box_(box), job_(job), dead_man_(now.config.jog_timeout), client_(now.config.jog_timeout) {}

  /// Whether a jog is in progress; in the middle of a job the job adopts its setpoints.
  bool inProgress() const noexcept { return in_progress_; }
  /// Whether the jog is a step of a series with a client.
  bool isForClient() const noexcept { return in_progress_ && for_client_; }
  Axes distanceToGo() const noexcept;  ///< of a jog or a lift, from the position read [m], A [rad]

  /// Executes a request. @param answer gets refusal, axis, value and limit.
  void execute(const JogRequest& jog, Answer& answer) noexcept;
  /// To be called when a stop was requested: a switch that is still pressed moves nothing until it is released.
  void block() noexcept { dead_man_.block(); }
  /// To be called in every cycle, after the drive was read and before execute().
  void watch() noexcept;
  /// To be called in every cycle of a jog: stops it if it must not go on.
  void stopIfNeeded() noexcept;
  void end() noexcept;

 private:
  Refusal goOn(const JogRequest& jog, Answer& answer) noexcept;
  Refusal begin(const JogRequest& jog, Answer& answer) noexcept;
  Refusal refusalOfState(const JogRequest& jog) const noexcept;
  Refusal refusalOfSpeed(const JogRequest& jog, Answer& answer) const noexcept;
  Refusal refusalOfPosition(Answer& answer) const noexcept;
  Refusal findEnd(const JogRequest& jog, Answer& answer) const noexcept;
  double lowest(int axis) const noexcept;
  void hearClient() noexcept;

  LoopState& now_;
  const RequestBox& box_;
  const JobRun& job_;
  bool in_progress_ = false;
  bool continuous_ = false;
  bool for_client_ = false;  ///< the jog stops when its client is silent
  bool touched_ = false;     ///< the probe is in contact
  bool touches_ = false;     ///< the contact has begun in this cycle
  DeadMansSwitch dead_man_;
  SilenceTimer client_;  ///< silence of a series' client
  std::uint32_t keep_alives_seen_ = 0;
};

}  // namespace grinder
