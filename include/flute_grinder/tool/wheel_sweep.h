#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/tool/wheel_profile.h"

#include <optional>
#include <vector>

namespace grinder {

/// The set-up of the machine for a wheel.
struct WheelSetup {
  double swivel = 0;   ///< angle of the wheel's plane to the cutter's axis; positive for right-hand flutes [rad]
  double height = 0;   ///< height of the wheel's centre above the cutter's axis at Z = 0 [m]
  double x_shift = 0;  ///< shift of A's curve along X, see LogCurve [m]
};

/// Deviations of the axes from the job's path at an X, or at a place of a straight stroke.
struct PathDeviation {
  double y = 0, z = 0, a = 0;  ///< [m], A [rad]
  double x = 0;                ///< only of a straight stroke [m]
};

/// Interpolates linearly.
/// @param part fraction of the way from a to b.
PathDeviation between(const PathDeviation& a, const PathDeviation& b, double part) noexcept;

/// Interpolates linearly between deviations at equal steps over a range of X; constant beyond the ends.
/// @param all at least one deviation.
/// @param range, x X [m].
PathDeviation deviationAt(const std::vector<PathDeviation>& all, const Range& range, double x) noexcept;

/// The deepest stroke of a tooth: X runs from one end to the other, and the other axes follow the job's path.
struct GrindStroke {
  double from = 0, to = 0;     ///< X at the ends [m]
  double y = 0;                ///< Y at X = 0: the flute's depth, negative, plus the wear that Y takes up [m]
  double y_per_x = 0;          ///< slope of a core taper, added to the cone's dY/dX
  double a = 0;                ///< A at X = 0 [rad]
  ZCorrection z_correction{};  ///< correction added to Z
  /// Deviations in a stroke of a run, at equal steps between the ends, from the smaller X on, linear in between; empty
  /// for none.
  std::vector<PathDeviation> deviations{};
};

/// An arc of a circle about the cutter's axis.
struct Arc {
  double low = 0, high = 0;      ///< ends, in the sense of A [rad]
  double low_x = 0, high_x = 0;  ///< X of the wheel's centre that forms the ends [m]
};

/// The wall of a groove on a circle about the cutter's axis.
struct Wall {
  double angle = 0;   ///< angle, in the sense of A [rad]
  double slope = 0;   ///< d angle / d radius [rad/m]
  double turn = 0;    ///< d angle / dX on the circle's cylinder [rad/m]
  double w = 0;       ///< place on the wheel's profile that forms it [m]
  double axis_x = 0;  ///< X of the wheel's centre that forms it [m]
};

/// The volume that a wheel removes from a blank in one stroke: for each circle about the cutter's axis, the arc that
/// the wheel passes through. Each end of an arc is an extremum over the stroke, found on the continuous path; discrete
/// poses would cause first-order errors. Lifts and plunges are radial and remove nothing more.
///
/// Frame: the cutter's, X from the small end to the shank, Y toward the wheel at A = 0, Z up.
class WheelSweep {
 public:
  /// @param nominal_radius radius of the wheel that touches the small end's circle at Y = 0 [m].
  /// @throw std::invalid_argument unless the swivel is within a quarter turn and the stroke's numbers are finite.
  WheelSweep(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius, const WheelSetup& setup,
             const GrindStroke& stroke);

  /// @param x X of the circle [m].
  /// @param r radius of the circle, positive [m].
  /// @return the removed arc; nothing if the wheel does not reach the circle.
  std::optional<Arc> arc(double x, double r) const;

  /// One end of the arc, with its slope over the radius from the wheel's normal where it forms the wall. Costs half as
  /// much as an arc.
  /// @param high whether it is the end at the larger angle.
  std::optional<Wall> wall(double x, double r, bool high) const;

  /// Whether no longer stroke would take an end of an arc farther, except a stroke so long that it spoils the end.
  /// @param x,r X and radius of the circle [m].
  /// @param angle,axis_x the end, or the wall there, and X of the wheel's centre that forms it [rad, m].
  /// @param high whether it is the end at the larger angle.
  bool isComplete(double x, double r, double angle, double axis_x, bool high) const;

  /// The minimum radius that is removed from a blank at `x`, to a nanometre; infinite if nothing is removed, 0 if the
  /// wheel cuts through the axis [m].
  double minRadius(double x, double blank_radius) const;

  /// Increase of the stroke's depth that makes the minimum radius at `x` equal to `radius`; infinite if no depth does
  /// [m].
  double deeperFor(double x, double radius) const;

  /// The X up to which a stroke may go toward the cone's apex. Near the apex the cutter turns ever faster, and a wheel
  /// that still reaches a circle extends a complete arc as far as the stroke goes.
  /// @param x X of the circle [m].
  /// @param r radius of the circle, positive [m].
  /// @return the X at which that begins, whether this stroke goes so far or not; nothing if it does not begin [m].
  std::optional<double> overcutStart(double x, double r) const;

  const GrindStroke& stroke() const noexcept { return stroke_; }

  /// A of the stroke over X [rad].
  double a(double axis_x) const noexcept { return stroke_.a + curve_.a(axis_x); }

 private:
  /// The position of the wheel while the axes are at an X, and the angle of the cutter.
  struct Pose {
    double axis_x, dx, y, z, a;
  };
  struct Window {
    double from, to;
  };

  PathDeviation deviation(double axis_x) const noexcept;
  PathDeviation deviationSlope(double axis_x) const noexcept;  ///< derivative by X
  Pose pose(double x, double axis_x) const noexcept;
  double lowestPoint(double axis_x) const noexcept;
  /// The range in which an endless stroke could reach a circle, limited to the stroke.
  Window reach(double x, double r) const noexcept;
  Window openReach(double x, double r) const noexcept;  ///< the same range, limited to where the cone is open
  /// The range of an endless stroke in which a circle is neither above nor below the whole wheel.
  Window betweenFaces(double x, double r) const noexcept;
  std::optional<Window> window(double x, double r) const noexcept;
  /// Number of steps through a window: their size depends on the cutter, not on the wheel.
  int posesOf(double x, const Window& window) const noexcept;
  std::optional<double> endAt(const Pose& pose, double r, bool high) const;
  /// An angle on a circle, and the value of outside() there.
  struct PlaceOnCircle {
    double theta, outside;
  };
  /// The angle at which the circle leaves the wheel.
  /// @param in a place in the wheel.
  /// @param out a place outside it.
  double endBetween(const Pose& pose, double r, PlaceOnCircle in, PlaceOnCircle out) const noexcept;
  double endOver(double x, double axis_x, double r, bool high) const;
  /// Distance of a point of the section from the spindle's axis, and from the wheel's surface, negative inside it [m].
  struct FromWheel {
    double spindle, outside;
  };
  FromWheel fromWheel(const Pose& pose, double y, double z) const noexcept;
  double outside(const Pose& pose, double y, double z) const noexcept { return fromWheel(pose, y, z).outside; }
  struct Extremum {
    double value;
    double axis_x;
  };
  Extremum extremum(double x, double r, const Window& window, bool high) const;
  /// The X at which an end of an arc begins to move on once more, on an endless stroke's way to the apex, and the
  /// extremum of that end before it.
  struct Spoiling {
    double from;
    Extremum end;
  };
  std::optional<Spoiling> spoiling(double x, double r, bool high) const;
  Extremum anyExtremum(double x, double r, const Window& window, bool high) const;
  /// A normal of the wheel, of any length: along the cutter's axis and radius, in the sense of rising angles, and along
  /// the wheel's motion relative to the cutter.
  struct Normal {
    double axial, radial, tangential, along_motion;
  };
  Normal normal(const Pose& pose, double r, double theta, double w) const noexcept;
  /// The minimum of a function of the wheel's lower side in a section, and its place on the stroke.
  struct Minimum {
    double value, axis_x;
  };
  template <typename Function>
  Minimum minimum(double x, double max_height, const Function& f) const;
  Minimum minSquare(double x) const;
  std::optional<Window> narrowWindow(double x, double r, double step) const;

  LogCurve curve_;
  WheelProfile wheel_;
  GrindStroke stroke_;
  double height_, sin_, cos_;
  double radius_;  ///< radius of the small end [m]
  double centre_, tan_cone_, y_per_x_, z_per_x_;
  double apex_;                   ///< X at which the stroke's curve ends; infinite for a cylinder [m]
  double deepest_deviation_ = 0;  ///< minimum deviation of Y [m]
  Window z_off_{0, 0};            ///< range of the difference of Z from the published law [m]
};

}  // namespace grinder
