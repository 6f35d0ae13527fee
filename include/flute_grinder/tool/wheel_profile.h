#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/job/wheel_shape.h"

#include <array>
#include <optional>
#include <vector>

namespace grinder {

/// A grinding wheel: a filled solid of revolution between two flat faces. Its diameter is the largest diameter with
/// wear and rounded corners, as measured with a micrometer. Evaluation is real-time safe.
class WheelProfile {
 public:
  /// A profile of straight lines between corners, the ends rounded where asked.
  /// @param corners from the lower face to the upper: at least two, w strictly ascending, radii positive.
  /// @param corner_radii fillets between profile and lower face, profile and upper face; 0 for a sharp edge [m].
  /// @throw std::invalid_argument naming the value and what is allowed.
  explicit WheelProfile(std::vector<ProfilePoint> corners, const std::array<double, 2>& corner_radii = {0, 0});

  /// Straight wheel (FEPA 1A1).
  static WheelProfile straight(double diameter, double width, const std::array<double, 2>& corner_radii = {0, 0});

  /// Bevelled wheel (FEPA 1V1), and the rim of a flaring cup (11V9).
  /// @param angle between bevel and spindle axis; positive if the upper face is the larger one [rad].
  static WheelProfile angled(double diameter, double width, double angle,
                             const std::array<double, 2>& corner_radii = {0, 0});

  /// Full-radius wheel (FEPA 1F1): the profile is a semicircle over the width.
  static WheelProfile fullRadius(double diameter, double width);

  double lowerFace() const noexcept { return corners_.front().w; }  ///< w of the lower face [m]
  double upperFace() const noexcept { return corners_.back().w; }   ///< w of the upper face [m]
  double maxRadius() const noexcept { return max_radius_; }

  /// The range of w with the largest radius: a point, or the length of a cylinder; of several, the one nearest to the
  /// upper face.
  const Range& maxPlace() const noexcept { return max_place_; }

  /// The intersections of the profile's lines, without the rounded ends.
  const std::vector<ProfilePoint>& corners() const noexcept { return corners_; }

  /// Corners of a polygon about the profile, from face to face, for rounded ends at most about `error` outside it [m].
  std::vector<ProfilePoint> outline(double error) const;

  /// Radius of the profile at `w`, clamped to the faces [m].
  double radius(double w) const noexcept;

  /// d radius / dw at `w`, clamped to the faces; at a corner, the slope below it.
  double slope(double w) const noexcept;

  /// The wheel the other way up.
  WheelProfile mirrored() const;

  /// The wheel after its radius has worn by `wear` [m].
  WheelProfile worn(double wear) const;

  /// The wheel with its profile moved out or in to this maximum diameter [m].
  WheelProfile withDiameter(double diameter) const;

  /// The same wheel with another width.
  /// @return nothing unless the wheel is straight and its corners fit.
  std::optional<WheelProfile> withWidth(double width) const;

 private:
  /// The part of the profile that is rounded by a circle.
  struct Fillet {
    double from = 0, to = 0;             ///< range of w; empty for a sharp edge [m]
    double w = 0, radius = 0, size = 0;  ///< centre, and radius of the circle [m]

    bool covers(double at) const noexcept { return at >= from && at < to; }
    double at(double w_here) const noexcept;
    double slopeAt(double w_here) const noexcept;
  };

  std::size_t lineAt(double w) const noexcept;  ///< index of the corner at the line's upper end
  Fillet fillet(bool upper, double size) const;
  void addEnd(bool upper, double error, std::vector<ProfilePoint>& outline) const;
  void findMax();

  std::vector<ProfilePoint> corners_;
  std::array<double, 2> corner_radii_;
  std::array<Fillet, 2> fillets_;
  double max_radius_ = 0;
  Range max_place_;  ///< range of w [m]
};

}  // namespace grinder
