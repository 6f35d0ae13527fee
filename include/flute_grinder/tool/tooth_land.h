#pragma once

#include "flute_grinder/tool/ground_cutter.h"

#include <optional>

namespace grinder {

/// The land of a tooth in a section, from its edge to the next flute. Angles are counted from the edge toward the heel.
class ToothLand {
 public:
  /// @param number number of a tooth that has an edge in the section.
  ToothLand(const GroundCutter& cutter, const GroundSection& section, std::size_t number);

  /// The point nearest to the edge where a relief's surface meets a circle, with its slope over the radius.
  struct Surface {
    double behind, slope;
  };
  std::optional<Surface> surface(const Relief& relief, double r) const;

  /// The tooth's own rake face, on a circle that it reaches.
  double rakeFace(double r) const { return wallOf(*flute_, r, right_).value_or(0); }

  /// The next flute's wall at the heel, and at the next edge, on a circle that it reaches.
  double heelWall(double r) const { return wallOf(*next_flute_, r, !right_).value_or(0) + pitch_; }
  double nextRakeFace(double r) const { return wallOf(*next_flute_, r, right_).value_or(0) + pitch_; }

  /// The end of a relief far behind the edge; a whole turn before the edge where it does not reach the circle.
  double farEnd(const Relief& relief, double r) const;

 private:
  double behind(double angle) const { return right_ ? angle - edge_ : edge_ - angle; }
  std::optional<double> wallOf(const Flute& flute, double r, bool high) const;

  double x_;
  bool right_;
  double edge_, pitch_;
  const Flute* flute_;
  const Flute* next_flute_;
};

}  // namespace grinder
