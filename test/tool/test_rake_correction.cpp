// The correction of Z: its derivatives, within its range and beyond.

#include "flute_grinder/curve/z_correction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_rake_correction {

/// Bent all along.
ZCorrection bent(double from, double piece, int pieces) {
  ZCorrection c;
  c.from = from;
  c.piece = piece;
  c.pieces = pieces;
  for (int i = 0; i < c.coefficientCount(); ++i) c.coefficients[static_cast<std::size_t>(i)] = std::sin(2.0 * i * i);
  return c;
}

TEST(ZCorrection, ItsDerivativesAreThoseOfZ) {
  const ZCorrection c = bent(-2, 1.5, 6);
  for (double x = -3; x < 8; x += 0.37) {
    constexpr double kStep = 1e-5;
    const auto a = c.at(x - kStep), b = c.at(x + kStep), v = c.at(x);
    EXPECT_NEAR((b.z - a.z) / (2 * kStep), v.first, 1e-6) << x;
    EXPECT_NEAR((b.first - a.first) / (2 * kStep), v.second, 1e-6) << x;
    EXPECT_NEAR((b.second - a.second) / (2 * kStep), v.third, 1e-6) << x;
  }
}

TEST(ZCorrection, OutsideItsRangeItStaysAsAtTheEnds) {
  const ZCorrection c = bent(1, 0.5, 4);
  for (const double end : {1.0, 3.0}) {
    for (const double beyond : {1e-9, 0.2, 30.0}) {
      const auto v = c.at(end == 1 ? end - beyond : end + beyond);
      EXPECT_DOUBLE_EQ(v.z, c.at(end).z);
      EXPECT_EQ(v.first, 0);
      EXPECT_EQ(v.second, 0);
      EXPECT_EQ(v.third, 0);
    }
  }
}

}  // namespace test_rake_correction
}  // namespace grinder
