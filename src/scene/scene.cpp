#include "flute_grinder/scene/scene.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <algorithm>
#include <cmath>

namespace flute_grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kHub = 0.84;                      ///< radius of the wheel's body, of the rim's
constexpr double kStraight = 1e-7;                 ///< a point that is nearer to a line is on it [m]
constexpr int kProfileSteps = 48;                  ///< of the rim's outline
constexpr std::uint64_t kUpdatesPerPathError = 5;  ///< it changes slowly

/// Appends a point to an outline. Where the outline goes straight on, the point before it is not needed: each costs
/// time in every frame.
void append(std::vector<OutlinePoint>& outline, const OutlinePoint& next) {
  if (outline.size() >= 2) {
    const OutlinePoint &a = outline[outline.size() - 2], &b = outline.back();
    const double dx = next.x - a.x, dr = next.radius - a.radius;
    const double off = std::abs((b.x - a.x) * dr - (b.radius - a.radius) * dx);
    if (off <= kStraight * std::hypot(dx, dr)) outline.pop_back();
  }
  outline.push_back(next);
}

/// The wheel as it is at the start of the job; its axis is the frame's Z.
void appendWheel(MarkerArray& array, const GrindJob& job) {
  const WheelProfile wheel = wheelOf(job).worn(job.process.wheel_wear);
  const double hub = kHub * wheel.largestRadius();
  const double lower = wheel.lowerFace(), upper = wheel.upperFace();
  const auto add = [&](const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour) {
    Marker& m = appendSolid(array, "wheel", "wheel", outline, colour);
    m.pose.orientation.y = -std::sqrt(0.5);
    m.pose.orientation.w = std::sqrt(0.5);
  };
  std::vector<OutlinePoint> rim{{lower, hub}};
  for (int i = 0; i <= kProfileSteps; ++i) {
    const double w = lower + (upper - lower) * i / kProfileSteps;
    append(rim, {w, std::max(hub, wheel.radius(w))});
  }
  rim.push_back({upper, hub});
  add(rim, colour(0.66, 0.45, 0.30));
  add({{lower, 0}, {lower, hub}}, colour(0.74, 0.75, 0.77));
  add({{upper, hub}, {upper, 0}}, colour(0.74, 0.75, 0.77));
}

/// All strokes of a job have the same errors.
PathErrorMarkers errorsOfFirstStroke(const std::shared_ptr<const GrindProgram>& program) {
  PathErrorMarkers errors(program->job());
  SetpointStream stream(program);
  bool in_stroke = false;
  for (Setpoint p; stream.next(p) && !(in_stroke && p.move != MoveKind::kStroke);) {
    in_stroke = p.move == MoveKind::kStroke;
    errors.add(p);
  }
  return errors;
}

MarkerArray sceneMarkers(const GrindJob& job) {
  MarkerArray array = clearedArray();
  appendWheel(array, job);
  return array;
}

}  // namespace

Scene::Scene(ros::NodeHandle private_nh)
    : scene_(private_nh.advertise<MarkerArray>("scene", 1, true)),
      tool_path_(private_nh.advertise<MarkerArray>("tool_path", 1, true)),
      executed_path_(private_nh.advertise<MarkerArray>("executed_path", 1, true)),
      path_error_(private_nh.advertise<MarkerArray>("path_error", 1, true)),
      legend_(private_nh.advertise<Legend>("legend", 1, true)),
      ground_(private_nh) {
  publishCleared();
}

/// Removes from rviz what this process or an earlier one has shown there.
void Scene::publishCleared() {
  for (const ros::Publisher* publisher : {&scene_, &tool_path_, &executed_path_, &path_error_}) {
    publisher->publish(clearedArray());
  }
  legend_.publish(Legend());
}

void Scene::show(const std::shared_ptr<const GrindProgram>& program, const std::string& digest,
                 const ToothPass& first) {
  const GrindJob& job = program->job();
  const bool continued = shown_ && shown_->digest == digest && (first.tooth > 0 || first.pass > 0);
  ToolPath path = continued ? shown_->tool_path : ToolPath(*program);
  shown_.emplace(Shown{std::make_shared<GrindJob>(job), digest, std::move(path), ExecutedPath(*program),
                       errorsOfFirstStroke(program), Legend()});
  shown_->legend.cutter = toMessage(job.cutter, job.tooth_angles);
  shown_->legend.tolerance = job.interpolation.tolerance;
  scene_.publish(sceneMarkers(job));
  ground_.show(shown_->job, std::nullopt);
  tool_path_.publish(shown_->tool_path.markers());
  publishPathError();
  publishExecuted();
}

void Scene::add(const Setpoint& setpoint, const Axes& actual) {
  if (shown_->tool_path.add(setpoint, actual)) flutes_changed_ = true;
  shown_->executed.add(setpoint, actual);
  shown_->errors.add(setpoint);
  trackGround(setpoint, actual);
}

void Scene::trackGround(const Setpoint& setpoint, const Axes& actual) {
  const PassPhase phase = phaseOf(setpoint.move);
  if (phase == PassPhase::kNone) return;
  Reached& reached = shown_->reached;
  const ToothPass pass{setpoint.tooth, setpoint.pass};
  if (phase != PassPhase::kStroke) {
    reached = {pass, phase, 0};
    return;
  }
  if (reached.phase != phase) reached = {pass, phase, setpoint.position[kX]};
  // What is ground stays so when the wheel goes back along the stroke; a faulty drive may report NaN.
  const bool from_end = shown_->job->process.direction == StrokeDirection::kFromEnd;
  if (from_end ? actual[kX] > reached.x : actual[kX] < reached.x) reached.x = actual[kX];
}

void Scene::showGround() {
  if (shown_->reached == shown_->ground) return;
  shown_->ground = shown_->reached;
  ground_.show(shown_->job, shown_->reached);
}

void Scene::update() {
  if (flutes_changed_) tool_path_.publish(shown_->tool_path.markers());
  flutes_changed_ = false;
  if (++updates_ % kUpdatesPerPathError == 0) publishPathError();
  publishExecuted();
  showGround();
}

void Scene::end() {
  shown_->tool_path.deactivate();
  tool_path_.publish(shown_->tool_path.markers());
  flutes_changed_ = false;
  publishPathError();
  publishExecuted();
  showGround();
}

void Scene::clear() {
  shown_.reset();
  publishCleared();
  ground_.clear();
}

void Scene::publishExecuted() {
  MarkerArray array = clearedArray();
  shown_->executed.append(array);
  executed_path_.publish(array);
}

/// The arrows, with the figures that go with them.
void Scene::publishPathError() {
  path_error_.publish(shown_->errors.markers());
  shown_->legend.arrow_scale = shown_->errors.scale();
  shown_->legend.largest_error = shown_->tool_path.largestMeasured();
  legend_.publish(shown_->legend);
}

}  // namespace flute_grinder
