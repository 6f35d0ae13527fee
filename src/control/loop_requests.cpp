#include "flute_grinder/control/loop_requests.h"

#include <sstream>

namespace grinder {

namespace {

constexpr int kSwivelDigits = 10;  ///< digits with which a job's angle appears as entered

/// An angle in degrees, as text. @param angle [rad].
std::string degrees(double angle, int digits = 6) { return grinder::text(Quantity{angle, Unit::kRadian}, digits); }

/// What the drive would have to do. @param event an event that not every drive can execute.
const char* offer(MachineEvent event) {
  if (event == MachineEvent::kHome) return "home the axes";
  const bool spindle = event == MachineEvent::kSpindleOn || event == MachineEvent::kSpindleOff;
  return spindle ? "switch the spindle" : "switch the coolant";
}

}  // namespace

RequestReply Answer::reply() const {
  if (refusal == Refusal::kNone) return {true, "", true};
  const auto position = [&](double si) { return grinder::text(Quantity{si, unitOf(axis, 0)}); };
  const auto speed = [&](double si) {
    const Unit unit = axis == kA ? Unit::kRadianPerSecond : Unit::kFeedMetrePerSecond;
    return grinder::text(Quantity{si, unit});
  };
  const auto words = [&] { return drive_text.text().empty() ? "" : ": " + drive_text.text(); };
  std::ostringstream text;
  const bool confirmation = refusal == Refusal::kSwivelMeasured || refusal == Refusal::kSwivelInUse;
  text << (confirmation ? "confirm-swivel" : toString(event)) << " refused: ";
  switch (refusal) {
    case Refusal::kNone: break;
    case Refusal::kState:
      text << "the machine is in state " << toString(state) << "; allowed: " << allowedIn(state);
      break;
    case Refusal::kNotOffered: text << "the drive does not " << offer(event); break;
    case Refusal::kEmergencyStop: text << "the emergency stop is pressed; release it first"; break;
    case Refusal::kDriveFault: text << "the drive reports a fault" << words() << "; reset it first"; break;
    case Refusal::kDriveFaultStays:
      text << "the drive still reports a fault after the reset" << words() << "; remove its cause";
      break;
    case Refusal::kInterlock: text << toString(interlock); break;
    case Refusal::kPreparing: text << "the drive has not become ready in time; wait, then try again"; break;
    case Refusal::kNotPrepared: text << "the drive is not ready: " << drive_text.text(); break;
    case Refusal::kNoPower: text << "the drive did not switch its power on in time"; break;
    case Refusal::kPowerStays:
      text << "the drive still reports power, though it was switched off; press the emergency stop";
      break;
    case Refusal::kMoved: text << "the axes are not where the job was planned to start; plan it again"; break;
    case Refusal::kFeedback: text << "the drive gives no valid, fresh positions"; break;
    case Refusal::kWithdrawn: text << "disable came before the power"; break;
    case Refusal::kInWork: text << "the wheel is in the work; lift it first"; break;
    case Refusal::kMayBeInWork: text << "it is not known whether the wheel is in the work; lift it first"; break;
    case Refusal::kNotInWork: text << "the wheel is not in the work"; break;
    // In shop units, because only people read them: the answer to a request has no fields for data.
    case Refusal::kTooFar:
      text << "it would lead " << axisName(axis) << " to machine position " << position(value)
           << (value < limit ? "; allowed: down to " : "; allowed: up to ") << position(limit);
      break;
    case Refusal::kSwivel: text << grinder::text(reasonOf(swivel, job_swivel)); break;
    case Refusal::kSwivelMeasured:
      text << "the drive measures the swivel, which is at " << degrees(swivel.angle) << "; nothing is to be confirmed";
      break;
    case Refusal::kSwivelInUse:
      text << "a job is in progress that needs " << degrees(job_swivel, kSwivelDigits)
           << "; allowed: that angle, or to end the job first";
      break;
    case Refusal::kNoAxis: text << axisRefusal(axis); break;
    case Refusal::kJogSpeed:
      text << "speed of " << axisName(axis) << " = " << speed(value) << "; allowed: above 0, up to " << speed(limit);
      break;
    case Refusal::kAtLimit:
      text << axisName(axis) << " is at machine position " << position(limit) << ", the end of its travel";
      break;
    case Refusal::kOutside:
      text << axisName(axis) << " is at machine position " << position(value) << ", outside its limit "
           << position(limit);
      break;
    case Refusal::kJogging: text << "an axis is being jogged; wait until it rests"; break;
    case Refusal::kJobOver: text << "the job has reached the end of its path; resume it first"; break;
    case Refusal::kStopped: text << "it was stopped or refused before; release the button first"; break;
    case Refusal::kTimedOut: text << "it was not repeated within jog_timeout; release the button first"; break;
    case Refusal::kTouches: text << "the probe touches already; move it off first"; break;
    case Refusal::kWheelTurns: text << "the wheel turns; switch the spindle off first"; break;
    case Refusal::kProbing: text << "a probing cycle is in progress; wait for its end, or cancel it"; break;
    case Refusal::kStopCameFirst: text << "a stop came first"; break;
  }
  return {false, text.str(), true};
}

}  // namespace grinder
