#include "setup/setup_trial.h"

#include "flute_grinder/tool/ground_cutter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr double kOfApex = 0.98;   ///< fraction of the way to the apex that the stroke may go
constexpr double kShortOf = 0.01;  ///< fraction of the way to where a flute is spoilt, by which a stroke ends earlier
constexpr int kWallRings = 10;     ///< rings of a wall on which its forming surface is determined
constexpr int kRingsOfReach = 6;
constexpr double kFloor = 1e-5;     ///< fraction of the depth at which a wall passes into the floor
constexpr double kEdgeStep = 1e-4;  ///< step for the slope of the edge, as a fraction of the radius
constexpr double kCylinder = 1e-6;
constexpr double kMinDepth = 1e-6;  ///< minimum depth of a job [m]
constexpr double kOnFace = 1e-8;    ///< distance below the edge that still counts as the edge [m]

}  // namespace

SetupTrial::SetupTrial(const CutterGeometry& asked, const WheelProfile& wheel, double nominal_radius, double y_per_x)
    : cutter_(asked),
      wheel_(wheel),
      nominal_radius_(nominal_radius),
      y_per_x_(y_per_x),
      chordal_rake_depth_(asked.chordal_rake_depth),
      deepest_(std::min(cutter_.radius(0), cutter_.radius(asked.flute_length) + y_per_x * asked.flute_length)),
      far_(4 * wheel.maxRadius() + wheel.upperFace() - wheel.lowerFace() + asked.flute_length),
      face_from_(wheel.maxPlace().to) {}

bool SetupTrial::isCylinder() const noexcept {
  return std::abs(cutter_.tanCone()) < kCylinder && std::abs(y_per_x_) < kCylinder;
}

bool SetupTrial::isSound(const SetupPoint& p) const noexcept {
  const double length = cutter_.cone().flute_length;
  const double at_end = p.depth - (y_per_x_ + p.taper) * length;
  return p.depth > kMinDepth && p.depth < cutter_.radius(0) && at_end > kMinDepth && at_end < cutter_.radius(length);
}

WheelSweep SetupTrial::sweep(const SetupPoint& p) const {
  // A stroke ends before the cutter's apex, and before the apex of the stroke's curve, which is shifted along X.
  const bool opens = cutter_.tanCone() >= 0;
  const double apex =
      -cutter_.radius(0) / cutter_.tanCone() + (opens ? std::max(0.0, p.x_shift) : std::min(0.0, p.x_shift));
  std::array<double, 2> ends{-far_, far_};
  if (cutter_.tanCone() > 0) ends[0] = std::max(-far_, kOfApex * apex);
  if (cutter_.tanCone() < 0) ends[1] = std::min(far_, kOfApex * apex);
  WheelSweep longest = sweep(p, ends);
  const double nearest = opens ? 0 : cutter_.cone().flute_length;
  const auto spoils = longest.overcutStart(nearest, cutter_.radius(nearest));
  if (!spoils) return longest;
  ends[opens ? 0 : 1] = *spoils + kShortOf * (nearest - *spoils);
  return sweep(p, ends);
}

WheelSweep SetupTrial::sweep(const SetupPoint& p, const std::array<double, 2>& ends) const {
  return {cutter_,
          wheel_,
          nominal_radius_,
          {p.swivel, p.height, p.x_shift},
          {ends[0], ends[1], -p.depth, y_per_x_ + p.taper, 0}};
}

SetupTrial::Edge SetupTrial::edge(const WheelSweep& sweep, double x) const {
  const double r = cutter_.radius(x);
  const auto wall = sweep.wall(x, r, true);
  return wall ? Edge{wall->angle, std::atan(-r * wall->slope)} : Edge{kNowhere, kNowhere};
}

double SetupTrial::spiral(const WheelSweep& sweep, double x) const {
  const double r = cutter_.radius(x), h = kEdgeStep * r;
  return std::atan(r * (edge(sweep, x + h).angle - edge(sweep, x - h).angle) / (2 * h));
}

double SetupTrial::chordalRake(const WheelSweep& sweep, double x, double edge, double core) const {
  const double r = cutter_.radius(x);
  const double inner = r - chordDepth(chordal_rake_depth_, r - core);
  const auto face = sweep.wall(x, inner, true);
  return face ? chordAngle(r, inner, face->angle - edge) : kNowhere;
}

double SetupTrial::land(const WheelSweep& sweep, double x, double pitch) const {
  const double r = cutter_.radius(x);
  const auto high = sweep.wall(x, r, true), low = sweep.wall(x, r, false);
  return high && low ? r * (pitch - (high->angle - low->angle)) : kNowhere;
}

double SetupTrial::coreRadius(const WheelSweep& sweep, double x) const {
  const double radius = sweep.minRadius(x, std::numeric_limits<double>::max());
  return std::isfinite(radius) ? radius : kNowhere;
}

double SetupTrial::depthFor(double swivel, double height, double core_radius) const {
  const double depth = sweep({swivel, height, 0}).deeperFor(0, core_radius);
  return isSound({swivel, height, depth}) ? depth : kNowhere;
}

double SetupTrial::formedByFace(const WheelSweep& sweep, double x) const {
  const double r = cutter_.radius(x);
  const double depth = r - sweep.minRadius(x, r);
  for (int i = 0; i < kWallRings; ++i) {
    const auto wall = sweep.wall(x, r - depth * i / kWallRings, true);
    if (!wall || wall->w < face_from_ - kOnFace) return static_cast<double>(i) / kWallRings;
  }
  return 1;
}

Range SetupTrial::reach(const WheelSweep& sweep, double x) const {
  const double r = cutter_.radius(x);
  const double core = sweep.minRadius(x, r);
  Range reach{x, x};
  for (int i = 0; i <= kRingsOfReach; ++i) {
    const double part = i == 0 ? kFloor : static_cast<double>(i) / kRingsOfReach;
    const double ring = core + part * (r - core);
    for (const bool high : {false, true}) {
      const auto wall = sweep.wall(x, ring, high);
      if (!wall) return {x, x};
      reach.from = std::min(reach.from, wall->axis_x);
      reach.to = std::max(reach.to, wall->axis_x);
    }
  }
  return reach;
}

}  // namespace grinder
