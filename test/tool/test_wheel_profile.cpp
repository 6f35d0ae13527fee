#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/wheel_profile.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

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

/// Each line of the outline touches the profile, and none of its corners is far from it.
TEST(WheelProfile, HasAnOutlineThatTouchesIt) {
  constexpr double kError = 1e-6;
  constexpr int kPlaces = 20000;
  for (const WheelProfile& wheel :
       {WheelProfile::straight(0.1, 0.006), WheelProfile::straight(0.1, 0.006, {0.0005, 0.001}),
        WheelProfile::angled(0.1, 0.005, 45 * kDegree, {0, 0.0002}),
        WheelProfile::angled(0.1, 0.005, -30 * kDegree, {0.0003, 0.0002}), WheelProfile::fullRadius(0.1, 0.006),
        WheelProfile({{-0.002, 0.04}, {0, 0.05}, {0.003, 0.045}}, {0.0001, 0})}) {
    const std::vector<ProfilePoint> outline = wheel.outline(kError);
    EXPECT_EQ(outline.front().w, wheel.lowerFace());
    EXPECT_EQ(outline.back().w, wheel.upperFace());
    std::vector<double> nearest(outline.size(), 1);
    std::vector<double> touches(outline.size(), 1);
    for (int i = 0; i <= kPlaces; ++i) {
      // Closer together toward the faces, where a rounded end is steep.
      const double part = (1 - std::cos(i * units::kPi / kPlaces)) / 2;
      const double w = wheel.lowerFace() + part * (wheel.upperFace() - wheel.lowerFace()), r = wheel.radius(w);
      for (std::size_t k = 0; k < outline.size(); ++k) {
        nearest[k] = std::min(nearest[k], std::hypot(outline[k].w - w, outline[k].radius - r));
        if (k == 0) continue;
        const double along = outline[k].w - outline[k - 1].w, up = outline[k].radius - outline[k - 1].radius;
        const double above = (along * (outline[k].radius - r) - up * (outline[k].w - w)) / std::hypot(along, up);
        touches[k] = std::min(touches[k], above);
      }
    }
    for (std::size_t k = 0; k < outline.size(); ++k) {
      EXPECT_LT(nearest[k], 1.5 * kError);
      if (k > 0) {
        EXPECT_NEAR(touches[k], 0, 1e-8);
      }
    }
  }
}

}  // namespace test_wheel_profile
}  // namespace grinder
