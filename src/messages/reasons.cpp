#include "flute_grinder/messages/reasons.h"

#include "flute_grinder/base/axes.h"

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
static_assert(is(flute_grinder::Reason::CUBIC_METRE_PER_SECOND, Unit::kCubicMetrePerSecond));
static_assert(flute_grinder::Reason::CUBIC_METRE_PER_SECOND + 1 == kUnitCount);
static_assert(+flute_grinder::Reason::X == kX && +flute_grinder::Reason::Y == kY && +flute_grinder::Reason::Z == kZ &&
              +flute_grinder::Reason::A == kA);

flute_grinder::Need toMessage(const Need& need) {
  flute_grinder::Need message;
  message.name = toString(need.kind);
  message.text = need.text;
  message.question = rowOf(need.kind).question;
  for (const NeedFigure& figure : need.figures) {
    flute_grinder::NeedFigure& row = message.figures.emplace_back();
    row.what = figure.what;
    row.asked = figure.asked;
    row.set = figure.set;
    row.difference = figure.difference;
  }
  for (const NeedAnswer answer : need.answers) {
    const NeedAnswerRow& row = rowOf(answer);
    flute_grinder::NeedAnswer& offered = message.answers.emplace_back();
    offered.id = answerId(need, answer);
    offered.text = row.text;
    offered.help = row.help;
    offered.danger = static_cast<std::uint8_t>(row.is_danger);
    offered.changes_plan = static_cast<std::uint8_t>(row.changes_plan);
  }
  return message;
}

}  // namespace

flute_grinder::Reason toMessage(const Reason& reason) {
  flute_grinder::Reason m;
  m.text = text(reason);
  m.kind = static_cast<std::uint8_t>(reason.kind);
  m.axis = static_cast<std::uint8_t>(reason.axis);
  m.field = reason.field;
  m.detail = reason.detail;
  m.unit = static_cast<std::uint8_t>(reason.unit);
  m.value = reason.value;
  m.low = reason.low;
  m.limit = reason.limit;
  m.has_place = static_cast<std::uint8_t>(reason.has_place);
  m.move = static_cast<std::uint8_t>(reason.move);
  m.tooth = static_cast<std::uint16_t>(reason.tooth);
  m.pass = static_cast<std::uint16_t>(reason.pass);
  m.x = reason.x;
  m.cycle = reason.cycle;
  m.count = reason.count;
  return m;
}

std::vector<flute_grinder::Reason> toMessage(const std::vector<Reason>& reasons) {
  std::vector<flute_grinder::Reason> messages;
  messages.reserve(reasons.size());
  for (const Reason& reason : reasons) messages.push_back(toMessage(reason));
  return messages;
}

std::vector<flute_grinder::Need> toMessage(const std::vector<Need>& needs) {
  std::vector<flute_grinder::Need> messages;
  for (const Need& need : needs) messages.push_back(toMessage(need));
  return messages;
}

}  // namespace grinder
