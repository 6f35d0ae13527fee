#pragma once

#include <utility>
#include <vector>

namespace grinder {

/// The ground edge of one tooth, from the small end to the shank: the X of the wheel's centre that forms it, and the
/// angle at which the wheel forms it beside its own lowest point. Known in some sections; both change slowly, and are
/// interpolated linearly.
class GroundEdge {
 public:
  struct Place {
    double x = 0;        ///< X of a section of the cutter [m]
    double wheel_x = 0;  ///< X of the wheel's centre while it forms the edge there [m]
    double turn = 0;     ///< angle of the edge less A at that moment: its machine angle [rad]
  };

  GroundEdge() = default;

  /// @param places places in ascending X, with wheel_x that does not descend.
  explicit GroundEdge(std::vector<Place> places) : places_(std::move(places)) {}

  /// Whether there is no ground edge.
  bool empty() const noexcept { return places_.empty(); }
  double from() const noexcept { return places_.front().x; }  ///< X of the first section, unless empty() [m]
  double to() const noexcept { return places_.back().x; }     ///< X of the last section, unless empty() [m]

  /// The place in a section, unless empty().
  /// @param x X of the section; beyond the ends, the end place moved along [m].
  Place at(double x) const noexcept;

  /// The place that the wheel forms, unless empty().
  /// @param wheel_x X of the wheel's centre; beyond the ends, the end place moved along [m].
  Place formedAt(double wheel_x) const noexcept;

 private:
  std::vector<Place> places_;
};

}  // namespace grinder
