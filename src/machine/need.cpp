#include "flute_grinder/machine/need.h"

#include "flute_grinder/base/escaped.h"
#include "flute_grinder/job/sha256.h"

#include <algorithm>

namespace grinder {

namespace {

constexpr char kSeparator = '#';
constexpr std::size_t kDigestDigits = 8;  ///< of a need's digest

std::string digestOf(const Need& need) {
  std::string all = toString(need.kind) + ('\n' + need.text);
  for (const NeedFigure& figure : need.figures) {
    for (const std::string& cell : {figure.what, figure.asked, figure.set, figure.difference}) all += '\n' + cell;
  }
  return sha256Hex(all.data(), all.size()).substr(0, kDigestDigits);
}

std::string nameIn(const std::string& given) { return given.substr(0, given.find(kSeparator)); }

bool isOneOf(const std::string& text, const std::vector<std::string>& texts) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

}  // namespace

std::string answerId(const Need& need, NeedAnswer answer) {
  return std::string(toString(answer)) + kSeparator + digestOf(need);
}

bool isAnswered(const Need& need, NeedAnswer answer, const std::vector<std::string>& given) {
  return isOneOf(toString(answer), given) || isOneOf(answerId(need, answer), given);
}

bool isAnswered(const Need& need, const std::vector<std::string>& given) {
  if (need.kind == NeedKind::kWheel && isAnswered(need, NeedAnswer::kIgnoreOffsets, given)) return true;
  return std::any_of(need.answers.begin(), need.answers.end(),
                     [&](NeedAnswer answer) { return isAnswered(need, answer, given); });
}

std::vector<Need> unanswered(const std::vector<Need>& needs, const std::vector<std::string>& given) {
  std::vector<Need> missing;
  std::copy_if(needs.begin(), needs.end(), std::back_inserter(missing),
               [&](const Need& need) { return !isAnswered(need, given); });
  return missing;
}

bool gives(const std::vector<std::string>& given, NeedAnswer answer) {
  return std::any_of(given.begin(), given.end(),
                     [&](const std::string& one) { return nameIn(one) == toString(answer); });
}

std::string answersRefusal(const std::vector<std::string>& given) {
  for (const std::string& one : given) {
    if (!valueOf<NeedAnswer>(nameIn(one))) {
      return "answer = " + escaped(one) + "; allowed: " + namesOf<NeedAnswer>();
    }
  }
  return "";
}

std::string text(const std::vector<Need>& needs) {
  std::string all;
  for (const Need& need : needs) {
    std::string answers;
    for (const NeedAnswer answer : need.answers)
      answers += (answers.empty() ? "; answer: " : " or ") + std::string(toString(answer));
    all += (all.empty() ? "" : "; ") + need.text + answers;
  }
  return all;
}

}  // namespace grinder
