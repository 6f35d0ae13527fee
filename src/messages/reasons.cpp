#include "flute_grinder/messages/reasons.h"

#include "flute_grinder/job/axes.h"

namespace grinder {

namespace {

/// Compares a constant of the message with core's.
constexpr bool is(std::uint8_t constant, Unit unit) { return constant == static_cast<std::uint8_t>(unit); }

static_assert(is(flute_grinder::Reason::UNIT_NONE, Unit::kNone) && is(flute_grinder::Reason::METRE, Unit::kMetre));
static_assert(is(flute_grinder::Reason::METRE_PER_SECOND, Unit::kMetrePerSecond));
static_assert(is(flute_grinder::Reason::METRE_PER_SECOND2, Unit::kMetrePerSecond2));
static_assert(is(flute_grinder::Reason::METRE_PER_SECOND3, Unit::kMetrePerSecond3) &&
              is(flute_grinder::Reason::RADIAN, Unit::kRadian));
static_assert(is(flute_grinder::Reason::RADIAN_PER_SECOND, Unit::kRadianPerSecond));
static_assert(is(flute_grinder::Reason::RADIAN_PER_SECOND2, Unit::kRadianPerSecond2));
static_assert(is(flute_grinder::Reason::RADIAN_PER_SECOND3, Unit::kRadianPerSecond3) &&
              is(flute_grinder::Reason::SECOND, Unit::kSecond));
static_assert(is(flute_grinder::Reason::FEED_METRE_PER_SECOND, Unit::kFeedMetrePerSecond));
static_assert(is(flute_grinder::Reason::DEVIATION_METRE, Unit::kDeviationMetre));
static_assert(is(flute_grinder::Reason::ROTARY_METRE_PER_RADIAN, Unit::kRotaryMetrePerRadian));
static_assert(flute_grinder::Reason::ROTARY_METRE_PER_RADIAN + 1 == kUnitCount);

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

flute_grinder::Reason toMessage(const Reason& reason) { return converted<Reason, flute_grinder::Reason>(reason); }

std::vector<flute_grinder::Reason> toMessage(const std::vector<Reason>& reasons) {
  std::vector<flute_grinder::Reason> messages;
  messages.reserve(reasons.size());
  for (const Reason& reason : reasons) messages.push_back(toMessage(reason));
  return messages;
}

Reason fromMessage(const flute_grinder::Reason& m) {
  const bool known = m.kind < kReasonKindCount && m.axis < kAxisCount && m.unit < kUnitCount && m.move < kMoveKindCount;
  return known ? converted<flute_grinder::Reason, Reason>(m) : Reason();
}

std::string faultText(const flute_grinder::GrinderState& state) {
  const std::string from_data = text(fromMessage(state.fault_reason), UnitSystem::kShop);
  return from_data.empty() ? state.fault : from_data;
}

std::string resultText(const flute_grinder::GrindResult& result) {
  std::vector<Reason> reasons;
  for (const flute_grinder::Reason& reason : result.reasons) reasons.push_back(fromMessage(reason));
  return reasons.empty() ? result.error_string : text(reasons, UnitSystem::kShop);
}

std::vector<std::string> planTexts(const flute_grinder::Plan::Response& plan) {
  if (plan.violations.empty()) return plan.reasons;
  std::vector<std::string> texts;
  for (const flute_grinder::Reason& reason : plan.violations)
    texts.push_back(text(fromMessage(reason), UnitSystem::kShop));
  return texts;
}

}  // namespace grinder
