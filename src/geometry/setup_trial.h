#pragma once

#include "flute_grinder/geometry/wheel_sweep.h"

#include <array>

namespace grinder {

/// The figures of a set-up that make the tool.
struct SetupPoint {
  double swivel = 0;   ///< [rad]
  double height = 0;   ///< of the wheel's centre above the axis at Z = 0 [m]
  double depth = 0;    ///< Y = -depth at X = 0 [m]
  double x_shift = 0;  ///< of the wheel's centre in X, see LogCurve [m]
  double taper = 0;    ///< added to dY/dX, beside the trial's own
};

/// What a right-hand cutter becomes in a set-up, with a stroke as long as the cone allows.
class SetupTrial {
 public:
  /// @param nominal_radius of the wheel, for which Y = 0 touches the small end [m].
  /// @param y_per_x of a core taper, added to the cone's.
  SetupTrial(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius, double y_per_x);

  const ConicalCutter& cutter() const noexcept { return cutter_; }
  const WheelProfile& wheel() const noexcept { return wheel_; }

  static constexpr int kSections = 8;

  /// X of the sections in which a flute is judged, from 0 at the small end to kSections at the flute's end [m].
  double section(int i) const noexcept { return cutter_.geometry().flute_length * i / kSections; }

  /// Whether the flute is the same everywhere: a radius that changes by less than a millionth of the length is none.
  bool isCylinder() const noexcept;

  /// Whether the depth is one, and leaves the cutter's axis, at both ends of the flute.
  bool isSound(const SetupPoint& point) const noexcept;
  double deepest() const noexcept { return deepest_; }  ///< where the axis is reached, at one of the ends [m]

  WheelSweep sweep(const SetupPoint& point) const;
  /// With a stroke of its own. @param ends X [m].
  WheelSweep sweep(const SetupPoint& point, const std::array<double, 2>& ends) const;

  /// The edge that a wheel leaves, NaN where it does not reach the outer circle.
  struct Edge {
    double angle, rake;  ///< [rad]; the rake is radial
  };
  Edge edge(const WheelSweep& sweep, double x) const;

  /// Of the edge, in a section as GroundCutter has it; NaN as Edge [rad].
  double spiral(const WheelSweep& sweep, double x) const;

  /// Of the rake face, as ToothSection has it; NaN as Edge [rad].
  /// @param edge its angle [rad]. @param core radius of the section [m].
  double chordalRake(const WheelSweep& sweep, double x, double edge, double core) const;

  /// Of a section, along the circle: what a flute leaves of the pitch; negative where flutes meet, NaN as Edge [m].
  double land(const WheelSweep& sweep, double x, double pitch) const;

  /// Of a section; 0 if the wheel cuts through the axis, NaN if it does not reach the cutter [m].
  double coreRadius(const WheelSweep& sweep, double x) const;

  /// The depth that leaves a core at X = 0; NaN if no sound one does [m].
  double depthFor(double swivel, double height, double core_radius) const;

  /// How much of the rake face's depth the wheel's upper face and edge form, from the outer circle inward, in a
  /// section.
  double formedByFace(const WheelSweep& sweep, double x) const;

  /// From where to where on the stroke a section's walls are formed [m].
  Range reach(const WheelSweep& sweep, double x) const;

 private:
  ConicalCutter cutter_;
  WheelProfile wheel_;
  double nominal_radius_, y_per_x_;
  double deepest_;    ///< [m]
  double far_;        ///< beyond the flute's ends, where a wheel reaches it at no depth [m]
  double face_from_;  ///< w on the wheel from which on its profile belongs to the upper face [m]
};

}  // namespace grinder
