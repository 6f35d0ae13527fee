#pragma once

#include "flute_grinder/collision/machine_shapes.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/geometry/wheel_profile.h"
#include "flute_grinder/geometry/wheel_sweep.h"
#include "flute_grinder/job/axes.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The place on a path where two bodies are closest.
struct ClosestPlace {
  double distance = std::numeric_limits<double>::infinity();  ///< 0 if the bodies touch [m]
  std::string first, second;                                  ///< the bodies: <collision> names, wheel, cutter, shank
  Axes axes = Axes::Zero();                                   ///< [m], A [rad]
  std::size_t leg = 0;                                        ///< of the path
};

/// What a job adds to the machine's bodies.
struct CollisionJob {
  WheelProfile wheel;
  double nominal_radius = 0;  ///< of the wheel, for which Y = 0 touches the small end's circle [m]
  WheelSetup setup;
  CutterGeometry cutter;
  double shank_diameter = 0;         ///< [m]
  std::optional<double> shank_from;  ///< X where the shank begins; absent: where the run-out ends, see runOutEnd() [m]
  Axes stroke_end = Axes::Zero();    ///< of the deepest stroke, on the shank's side
  double clearance = 0;              ///< the minimum distance that is allowed [m]
  double x_offset = 0;               ///< work offset of X: how far the cutter stands in its holder, or out of it [m]
  double work_clearance = 0;         ///< the minimum distance of the wheel from the work outside the cut [m]
};

/// Finds how close the bodies of a machine and a job come to each other along a path.
///
/// What moves with the wheel is checked against all that does not, and the wheel against what carries it; left out are
/// a link's shapes against those of the link that they slide or turn on, and those that are centred on the wheel's axis
/// against the wheel.
///
/// The wheel is meant to cut the fluted part, and to leave the cutter toward the shank in a run-out. So the wheel is
/// checked against the shank alone, from CollisionJob::shank_from on; all else against the fluted part too, and against
/// a shank that begins at the flute's end. The shank reaches to the first shape that turns with the cutter.
///
/// Outside the cut the wheel is checked against the work as well: the cone before it is ground, and a shank that begins
/// where the flute ends, or the neck. Whatever is left of the cutter lies within these.
///
/// The path is in work coordinates. In Y and Z they say how wheel and cutter stand to each other, and what carries them
/// follows. In X the machine's bodies stand where the machine coordinates say, and the cutter where it was clamped.
///
/// Since no distance depends on A (MachineShapes) and all bodies are convex, the distance of two bodies is a convex
/// function of X, Y and Z. Two planes that part them at one position bound their distance at all others from below, so
/// that few positions are computed.
class CollisionCheck {
 public:
  /// @throw std::invalid_argument if no shape turns with the cutter, or a figure is not usable.
  CollisionCheck(const MachineShapes& machine, const CollisionJob& job);

  /// The closest place, to 2 um; the search ends at the first contact that it finds.
  /// @param path points with straight legs in X, Y and Z; at least one.
  ClosestPlace closest(const std::vector<Axes>& path) const;

  /// Where the wheel comes closest to the work outside the cut; the search ends at the first contact that it finds.
  /// @param path as above. @param outside_cut of every leg of the path, whether it is outside the cut.
  /// @return none if it keeps CollisionJob::work_clearance everywhere.
  std::optional<ClosestPlace> tooCloseToWork(const std::vector<Axes>& path, const std::vector<bool>& outside_cut) const;

  /// A pair of bodies that can meet.
  struct Pair {
    Solid first, second;
    Eigen::Matrix3d motion;  ///< of the second against the first, for a motion of X, Y and Z
    double below = std::numeric_limits<double>::infinity();  ///< a distance that is not less is as it should be [m]
  };
  const std::vector<Pair>& pairs() const noexcept { return pairs_; }

 private:
  void addJob(const MachineShapes& machine, const CollisionJob& job, std::vector<MachinePart> parts);
  void add(const MachinePart& first, const MachinePart& second);

  std::vector<Pair> pairs_;
  std::vector<Pair> work_pairs_;
  double height_;
};

/// The X from which on the wheel, at the end of its deepest stroke, is clear of the shank. The run-out may be twice as
/// deep as the flute: of a shank that stands out farther than that from the cutter, no more is left out.
double runOutEnd(const CollisionJob& job);

}  // namespace grinder
