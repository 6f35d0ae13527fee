#include "setup/flute_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace grinder {

namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr double kOfApex = 0.98;   ///< fraction of the way to the apex that the stroke may go
constexpr double kShortOf = 0.01;  ///< fraction of the way to where a flute is spoilt, by which a stroke ends earlier
constexpr int kRingsOfReach = 6;
constexpr double kFloor = 1e-5;  ///< fraction of the depth at which a wall passes into the floor
constexpr double kCylinder = 1e-6;
constexpr double kMinSpiral = 1e-3;  ///< spiral angle below whose tangent a shift along X has no effect
constexpr double kMinDepth = 1e-6;   ///< minimum depth of a job [m]

Eigen::ArrayXd arrayOf(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

double FluteErrors::worst() const {
  if (!asked.allFinite() || !chord.allFinite()) return std::numeric_limits<double>::infinity();
  return std::max(asked.abs().maxCoeff(), chord.abs().maxCoeff());
}

FluteTrial::FluteTrial(const FluteRequest& request)
    : request_(request),
      cutter_(request.cutter),
      far_(4 * request.wheel.maxRadius() + request.wheel.upperFace() - request.wheel.lowerFace() +
           request.cutter.flute_length) {}

bool FluteTrial::isCylinder() const noexcept {
  return std::abs(cutter_.tanCone()) < kCylinder && std::abs(askedTaper()) < kCylinder;
}

bool FluteTrial::hasShift() const noexcept { return !isCylinder() && std::abs(cutter_.tanSpiral()) > kMinSpiral; }

double FluteTrial::askedTaper() const noexcept {
  const CutterGeometry& c = request_.cutter;
  return (c.core_diameter_end - c.core_diameter) / 2 / c.flute_length - cutter_.tanCone();
}

bool FluteTrial::isSound(const SetupPoint& p) const {
  const double length = cutter_.cone().flute_length, at_end = p.depth - p.taper * length;
  if (!(std::abs(p.x_shift) < request_.wheel.maxRadius() && cutter_.radius(-p.x_shift) > 0)) return false;
  const double width = request_.wheel.upperFace() - request_.wheel.lowerFace();
  if (p.less_width > 0 && !request_.wheel.withWidth(width - p.less_width)) return false;
  return p.depth > kMinDepth && p.depth < cutter_.radius(0) && at_end > kMinDepth && at_end < cutter_.radius(length);
}

WheelSweep FluteTrial::sweep(const SetupPoint& p) const {
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

WheelSweep FluteTrial::sweep(const SetupPoint& p, const std::array<double, 2>& ends) const {
  WheelProfile wheel = request_.wheel;
  if (p.less_width > 0) wheel = wheel.withWidth(wheel.upperFace() - wheel.lowerFace() - p.less_width).value();
  if (p.less_diameter > 0) wheel = wheel.withDiameter(2 * wheel.maxRadius() - p.less_diameter);
  return {cutter_,
          wheel,
          request_.nominal_radius - p.less_diameter / 2,
          {p.swivel, p.height, p.x_shift},
          {ends[0], ends[1], -p.depth, p.taper, 0}};
}

GroundCutter FluteTrial::ground(const WheelSweep& sweep) const {
  return {cutter_, {{sweep}}, {{0, 0}}, {}, request_.cutter.chordal_rake_depth};
}

FluteErrors FluteTrial::errors(const SetupPoint& p, int sections) const {
  const CutterGeometry& c = request_.cutter;
  if (isCylinder()) sections = 0;
  const GroundCutter cutter = ground(sweep(p));
  std::vector<double> asked, chords, lands;
  double before = 0, x_before = 0;
  for (int i = 0; i <= sections; ++i) {
    const double x = sections > 0 ? c.flute_length * i / sections : 0, radius = cutter_.radius(x);
    const ToothSection tooth = cutter.tooth(0, x);
    const double edge = tooth.edge.value_or(kNowhere);
    asked.push_back((tooth.rake.value_or(kNowhere) - c.rake_angle) / c.rake_tolerance);
    asked.push_back((tooth.spiral.value_or(kNowhere) - c.spiral_angle) / c.spiral_tolerance);
    asked.push_back((2 * (radius - tooth.depth) - askedCore(c, x)) / c.core_tolerance);
    if (i > 0) {
      asked.push_back((meanSpiral(cutter_, x_before, x, edge - before) - c.spiral_angle) / c.spiral_tolerance);
    }
    chords.push_back((tooth.chordal_rake.value_or(kNowhere) - c.rake_angle) / c.chordal_rake_tolerance);
    lands.push_back(radius * (request_.pitch - tooth.flute.value_or(kNowhere)) / c.end_diameter);
    before = edge;
    x_before = x;
  }
  return {arrayOf(asked), arrayOf(chords), arrayOf(lands)};
}

Range FluteTrial::reach(const WheelSweep& sweep, double x) const {
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
