#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"

#include <gtest/gtest.h>

#include <limits>

namespace grinder {
namespace test_format {

TEST(Fixed, WhatRoundsToZeroHasNoSignAndAllElseKeepsIt) {
  EXPECT_EQ(fixed(-0.00004, 4), "0.0000");
  EXPECT_EQ(fixed(-0.00006, 4), "-0.0001");
  EXPECT_EQ(fixed(-0.0, 0), "0");
  EXPECT_EQ(fixed(-10, 1), "-10.0");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 3), "-inf");
  EXPECT_EQ(text(Quantity{-0.0, Unit::kMetre}), "0 mm");
}

}  // namespace test_format
}  // namespace grinder
