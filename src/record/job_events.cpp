#include "flute_grinder/record/job_events.h"

namespace grinder {

namespace {

constexpr std::size_t kMaxEntries = 10000;  ///< most entries of each kind, because a client may cause any number

/// Appends tooth and pass, which count from 1.
Json placed(Json json, const ToothPass& pass) {
  json["tooth"] = pass.tooth + 1;
  json["pass"] = pass.pass + 1;
  return json;
}

}  // namespace

void JobEvents::add(double time, bool held, std::string_view reason, double feed_override, const ToothPass& pass) {
  if (held && !held_) {
    hold_listed_ = hasRoom(holds_);
    if (hold_listed_) holds_.push_back({time, time, std::string(reason.empty() ? "operator" : reason), pass});
  }
  if ((held || held_) && hold_listed_) holds_.back().to = time;
  held_ = held;
  if (feed_override == override_) return;
  override_ = feed_override;
  if (hasRoom(overrides_)) overrides_.push_back({time, override_, pass});
}

template <typename Entry>
bool JobEvents::hasRoom(const std::vector<Entry>& list) {
  if (list.size() < kMaxEntries) return true;
  ++omitted_;
  return false;
}

Json JobEvents::holds() const {
  Json list = Json::array();
  for (const Hold& hold : holds_) {
    list.push_back(
        placed({{"at_s", hold.from}, {"duration_s", hold.to - hold.from}, {"reason", hold.reason}}, hold.pass));
  }
  return list;
}

Json JobEvents::overrides() const {
  Json list = Json::array();
  for (const Override& change : overrides_) {
    list.push_back(placed({{"at_s", change.at}, {"percent", change.fraction * 100}}, change.pass));
  }
  return list;
}

}  // namespace grinder
