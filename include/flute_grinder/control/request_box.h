#pragma once

#include "flute_grinder/control/loop_requests.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/control/request_slot.h"
#include "flute_grinder/control/stop_requests.h"
#include "flute_grinder/core/setpoint_stream.h"

#include <cstdint>
#include <optional>

namespace flute_grinder {

/// A job to start.
struct JobStart {
  SetpointStream* stream = nullptr;
  Wheel wheel;  ///< of this job
};

/// Where other threads leave their requests to the control loop and find the answers. Stops, job starts and all other
/// requests each have a place of their own, so that none waits for another. The public side is for the requesting
/// threads, the protected side for the loop, which it never makes wait.
class RequestBox {
 public:
  /// Requests enable, home, resume, retract, lift or reset, and waits for the answer. For one thread at a time.
  ///
  /// Lift takes the wheel off the work where it was left, straight up: to the Y at which it is clear if the axes are
  /// homed, else by the distance from the deepest place of the last job. Until then no job starts and the machine does
  /// not home.
  RequestReply request(MachineEvent event);
  /// The same without waiting: the next cycle executes it.
  /// @return false while the previous request is unanswered; this one is then not posted.
  bool post(MachineEvent event) noexcept { return requests_.post(event); }
  /// The answer to the last post(), once there is one.
  std::optional<RequestReply> reply();

  /// Requests a stop - hold, cancel or disable - and waits for the answer, 100 ms at the most. For one thread at a
  /// time.
  ///
  /// Hold stops a job on its path, before its first setpoint too. Cancel stops it on its path, lifts the wheel off the
  /// work and ends the job. Disable does the same and then switches the power off. Each also stops a lift; a hold stops
  /// even the lift of a canceled job, which then ends there. During homing the drive moves by itself, so each stop
  /// switches the power off.
  RequestReply stop(MachineEvent event);
  /// The same without waiting.
  /// @return the ticket for stopReply().
  std::uint32_t postStopWithReply(MachineEvent event) noexcept { return stops_.postWithReply(event); }
  /// The answer to postStopWithReply(), once there is one.
  std::optional<RequestReply> stopReply(MachineEvent event, std::uint32_t ticket) const;
  /// Requests a stop without an answer. For any thread and for signal handlers; an event that is not a stop is ignored.
  void postStop(MachineEvent event) noexcept { stops_.post(event); }

  /// Requests to start a job, without waiting. For one thread at a time.
  /// @param stream not null; must stay alive until the job has ended (LoopStatus::jobs_ended), or the start is refused.
  /// @return false while the previous start is unanswered; this one is then not posted.
  bool startJob(SetpointStream* stream) noexcept;
  /// The answer to the last startJob(), once there is one. For one thread at a time.
  std::optional<RequestReply> startJobReply();

 protected:
  /// @param enable_timeout longest time from an enable to its answer [s].
  explicit RequestBox(double enable_timeout) noexcept : enable_timeout_(enable_timeout) {}
  ~RequestBox() = default;

  // The loop's side. Real-time safe.
  StopRequests::Taken takeStops() noexcept { return stops_.take(); }
  std::optional<JobStart> takeJobStart() noexcept { return job_starts_.take(); }
  std::optional<MachineEvent> takeRequest() noexcept { return requests_.take(); }
  void answerStop(const Answer& answer) noexcept { stops_.answer(answer); }
  void answerJobStart(const Answer& answer) noexcept { job_starts_.answer(answer); }
  void answerRequest(const Answer& answer) noexcept { requests_.answer(answer); }

 private:
  const double enable_timeout_;
  StopRequests stops_;
  RequestSlot<JobStart> job_starts_;
  RequestSlot<MachineEvent> requests_;
};

}  // namespace flute_grinder
