#pragma once

#include <functional>
#include <vector>

namespace flute_grinder {

/// A range of an unknown, looked through in equal steps.
struct SearchRange {
  double from = 0, to = 0;
  int steps = 1;

  double at(double i) const noexcept { return from + (to - from) * i / steps; }
  double step() const noexcept { return (to - from) / steps; }
};

/// A function of one unknown; NaN where it does not exist.
using LineFunction = std::function<double(double)>;

/// A root of a function of one unknown, and whether the function rises there.
struct LineRoot {
  double at = 0;
  bool rising = false;
};

/// The roots of a function: steps of the range at which it counts as 0, and places between steps where its sign
/// changes. A jump is none.
/// @param tolerance largest value that counts as 0.
std::vector<LineRoot> lineRoots(const LineFunction& f, const SearchRange& range, double tolerance);

/// A function of two unknowns u and v; NaN where it does not exist.
using PlaneFunction = std::function<double(double, double)>;

/// Where two functions of two unknowns vanish together.
struct PlaneRoot {
  double u = 0, v = 0;
};

/// The places where two functions vanish together, found along the lines on which the first one does: both may have
/// corners and jumps. The second one's values are to be of order 1.
/// @param tolerance largest value of each that counts as 0.
std::vector<PlaneRoot> planeRoots(const PlaneFunction& first, const PlaneFunction& second, const SearchRange& u,
                                  const SearchRange& v, double tolerance);

}  // namespace flute_grinder
