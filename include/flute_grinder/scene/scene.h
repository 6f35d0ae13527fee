#pragma once

#include "flute_grinder/Legend.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/scene/first_view.h"
#include "flute_grinder/scene/ground_view.h"
#include "flute_grinder/scene/path_markers.h"

#include <ros/ros.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The job in rviz: ground cutter, wheel, flutes, executed path and path errors, on `~ground_cutter`, `~scene`,
/// `~tool_path`, `~executed_path` and `~path_error`, and what they mean in figures on `~legend`; each latched, every
/// message complete. Until there is a job only wheel and blank of a first view are shown. Not thread safe; not for the
/// control thread.
class Scene {
 public:
  /// @param private_nh the node's own namespace.
  Scene(ros::NodeHandle private_nh, const FirstView& first_view);

  /// Shows a job before its first setpoint, with the errors of its first stroke. If the same job is continued, its
  /// measurements are kept.
  /// @param program not null. @param edges of the teeth that it grinds. @param digest of its job, see jobDigest().
  /// @param first first pass to grind. @param shown as Legend.shown.
  void show(const std::shared_ptr<const GrindProgram>& program, const std::vector<GroundEdge>& edges,
            const std::string& digest, const ToothPass& first, const std::string& shown);

  /// Adds a setpoint of the job shown.
  /// @param actual position of the axes in work coordinates [m], A [rad].
  void add(const Setpoint& setpoint, const Axes& actual);

  /// Publishes what has changed; to be called at 10 Hz while the job runs.
  void update();

  /// Publishes once more to a viewer that has come: rviz drops markers that it gets before it knows their frames. The
  /// first view is published by this alone. To be called often, once the frames are published.
  void greet();

  /// Ends the job: publishes the final picture.
  void end();

  /// Takes back everything that is shown, so that it does not outlive the node in rviz.
  void clear();

  /// Shows the first view again: what is shown is no longer so.
  void discard();

 private:
  struct Shown {
    ValidJob job;
    std::string digest;
    ToolPath tool_path;
    ExecutedPath executed;
    PathErrorMarkers errors;
    flute_grinder::Legend legend;
    Reached reached{};
    Reached ground{};  ///< what was shown last
  };

  void trackGround(const Setpoint& setpoint, const Axes& actual);
  void showGround();
  void publishExecuted();
  void publishPathError();

  void publishAll();
  void publishCleared();

  ros::Publisher scene_, tool_path_, executed_path_, path_error_, legend_;
  const FirstView first_view_;
  std::optional<Shown> shown_;
  std::uint32_t viewers_ = 0;
  ros::SteadyTime greeting_due_;  ///< zero if none is
  GroundView ground_;
  bool flutes_changed_ = false;
  std::uint64_t updates_ = 0;
};

}  // namespace grinder
