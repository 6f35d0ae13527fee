#pragma once

#include "flute_grinder/curve/relief_path.h"
#include "flute_grinder/geometry/ground_cutter.h"

#include <optional>
#include <string>

namespace grinder {

/// What a set-up for a relief is to reach.
struct ReliefRequest {
  ReliefStart start;
  ReliefWheel wheel;  ///< swivel and height are to be found
  double edge = 0;    ///< angle of the edge of a tooth at angle 0 against its asked helix [rad]
  double land = 0;    ///< how far from its start the relief must reach, where another follows; 0: to the heel [m]
  double near = 0;    ///< the swivel is the nearest possible one to this: the flute's [rad]
  Range swivel{};     ///< to which the machine swivels [rad]
  std::optional<double> asked;  ///< swivel, instead of the nearest one [rad]
};

/// A set-up for a relief.
struct ReliefSetup {
  double swivel = 0;           ///< [rad]
  double height = 0;           ///< of the wheel's centre above the cutter's axis at Z = 0 [m]
  double width = 0;            ///< of the rim, from the relief's start on, that grinds the relief [m]
  double next_edge = 0;        ///< how near the wheel comes to the next tooth's edge [rad]
  Range land_end_clearance{};  ///< minimum and maximum over the flute, at the land's end [rad]
  std::string refused;         ///< why there is none, of the swivel that comes nearest; else empty
};

/// Finds swivel and height for a relief that reaches over the land of every tooth all along the flute, keeps clear of
/// the next tooth, leaves the core within its tolerance, and a clearance up to the land's end. Takes some ten
/// milliseconds.
/// @param cutter the flutes.
ReliefSetup findReliefSetup(const GroundCutter& cutter, const ReliefRequest& request);

/// The stroke that grinds a relief at its full depth, as if the tooth were at angle 0. @param edge as in ReliefRequest.
WheelSweep reliefSweep(const ConicalCutter& cutter, const ReliefPath& path, const ReliefWheel& wheel, double edge);

}  // namespace grinder
