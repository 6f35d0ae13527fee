#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/wheel_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace grinder {
namespace test_wheel_profile {

using units::kDegree;

TEST(WheelProfile, AFullRadiusIsASemicircle) {
  const auto wheel = WheelProfile::fullRadius(0.1, 0.006);
  for (const double w : {-0.003, -0.002, 0.0, 0.0011, 0.003}) {
    EXPECT_NEAR(wheel.radius(w), 0.047 + std::sqrt(0.003 * 0.003 - w * w), 1e-12);
  }
  EXPECT_NEAR(wheel.maxRadius(), 0.05, 1e-15);
}

TEST(WheelProfile, TheSlopeIsThatOfTheRadius) {
  for (const auto& wheel :
       {WheelProfile::straight(0.1, 0.006), WheelProfile::angled(0.08, 0.005, 25 * kDegree, {8e-4, 3e-4}),
        WheelProfile::fullRadius(0.1, 0.006)}) {
    for (const double part : {0.02, 0.11, 0.3, 0.52, 0.77, 0.98}) {
      const double w = wheel.lowerFace() + part * (wheel.upperFace() - wheel.lowerFace());
      constexpr double kStep = 1e-8;
      EXPECT_NEAR(wheel.slope(w), (wheel.radius(w + kStep) - wheel.radius(w - kStep)) / (2 * kStep), 1e-6) << part;
    }
  }
}

TEST(WheelProfile, InTheMirrorItsFacesChangePlaces) {
  const auto wheel = WheelProfile::angled(0.08, 0.005, 25 * kDegree, {8e-4, 3e-4});
  const auto mirrored = wheel.mirrored();
  for (double w = -0.0025; w <= 0.0025; w += 0.0001) EXPECT_NEAR(mirrored.radius(-w), wheel.radius(w), 1e-15) << w;
}

TEST(WheelProfile, WhatIsNoWheelIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const auto& make, const std::string& name) {
    try {
      make();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find(name) != std::string::npos;
    }
    return false;
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
