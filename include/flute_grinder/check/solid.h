#pragma once

#include "flute_grinder/tool/wheel_profile.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace grinder {

/// A convex body: a box, or the convex hull of rings about its own Z axis, thickened in all directions by a radius.
struct Solid {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< pose of the body's frame in the machine's frame
  Eigen::Vector3d half = Eigen::Vector3d::Zero();          ///< half the sides of a box; zero for rings [m]
  std::vector<ProfilePoint> rings{{0, 0}};                 ///< rings about Z; w is their Z
  double thickness = 0;                                    ///< radius of the thickening [m]

  static Solid box(const Eigen::Vector3d& sides);
  static Solid cylinder(double radius, double length);
  static Solid sphere(double radius);

  /// The hull of a wheel, exact at the profile's corners, and to a few micrometres at its fillets.
  static Solid wheel(const WheelProfile& profile);

  /// The farthest point in a direction, which need not have length 1.
  Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const;

  /// The volume that the body sweeps in a turn about an axis. It lies about the new body's Z.
  /// @param axis frame whose Z is the axis, in the machine's frame.
  Solid swept(const Eigen::Isometry3d& axis) const;
};

/// The space between two bodies.
struct Gap {
  double distance = 0;                               ///< 0 if they touch [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< direction from first to second; zero if they touch
};

/// Computes the distance of two bodies with FCL's GJK. FCL alone errs by up to millimetres on some cylinders, one pair
/// in some thousand; so its direction only defines two parallel planes between the bodies, whose distance is a lower
/// bound whatever the direction, and GJK is repeated in a turned frame until the bound is within a micrometre.
/// @param shift displacement of the second body [m].
/// @return the distance of the planes: never more than the true distance, and in practice at most 1 um less.
Gap gap(const Solid& first, const Solid& second, const Eigen::Vector3d& shift = Eigen::Vector3d::Zero());

}  // namespace grinder
