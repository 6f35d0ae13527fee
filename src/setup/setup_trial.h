#pragma once

#include "flute_grinder/tool/wheel_sweep.h"

#include <array>

namespace grinder {

/// The figures of a set-up that determine the tool.
struct SetupPoint {
  double swivel = 0;   ///< [rad]
  double height = 0;   ///< height of the wheel's centre above the axis at Z = 0 [m]
  double depth = 0;    ///< depth: Y = -depth at X = 0 [m]
  double x_shift = 0;  ///< shift of A's curve along X, see LogCurve [m]
  double taper = 0;    ///< slope added to dY/dX, besides the trial's own
};

/// The tool that a set-up makes of a right-hand cutter, with a stroke as long as the cone allows.
class SetupTrial {
 public:
  /// @param nominal_radius radius of the wheel that touches the small end at Y = 0 [m].
  /// @param y_per_x slope of a core taper, added to the cone's.
  SetupTrial(const CutterGeometry& asked, const WheelProfile& wheel, double nominal_radius, double y_per_x);

  const ConicalCutter& cutter() const noexcept { return cutter_; }
  const WheelProfile& wheel() const noexcept { return wheel_; }

  static constexpr int kSections = 8;

  /// X of the sections in which a flute is judged, from 0 at the small end to kSections at the flute's end [m].
  double section(int i) const noexcept { return cutter_.cone().flute_length * i / kSections; }

  /// Whether the flute is the same everywhere: the radius changes by less than a millionth of the length.
  bool isCylinder() const noexcept;

  /// Whether the depth is positive, and leaves the cutter's axis, at both ends of the flute.
  bool isSound(const SetupPoint& point) const noexcept;
  double deepest() const noexcept { return deepest_; }  ///< depth that reaches the axis at one of the ends [m]

  WheelSweep sweep(const SetupPoint& point) const;
  /// A sweep with a given stroke.
  /// @param ends X of its ends [m].
  WheelSweep sweep(const SetupPoint& point, const std::array<double, 2>& ends) const;

  /// The edge that a wheel leaves; NaN where it does not reach the outer circle.
  struct Edge {
    double angle, rake;  ///< angle of the edge, and its radial rake [rad]
  };
  Edge edge(const WheelSweep& sweep, double x) const;

  /// The spiral angle of the edge in a section, see ToothSection; NaN like Edge [rad].
  double spiral(const WheelSweep& sweep, double x) const;

  /// The chordal rake of the rake face, see ToothSection; NaN like Edge [rad].
  /// @param edge angle of the edge [rad].
  /// @param core core radius of the section [m].
  double chordalRake(const WheelSweep& sweep, double x, double edge, double core) const;

  /// The part of the pitch along the circle that a flute leaves in a section; negative where flutes meet, NaN like Edge
  /// [m].
  double land(const WheelSweep& sweep, double x, double pitch) const;

  /// The core radius of a section; 0 if the wheel cuts through the axis, NaN if it does not reach the cutter [m].
  double coreRadius(const WheelSweep& sweep, double x) const;

  /// The depth that leaves a core at X = 0; NaN if no sound depth does [m].
  double depthFor(double swivel, double height, double core_radius) const;

  /// The fraction of the rake face's depth that the wheel's upper face and edge form in a section, from the outer
  /// circle inward.
  double formedByFace(const WheelSweep& sweep, double x) const;

  /// The range of the stroke in which a section's walls are formed [m].
  Range reach(const WheelSweep& sweep, double x) const;

 private:
  ConicalCutter cutter_;
  WheelProfile wheel_;
  double nominal_radius_, y_per_x_;
  double chordal_rake_depth_;  ///< as in CutterGeometry [m]
  double deepest_;             ///< [m]
  double far_;                 ///< distance beyond the flute's ends at which a wheel reaches it at no depth [m]
  double face_from_;           ///< w on the wheel from which its profile belongs to the upper face [m]
};

}  // namespace grinder
