#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/geometry/wheel_profile.h"

#include <optional>
#include <vector>

namespace grinder {

/// How the machine is set for a wheel.
struct WheelSetup {
  double swivel = 0;   ///< of the wheel's plane against the cutter's axis; positive for right-hand flutes [rad]
  double height = 0;   ///< of the wheel's centre above the cutter's axis at Z = 0 [m]
  double x_shift = 0;  ///< shift of A's curve along X, see LogCurve [m]
};

/// How far the axes are off the job's path at an X.
struct PathDeviation {
  double y = 0, z = 0, a = 0;  ///< [m], A [rad]
};

/// Interpolates linearly. @param part of the way from a to b.
PathDeviation between(const PathDeviation& a, const PathDeviation& b, double part) noexcept;

/// Interpolates linearly between deviations at equal steps over a range of X; beyond an end, that end's.
/// @param all one at least. @param range, x [m].
PathDeviation deviationAt(const std::vector<PathDeviation>& all, const Range& range, double x) noexcept;

/// The deepest stroke of a tooth: X runs from one end to the other, the other axes follow as on the job's path.
struct GrindStroke {
  double from = 0, to = 0;     ///< X at the ends [m]
  double y = 0;                ///< Y at X = 0: the flute's depth, negative, plus the wear that Y takes up [m]
  double y_per_x = 0;          ///< added to the cone's own, for a core taper
  double a = 0;                ///< A at X = 0 [rad]
  ZCorrection z_correction{};  ///< added to Z
  /// Of a stroke of a run: at even distances between the ends, from the lesser X on, linear in between; empty
  /// for none.
  std::vector<PathDeviation> deviations{};
};

/// A part of a circle about the cutter's axis.
struct Arc {
  double low = 0, high = 0;      ///< ends, counted as A is [rad]
  double low_x = 0, high_x = 0;  ///< where on the stroke they are formed [m]
};

/// A wall of a groove where it meets a circle about the cutter's axis.
struct Wall {
  double angle = 0;   ///< counted as A is [rad]
  double slope = 0;   ///< d angle / d radius [rad/m]
  double w = 0;       ///< the place on the wheel's profile that forms it [m]
  double axis_x = 0;  ///< where on the stroke it is formed [m]
};

/// What a wheel removes from a cutter's blank in one stroke: for each circle about the cutter's axis, the arc that the
/// wheel goes through. Each end of an arc is an extremum over the stroke, found on the continuous path and not among
/// discrete poses, which would err to first order. Lifts and plunges are along the radius and remove nothing more.
///
/// Frame: the cutter's, X from the small end to the shank, Y toward the wheel at A = 0, Z up.
class WheelSweep {
 public:
  /// @param nominal_radius of the wheel, for which Y = 0 touches the small end's circle [m].
  /// @throw std::invalid_argument unless the swivel is within a quarter turn and the stroke's figures are finite.
  WheelSweep(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius, const WheelSetup& setup,
             const GrindStroke& stroke);

  /// @param x of the circle. @param r its radius, positive [m].
  /// @return the arc that is removed; nothing if the wheel does not reach the circle.
  std::optional<Arc> arc(double x, double r) const;

  /// One end of the arc, with its slope over the radius from the wheel's normal where it forms the wall. Costs half an
  /// arc.
  /// @param high the end at the larger angle, else the other one.
  std::optional<Wall> wall(double x, double r, bool high) const;

  /// Whether no longer stroke, short of one that spoils it, would take an end of an arc farther.
  /// @param x,r of the circle [m].
  /// @param angle,axis_x the end, or the wall there, and where on the stroke it is formed [rad, m].
  /// @param high whether it is the end at the larger angle.
  bool isComplete(double x, double r, double angle, double axis_x, bool high) const;

  /// The minimum radius that is removed from a blank at `x`, to a nanometre; infinite if nothing is, 0 if the wheel
  /// cuts through the axis [m].
  double minRadius(double x, double blank_radius) const;

  /// How much deeper the stroke must go for the minimum radius at `x` to become `radius`; infinite if no depth does
  /// [m].
  double deeperFor(double x, double radius) const;

  /// How far toward the cone's apex a stroke may go. Near the apex the cutter turns ever faster, and a wheel that still
  /// reaches a circle takes its arc farther than it was complete, as far as the stroke goes.
  /// @param x of the circle. @param r its radius, positive [m].
  /// @return the X at which that begins, whether this stroke goes so far or not; nothing if it does not begin [m].
  std::optional<double> overcutStart(double x, double r) const;

  const GrindStroke& stroke() const noexcept { return stroke_; }

  /// A of the stroke over X [rad].
  double a(double axis_x) const noexcept { return stroke_.a + curve_.a(axis_x); }

 private:
  /// Where the wheel stands while the axes are at an X, and which way round the cutter.
  struct Pose {
    double axis_x, dx, y, z, a;
  };
  struct Window {
    double from, to;
  };

  PathDeviation deviation(double axis_x) const noexcept;
  PathDeviation deviationSlope(double axis_x) const noexcept;  ///< by X
  Pose pose(double x, double axis_x) const noexcept;
  double lowestPoint(double axis_x) const noexcept;
  /// Where an endless stroke could reach a circle, and the part of it that the stroke has.
  Window reach(double x, double r) const noexcept;
  Window openReach(double x, double r) const noexcept;  ///< as far as the cone is open
  /// Where on an endless stroke a circle is not above or below the whole wheel.
  Window betweenFaces(double x, double r) const noexcept;
  std::optional<Window> window(double x, double r) const noexcept;
  /// How many steps a window is gone through in: of the size of the cutter, not of the wheel.
  int posesOf(double x, const Window& window) const noexcept;
  std::optional<double> endAt(const Pose& pose, double r, bool high) const;
  /// An angle on a circle, and what outside() is there.
  struct PlaceOnCircle {
    double theta, outside;
  };
  /// Where the circle leaves the wheel. @param in a place in the wheel. @param out one outside.
  double endBetween(const Pose& pose, double r, PlaceOnCircle in, PlaceOnCircle out) const noexcept;
  double endOver(double x, double axis_x, double r, bool high) const;
  /// How far a point of the section is from the spindle's axis, and outside the wheel: below 0 in it [m].
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
  /// Where an end of an arc, on an endless stroke's way to the apex, begins to move on once more, and its extremum up
  /// to there.
  struct Spoiling {
    double from;
    Extremum end;
  };
  std::optional<Spoiling> spoiling(double x, double r, bool high) const;
  Extremum anyExtremum(double x, double r, const Window& window, bool high) const;
  /// A normal of the wheel, its length free: along the cutter's radius, in the sense of rising angles, and along the
  /// wheel's motion against the cutter.
  struct Normal {
    double radial, tangential, along_motion;
  };
  Normal normal(const Pose& pose, double r, double theta, double w) const noexcept;
  /// The least of a function of the wheel's lower side in a section, and where on the stroke.
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
  double radius_;  ///< of the small end [m]
  double centre_, tan_cone_, y_per_x_, z_per_x_;
  double apex_;                   ///< X at which the stroke's curve ends, infinite for a cylinder [m]
  double deepest_deviation_ = 0;  ///< the least of Y [m]
  Window z_off_{0, 0};            ///< between which Z is off the published law [m]
};

}  // namespace grinder
