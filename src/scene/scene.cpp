#include "flute_grinder/scene/scene.h"

#include "flute_grinder/core/units.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/scene/board.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flute_grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kBlankLength = 0.066;             ///< from the small end into the collet [m]
constexpr std::uint64_t kUpdatesPerPathError = 5;  ///< it changes slowly

/// The blank before it is ground: the cone over the whole stroke, and a shank of the diameter there. The cone is
/// translucent, so that the executed path below its surface can be seen.
void appendBlank(MarkerArray& array, const GrindProgram& program) {
  const ConicalCutter& cutter = program.cutter();
  const double flute = cutter.geometry().flute_length;
  const double cone = flute + program.job().process.overtravel_shank;
  const double shank = std::max(kBlankLength, cone);
  const auto at = [&](double x) { return OutlinePoint{x, cutter.radius(x)}; };
  const auto add = [&](const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour) {
    Marker& m = appendSolid(array, "blank", "cutter", outline, colour);
    // Unlit, because rviz draws translucent faces in any order, and the lit back would show through.
    m.colors.assign(m.points.size(), colour);
  };
  add({{0, 0}, at(0), at(flute)}, colour(0.20, 0.32, 0.52, 0.65));
  add({at(flute), at(cone)}, colour(0.42, 0.44, 0.48, 0.65));
  appendSolid(array, "blank", "cutter", {{cone, 0}, at(cone), {shank, cutter.radius(cone)}}, colour(0.74, 0.75, 0.77));
}

/// The wheel as it is at the start of the job; its axis is the frame's Z.
void appendWheel(MarkerArray& array, const GrindProcess& process) {
  const double radius = process.wheel_diameter / 2 - process.wheel_wear;
  const double half = process.wheel_width / 2;
  const double hub = 0.84 * radius;
  const auto add = [&](const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour) {
    Marker& m = appendSolid(array, "wheel", "wheel", outline, colour);
    m.pose.orientation.y = -std::sqrt(0.5);
    m.pose.orientation.w = std::sqrt(0.5);
  };
  add({{-half, hub}, {-half, radius}, {half, radius}, {half, hub}}, colour(0.66, 0.45, 0.30));
  add({{-half, 0}, {-half, hub}}, colour(0.74, 0.75, 0.77));
  add({{half, hub}, {half, 0}}, colour(0.74, 0.75, 0.77));
}

MarkerArray sceneMarkers(const GrindProgram& program) {
  MarkerArray array = clearedArray();
  appendBlank(array, program);
  appendWheel(array, program.job().process);
  board::appendBoard(array);
  return array;
}

std::string plannedText(const GrindJob& job) {
  char text[96];
  std::snprintf(text, sizeof text, "planned   teeth %zu   passes %zu   feed %.4g mm/min", job.tooth_angles.size(),
                passDepths(job.process).size(), job.process.feed / units::kMillimetrePerMinute);
  return text;
}

}  // namespace

Scene::Scene(ros::NodeHandle private_nh)
    : scene_(private_nh.advertise<MarkerArray>("scene", 1, true)),
      tool_path_(private_nh.advertise<MarkerArray>("tool_path", 1, true)),
      executed_path_(private_nh.advertise<MarkerArray>("executed_path", 1, true)),
      path_error_(private_nh.advertise<MarkerArray>("path_error", 1, true)) {
  // Remove what an earlier process left in rviz.
  for (const ros::Publisher* publisher : {&scene_, &tool_path_, &executed_path_, &path_error_}) {
    publisher->publish(clearedArray());
  }
}

void Scene::show(const GrindProgram& program, const ToothPass& first, const PathErrorMarkers& planned) {
  const GrindJob& job = program.job();
  const std::string digest = jobDigest(job);
  const bool continued = shown_ && shown_->digest == digest && (first.tooth > 0 || first.pass > 0);
  ToolPath path = continued ? shown_->tool_path : ToolPath(program);
  shown_.emplace(Shown{job, digest, passDepths(job.process).size(), std::move(path), ExecutedPath(program), planned});
  setup_ = {job.cutter.spiral_angle, job.cutter.end_diameter / 2 + job.process.wheel_diameter / 2};
  scene_.publish(sceneMarkers(program));
  tool_path_.publish(shown_->tool_path.markers());
  path_error_.publish(planned.markers());
  publishRun(plannedText(job));
}

void Scene::add(const Setpoint& setpoint, const Axes& actual) {
  if (shown_->tool_path.add(setpoint, actual)) flutes_changed_ = true;
  shown_->executed.add(setpoint, actual);
  shown_->errors.add(setpoint);
  shown_->last = setpoint;
}

void Scene::update(const char* state) {
  if (flutes_changed_) tool_path_.publish(shown_->tool_path.markers());
  flutes_changed_ = false;
  if (++updates_ % kUpdatesPerPathError == 0) path_error_.publish(shown_->errors.markers());
  publishRun(runText(state));
}

void Scene::end(const char* state) {
  shown_->tool_path.deactivate();
  tool_path_.publish(shown_->tool_path.markers());
  flutes_changed_ = false;
  path_error_.publish(shown_->errors.markers());
  publishRun(runText(state));
}

void Scene::publishRun(const std::string& text) {
  MarkerArray array = clearedArray();
  shown_->executed.append(array);
  board::appendLine(array, text);
  executed_path_.publish(array);
}

std::string Scene::runText(const char* state) const {
  const Setpoint& p = shown_->last;
  char text[160];
  // Teeth and passes count from 1 for the operator.
  std::snprintf(text, sizeof text, "%s   tooth %d/%zu   pass %d/%zu   feed %.0f mm/min   largest error %s", state,
                p.tooth + 1, shown_->job.tooth_angles.size(), p.pass + 1, shown_->passes,
                p.feed / units::kMillimetrePerMinute, board::micrometres(shown_->tool_path.largestMeasured()).c_str());
  return text;
}

}  // namespace flute_grinder
