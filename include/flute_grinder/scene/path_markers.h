#pragma once

#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/scene/end_line.h"
#include "flute_grinder/scene/markers.h"
#include "flute_grinder/tool/ground_edge.h"

#include <optional>
#include <variant>
#include <vector>

namespace grinder {

/// The straight strokes of a job on the end, by the passes of its teeth.
class EndPasses {
 public:
  explicit EndPasses(const ValidJob& job) : job_(job) {}

  /// Where the rim is in a stroke; nothing unless it is on the stroke's line.
  /// @param actual position read from the drive [m], A [rad].
  std::optional<EndLine::Place> placeOf(const Setpoint& setpoint, const Axes& actual);

 private:
  ValidJob job_;
  std::optional<ToothPass> pass_;
  std::optional<EndLine> line_;  ///< of the pass
};

/// The ground edges of all teeth, or the lines of the deepest strokes on the end (EndLine), as line strips in the frame
/// `cutter`, so that they turn with A: a planned edge is grey, the one being ground bright, and a finished one coloured
/// point by point by the error measured in its last pass, red beyond the job's tolerance.
class ToolPath {
 public:
  /// @param edges edges of the teeth, none of an operation on the end; an empty edge and its measurements are not
  /// shown.
  ToolPath(const GrindProgram& program, const std::vector<GroundEdge>& edges);

  /// Adds a measured position; positions off the stroke are ignored.
  /// @param setpoint setpoint that reached the axes; its tooth is active until the end of the stroke.
  /// @param actual position read from the drive [m], A [rad].
  /// @return whether the appearance of a flute has changed.
  bool add(const Setpoint& setpoint, const Axes& actual);

  /// Ends the active state of a tooth; measurements of an unfinished pass are discarded.
  void deactivate();

  /// The maximum error measured so far, normal to the helix on the cutter's surface, or EndLine::Place::error [m].
  double maxMeasured() const { return max_; }

  /// @return markers of namespace "tool_path", one for each tooth that has an edge, in order; the first deletes the
  /// earlier ones.
  visualization_msgs::MarkerArray markers() const;

 private:
  struct Edge {
    double angle;    ///< angle that the strokes add to the curve [rad]
    LogCurve curve;  ///< A over X
    GroundEdge edge;
  };
  struct Flute {
    std::variant<Edge, EndLine> line;
    std::vector<float> errors;  ///< error per point of the strip [m]; empty until a pass is finished
  };
  struct Measured {
    std::optional<double> part;  ///< of the strip, from 0 to 1; nothing beyond it
    double error;                ///< [m]
  };

  static bool isShown(const Flute& flute);
  geometry_msgs::Point pointOf(const Flute& flute, std::size_t i) const;
  std::optional<Measured> measured(const Setpoint& setpoint, const Axes& actual);
  void measure(const Setpoint& setpoint, const Axes& actual);
  void finishPass(Flute& flute);
  void appendFlute(visualization_msgs::MarkerArray& array, std::size_t tooth) const;

  FormedEdge formed_;
  std::optional<EndPasses> straight_;  ///< of an operation on the end
  double tolerance_;                   ///< error at the end of the colour scale [m]
  double fineness_;                    ///< scale of line widths
  std::size_t steps_;                  ///< number of steps between the points of a strip
  std::vector<Flute> flutes_;
  std::optional<std::size_t> active_;
  std::vector<float> measured_;  ///< errors measured in the current pass, as in Flute; negative where not yet measured
  double max_ = 0;               ///< [m]
};

/// The measured path of the wheel along the edge in the current stroke, as a line strip in the frame `cutter`, below
/// the edge by the depth of the pass; on the end, where the rim was along the stroke's line. Thinned out as it grows.
class ExecutedPath {
 public:
  /// @param edges edges of the teeth.
  ExecutedPath(const GrindProgram& program, std::vector<GroundEdge> edges);

  /// Adds a measured position; the first of a stroke starts a new path, and positions off the stroke are ignored.
  void add(const Setpoint& setpoint, const Axes& actual);

  /// Appends a marker of namespace "executed_path" once there are two points.
  void append(visualization_msgs::MarkerArray& array) const;

 private:
  std::optional<geometry_msgs::Point> placeOf(const Setpoint& setpoint, const Axes& actual);

  ConicalCutter cutter_;
  double fineness_;                    ///< scale of line widths
  std::optional<EndPasses> straight_;  ///< of an operation on the end
  std::vector<GroundEdge> edges_;
  std::vector<double> wear_of_move_;  ///< wear of the wheel's radius, by the program's moves [m]
  std::optional<std::uint32_t> move_;
  std::vector<geometry_msgs::Point> points_;
  geometry_msgs::Point last_;
  std::uint64_t taken_ = 0;
  std::uint64_t every_ = 1;  ///< only every n-th position is kept
};

/// Deviations of one stroke from the theoretical helix as arrows normal to it on the cutter's surface, scaled up and
/// coloured by size, red beyond the job's tolerance. Thinned out as setpoints are added. Straight strokes have none.
class PathErrorMarkers {
 public:
  /// @param edges edges of the teeth.
  PathErrorMarkers(const ValidJob& job, std::vector<GroundEdge> edges);

  /// Adds a setpoint; the first of another stroke restarts the markers, and setpoints off the stroke are ignored.
  void add(const Setpoint& setpoint);

  /// The ratio of the arrows' length to the deviations; 0 if there are none.
  double scale() const;

  /// @return markers of namespace "path_error"; the first deletes the earlier ones.
  visualization_msgs::MarkerArray markers() const;

 private:
  struct Point {
    double x;          ///< X of the edge [m]
    double a;          ///< angle of the edge [rad]
    double deviation;  ///< commanded - theory, normal to the helix [m]
  };
  void thinOut();

  FormedEdge formed_;
  std::vector<GroundEdge> edges_;
  double tolerance_;  ///< [m]
  std::optional<std::uint32_t> move_;
  std::vector<Point> points_;
  double max_ = 0;  ///< [m]
  std::uint64_t pairs_ = 0;
  std::uint64_t every_ = 1;  ///< only every n-th pair is kept
};

}  // namespace grinder
