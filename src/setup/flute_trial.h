#pragma once

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/setup_file.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace grinder {

/// The figures of a set-up that determine the flute, and the wheel's size.
struct SetupPoint {
  double swivel = 0;         ///< [rad]
  double height = 0;         ///< height of the wheel's centre above the axis at Z = 0 [m]
  double depth = 0;          ///< depth: Y = -depth at X = 0 [m]
  double x_shift = 0;        ///< shift of A's curve along X, see LogCurve [m]
  double taper = 0;          ///< slope of a core taper, added to the cone's dY/dX
  double less_diameter = 0;  ///< how much smaller the wheel's diameter is than the request's [m]
  double less_width = 0;     ///< how much narrower a straight wheel is than the request's [m]
};

/// The flute of a right-hand cutter, with the wheel and the machine for grinding it.
struct FluteRequest {
  CutterGeometry cutter;      ///< the asked tool, with its tolerances
  double pitch = 0;           ///< minimum angle from one tooth to the next [rad]
  WheelProfile wheel;         ///< wheel with its present wear
  double nominal_radius = 0;  ///< radius of the wheel that touches the small end at Y = 0 [m]
  Range swivel;               ///< range that is searched [rad]
  std::optional<SetupFigure> keep;
  SetupPoint kept;  ///< values of the figure that stays
};

/// The errors of a flute against the asked tool, in equidistant sections that include the flute's ends; NaN where the
/// wheel does not reach the cutter.
struct FluteErrors {
  /// Of rake, spiral angle and core diameter, and of the edge's turn from each section to the next, per tolerance.
  Eigen::ArrayXd asked;
  Eigen::ArrayXd chord;  ///< of the chordal rake, per tolerance
  Eigen::ArrayXd land;   ///< what is left of the pitch along the circle, per end diameter; negative where flutes meet

  /// The maximum error per tolerance: up to 1 is within the tolerances; infinite if there is no tool.
  double worst() const;
};

/// The flutes that set-ups grind, with strokes as long as the cone allows.
class FluteTrial {
 public:
  explicit FluteTrial(const FluteRequest& request);

  const FluteRequest& request() const noexcept { return request_; }
  const ConicalCutter& cutter() const noexcept { return cutter_; }

  /// Whether the flute is the same everywhere: radius and core change by less than a millionth of the length.
  bool isCylinder() const noexcept;

  /// Whether a shift along X has an effect: it has none on a cylinder or on straight flutes.
  bool hasShift() const noexcept;

  /// The taper from the asked cores.
  double askedTaper() const noexcept;

  /// Whether the wheel exists, stays within the cone, and leaves a depth and the cutter's axis at both ends.
  bool isSound(const SetupPoint& point) const;

  WheelSweep sweep(const SetupPoint& point) const;
  /// @param ends X of the stroke's ends [m].
  WheelSweep sweep(const SetupPoint& point, const std::array<double, 2>& ends) const;

  /// A cutter with this flute alone.
  GroundCutter ground(const WheelSweep& sweep) const;

  /// @param sections intervals between sections; a cylinder has one section.
  FluteErrors errors(const SetupPoint& point, int sections) const;

  /// The range of the stroke in which a section's walls are formed [m].
  Range reach(const WheelSweep& sweep, double x) const;

 private:
  const FluteRequest request_;
  ConicalCutter cutter_;
  double far_;  ///< distance beyond the flute's ends at which a wheel reaches it at no depth [m]
};

}  // namespace grinder
