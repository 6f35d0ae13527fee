#include "flute_grinder/record/job_record.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/record/cycle_figures.h"
#include "flute_grinder/record/record_name.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flute_grinder {

namespace {

using namespace units;

constexpr double kMillisecond = 1e-3;
constexpr std::size_t kMaxEntries = 10000;  ///< of holds and of overrides; a client may make any number
constexpr const char* kNoEnd = "the grinder's program ended before the job did";

/// Appends tooth and pass, which count from 1.
Json placed(Json json, const ToothPass& pass) {
  json["tooth"] = pass.tooth + 1;
  json["pass"] = pass.pass + 1;
  return json;
}

Json toJson(const core::MachineInfo& machine) {
  return {{"name", machine.name},
          {"software", machine.version},
          {"drive", machine.drive},
          {"period_ms", machine.period / kMillisecond},
          {"max_velocity", flute_grinder::toJson(machine.max_velocity, "_s")},
          {"max_acceleration", flute_grinder::toJson(machine.max_acceleration, "_s2")},
          {"max_following_error", flute_grinder::toJson(machine.max_following_error, "")}};
}

Json followingJson(const Axes& error) {
  return {{"x_um", error[kX] / kMicrometre},
          {"y_um", error[kY] / kMicrometre},
          {"z_um", error[kZ] / kMicrometre},
          {"a_mdeg", error[kA] / (kMillisecond * kDegree)}};
}

}  // namespace

JobRecord::JobRecord(const PlannedJob& plan, std::string name)
    : program_(plan.program),
      planned_(plan.statistics),
      digest_(plan.digest),
      first_(plan.first),
      name_(std::move(name)),
      depths_(passDepths(plan.program->job().process)),
      pass_(plan.first) {
  conclusion_.reason = kNoEnd;
}

void JobRecord::addCycle(const CycleRecord& record) {
  if (cycles_++ == 0) started_ = record.time;
  ended_ = record.time;
  if (isLate(record.period, program_->machine().period)) ++late_;
  updateMax(longest_, record.period);
  addToHold(record);
  if (record.feed_override == override_) return;
  override_ = record.feed_override;
  if (hasRoom(overrides_)) overrides_.push_back({since(record), override_, pass_});
}

void JobRecord::addToHold(const CycleRecord& record) {
  const bool held = rowOf(record.state).holds_job;
  if (held && !held_) {
    const bool by_operator = record.interlock == Interlock::kNone;
    hold_listed_ = hasRoom(holds_);
    if (hold_listed_) {
      holds_.push_back({since(record), since(record), by_operator ? "operator" : toString(record.interlock), pass_});
    }
  }
  if ((held || held_) && hold_listed_) holds_.back().to = since(record);
  held_ = held;
}

template <typename Entry>
bool JobRecord::hasRoom(const std::vector<Entry>& list) {
  if (list.size() < kMaxEntries) return true;
  ++omitted_;
  return false;
}

void JobRecord::addSetpoint(const Setpoint& setpoint, const CycleRecord& record) {
  ++setpoints_;
  pass_ = {setpoint.tooth, setpoint.pass};
  if (setpoint.move == MoveKind::kStroke) addToStroke(setpoint, record);
}

void JobRecord::addToStroke(const Setpoint& setpoint, const CycleRecord& record) {
  // A stroke that is resumed after a hold goes on.
  if (strokes_.empty() || strokes_.back().pass != pass_) {
    Stroke& fresh = strokes_.emplace_back();
    fresh.pass = pass_;
    fresh.from = since(record);
  }
  Stroke& stroke = strokes_.back();
  stroke.to = since(record);
  stroke.complete |= setpoint.move_fraction == 1;
  const double x = setpoint.position[kX];
  const FormedEdge& edge = program_->helix(setpoint.tooth).edge;
  updateMax(stroke.deviation, edge.deviation(x, std::abs(setpoint.path_error)));
  for (int axis = 0; axis < kAxisCount; ++axis) {
    updateMax(stroke.following_error[axis], record.followingError(axis));
  }
  if (setpoint.step != StepKind::kEven || !(x >= 0 && x <= edge.cutter.geometry().flute_length)) return;
  stroke.min_feed = stroke.has_feed ? std::min(stroke.min_feed, setpoint.feed) : setpoint.feed;
  stroke.max_feed = std::max(stroke.max_feed, setpoint.feed);
  stroke.has_feed = true;
}

Json JobRecord::jobJson() const {
  const GrindJob& job = program_->job();
  return {{"name", name_}, {"digest", digest_}, {"file", flute_grinder::toJson(job)}};
}

void JobRecord::setZeroPoints(const core::WorkOffsets& offsets, bool said_right) {
  offsets_ = offsets;
  offsets_said_right_ = said_right;
}

Json JobRecord::zeroPointsJson() const {
  Json json = Json::object();
  for (std::size_t i = 0; i < offsets_.axes.size(); ++i) {
    const core::WorkOffset& offset = offsets_.axes[i];
    json[std::string(1, "xyza"[i])] = {{"set_by", offset.wasSet() ? Json(offset.set_by) : Json(nullptr)},
                                       {"set_at", offset.wasSet() ? Json(utcText(offset.set_at)) : Json(nullptr)},
                                       {"set_for", flute_grinder::toJson(offset.basis)}};
  }
  json["said_right"] = offsets_said_right_;
  return json;
}

Json JobRecord::strokesJson() const {
  Json list = Json::array();
  for (const Stroke& stroke : strokes_) {
    const double depth = depthLaw(program_->job(), depths_[static_cast<std::size_t>(stroke.pass.pass)]).at_end;
    const auto feed = [&](double value) {
      return stroke.has_feed ? Json(value / kMillimetrePerMinute) : Json(nullptr);
    };
    Json json = placed(Json::object(), stroke.pass);
    json["depth_mm"] = depth / kMillimetre;
    json["started_s"] = stroke.from;
    json["duration_s"] = stroke.to - stroke.from;
    json["complete"] = stroke.complete;
    json["feed_min_mm_min"] = feed(stroke.min_feed);
    json["feed_max_mm_min"] = feed(stroke.max_feed);
    json["deviation_um"] = stroke.deviation / kMicrometre;
    json["following_error"] = followingJson(stroke.following_error);
    list.push_back(std::move(json));
  }
  return list;
}

Json JobRecord::json(const std::string& grinder, const core::MachineInfo& machine) const {
  Json holds = Json::array(), overrides = Json::array();
  for (const Hold& hold : holds_) {
    holds.push_back(
        placed({{"at_s", hold.from}, {"duration_s", hold.to - hold.from}, {"reason", hold.reason}}, hold.pass));
  }
  for (const Override& change : overrides_) {
    overrides.push_back(placed({{"at_s", change.at}, {"percent", change.fraction * 100}}, change.pass));
  }
  const std::uint64_t written = std::max(conclusion_.setpoints_written, setpoints_ + lost_);
  Json record{{"record", 1},
              {"grinder", grinder},
              {"machine", toJson(machine)},
              {"job", jobJson()},
              {"started", utcText(started_)},
              {"ended", utcText(ended_)},
              {"outcome", conclusion_.outcome},
              {"reason", conclusion_.reason},
              {"first", placed(Json::object(), first_)},
              {"work_offsets", flute_grinder::toJson(program_->machine().work_offset, "")},
              {"zero_points", zeroPointsJson()},
              {"planned",
               {{"setpoints", planned_.setpoints},
                {"duration_s", planned_.duration},
                {"max_deviation_um", planned_.max_deviation / kMicrometre},
                {"feed_limits", flute_grinder::toJson(planned_.feed_limits)}}},
              {"setpoints", {{"written", written}, {"lost", lost_}}},
              {"late_cycles", {{"count", late_}, {"longest_ms", longest_ / kMillisecond}}},
              {"strokes", strokesJson()},
              {"holds", holds},
              {"overrides", overrides}};
  if (omitted_ > 0) record["omitted"] = omitted_;
  return record;
}

}  // namespace flute_grinder
