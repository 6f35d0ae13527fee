#pragma once

#include "curve/examples.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

// What the property tests draw from: numbers, and cutters of both hands.
namespace grinder::test_support {

/// Even over [low, high], whatever rapidcheck's size.
inline rc::Gen<double> uniform(double low, double high) {
  constexpr std::int64_t steps = std::int64_t{1} << 40;
  return rc::gen::map(rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(0, steps + 1)),
                      [=](std::int64_t i) { return low + (high - low) * (static_cast<double>(i) / steps); });
}

/// Even in the logarithm over [low, high].
inline rc::Gen<double> logUniform(double low, double high) {
  return rc::gen::map(uniform(0, 1), [=](double f) { return std::min(high, low * std::pow(high / low, f)); });
}

/// One of low, ..., high.
inline rc::Gen<int> whole(int low, int high) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}

/// -3 to 30 deg, now and then none or next to none.
inline rc::Gen<double> coneAngle() {
  return rc::gen::weightedOneOf<double>({{1, rc::gen::just(0.0)},
                                         {1, uniform(-1e-8 * units::kDegree, 1e-8 * units::kDegree)},
                                         {6, uniform(-3 * units::kDegree, 30 * units::kDegree)}});
}

/// -60 to 60 deg, now and then none.
inline rc::Gen<double> spiralAngle() {
  return rc::gen::weightedOneOf<double>(
      {{1, rc::gen::just(0.0)}, {7, uniform(-60 * units::kDegree, 60 * units::kDegree)}});
}

/// Length from X = 0 toward the shank (+1) or beyond the end (-1) over which the radius keeps a fifth of what it is at
/// X = 0; at most `limit`. [m]
inline double openLength(const Cone& g, int side, double limit) {
  const double closing = -side * std::tan(g.cone_angle);
  return closing > 0 ? std::min(limit, 0.8 * g.end_diameter / 2 / closing) : limit;
}

/// dZ/dY of the published law: a left-hand cutter is a right-hand one in the mirror.
inline long double zPerY(const Cone& g) {
  return (g.cut == CutDirection::kLeftHand ? -1 : 1) * std::sin(static_cast<long double>(g.rake_angle));
}

inline rc::Gen<Cone> cone() {
  return rc::gen::exec([] {
    Cone g;
    g.end_diameter = *logUniform(0.3e-3, 30e-3);
    g.cone_angle = *coneAngle();
    g.spiral_angle = *spiralAngle();
    g.rake_angle = *uniform(-20 * units::kDegree, 20 * units::kDegree);
    g.flute_length = openLength(g, 1, *logUniform(1e-3, 60e-3));
    g.cut = *rc::gen::arbitrary<bool>() ? CutDirection::kLeftHand : CutDirection::kRightHand;
    return g;
  });
}

inline double edgePerTravel(const Cone& g) {
  return std::sqrt(1 + std::pow(std::tan(g.cone_angle), 2) + std::pow(std::tan(g.spiral_angle), 2));
}

}  // namespace grinder::test_support
