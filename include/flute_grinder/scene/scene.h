#pragma once

#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/scene/path_markers.h"

#include <ros/ros.h>

#include <optional>
#include <string>

namespace flute_grinder {

/// How the machine is set up for a job: the positions of the URDF's joints that no drive moves.
struct MachineSetup {
  double wheel_swivel = 0;  ///< the job's spiral angle [rad]
  double y_zero = 0.055;    ///< from the cutter's axis to the wheel's centre at Y = 0; here as for 10 and 100 mm [m]
};

/// The job in rviz: blank, wheel, flutes, executed path, path errors and a line of text, on `~scene`, `~tool_path`,
/// `~executed_path` and `~path_error`, each latched and whole in every message. Shows nothing until there is a job.
/// Not thread safe; not for the control thread.
class Scene {
 public:
  /// @param private_nh the node's own namespace.
  explicit Scene(ros::NodeHandle private_nh);

  /// Shows a job ahead of its first setpoint. What was measured on it remains if it is the same job, continued.
  /// @param first first pass to grind.
  /// @param planned errors of its first stroke.
  void show(const GrindProgram& program, const ToothPass& first, const PathErrorMarkers& planned);

  /// Takes a setpoint of the job shown.
  /// @param actual where the axes are [m], A [rad].
  void follow(const Setpoint& setpoint, const Axes& actual);

  /// Publishes what has changed; to be called at 10 Hz while the job runs.
  /// @param state of the machine, for the line of text.
  void update(const char* state);

  /// The job has ended: publishes what it has left.
  void end(const char* state);

  const MachineSetup& setup() const { return setup_; }

 private:
  struct Shown {
    GrindJob job;
    std::string digest;
    std::size_t passes;  ///< of each tooth
    ToolPath tool_path;
    ExecutedPath executed;
    PathErrorMarkers errors;
    Setpoint last{};
  };

  void publishRun(const std::string& text);
  std::string runText(const char* state) const;

  ros::Publisher scene_, tool_path_, executed_path_, path_error_;
  MachineSetup setup_;
  std::optional<Shown> shown_;
  bool flutes_changed_ = false;
  std::uint64_t updates_ = 0;
};

}  // namespace flute_grinder
