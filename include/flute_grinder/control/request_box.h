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
  Wheel wheel;  ///< for this job
};

/// Holds other threads' requests to the control loop, and the answers. Stops, job starts and all other requests have
/// separate slots, so none waits for another. The public functions are for the requesting threads, the protected ones
/// for the loop; they never make the loop wait.
class RequestBox {
 public:
  /// Requests enable, home, resume, retract, lift or reset, and waits for the answer. For one thread at a time.
  ///
  /// Lift moves the wheel straight up, off the workpiece in which it was left: to the Y at which it is clear if the
  /// axes are homed, otherwise by the distance from the deepest point of the last job. Until the wheel is off the
  /// workpiece, no job starts and the machine does not home.
  RequestReply request(MachineEvent event);
  /// The same without waiting: the next cycle executes it.
  /// @return false while the previous request is unanswered; this one is then not posted.
  bool post(MachineEvent event) noexcept { return requests_.post(event); }
  /// The answer to the last post(), once available.
  std::optional<RequestReply> reply();

  /// Requests a stop - hold, cancel or disable - and waits at most 100 ms for the answer. For one thread at a time.
  ///
  /// Hold stops a job on its path, even before its first setpoint. Cancel stops the job on its path, lifts the wheel
  /// off the workpiece and ends the job. Disable does the same and then switches the power off. Each of them also stops
  /// a lift; a hold stops even the lift of a canceled job, which then ends there. During homing the drive controls the
  /// motion, so each stop switches the power off.
  RequestReply stop(MachineEvent event);
  /// The same without waiting.
  /// @return a ticket for stopReply().
  std::uint32_t postStopWithReply(MachineEvent event) noexcept { return stops_.postWithReply(event); }
  /// The answer to postStopWithReply(), once available.
  std::optional<RequestReply> stopReply(MachineEvent event, std::uint32_t ticket) const;
  /// Requests a stop without an answer. For any thread and for signal handlers; an event that is not a stop is ignored.
  void postStop(MachineEvent event) noexcept { stops_.post(event); }

  /// Requests to start a job, without waiting. For one thread at a time.
  /// @param stream not null; must stay alive until the job has ended (LoopStatus::jobs_ended) or its start is refused.
  /// @return false while the previous start is unanswered; this one is then not posted.
  bool startJob(SetpointStream* stream) noexcept;
  /// The answer to the last startJob(), once available. For one thread at a time.
  std::optional<RequestReply> startJobReply();

 protected:
  /// @param enable_timeout longest allowed time from an enable to its answer [s].
  explicit RequestBox(double enable_timeout) noexcept : enable_timeout_(enable_timeout) {}
  ~RequestBox() = default;

  // For the loop. Real-time safe.
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
