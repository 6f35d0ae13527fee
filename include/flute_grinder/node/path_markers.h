#pragma once

#include "flute_grinder/core/grind_program.h"

#include <visualization_msgs/MarkerArray.h>

namespace flute_grinder {

/// The largest number of points in one marker: rviz crashes on a line strip of more than 16,384.
constexpr std::size_t kMaxMarkerPoints = 16000;

/// The paths of all teeth as line strips in the frame `cutter`, so that they turn with A.
/// @param program the job.
/// @return markers of namespace "tool_path"; the first deletes what was shown before.
visualization_msgs::MarkerArray toolPathMarkers(const GrindProgram& program);

/// Deviations of one stroke from the theoretical helix as lines normal to it on the cutter's surface, exaggerated by
/// a factor that stands beside them, coloured by size, with the colour scale. Gathers the setpoints of a stroke and
/// thins them out as they come.
class PathErrorMarkers {
 public:
  explicit PathErrorMarkers(const ConicalCutter& cutter) : cutter_(cutter) {}

  /// Takes a setpoint; those off the stroke are left out.
  void add(const Setpoint& setpoint);

  /// @return markers of namespace "path_error"; the first deletes what was shown before.
  visualization_msgs::MarkerArray markers() const;

 private:
  struct Point {
    double x, a, error;
  };
  void thinOut();

  ConicalCutter cutter_;
  std::vector<Point> points_;
  std::uint64_t pairs_ = 0;
  std::uint64_t every_ = 1;  ///< which pairs are kept
};

}  // namespace flute_grinder
