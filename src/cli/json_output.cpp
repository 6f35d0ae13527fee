#include "cli/json_output.h"

#include "cli/waiting.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/offset_basis.h"

#include <cstdio>

namespace grinder {

namespace {

using namespace units;

Json moveDurations(const PathStatistics& statistics) {
  Json json = Json::object();
  for (const MoveRow& move : kMoveKinds) {
    json[std::string(move.name) + "_s"] = statistics.move_duration[static_cast<std::size_t>(move.value)];
  }
  return json;
}

Json lastJobObject(const flute_grinder::JobProgress& progress) {
  if (progress.job_digest.empty()) return nullptr;
  const flute_grinder::Cutter& cutter = progress.cutter;
  return {{"name", progress.job_name},
          {"operation", progress.operation},
          {"cutter",
           {{"end_diameter_mm", cutter.end_diameter / kMillimetre},
            {"cone_angle_deg", cutter.cone_angle / kDegree},
            {"spiral_angle_deg", cutter.spiral_angle / kDegree},
            {"rake_angle_deg", cutter.rake_angle / kDegree},
            {"flute_length_mm", cutter.flute_length / kMillimetre},
            {"teeth", cutter.tooth_angles.size()}}},
          {"digest", progress.job_digest},
          {"finished", progress.finished != 0},
          {"tooth", progress.tooth + 1},
          {"pass", progress.pass + 1},
          {"x_mm", progress.x / kMillimetre},
          {"end", progress.end}};
}

/// The basis of each work offset; null if it was never set.
Json zeroPoints(const flute_grinder::WorkOffsets& offsets) {
  Json json = Json::object();
  for (std::size_t i = 0; i < offsets.basis.size(); ++i) {
    const bool set = !offsets.set_at[i].isZero();
    json[std::string(1, "xyza"[i])] = set ? grinder::toJson(fromMessage(offsets.basis[i])) : Json(nullptr);
  }
  return json;
}

Json toJson(const ClosestPlace& place) {
  return {{"bodies", {place.first, place.second}},
          {"distance_mm", place.distance / kMillimetre},
          {"x_mm", place.axes[kX] / kMillimetre}};
}

}  // namespace

Json toJson(const CutterFigures& figures) {
  Json all = Json::object();
  for (const GroundFigure& figure : figures) {
    const ToolFigureRow& row = rowOf(figure.figure);
    const double scale = shopScale(row.unit);
    const std::string unit = std::string("_") + shopUnit(row.unit);
    Json& json = all[row.name];
    json = {{"ground" + unit, {figure.least.value / scale, figure.largest.value / scale}},
            {"x_mm", {figure.least.x / kMillimetre, figure.largest.x / kMillimetre}},
            {"tooth", {figure.least.tooth, figure.largest.tooth}}};
    if (!figure.asked) continue;
    json["asked" + unit] = {figure.asked->from / scale, figure.asked->to / scale};
    json["tolerance" + unit] = figure.tolerance / scale;
  }
  return all;
}

Json toJson(const PlannedJob& plan) {
  const PathStatistics& s = plan.statistics;
  Json reasons = Json::array();
  for (const Reason& reason : plan.reasons) reasons.push_back(text(reason));
  return {{"valid", plan.good()},
          {"reasons", reasons},
          {"complete_from_mm", plan.complete ? Json(plan.complete->from / kMillimetre) : Json(nullptr)},
          {"complete_to_mm", plan.complete ? Json(plan.complete->to / kMillimetre) : Json(nullptr)},
          {"figures", toJson(plan.figures)},
          {"closest", plan.closest ? toJson(*plan.closest) : Json(nullptr)},
          {"passes", plan.passes ? toJson(*plan.passes) : Json::array()},
          {"setpoints", s.setpoints},
          {"duration_s", s.duration},
          {"move_durations", moveDurations(s)},
          {"max_odd_error_rad", s.max_odd_error},
          {"max_even_error_rad", s.max_even_error},
          {"max_deviation_um", s.max_deviation / kMicrometre},
          {"min_feed_mm_min", s.min_feed / kMillimetrePerMinute},
          {"max_feed_mm_min", s.max_feed / kMillimetrePerMinute},
          {"feed_limits", toJson(s.feed_limits)},
          {"max_velocity", toJson(s.max_velocity, "_s")},
          {"max_acceleration", toJson(s.max_acceleration, "_s2")},
          {"max_jerk", toJson(s.max_jerk, "_s3")},
          {"odd_even_ripple", toJson(s.ripple_acceleration, "_s2")}};
}

Json toJson(const std::string& node, const flute_grinder::GrinderState& state,
            const flute_grinder::WorkOffsets::ConstPtr& offsets) {
  const bool job = inJob(state);
  return {{"grinder", node},
          {"state", state.state_name},
          {"enabled", state.enabled != 0},
          {"power_stays_on", state.power_stays_on != 0},
          {"homed", state.homed != 0},
          {"spindle_at_speed", state.spindle_at_speed != 0},
          {"coolant_on", state.coolant_on != 0},
          {"spindle_commanded", state.spindle_commanded != 0},
          {"coolant_commanded", state.coolant_commanded != 0},
          {"emergency_stop", state.emergency_stop != 0},
          {"wheel_in_work", state.wheel_in_work != 0},
          {"wheel_backs_off", state.wheel_backs_off != 0},
          {"swivel_deg", state.swivel / kDegree},
          {"swivel_measured", state.swivel_measured != 0},
          {"machine", toJson(Axes(state.position.data()), "")},
          {"work", toJson(Axes(state.work_position.data()), "")},
          {"zero_points", offsets ? zeroPoints(*offsets) : Json(nullptr)},
          {"to_go", toJson(Axes(state.distance_to_go.data()), "")},
          {"feed_mm_min", state.feed / kMillimetrePerMinute},
          {"override_percent", state.override * 100},
          {"tooth", job ? Json(state.tooth + 1) : Json(nullptr)},
          {"pass", job ? Json(state.pass + 1) : Json(nullptr)},
          {"hold_reason", state.hold_reason},
          {"fault", state.fault},
          {"journal_error", state.journal_error},
          {"last_job", lastJobObject(state.progress)}};
}

void print(const Json& json) { std::printf("%s\n", text(json).c_str()); }

}  // namespace grinder
