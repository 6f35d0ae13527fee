#pragma once

namespace grinder {

constexpr int kExactHalvings = 36;  ///< of a fraction of a tool, to femtometres

/// The place nearest to where a condition ceases to hold, by halving.
/// @param fails,holds places where it does not hold and where it does, one change between them.
template <typename Condition>
double changeBetween(double fails, double holds, const Condition& condition, int halvings = kExactHalvings) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = (fails + holds) / 2;
    (condition(middle) ? holds : fails) = middle;
  }
  return holds;
}

}  // namespace grinder
