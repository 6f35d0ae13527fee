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
/// `~tool_path`, `~executed_path` and `~path_error`, and their legend on `~legend`; each latched, every message
/// complete. Until there is a job, only wheel and blank of a first view are shown. Not thread safe; not for the control
/// thread.
class Scene {
 public:
  Scene(ros::NodeHandle private_nh, const FirstView& first_view);

  /// Shows a job before its first setpoint, with the errors of its first stroke. If the same job is continued, its
  /// measurements are kept.
  /// @param program not null.
  /// @param edges edges of the teeth that it grinds.
  /// @param digest digest of its job, see jobDigest().
  /// @param first first pass to grind.
  /// @param shown see Legend.shown.
  void show(const std::shared_ptr<const GrindProgram>& program, const std::vector<GroundEdge>& edges,
            const std::string& digest, const ToothPass& first, const std::string& shown);

  /// Adds a setpoint of the shown job.
  /// @param actual position of the axes in work coordinates [m], A [rad].
  void add(const Setpoint& setpoint, const Axes& actual);

  /// Publishes changes; to be called at 10 Hz while the job runs.
  void update();

  /// Publishes again for a new viewer: rviz drops markers that arrive before it knows their frames. The first view is
  /// published only here. To be called often, once the frames are published.
  void greet();

  /// Ends the job: publishes the final picture.
  void end();

  /// Removes everything shown, so that it does not outlive the node in rviz.
  void clear();

  /// Returns to the first view, because the job shown is obsolete.
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
    Reached ground{};  ///< progress shown last
  };

  void showGround();
  void publishExecuted();
  void publishPathError();

  void publishAll();
  void publishCleared();

  ros::Publisher scene_, tool_path_, executed_path_, path_error_, legend_;
  const FirstView first_view_;
  std::optional<Shown> shown_;
  std::uint32_t viewers_ = 0;
  ros::SteadyTime greeting_due_;  ///< time of the next greeting; zero if there is none
  GroundView ground_;
  bool flutes_changed_ = false;
  std::uint64_t updates_ = 0;
};

}  // namespace grinder
