#include "flute_grinder/messages/reasons.h"

#include "flute_grinder/job/axes.h"

namespace flute_grinder {

namespace {

/// Compares a constant of the message with core's.
constexpr bool is(std::uint8_t constant, Unit unit) { return constant == static_cast<std::uint8_t>(unit); }

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
