#pragma once

#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/core/log_curve.h"
#include "flute_grinder/scene/markers.h"

#include <optional>
#include <vector>

namespace flute_grinder {

/// The flutes of all teeth as line strips in the frame `cutter`, so that they turn with A: planned ones grey, the one
/// being ground bright, and one that has been ground coloured, point by point, by the largest error measured there in
/// its last finished pass.
class ToolPath {
 public:
  explicit ToolPath(const GrindProgram& program);

  /// Takes where the axes were in a stroke; what is off the stroke is left out.
  /// @param setpoint that the axes have got; its tooth becomes the active one until the stroke's end.
  /// @param actual where the drive says they are [m], A [rad].
  /// @return whether the looks of a flute have changed.
  bool follow(const Setpoint& setpoint, const Axes& actual);

  /// No tooth is being ground any more; what was measured in an unfinished pass is forgotten.
  void leave();

  /// The largest error measured so far, normal to the helix on the cutter's surface [m].
  double largestMeasured() const { return largest_; }

  /// @return markers of namespace "tool_path", one or more for each tooth, in order; the first deletes what was shown
  ///         before. Once a pass is finished, the scale of the colours too.
  visualization_msgs::MarkerArray markers() const;

 private:
  struct Flute {
    double angle;               ///< of the tooth [rad]
    std::vector<float> errors;  ///< per point of the strip [m]; empty until a pass is finished
  };

  double x(std::size_t i) const;
  void measure(const Setpoint& setpoint, const Axes& actual);
  void finishPass(Flute& flute);
  double scaleEnd() const;
  void appendFlute(visualization_msgs::MarkerArray& array, std::size_t tooth, double scale_end) const;

  ConicalCutter cutter_;
  LogCurve curve_;
  double from_, to_;   ///< of the stroke [m]
  std::size_t steps_;  ///< between the points of a strip
  std::vector<Flute> flutes_;
  std::optional<std::size_t> active_;
  std::vector<float> measured_;  ///< in the pass that is being ground, as in Flute; negative where nothing yet
  double largest_ = 0;           ///< [m]
};

/// Where the wheel's lowest point has gone in the current stroke, by the axes' actual positions, as a line strip in the
/// frame `cutter`: below the planned path by the pass' depth. Thinned out as it grows.
class ExecutedPath {
 public:
  explicit ExecutedPath(const GrindProgram& program);

  /// Takes a position; the first of a stroke begins the path anew, and those off the strokes are left out.
  void follow(const Setpoint& setpoint, const Axes& actual);

  /// Appends a marker of namespace "executed_path" once there are two points.
  void append(visualization_msgs::MarkerArray& array) const;

 private:
  ConicalCutter cutter_;
  std::vector<double> wear_of_move_;  ///< of the wheel's radius, by the program's moves [m]
  std::optional<std::uint32_t> move_;
  std::vector<geometry_msgs::Point> points_;
  geometry_msgs::Point last_;
  std::uint64_t taken_ = 0;
  std::uint64_t every_ = 1;  ///< which positions are kept
};

/// Deviations of one stroke from the theoretical helix as arrows normal to it on the cutter's surface, exaggerated by
/// a factor that stands beside them, coloured by size, with the colour scale. Gathers the setpoints of a stroke and
/// thins them out as they come.
class PathErrorMarkers {
 public:
  explicit PathErrorMarkers(const ConicalCutter& cutter) : cutter_(cutter) {}

  /// Takes a setpoint; those off the strokes are left out, and one of another stroke begins anew.
  void add(const Setpoint& setpoint);

  /// @return markers of namespace "path_error"; the first deletes what was shown before.
  visualization_msgs::MarkerArray markers() const;

 private:
  struct Point {
    double x, a, deviation;  ///< of what is commanded from the theory, normal to the helix [m]
  };
  void thinOut();

  ConicalCutter cutter_;
  std::optional<std::uint32_t> move_;
  std::vector<Point> points_;
  double largest_ = 0;  ///< [m]
  std::uint64_t pairs_ = 0;
  std::uint64_t every_ = 1;  ///< which pairs are kept
};

}  // namespace flute_grinder
