#pragma once

#include "flute_grinder/tool/ground_cutter.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace grinder {

/// Flutes near the end of a tool, as ranges of X on rays parallel to its axis: interpolated between arcs of two
/// sections, one at the end and one as far behind it as the radius.
class EndFlutes {
 public:
  EndFlutes() = default;
  explicit EndFlutes(const GroundCutter& cutter);

  std::size_t teeth() const noexcept { return teeth_.size(); }

  /// Adds the ranges of X in which a flute has removed a ray; beyond the sections as if it went on.
  /// @param r,angle the ray: distance from the axis [m], angle in the sense of A [rad].
  void addRemoved(std::size_t tooth, double r, double angle, std::vector<Range>& ranges) const;

 private:
  /// The arcs of a flute on a circle in both sections; nothing where it is not that deep.
  using Ring = std::optional<std::array<Arc, 2>>;

  double radius_ = 0, length_ = 0;
  std::vector<std::vector<Ring>> flutes_;  ///< from the axis to the radius, in equal steps
  std::vector<GroundTooth> teeth_;
};

}  // namespace grinder
