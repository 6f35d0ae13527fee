#include "flute_grinder/machine/loop_fault.h"

#include <utility>

namespace flute_grinder {

namespace {

using core::ReasonKind;

std::pair<ReasonKind, Unit> kindAndUnit(const LoopFault& fault) {
  switch (fault.kind) {
    case FaultKind::kNone: break;
    case FaultKind::kEmergencyStop: return {ReasonKind::kEmergencyStop, Unit::kNone};
    case FaultKind::kDriveFault: return {ReasonKind::kDriveFault, Unit::kNone};
    case FaultKind::kPowerLost: return {ReasonKind::kPowerLost, Unit::kNone};
    case FaultKind::kStaleFeedback: return {ReasonKind::kStaleFeedback, Unit::kSecond};
    case FaultKind::kInvalidFeedback: return {ReasonKind::kInvalidFeedback, unitOf(fault.axis, 0)};
    case FaultKind::kFollowingError: return {ReasonKind::kFollowingError, unitOf(fault.axis, 0)};
    case FaultKind::kUnderrun: return {ReasonKind::kUnderrun, Unit::kNone};
    case FaultKind::kLate: return {ReasonKind::kLate, Unit::kSecond};
    case FaultKind::kLimit: break;  // the violation determines the kind
    case FaultKind::kHoming: return {ReasonKind::kHoming, Unit::kSecond};
    case FaultKind::kInterlock: return {ReasonKind::kInterlock, Unit::kSecond};
  }
  return {ReasonKind::kNone, Unit::kNone};
}

}  // namespace

const char* toString(Interlock interlock) noexcept {
  switch (interlock) {
    case Interlock::kNone: return "";
    case Interlock::kNotHomed: return "the axes are not homed";
    case Interlock::kSpindle: return "the spindle is not at speed";
    case Interlock::kCoolant: return "no coolant flows";
    case Interlock::kProbe: return "the measuring probe is in the way";
    case Interlock::kSwivel: return "the swivel is not at the job's angle";
    case Interlock::kJournal: return "the journal does not contain the job";
  }
  return "unknown";
}

std::string LoopFault::text() const { return core::text(reasonOf(*this), UnitSystem::kSi); }

core::Reason reasonOf(const LoopFault& fault) {
  if (fault.kind == FaultKind::kLimit) return reasonOf(fault.violation);
  const auto [kind, unit] = kindAndUnit(fault);
  core::Reason reason;
  reason.kind = kind;
  reason.axis = fault.axis;
  reason.detail = toString(fault.interlock);
  reason.unit = unit;
  reason.value = fault.value;
  reason.limit = fault.limit;
  reason.cycle = fault.cycle;
  return reason;
}

}  // namespace flute_grinder
