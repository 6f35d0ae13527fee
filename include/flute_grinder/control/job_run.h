#pragma once

#include "flute_grinder/control/command_history.h"
#include "flute_grinder/control/loop_state.h"
#include "flute_grinder/control/request_box.h"

#include <cstdint>

namespace grinder {

/// The job in progress: its setpoints, its interlocks, spindle and coolant. Real-time safe.
class JobRun {
 public:
  /// @param now state of the loop. @param box where the journal is confirmed. Both must outlive this object.
  JobRun(LoopState& now, const RequestBox& box) noexcept : now_(now), box_(box) {}

  bool inProgress() const noexcept { return stream_ != nullptr; }
  double swivel() const noexcept { return swivel_; }       ///< swivel that the job needs, or the last one [rad]
  const Axes& offset() const noexcept { return offset_; }  ///< machine position - setpoint's position [m], A [rad]
  const JobTrack& written() const noexcept { return written_; }  ///< setpoints written for the job, or the last one
  /// Whether a jog may move the axes without losing the job: none is in progress, or it has a path to return to.
  bool allowsJog() const noexcept { return !stream_ || stream_->rest() == Rest::kLifted; }
  bool spindle() const noexcept { return spindle_; }  ///< whether the spindle is commanded, by a job or by hand
  /// The first open interlock, including those of the job; kNone if grinding is allowed.
  Interlock openInterlock() const noexcept;
  Axes distanceToGo() const noexcept;  ///< distance to the end of the program's move in effect [m], A [rad]

  /// Starts a job. @return why not; kNone if it starts.
  Refusal begin(const JobStart& job) noexcept;
  Refusal resume() noexcept;
  Refusal retract() noexcept;
  /// Stops on the path. @param event hold, cancel or disable.
  void stop(MachineEvent event) noexcept;

  /// What a job does in a cycle.
  enum class Step : std::uint8_t {
    kWaits,
    kMoves,  ///< has computed the sample's setpoint
    kRests,
    kEnded,  ///< its interlocks were not closed in time
  };
  Step next(double feed_override) noexcept;
  /// To be called once the axes have reached the last setpoint. @return whether they stay there.
  bool rest(bool all_reached) noexcept;
  /// Counts the sample's setpoint as written.
  void count() noexcept {
    if (stream_) written_.add(now_.sample.setpoint);
  }
  /// Takes a setpoint of a jog into the job. @param setpoint in machine coordinates, afterwards in the job's.
  void adopt(Setpoint& setpoint) noexcept;
  /// See SetpointStream::slowDown().
  void slowDown(double factor) noexcept {
    if (stream_) stream_->slowDown(factor);
  }
  void end(JobEnd end) noexcept;

  /// Switches spindle or coolant by hand.
  void switchByHand(bool spindle, bool on) noexcept {
    (spindle ? spindle_ : coolant_) = on;
    switched_by_hand_ = true;
  }
  /// Passes on in the sample whether spindle and coolant are commanded.
  void commandSwitches() noexcept;

 private:
  bool awaitInterlocks() noexcept;
  void checkInterlocks() noexcept;
  bool beginLiftOff() noexcept;

  LoopState& now_;
  const RequestBox& box_;
  SetpointStream* stream_ = nullptr;
  double swivel_ = 0;
  Axes offset_ = Axes::Zero();
  bool in_journal_ = true;  ///< the journal contained the job when it was started
  JobTrack written_;
  bool may_lift_off_ = true;  ///< a canceled job lifts the wheel once it has stopped
  bool spindle_ = false;
  bool coolant_ = false;
  bool switched_by_hand_ = false;  ///< spindle or coolant, since the job began or was resumed
  double waited_ = 0;              ///< time waited for the interlocks [s]
};

}  // namespace grinder
