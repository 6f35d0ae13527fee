#include "flute_grinder/scene/scene.h"

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/motion/setpoint_stream.h"
#include "flute_grinder/tool/ground_job.h"
#include "scene/scale.h"

#include <algorithm>

namespace grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::uint64_t kUpdatesPerPathError = 5;  ///< updates per path error, which changes slowly
const ros::WallDuration kGreeting(1);              ///< time within which a new viewer learns the frames

/// All strokes of a job have the same errors.
PathErrorMarkers errorsOfFirstStroke(const std::shared_ptr<const GrindProgram>& program,
                                     const std::vector<GroundEdge>& edges) {
  PathErrorMarkers errors(program->job(), edges);
  SetpointStream stream(program);
  bool in_stroke = false;
  for (Setpoint p; stream.next(p) && !(in_stroke && p.move != MoveKind::kStroke);) {
    in_stroke = p.move == MoveKind::kStroke;
    errors.add(p);
  }
  return errors;
}

MarkerArray sceneMarkers(const GrindJob& job, const std::string& shown) {
  MarkerArray array = clearedArray();
  appendWheel(array, wheelOf(job).worn(job.process().wheel_wear));
  appendScale(array, job.cutter, shown);
  return array;
}

}  // namespace

Scene::Scene(ros::NodeHandle private_nh, const FirstView& first_view)
    : scene_(private_nh.advertise<MarkerArray>("scene", 1, true)),
      tool_path_(private_nh.advertise<MarkerArray>("tool_path", 1, true)),
      executed_path_(private_nh.advertise<MarkerArray>("executed_path", 1, true)),
      path_error_(private_nh.advertise<MarkerArray>("path_error", 1, true)),
      legend_(private_nh.advertise<flute_grinder::Legend>("legend", 1, true)),
      first_view_(first_view),
      ground_(private_nh) {
  publishCleared();
}

/// Removes from rviz what this process or an earlier one has shown there.
void Scene::publishCleared() {
  for (const ros::Publisher* publisher : {&scene_, &tool_path_, &executed_path_, &path_error_}) {
    publisher->publish(clearedArray());
  }
  legend_.publish(flute_grinder::Legend());
}

void Scene::show(const std::shared_ptr<const GrindProgram>& program, const std::vector<GroundEdge>& edges,
                 const std::string& digest, const ToothPass& first, const std::string& shown) {
  const GrindJob& job = *program->job();
  const bool continued = shown_ && shown_->digest == digest && (first.tooth > 0 || first.pass > 0);
  ToolPath path = continued ? shown_->tool_path : ToolPath(*program, edges);
  shown_.emplace(Shown{program->job(), digest, std::move(path), ExecutedPath(*program, edges),
                       errorsOfFirstStroke(program, edges), flute_grinder::Legend()});
  shown_->legend.shown = shown;
  shown_->legend.cutter = toMessage(job.cutter, job.tooth_angles);
  shown_->legend.tolerance = job.interpolation.tolerance;
  publishAll();
}

void Scene::greet() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const std::uint32_t viewers = scene_.getNumSubscribers();
  if (viewers > viewers_) greeting_due_ = now + kGreeting;
  viewers_ = viewers;
  if (greeting_due_.isZero() || now < greeting_due_) return;
  greeting_due_ = {};
  publishAll();
}

void Scene::publishAll() {
  if (!shown_) return scene_.publish(firstViewMarkers(first_view_));
  scene_.publish(sceneMarkers(*shown_->job, shown_->legend.shown));
  ground_.show(shown_->job, shown_->reached == Reached{} ? std::nullopt : std::optional(shown_->reached));
  tool_path_.publish(shown_->tool_path.markers());
  publishPathError();
  publishExecuted();
}

void Scene::add(const Setpoint& setpoint, const Axes& actual) {
  if (shown_->tool_path.add(setpoint, actual)) flutes_changed_ = true;
  shown_->executed.add(setpoint, actual);
  shown_->errors.add(setpoint);
  shown_->reached.add(setpoint, actual, shown_->job->process().direction);
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

void Scene::discard() {
  clear();
  publishAll();
}

void Scene::publishExecuted() {
  MarkerArray array = clearedArray();
  shown_->executed.append(array);
  executed_path_.publish(array);
}

/// Publishes the arrows and the numbers of their legend.
void Scene::publishPathError() {
  path_error_.publish(shown_->errors.markers());
  shown_->legend.arrow_scale = shown_->errors.scale();
  shown_->legend.max_error = shown_->tool_path.maxMeasured();
  legend_.publish(shown_->legend);
}

}  // namespace grinder
