#include "flute_grinder/messages/needs.h"

namespace grinder {

namespace {

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

std::vector<flute_grinder::Need> toMessage(const std::vector<Need>& needs) {
  std::vector<flute_grinder::Need> messages;
  for (const Need& need : needs) messages.push_back(toMessage(need));
  return messages;
}

}  // namespace grinder
