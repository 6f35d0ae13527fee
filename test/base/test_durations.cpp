#include "flute_grinder/base/durations.h"

#include <gtest/gtest.h>

#include <limits>

namespace grinder {
namespace test_durations {

TEST(Durations, OfNothingAreZeroAndOfOneThatItself) {
  Durations durations;
  EXPECT_EQ(durations.quantile(0.5), 0);
  EXPECT_EQ(durations.longest(), 0);
  durations.add(1.01e-6);
  EXPECT_EQ(durations.quantile(0.5), 1.01e-6) << "no more than the longest";
}

TEST(Durations, QuantilesAreAtMostAClassTooLong) {
  Durations durations;
  for (int i = 1; i <= 10000; ++i) durations.add(i * 1e-7);
  for (const double fraction : {0.001, 0.1, 0.5, 0.9, 0.99, 0.9999}) {
    EXPECT_GE(durations.quantile(fraction), fraction * 1e-3 * (1 - 1e-9));
    EXPECT_LE(durations.quantile(fraction), fraction * 1e-3 * 1.045);
  }
  EXPECT_EQ(durations.quantile(1), 1e-3);
  EXPECT_EQ(durations.longest(), 1e-3);
}

TEST(Durations, WhatIsNoDurationCountsAsZeroAndOneBeyondTheLastClassIsStillTheLongest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Durations durations;
  for (const double none : {0.0, -1e-3, 0.9e-9, std::numeric_limits<double>::quiet_NaN()}) durations.add(none);
  for (const double some : {1.0, 1.0, 100.0, infinity}) durations.add(some);
  EXPECT_EQ(durations.quantile(0.5), 0);
  EXPECT_NEAR(durations.quantile(0.51), 1, 0.045);
  EXPECT_GT(durations.quantile(0.8), 17);
  EXPECT_EQ(durations.longest(), infinity);
}

}  // namespace test_durations
}  // namespace grinder
