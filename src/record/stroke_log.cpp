#include "flute_grinder/record/stroke_log.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/record/cycle_figures.h"

#include <cmath>

namespace grinder {

namespace {

using namespace units;

constexpr double kMillidegree = 1e-3 * kDegree;

Json followingJson(const Axes& error) {
  return {{"x_um", error[kX] / kMicrometre},
          {"y_um", error[kY] / kMicrometre},
          {"z_um", error[kZ] / kMicrometre},
          {"a_mdeg", error[kA] / kMillidegree}};
}

}  // namespace

StrokeLog::StrokeLog(const ValidJob& job) {
  for (int tooth = 0; tooth < job.teeth() && !job.isStraight(); ++tooth) {
    edges_.push_back({ConicalCutter(job.strokeLaw(tooth).cutter), job.strokeLaw(tooth).x_shift});
    starts_.push_back(job.relief(tooth) == nullptr ? 0 : job.strokeLaw(tooth).x_shift);
  }
  for (const double depth : job.depths()) depths_.push_back(job.depthAtEnd(depth));
}

void StrokeLog::add(const Setpoint& setpoint, double time) {
  const ToothPass place{setpoint.tooth, setpoint.pass};
  if (strokes_.empty() || strokes_.back().place != place) {
    StrokeFigures& fresh = strokes_.emplace_back();
    fresh.place = place;
    fresh.from = time;
  }
  StrokeFigures& stroke = strokes_.back();
  stroke.to = time;
  stroke.complete |= setpoint.move_fraction == 1;
  const double x = setpoint.position[kX];
  bool in_flute = true;
  if (setpoint.tooth < edges_.size()) {
    const FormedEdge& edge = edges_[setpoint.tooth];
    const double along = x - starts_[setpoint.tooth];
    in_flute = along >= 0 && along <= edge.cutter.cone().flute_length;
    const double deviation = edge.deviation(x, std::abs(setpoint.path_error));
    if (!(deviation <= stroke.deviation)) stroke.deviation_x = x;
    updateMax(stroke.deviation, deviation);
  }
  const bool straight = setpoint.step == StepKind::kNone;
  if (straight ? !setpoint.at_feed : !in_flute || setpoint.step != StepKind::kEven) return;
  if (!stroke.has_feed || setpoint.feed < stroke.min_feed) {
    stroke.min_feed = setpoint.feed;
    stroke.min_feed_x = x;
  }
  updateMax(stroke.max_feed, setpoint.feed);
  stroke.has_feed = true;
}

void StrokeLog::addFollowingError(const Axes& error) {
  for (int axis = 0; axis < kAxisCount; ++axis) updateMax(strokes_.back().following_error[axis], error[axis]);
}

Json StrokeLog::json() const {
  Json list = Json::array();
  for (const StrokeFigures& stroke : strokes_) {
    const auto if_any = [](bool any, double value) { return any ? Json(value) : Json(nullptr); };
    const auto pass = static_cast<std::size_t>(stroke.place.pass);
    const bool has_edge = static_cast<std::size_t>(stroke.place.tooth) < edges_.size();
    Json json{{"tooth", stroke.place.tooth + 1},
              {"pass", stroke.place.pass + 1},
              {"depth_mm", pass < depths_.size() ? Json(depths_[pass] / kMillimetre) : Json(nullptr)},
              {"started_s", stroke.from},
              {"duration_s", stroke.to - stroke.from},
              {"feed_min_mm_min", if_any(stroke.has_feed, stroke.min_feed / kMillimetrePerMinute)},
              {"feed_min_x_mm", if_any(stroke.has_feed, stroke.min_feed_x / kMillimetre)},
              {"feed_max_mm_min", if_any(stroke.has_feed, stroke.max_feed / kMillimetrePerMinute)},
              {"deviation_um", if_any(has_edge, stroke.deviation / kMicrometre)},
              {"deviation_x_mm", if_any(has_edge, stroke.deviation_x / kMillimetre)}};
    json["following_error"] = followingJson(stroke.following_error);
    json["complete"] = stroke.complete;
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace grinder
