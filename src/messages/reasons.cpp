#include "flute_grinder/messages/reasons.h"

#include "flute_grinder/job/axes.h"

namespace flute_grinder {

namespace {

/// Compares a constant of the message with core's.
constexpr bool is(std::uint8_t constant, core::ReasonKind kind) { return constant == static_cast<std::uint8_t>(kind); }
constexpr bool is(std::uint8_t constant, Unit unit) { return constant == static_cast<std::uint8_t>(unit); }

using K = core::ReasonKind;
static_assert(is(Reason::NONE, K::kNone) && is(Reason::OUT_OF_RANGE, K::kOutOfRange));
static_assert(is(Reason::NOT_BELOW, K::kNotBelow) && is(Reason::ABOVE, K::kAbove));
static_assert(is(Reason::NOT_ALLOWED, K::kNotAllowed) && is(Reason::FEED_TOO_LOW, K::kFeedTooLow));
static_assert(is(Reason::PARK_IN_WORK, K::kParkInWork) && is(Reason::TOLERANCE, K::kTolerance));
static_assert(is(Reason::TOO_LONG, K::kTooLong) && is(Reason::GIVEN_UP, K::kGivenUp) && is(Reason::OTHER, K::kOther));
static_assert(is(Reason::POSITION, K::kPosition) && is(Reason::VELOCITY, K::kVelocity));
static_assert(is(Reason::ACCELERATION, K::kAcceleration) && is(Reason::JERK, K::kJerk));
static_assert(is(Reason::NOT_FINITE, K::kNotFinite) && is(Reason::EMERGENCY_STOP, K::kEmergencyStop));
static_assert(is(Reason::DRIVE_FAULT, K::kDriveFault) && is(Reason::POWER_LOST, K::kPowerLost));
static_assert(is(Reason::STALE_FEEDBACK, K::kStaleFeedback) && is(Reason::INVALID_FEEDBACK, K::kInvalidFeedback));
static_assert(is(Reason::FOLLOWING_ERROR, K::kFollowingError) && is(Reason::UNDERRUN, K::kUnderrun));
static_assert(is(Reason::LATE, K::kLate) && is(Reason::HOMING, K::kHoming) && is(Reason::INTERLOCK, K::kInterlock));
static_assert(is(Reason::CANCELED, K::kCanceled) && is(Reason::RAKE, K::kRake) && is(Reason::LAND, K::kLand));
static_assert(is(Reason::CORE, K::kCore) && is(Reason::INCOMPLETE, K::kIncomplete));
static_assert(is(Reason::COLLISION, K::kCollision) && is(Reason::SWIVEL, K::kSwivel));
static_assert(is(Reason::UNEVEN_RAKE, K::kUnevenRake));
static_assert(Reason::UNEVEN_RAKE + 1 == core::kReasonKindCount);

static_assert(is(Reason::UNIT_NONE, Unit::kNone) && is(Reason::METRE, Unit::kMetre));
static_assert(is(Reason::METRE_PER_SECOND, Unit::kMetrePerSecond));
static_assert(is(Reason::METRE_PER_SECOND2, Unit::kMetrePerSecond2));
static_assert(is(Reason::METRE_PER_SECOND3, Unit::kMetrePerSecond3) && is(Reason::RADIAN, Unit::kRadian));
static_assert(is(Reason::RADIAN_PER_SECOND, Unit::kRadianPerSecond));
static_assert(is(Reason::RADIAN_PER_SECOND2, Unit::kRadianPerSecond2));
static_assert(is(Reason::RADIAN_PER_SECOND3, Unit::kRadianPerSecond3) && is(Reason::SECOND, Unit::kSecond));
static_assert(is(Reason::FEED_METRE_PER_SECOND, Unit::kFeedMetrePerSecond));
static_assert(is(Reason::DEVIATION_METRE, Unit::kDeviationMetre));
static_assert(is(Reason::ROTARY_METRE_PER_RADIAN, Unit::kRotaryMetrePerRadian));
static_assert(Reason::ROTARY_METRE_PER_RADIAN + 1 == kUnitCount);

/// Copies the members that have the same name and type in both.
template <typename From, typename To>
To converted(const From& from) {
  To to;
  to.kind = static_cast<decltype(to.kind)>(from.kind);
  to.axis = static_cast<decltype(to.axis)>(from.axis);
  to.field = from.field;
  to.detail = from.detail;
  to.unit = static_cast<decltype(to.unit)>(from.unit);
  to.value = from.value;
  to.low = from.low;
  to.limit = from.limit;
  to.has_place = from.has_place;
  to.move = static_cast<decltype(to.move)>(from.move);
  to.tooth = static_cast<decltype(to.tooth)>(from.tooth);
  to.pass = static_cast<decltype(to.pass)>(from.pass);
  to.x = from.x;
  to.cycle = from.cycle;
  to.count = from.count;
  return to;
}

}  // namespace

Reason toMessage(const core::Reason& reason) { return converted<core::Reason, Reason>(reason); }

std::vector<Reason> toMessage(const std::vector<core::Reason>& reasons) {
  std::vector<Reason> messages;
  messages.reserve(reasons.size());
  for (const core::Reason& reason : reasons) messages.push_back(toMessage(reason));
  return messages;
}

core::Reason fromMessage(const Reason& m) {
  const bool known =
      m.kind < core::kReasonKindCount && m.axis < kAxisCount && m.unit < kUnitCount && m.move < kMoveKindCount;
  return known ? converted<Reason, core::Reason>(m) : core::Reason();
}

std::string faultText(const GrinderState& state) {
  const std::string from_data = text(fromMessage(state.fault_reason), UnitSystem::kShop);
  return from_data.empty() ? state.fault : from_data;
}

std::string resultText(const GrindResult& result) {
  std::vector<core::Reason> reasons;
  for (const Reason& reason : result.reasons) reasons.push_back(fromMessage(reason));
  return reasons.empty() ? result.error_string : text(reasons, UnitSystem::kShop);
}

std::vector<std::string> planTexts(const Plan::Response& plan) {
  if (plan.violations.empty()) return plan.reasons;
  std::vector<std::string> texts;
  for (const Reason& reason : plan.violations) texts.push_back(text(fromMessage(reason), UnitSystem::kShop));
  return texts;
}

}  // namespace flute_grinder
