#pragma once

#include "flute_grinder/control/jog.h"
#include "flute_grinder/control/loop_requests.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/control/request_slot.h"
#include "flute_grinder/control/stop_requests.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <atomic>
#include <cstdint>
#include <optional>

namespace grinder {

/// A job to start.
struct JobStart {
  SetpointStream* stream = nullptr;  ///< stays alive until the job has ended, see LoopStatus, or its start is refused
  Wheel wheel;                       ///< wheelOf() the stream's program
  /// Whether the journal contains the job. If not, the job waits for confirmJournal() before it moves, as for any other
  /// interlock.
  bool in_journal = true;
  /// Whether an operator has set the swivel to the job's angle; without effect if the drive measures it.
  bool swivel_confirmed = false;
};

/// Holds other threads' requests to the control loop, and the answers. Stops, job starts, jogs, confirmations of the
/// swivel and all other requests have separate slots, so none waits for another. The public functions are for the
/// requesting threads, the protected ones for the loop; they never make the loop wait.
class RequestBox {
 public:
  /// Requests enable, home, resume, retract, lift, reset or a switch of spindle or coolant, and waits for the answer.
  /// For one thread at a time.
  ///
  /// Lift moves the wheel straight up, off the workpiece in which it was left: to the Y at which it is clear if the
  /// axes are homed, otherwise by the distance from the deepest point of the last job. Until the wheel is off the
  /// workpiece, no job starts and the machine does not home.
  RequestReply request(MachineEvent event);
  /// As request(), without waiting: the next cycle executes the request.
  /// @return false while the previous request is unanswered; this one is then not posted.
  bool post(MachineEvent event) noexcept { return requests_.post(event); }
  /// The answer to the last post(), once available.
  std::optional<RequestReply> reply();

  /// Confirms the angle of the swivel, and waits for the answer. For one thread at a time.
  ///
  /// Refused if the drive measures the swivel. While a job is in progress only the job's angle is accepted, because the
  /// swivel must not be turned then. A start is refused unless the swivel is at the job's angle.
  /// @param angle -kMaxSwivel to kMaxSwivel [rad].
  RequestReply confirmSwivel(double angle);
  /// As confirmSwivel(), without waiting and without a check of the angle.
  /// @return false while the previous confirmation is unanswered; this one is then not posted.
  bool postSwivel(double angle) noexcept { return swivels_.post(angle); }
  /// The answer to the last postSwivel(), once available.
  std::optional<RequestReply> swivelReply();

  /// Requests a stop - hold, cancel or disable - and waits at most 100 ms for the answer, see await(). For one thread
  /// at a time.
  ///
  /// Hold stops a job on its path, even before its first setpoint. Cancel stops the job on its path, lifts the wheel
  /// off the workpiece and ends the job. Disable cancels the job and then switches the power off. Each of them also
  /// stops a lift or a jog; a hold stops even the lift of a canceled job, which then ends there. During homing the
  /// drive controls the motion, so each stop switches the power off.
  RequestReply stop(MachineEvent event);
  /// As stop(), without waiting.
  /// @return a ticket for stopReply().
  std::uint32_t postStopWithReply(MachineEvent event) noexcept { return stops_.postWithReply(event); }
  /// The answer to postStopWithReply(), once available.
  std::optional<RequestReply> stopReply(MachineEvent event, std::uint32_t ticket) const;
  /// Requests a stop without an answer. For any thread and for signal handlers; an event that is not a stop is ignored.
  void postStop(MachineEvent event) noexcept { stops_.post(event); }

  /// Requests to start a job, without waiting. For one thread at a time.
  /// @return false while the previous start is unanswered; this one is then not posted.
  bool startJob(const JobStart& start) noexcept { return job_starts_.post(start); }
  /// Reports that the journal contains a job. Thread safe.
  /// @param number the loop's number for this job, see LoopStatus::jobs_started.
  void confirmJournal(std::uint64_t number) noexcept { job_in_journal_.store(number, std::memory_order_release); }
  /// The answer to the last startJob(), once available. For one thread at a time.
  std::optional<RequestReply> startJobReply();

  /// Requests a jog, and waits for the answer, not for the motion. For one thread at a time.
  ///
  /// A step moves its axis by its distance, or is refused if that would lead beyond a limit. A continuous jog moves its
  /// axis toward its limit, and must be requested again and again: without a request for jog_timeout the axis stops,
  /// and the next jog needs a request for velocity 0 first.
  /// In the middle of a job only a retracted wheel is jogged, and never down to the workpiece.
  RequestReply jog(const JogRequest& jog);
  /// As jog(), without waiting: the next cycle answers.
  /// @return false while the previous jog is unanswered; this one is then not posted.
  bool postJog(const JogRequest& jog) noexcept { return jogs_.post(jog); }
  /// The answer to the last postJog(), once available.
  std::optional<RequestReply> jogReply();
  /// As jog(), for the steps of a series, which set JogRequest::stops. For another single thread.
  RequestReply jogInSeries(const JogRequest& jog);
  /// Reports that the client of a series is alive. Thread safe.
  void keepAlive() noexcept { keep_alives_.fetch_add(1, std::memory_order_relaxed); }

  // For the loop and its parts. Real-time safe.
  std::uint64_t jobInJournal() const noexcept { return job_in_journal_.load(std::memory_order_acquire); }
  std::uint32_t keepAlives() const noexcept { return keep_alives_.load(std::memory_order_relaxed); }

 protected:
  /// @param enable_timeout longest allowed time from an enable to its answer [s].
  explicit RequestBox(double enable_timeout) noexcept : enable_timeout_(enable_timeout) {}
  ~RequestBox() = default;

  // For the loop, which takes the requests and answers them. Real-time safe.
  StopRequests stops_;
  RequestSlot<JobStart> job_starts_;
  RequestSlot<JogRequest> jogs_;
  RequestSlot<JogRequest> series_jogs_;
  RequestSlot<MachineEvent> requests_;
  RequestSlot<double> swivels_;

 private:
  const double enable_timeout_;
  std::atomic<std::uint64_t> job_in_journal_{0};  ///< number of the last job confirmed
  std::atomic<std::uint32_t> keep_alives_{0};     ///< number of calls of keepAlive()
};

}  // namespace grinder
