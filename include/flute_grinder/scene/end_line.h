#pragma once

#include "flute_grinder/job/valid_job.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace grinder {

/// The line on an end tooth along which the rim of the wheel grinds in a straight stroke: the bottom of a gash, as long
/// as the deepest is within the tool's diameter, or the edge before a flank, as far as the rim comes along it. The rim
/// is taken as sharp. Lengths in the frame `work`, while the cutter is at the stroke's A.
class EndLine {
 public:
  /// Where the rim is.
  struct Place {
    double part = 0;     ///< of the line, from 0 at its beginning to 1; outside it less or more
    Eigen::Vector3d at;  ///< point of the rim: of a gash the lowest, of a flank the one over the edge [m]
    double error = 0;    ///< distance of the point from the bottom's line, or from the flank, on the cutter [m]
  };

  /// @param job job of an operation on the end, from withLaws().
  /// @param depth,wear of the pass, see ValidJob::faceStroke() [m].
  EndLine(const ValidJob& job, int tooth, double depth, double wear);

  double a() const noexcept { return a_; }  ///< A of the stroke [rad]
  /// A point of the line. @param part as in Place.
  Eigen::Vector3d at(double part) const noexcept { return from_ + part * (to_ - from_); }
  /// Away from what is ground, at right angles to the line.
  const Eigen::Vector3d& outward() const noexcept { return outward_; }

  /// Where the rim is at a position of the axes, which may be any number. Nothing if it is nowhere over the line, as
  /// that of a cup that is fed along X.
  /// @param position in work coordinates [m], A [rad].
  std::optional<Place> placeOf(const Axes& position) const;

 private:
  void takeBottom(const ValidJob& job, double depth, const FaceStroke& stroke);
  void takeEdge(const ValidJob& job, int tooth, const FaceStroke& stroke);
  Eigen::Vector3d inWork(const Axes& position) const;

  double a_;
  double rim_;  ///< radius of the wheel; 0 of a cup [m]
  bool is_gash_;
  Eigen::Vector3d spindle_;  ///< direction of the wheel's axis
  Eigen::Vector3d zero_;     ///< while X, Y and Z are 0: of a gash the rim's lowest point, else the face's centre [m]
  Eigen::Vector3d from_, to_, outward_;
};

/// The lines of the deepest strokes of all teeth; none unless the job is of an operation on the end.
std::vector<EndLine> deepestLines(const ValidJob& job);

}  // namespace grinder
