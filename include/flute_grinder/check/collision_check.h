#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/check/machine_shapes.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/tool/wheel_profile.h"
#include "flute_grinder/tool/wheel_sweep.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The place on a path where two bodies are closest.
struct ClosestPlace {
  double distance = std::numeric_limits<double>::infinity();  ///< 0 if the bodies touch [m]
  std::string first, second;                                  ///< names: <collision>, wheel, cutter or shank
  Axes axes = Axes::Zero();                                   ///< [m], A [rad]
  std::size_t leg = 0;                                        ///< index of the leg in the path
};

/// The data that a job adds to the machine's bodies.
struct CollisionJob {
  WheelProfile wheel;
  double nominal_radius = 0;  ///< radius of the wheel that touches the small end's circle at Y = 0 [m]
  WheelSetup setup;
  Cone cutter;
  double shank_diameter = 0;         ///< [m]
  std::optional<double> shank_from;  ///< X where the shank begins; absent: where the run-out ends, see runOutEnd() [m]
  Axes stroke_end = Axes::Zero();    ///< position at the shank's end of the deepest stroke
  double clearance = 0;              ///< minimum allowed distance [m]
  double x_offset = 0;               ///< work offset of X: position of the cutter in its holder [m]
  double work_clearance = 0;         ///< minimum distance between wheel and work outside the cut [m]
};

/// Finds how close the bodies of a machine and a job come to each other along a path.
///
/// Bodies that move with the wheel are checked against bodies that do not, and the wheel against its carriers. Left out
/// are a link's shapes against the shapes of the link on which it slides or turns, and shapes centred on the wheel's
/// axis against the wheel.
///
/// The wheel is meant to cut the fluted part, and to leave the cutter toward the shank in a run-out. So the wheel is
/// checked only against the shank, from CollisionJob::shank_from on; all other bodies also against the fluted part, and
/// against a shank that begins at the flute's end. The shank reaches to the first shape that turns with the cutter.
///
/// Outside the cut the wheel is also checked against the work: the unground cone, and the neck or a shank that begins
/// at the flute's end. The ground cutter always lies within these.
///
/// The path is in work coordinates. In Y and Z they give the position of the wheel relative to the cutter, and the
/// carriers follow. In X the machine's bodies are at machine coordinates, and the cutter is where it was clamped.
///
/// No distance depends on A (MachineShapes) and all bodies are convex, so the distance of two bodies is a convex
/// function of X, Y and Z. Two planes that separate them at one position bound their distance at all others from below,
/// so few positions need computing.
class CollisionCheck {
 public:
  /// @throw std::invalid_argument if no shape turns with the cutter, or a number is not usable.
  CollisionCheck(const MachineShapes& machine, const CollisionJob& job);

  /// The closest place, to 2 um; the search ends at the first contact that it finds.
  /// @param path points with straight legs in X, Y and Z; at least one.
  ClosestPlace closest(const std::vector<Axes>& path) const;

  /// The place where the wheel comes closest to the work outside the cut; the search ends at the first contact that it
  /// finds.
  /// @param path see closest().
  /// @param outside_cut for every leg of the path, whether it is outside the cut.
  /// @return nothing if the wheel keeps CollisionJob::work_clearance everywhere.
  std::optional<ClosestPlace> tooCloseToWork(const std::vector<Axes>& path, const std::vector<bool>& outside_cut) const;

  /// A pair of bodies that can meet.
  struct Pair {
    Solid first, second;
    Eigen::Matrix3d motion;  ///< motion of the second body relative to the first, per motion of X, Y and Z
    double below = std::numeric_limits<double>::infinity();  ///< distances of this value and more are acceptable [m]
  };
  const std::vector<Pair>& pairs() const noexcept { return pairs_; }

 private:
  void addJob(const MachineShapes& machine, const CollisionJob& job, std::vector<MachinePart> parts);
  void add(const MachinePart& first, const MachinePart& second);

  std::vector<Pair> pairs_;
  std::vector<Pair> work_pairs_;
  double height_;
};

/// The X beyond which the wheel, at the end of its deepest stroke, is clear of the shank. The run-out may be twice as
/// deep as the flute at most: a higher shank does not move that X further.
double runOutEnd(const CollisionJob& job);

}  // namespace grinder
