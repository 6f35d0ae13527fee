#include "brute_force.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/check/solid.h"

#include <gtest/gtest.h>

#include <random>

namespace grinder {
namespace test_solid {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using units::kDegree;

constexpr double kAccuracy = 1.1e-6;  ///< of gap() [m]

TEST(Solid, BodiesThatTouchHaveNoGap) {
  const Solid cylinder = Solid::cylinder(0.05, 0.006);
  EXPECT_EQ(gap(cylinder, cylinder).distance, 0);
  EXPECT_EQ(gap(cylinder, cylinder, {0.0999, 0, 0}).distance, 0);
  EXPECT_EQ(gap(cylinder, Solid::box({0.1, 0.1, 0.006}), {0.05, 0, 0.0059}).distance, 0);
}

/// Of everything from a hair's breadth to half a metre apart, and of slender bodies as well as flat ones.
TEST(Solid, RandomPairsAgreeWithBruteForce) {
  auto between = test_support::numbers(11);
  const auto shape = [&] {
    Shape s;
    s.is_box = between(0, 1) < 0.4;
    s.half = {between(0.002, 0.2), between(0.002, 0.2), between(0.002, 0.2)};
    s.radius = between(0.002, 0.25);
    s.half_length = between(0.001, 0.1);
    s.pose = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
    return s;
  };
  int apart = 0;
  for (int i = 0; i < 60; ++i) {
    const Shape first = shape();
    Shape second = shape();
    if (i % 3 == 0) second.pose = first.pose;  // parallel faces
    second.pose.pretranslate(Vector3d(between(-1, 1), between(-1, 1), between(-1, 1)).normalized() * between(0.1, 0.5));
    const Gap far = gap(first.solid(), second.solid());
    if (i % 2 == 0) second.pose.pretranslate(-far.normal * (far.distance - std::pow(10, between(-5, -3))));
    const double expected = first.distance(second);
    const double found = gap(first.solid(), second.solid()).distance;
    EXPECT_LE(found, expected + 1e-8) << i;
    EXPECT_GE(found, expected - kAccuracy - 1e-8) << i;
    apart += found > 0;
  }
  EXPECT_GT(apart, 30);
}

/// FCL alone is more than a micrometre wrong on every two-hundredth of such pairs, at worst by millimetres.
TEST(Solid, NoPairOfManyIsLeftInaccurate) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  const auto turn = [&] {
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  };
  for (int i = 0; i < 2000; ++i) {
    Solid disc = Solid::cylinder(0.002 + 0.2 * unit(random), 0.003 + 0.02 * unit(random));
    Solid other = i % 2 ? Solid::box({0.1 * unit(random) + 0.004, 0.02 * unit(random) + 0.003, 0.1})
                        : Solid::cylinder(0.002 + 0.05 * unit(random), 0.003 + 0.1 * unit(random));
    disc.pose = turn();
    other.pose = Translation3d(0.6 * Vector3d(normal(random), normal(random), normal(random)).normalized()) * turn();
    const Gap far = gap(disc, other);
    // Along the shortest way the distance falls by just as much.
    const double wanted = std::pow(10, -5 + 3.5 * unit(random));
    const double found = gap(disc, other, -far.normal * (far.distance - wanted)).distance;
    EXPECT_GE(found, wanted - kAccuracy) << i;
    EXPECT_LE(found, wanted + 2 * kAccuracy) << i;
  }
}

TEST(Solid, AWheelHasTheReachOfItsProfile) {
  const auto profile = WheelProfile::angled(0.1, 0.006, 30 * kDegree, {0.0005, 0.001});
  const Solid wheel = Solid::wheel(profile);
  for (double angle = -89; angle < 90; angle += 0.7) {
    const Vector3d direction(std::cos(angle * kDegree), 0, std::sin(angle * kDegree));
    double reach = -1;
    for (int i = 0; i <= 20000; ++i) {
      const double w = profile.lowerFace() + (profile.upperFace() - profile.lowerFace()) * i / 20000;
      reach = std::max(reach, profile.radius(w) * direction.x() + w * direction.z());
    }
    EXPECT_NEAR(wheel.farthest(direction).dot(direction), reach, 5e-6) << angle;
  }
}

/// The body at any angle is within what it sweeps, and at some angle reaches its rim.
TEST(Solid, ATurningBodySweepsItsMaxCircles) {
  const Isometry3d axis = Translation3d(0.1, 0.02, -0.03) * AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
  Solid box = Solid::box({0.02, 0.05, 0.03});
  box.pose = axis * Translation3d(0.03, -0.01, 0.2) * AngleAxisd(0.4, Vector3d::UnitX());
  Solid rod = Solid::cylinder(0.01, 0.08);
  rod.pose = axis * Translation3d(0.05, 0, 0) * AngleAxisd(90 * kDegree, Vector3d::UnitX());
  Solid ball = Solid::sphere(0.02);
  ball.pose = axis * Translation3d(0, 0.04, 0.1);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Solid& body : {box, ball, rod}) {
    const Solid swept = body.swept(axis);
    for (int i = 0; i < 50; ++i) {
      const Vector3d direction = Vector3d(normal(random), normal(random), normal(random)).normalized();
      double reach = -1;
      for (int step = 0; step < 3600; ++step) {
        Solid turned = body;
        turned.pose = axis * AngleAxisd(step * 0.1 * kDegree, Vector3d::UnitZ()) * axis.inverse() * body.pose;
        reach = std::max(reach, turned.farthest(direction).dot(direction));
      }
      const double found = swept.farthest(direction).dot(direction);
      EXPECT_GE(found, reach - 1e-12) << i;
      if (body.rings.size() == 1) {  // a rod counts as the box about it
        EXPECT_LE(found, reach + 1e-6) << i;
      }
    }
  }
}

}  // namespace test_solid
}  // namespace grinder
