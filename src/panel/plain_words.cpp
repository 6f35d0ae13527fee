#include "panel/plain_words.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/plan_result.h"
#include "flute_grinder/messages/wheel_known.h"

#include <cmath>

namespace grinder {

namespace {

using namespace units;

std::string wheelInWork(const flute_grinder::GrinderState& state) {
  const std::string wheel =
      isWheelUnknown(state) ? "It is not known whether the wheel is in the work" : "The wheel is in the work";
  switch (static_cast<MachineState>(state.state)) {
    case MachineState::kFault: return wheel + ": reset, enable, then lift it.";
    case MachineState::kDisabled: return wheel + ": enable, then lift it.";
    case MachineState::kHeld: return "The job is held with the wheel in the work. Resume continues; Retract lifts it.";
    case MachineState::kLifting: return wheel + ": it is being lifted; no job runs.";
    case MachineState::kJogging:
      return wheel +
             (state.wheel_backs_off ? ": it is being jogged off, along X." : ": it is being jogged off, along Y.");
    default: return wheel + ": lift it.";
  }
}

std::string feedText(const flute_grinder::PathStatistics& s) {
  if (!(s.max_feed > 0)) return "The feed is never reached.";
  const double slowest = s.min_feed / kMillimetrePerMinute;
  const double fastest = s.max_feed / kMillimetrePerMinute;
  const std::string feed = fastest - slowest < 0.05 ? format("Feed %.1f mm/min", fastest)
                                                    : format("Feed %.1f to %.1f mm/min", slowest, fastest);
  return feed + (s.feed_limits.empty() ? "; no axis limits it." : ", limited by");
}

}  // namespace

std::string duration(double seconds) {
  if (seconds < 59.95) return format("%.1f s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 3600) return format("%ld:%02ld min", whole / 60, whole % 60);
  return format("%ld:%02ld:%02ld h", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string describe(const flute_grinder::GrinderState& state) {
  const auto machine = static_cast<MachineState>(state.state);
  std::string text;
  // In states other than a fault, `fault` says why the last job did not begin.
  if (!state.fault.empty()) text = "Fault: " + state.fault + ". ";
  if (!state.hold_reason.empty()) text += "Held because " + state.hold_reason + ". ";
  if (state.power_stays_on)
    return text + "The drive still reports power, though it was switched off: press the emergency stop.";
  if (state.emergency_stop) text += "The emergency stop is pressed. ";
  if (state.spindle_commanded && !isInJob(machine)) text += "The spindle is on. ";
  if (!state.homed && after(machine, MachineEvent::kResume)) {
    return text + "The reference is lost, so the job cannot be resumed: cancel it, then home.";
  }
  // A spindle or coolant that is off while the wheel is lifted keeps the job from being resumed.
  const bool is_lifted = isInJob(machine) && after(machine, MachineEvent::kSpindleOn);
  if (is_lifted && !state.spindle_commanded) text += "The spindle is off: switch it on first. ";
  if (is_lifted && !state.coolant_commanded) text += "The coolant is off: switch it on first. ";
  // In the other states of a job the wheel belongs in the work.
  if (state.wheel_in_work && (!isInJob(machine) || machine == MachineState::kHeld)) return text + wheelInWork(state);
  if (machine == MachineState::kReady && !state.homed)
    return text + "The axes are not homed. Home finds their reference.";
  if (machine == MachineState::kRunning && state.override == 0)
    return text + "The feed override is 0 %: the axes rest.";
  const std::string sentence = rowOf(machine).sentence;
  return text + (sentence.empty() ? "This panel does not know the grinder's state." : sentence);
}

std::string swivelText(const flute_grinder::GrinderState& state) {
  if (!std::isfinite(state.swivel)) return state.swivel_measured ? "Swivel not known" : "Swivel not confirmed";
  return (state.swivel_measured ? "Swivel at " : "Swivel set to ") + text(Quantity{state.swivel, Unit::kRadian});
}

std::string done(MachineEvent event) {
  switch (event) {
    case MachineEvent::kEnable: return "enable: the power is on";
    case MachineEvent::kHome: return "home: the drive is homing the axes";
    case MachineEvent::kReset: return "reset: the fault is cleared; the power is commanded off";
    case MachineEvent::kRetract:
    case MachineEvent::kLift: return toString(event) + std::string(": the wheel is being lifted");
    case MachineEvent::kResume: return "resume: the job continues";
    case MachineEvent::kSpindleOn: return "the spindle is on; keep clear of the wheel";
    case MachineEvent::kSpindleOff: return "the spindle is off; the wheel runs down";
    case MachineEvent::kCoolantOn: return "the coolant is on";
    case MachineEvent::kCoolantOff: return "the coolant is off";
    default: return toString(event) + std::string(" was sent");
  }
}

std::string operationEntry(int index, OperationKind kind) { return format("%d %s", index + 1, rowOf(kind).words); }

std::optional<OperationKind> operationOf(const flute_grinder::GrindGoal& goal) {
  if (goal.operations.size() < 2 || goal.operation >= goal.operations.size()) return std::nullopt;
  const int kind = processOf(goal).kind;
  return kind < countOf<OperationKind>() ? std::optional(static_cast<OperationKind>(kind)) : std::nullopt;
}

std::string describe(const flute_grinder::GrindGoal& goal) {
  const auto operation = operationOf(goal);
  return jobText(goal.job_name, operation ? rowOf(*operation).words : "", fromMessage(goal.cutter),
                 goal.cutter.tooth_angles.size());
}

std::string describe(const flute_grinder::JobProgress& progress) {
  return jobText(progress.job_name, progress.operation, fromMessage(progress.cutter),
                 progress.cutter.tooth_angles.size()) +
         format(", at tooth %d, pass %d", progress.tooth + 1, progress.pass + 1);
}

std::string describe(const flute_grinder::GrindResult& planned) {
  const flute_grinder::PlanReport& plan = planned.plan;
  if (!plan.valid) {
    std::string text = "Cannot be ground:";
    if (planned.reasons.empty()) text += "\n" + planned.error_string;
    for (const flute_grinder::Reason& reason : planned.reasons) text += "\n" + reason.text;
    return text;
  }
  std::string text = "Takes " + duration(plan.statistics.duration) + ".\n";
  const std::string closest = closestText(plan);
  if (!closest.empty()) text += "Closest: " + closest + ".\n";
  for (const flute_grinder::Need& need : plan.needs) text += "To start it: " + need.text + ".\n";
  text += feedText(plan.statistics);
  for (const flute_grinder::FeedLimit& limit : plan.statistics.feed_limits) text += "\n" + grinder::text(limit);
  if (plan.shank_cut > 0) {
    text +=
        format("\nThe first pass cuts %.3f mm more than its infeed out of the shank.", plan.shank_cut / kMillimetre);
  }
  if (!plan.passes.empty()) text += "\nPasses: depth, area of a section, rate";
  for (std::size_t i = 0; i < plan.passes.size(); ++i) text += format("\n%zu: ", i + 1) + passText(plan, i);
  return text;
}

}  // namespace grinder
