#include "record/record_summary.h"

#include "record/json_scanner.h"

#include <functional>
#include <map>
#include <optional>

namespace grinder {

namespace {

/// Takes the worst of a figure so far and another, each of which may be missing.
template <typename Worse>
void takeWorst(std::optional<double>& worst, const std::optional<double>& value, const Worse& worse) {
  if (value && (!worst || worse(*value, *worst))) worst = value;
}

/// Strokes as one that has the worst figure of all: what is farthest from what its job asks for is one of these.
class WorstStroke {
 public:
  void add(JsonScanner& stroke) {
    std::optional<double> min_feed, max_feed;
    stroke.members([&](std::string_view key) {
      if (key == "complete") complete_ += stroke.value() == "true" ? 1 : 0;
      if (key == "deviation_um") takeWorst(deviation_, stroke.number(), std::greater<>());
      if (key == "feed_min_mm_min") min_feed = stroke.number();
      if (key == "feed_max_mm_min") max_feed = stroke.number();
      if (key == "following_error") addFollowingError(stroke);
    });
    ++count_;
    if (!min_feed) return;  // none within the flute
    takeWorst(min_feed_, min_feed, std::less<>());
    takeWorst(max_feed_, max_feed, std::greater<>());
    if (!max_feed) bad_feed_ = true;
  }

  std::size_t complete() const { return complete_; }

  /// As the strokes of a record.
  Json json() const {
    if (count_ == 0) return Json::array();
    Json following = Json::object();
    for (const auto& [axis, error] : following_error_) following[axis] = orNull(error);
    const Json worst{{"tooth", 0},
                     {"pass", 0},
                     {"feed_min_mm_min", orNull(min_feed_)},
                     {"feed_max_mm_min", bad_feed_ ? Json() : orNull(max_feed_)},
                     {"deviation_um", orNull(deviation_)},
                     {"following_error", following}};
    return Json::array({worst});
  }

 private:
  static Json orNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

  void addFollowingError(JsonScanner& stroke) {
    stroke.members([&](std::string_view axis) {
      const auto found = following_error_.find(axis);
      auto& worst = found != following_error_.end() ? found->second : following_error_[std::string(axis)];
      takeWorst(worst, stroke.number(), std::greater<>());
    });
  }

  std::size_t count_ = 0, complete_ = 0;
  std::optional<double> deviation_, min_feed_, max_feed_;
  bool bad_feed_ = false;  ///< a stroke has a lowest feed, but no highest
  std::map<std::string, std::optional<double>, std::less<>> following_error_;
};

Json taken(JsonScanner& scanner) { return Json::parse(scanner.value()); }

/// Takes of an object what is neither an object nor a list itself.
Json takenPlain(JsonScanner& scanner) {
  Json object = Json::object();
  scanner.members([&](std::string_view key) {
    const std::string_view value = scanner.value();
    if (value.front() != '{' && value.front() != '[') object[std::string(key)] = Json::parse(value);
  });
  return object;
}

Json jobOfSummary(JsonScanner& scanner) {
  Json job;
  scanner.members([&](std::string_view key) {
    if (key == "name") job["name"] = taken(scanner);
    if (key != "file") return;
    Json& file = job["file"] = Json::object();
    scanner.members([&](std::string_view part) {
      Json& section = file[std::string(part)];
      // All operations are much text, of which the one that was ground is repeated.
      if (part == "operations") return;
      section = part == "process" ? takenPlain(scanner) : taken(scanner);
    });
  });
  return job;
}

/// Whether a list needs nothing of a part of a record.
bool isLeftOut(std::string_view key) { return key == "zero_points" || key == "work_offsets" || key == "overrides"; }

}  // namespace

Json summaryOf(const std::string& text) {
  JsonScanner scanner(text);
  Json record = Json::object();
  scanner.members([&](std::string_view key) {
    Json part;
    if (key == "job") {
      part = jobOfSummary(scanner);
    } else if (key == "strokes") {
      WorstStroke worst;
      scanner.elements([&] { worst.add(scanner); });
      part = worst.json();
      record["complete_strokes"] = worst.complete();
    } else if (key == "holds") {
      std::size_t count = 0;
      scanner.elements([&] { ++count; });
      part = count;
    } else if (key == "machine") {
      part = takenPlain(scanner);
    } else if (!isLeftOut(key)) {
      part = taken(scanner);
    }
    record[std::string(key)] = std::move(part);
  });
  scanner.end();
  return record;
}

}  // namespace grinder
