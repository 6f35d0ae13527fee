#pragma once

#include "flute_grinder/curve/face_stroke.h"
#include "flute_grinder/tool/removed_volume.h"
#include "flute_grinder/tool/wheel_profile.h"

#include <optional>
#include <vector>

namespace grinder {

/// The volume that a wheel removes in a FaceStroke, on rays parallel to the cutter's axis, found on the continuous
/// stroke. A wheel that comes in its face's plane goes out along Y, and one that is fed along X goes back;
/// the rim of such a cup is taken as sharp.
class FaceSweep {
 public:
  /// @param wheel worn, if at all, at its lower face.
  /// @param profile the wheel with its present wear, convex; as wide as FaceWheel::width less the face's wear.
  /// @param end_radius radius of the tool at its end [m].
  /// @param tooth_angle added to A of the stroke [rad].
  FaceSweep(const FaceStroke& stroke, const FaceWheel& wheel, WheelProfile profile, double end_radius,
            double tooth_angle);

  /// A ray, by its place at right angles to the axis, which turns with A [m].
  using OnRay = Eigen::Vector2d;

  /// Whether the wheel passes through a place. @param x of the place on the ray [m].
  bool removes(const OnRay& ray, double x) const;
  /// How far it passes through the ray from a place toward +X [m]; nothing if not through the place.
  std::optional<double> removedTo(const OnRay& ray, double x) const;

  /// What is removed of the tool, in its frame at A = 0, as between planes that touch the wheel on its way. Its face is
  /// exact, its rim, rounded corners and recess off by at most about `error` [m].
  /// Kind and tooth of its faces are left to the caller.
  RemovedVolume volume(double error) const;

 private:
  /// A convex part of the path of the wheel's centre in the face's plane, seen from its end.
  struct Leg {
    Eigen::Vector2d from, to;  ///< across Y and along it [m]
    bool endless;              ///< on upward from `to`, without end

    double squaredDistance(const Eigen::Vector2d& at) const noexcept;
    /// The places across Y, at a place along it, that are within a distance; empty if `from` is above `to`.
    Range within(double distance, double along) const noexcept;
  };
  /// A ray in the wheel: along its axis from the middle of its width, and in the plane of its faces, at X = 0 and for
  /// each metre of X.
  struct Ray {
    double w, w_per_x;
    Eigen::Vector2d at, at_per_x;
  };

  Ray inWheel(const OnRay& ray) const;
  bool covers(const Ray& ray, const Leg& leg, double x) const;
  double coveredTo(const Ray& ray, const Leg& leg, double x) const;
  double plungedTo(const Ray& ray) const;
  double depth(const Ray& ray, const Leg& leg, double x) const;
  Plane touching(const Eigen::Vector3d& outward, const Eigen::Vector3d& at) const;
  void addPlanes(double error, RemovedVolume& volume) const;
  void addPlunged(double error, RemovedVolume& volume) const;

  WheelProfile profile_;
  double inner_radius_, cos_a_, sin_a_;
  Eigen::Vector3d end_, spindle_, across_;  ///< of the wheel's centre at the stroke's end, and its directions
  bool plunges_;                            ///< whether the stroke is along X rather than within the face's plane
  std::vector<Leg> legs_;
};

}  // namespace grinder
