#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/wheel_profile.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace grinder {
namespace test_wheel_profile {

using units::kDegree;

TEST(WheelProfile, WhatIsNoWheelIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const auto& make, const std::string& name) {
    return test_support::refusalOf<std::invalid_argument>(make).find(name) != std::string::npos;
  };
  EXPECT_TRUE(refused([] { WheelProfile({{0, 0.05}}); }, "points"));
  EXPECT_TRUE(refused([] { WheelProfile({{0, 0.05}, {0, 0.05}}); }, "w = "));
  EXPECT_TRUE(refused([&] { WheelProfile({{0, 0.05}, {nan, 0.05}}); }, "w = "));
  EXPECT_TRUE(refused([&] { WheelProfile({{0, 0.05}, {0.01, nan}}); }, "radius"));
  EXPECT_TRUE(refused([] { WheelProfile::straight(0, 0.006); }, "radius"));
  EXPECT_TRUE(refused([] { WheelProfile::straight(0.1, 0.006, {0.004, 0.004}); }, "corner_radius"));
  EXPECT_TRUE(refused([] { WheelProfile::straight(0.1, 0.006, {-0.001, 0}); }, "corner_radius"));
  EXPECT_TRUE(refused([&] { WheelProfile::straight(0.1, 0.006, {nan, 0}); }, "corner_radius"));
  EXPECT_TRUE(refused([] { WheelProfile::angled(0.02, 0.02, 60 * kDegree); }, "radius"));
}

}  // namespace test_wheel_profile
}  // namespace grinder
