#pragma once

#include <utility>
#include <vector>

namespace grinder {

/// The edge of one tooth where the wheel grinds it, from the small end to the shank: which X of the wheel's centre
/// forms it, and how far the wheel forms it beside its own lowest point. Known in some sections; both change slowly,
/// and are linear in between.
class GroundEdge {
 public:
  struct Place {
    double x = 0;        ///< of a section of the cutter [m]
    double wheel_x = 0;  ///< of the wheel's centre, as it forms the edge there [m]
    double turn = 0;     ///< the edge's angle less A at that moment: its angle in the machine [rad]
  };

  GroundEdge() = default;

  /// @param places in ascending X, with wheel_x that does not descend.
  explicit GroundEdge(std::vector<Place> places) : places_(std::move(places)) {}

  /// Whether no edge is ground.
  bool empty() const noexcept { return places_.empty(); }
  double from() const noexcept { return places_.front().x; }  ///< X of its first section, unless empty() [m]
  double to() const noexcept { return places_.back().x; }     ///< X of its last one, unless empty() [m]

  /// The place in a section. @param x beyond the ends: as there, moved along. Not of an empty one.
  Place at(double x) const noexcept;

  /// The place that is formed by the wheel. @param wheel_x of its centre; beyond the ends: as there, moved along. Not
  /// of an empty one.
  Place formedAt(double wheel_x) const noexcept;

 private:
  std::vector<Place> places_;
};

}  // namespace grinder
