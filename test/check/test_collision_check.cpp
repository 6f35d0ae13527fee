#include "flute_grinder/check/collision_check.h"

#include "brute_force.h"
#include "flute_grinder/base/units.h"
#include "machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grinder {
namespace test_collision_check {

using Eigen::AngleAxisd;
using Eigen::Translation3d;
using Eigen::Vector3d;
using units::kDegree;

constexpr double kAccuracy = 2.2e-6;  ///< of the check [m]
constexpr double kFarAway = 1;        ///< [m]

/// A wheel of 100 mm and 6 mm width on a cutter of 10 mm, without a shank for the wheel.
CollisionJob plainJob(double swivel = 0, double height = 0) {
  CollisionJob job{WheelProfile::straight(0.1, 0.006), 0.05, {swivel, height}, {}, 0.01, kFarAway, Axes::Zero(), 1e-3};
  job.cutter.end_diameter = 0.01;
  job.cutter.flute_length = 0.02;
  return job;
}

Axes axes(double x, double y, double z = 0, double a = 0) { return Axes(x, y, z, a); }

ClosestPlace closestOf(const std::string& urdf, const CollisionJob& job, const std::vector<Axes>& path) {
  return CollisionCheck(shapesOf(urdf), job).closest(path);
}

/// The rim meets the edge of the collet, 21 mm from the axis at X = 62 mm, in the plane Z = 0.
TEST(CollisionCheck, ReportsATenthOfAMillimetreFromTheClearanceAndFromAHit) {
  const double y = -0.0015;
  const double across = 0.005 + 0.05 + y - 0.021;
  for (const double wanted : {-0.1e-3, 0.1e-3, 0.9e-3, 1.1e-3}) {
    const double x = 0.062 - std::sqrt(std::pow(0.05 + wanted, 2) - across * across);
    const ClosestPlace place =
        closestOf(SmallMachine().urdf(), plainJob(), {axes(-0.05, 0.05), axes(0, 0.05), axes(0, y), axes(x, y, 0, 3)});
    EXPECT_NEAR(place.distance, std::max(0.0, wanted), kAccuracy);
    EXPECT_EQ(place.first + " and " + place.second, "wheel and collet");
    EXPECT_EQ(place.leg, 2u);
    if (wanted > 0) {
      EXPECT_NEAR(place.axes[kX], x, 1e-5);
      EXPECT_NEAR(place.axes[kA], 3, 1e-3);
    }
  }
}

/// The wheel stands at (X, D1/2 + Dw/2 + Y, h + Z) of the cutter's frame, its axis along (-sin s, 0, cos s).
TEST(CollisionCheck, AgreesWithBruteForceAlongAnyStroke) {
  auto between = test_support::numbers(5);
  Shape collet;
  collet.pose = Translation3d(0.0735, 0, 0) * AngleAxisd(90 * kDegree, Vector3d::UnitY());
  collet.radius = 0.021;
  collet.half_length = 0.0115;
  for (int i = 0; i < 6; ++i) {
    const double swivel = (i % 2 ? -1 : 1) * between(0, 89) * kDegree;
    const double height = between(-0.02, 0.02);
    const Axes from = axes(between(-0.02, 0.01), between(-0.002, 0.02), between(-0.01, 0.01));
    const Axes to = axes(between(0.01, 0.05), between(-0.002, 0.03), between(-0.01, 0.01), between(-20, 20));
    const double expected = minOf(
        0, 1,
        [&](double part) {
          const Axes at = (1 - part) * from + part * to;
          return wheelAt({at[kX], 0.055 + at[kY], height + at[kZ]}, swivel, 0.05, 0.006).distance(collet, 1e-7);
        },
        1e-6);
    EXPECT_NEAR(closestOf(SmallMachine().urdf(), plainJob(swivel, height), {from, to}).distance, expected, kAccuracy)
        << i;
  }
}

/// Many legs, all pairs of the shipped machine, angled wheels: the closest of close positions all along the path.
TEST(CollisionCheck, AgreesWithManyPositionsOfAPath) {
  auto between = test_support::numbers(9);
  const MachineShapes machine = shippedShapes();
  int apart = 0;
  for (int i = 0; i < 6; ++i) {
    CollisionJob job = plainJob(between(-50, 50) * kDegree, between(-0.01, 0.01));
    job.wheel = WheelProfile::angled(0.1, 0.008, between(-40, 40) * kDegree, {0.0005, 0.001});
    job.shank_from = between(0.03, 0.08);
    const CollisionCheck check(machine, job);
    std::vector<Axes> path{axes(-0.05, 0.05)};
    for (int leg = 0; leg < 8; ++leg)
      path.push_back(axes(between(-0.03, 0.03), between(0, 0.06), between(-0.01, 0.02)));
    double sampled = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 200;
    double longest = 0;
    for (std::size_t leg = 0; leg + 1 < path.size(); ++leg) {
      const double step = (path[leg + 1] - path[leg]).head<3>().matrix().norm() / kSteps;
      longest = std::max(longest, step);
      for (const CollisionCheck::Pair& pair : check.pairs()) {
        for (int k = 0; k <= kSteps && sampled > 0;) {
          Vector3d at = ((kSteps - k) * path[leg] + k * path[leg + 1]).head<3>().matrix() / kSteps;
          at.z() += job.setup.height;
          const double distance = gap(pair.first, pair.second, pair.motion * at).distance;
          sampled = std::min(sampled, distance);
          // A distance falls by no more than what is moved.
          k += std::max(1, static_cast<int>((distance - sampled) / step));
        }
      }
    }
    const double found = check.closest(path).distance;
    EXPECT_LE(found, sampled + kAccuracy) << i;
    EXPECT_GE(found, sampled - longest / 2 - kAccuracy) << i;
    apart += found > 0;
  }
  EXPECT_GT(apart, 2);
}

TEST(CollisionCheck, TheFlangeIsInTheWayOfCutterAndShank) {
  SmallMachine small;
  small.wheel = SmallMachine::cylinder("flange", "0 0 0.0065", "0 0 0", 0.049, 0.006);
  CollisionJob job = plainJob();
  job.wheel = WheelProfile::straight(0.09, 0.006);
  for (const auto& [flute_end, body] : {std::pair{0.02, "cutter"}, {0.001, "shank"}}) {
    job.cutter.flute_length = flute_end;
    job.shank_from = flute_end;
    const ClosestPlace place = closestOf(small.urdf(), job, {axes(0.01, 0.05), axes(0.01, -0.0008)});
    EXPECT_NEAR(place.distance, std::hypot(0.055 - 0.0008 - 0.049, 0.0035) - 0.005, kAccuracy);
    EXPECT_EQ(place.first + " and " + place.second, std::string("flange and ") + body);
  }
}

TEST(CollisionCheck, AWheelMayBeTooLargeForItsOwnHead) {
  CollisionJob job = plainJob(20 * kDegree);
  job.wheel = WheelProfile::straight(0.1632, 0.006);
  job.nominal_radius = 0.0816;
  const ClosestPlace place = closestOf(shippedUrdf(), job, {axes(-0.05, 0.05), axes(-0.05, 0.06)});
  EXPECT_NEAR(place.distance, 0.082 - 0.0816, kAccuracy);
  EXPECT_EQ(place.first + " and " + place.second, "wheel and swivel");
}

/// A straight flute of 1.6 mm in a cylinder of 10 mm: the rim leaves the shank in the plane Z = 0.
TEST(CollisionCheck, TheRunOutEndsWhereTheWheelIsClearOfTheShank) {
  CollisionJob job = plainJob();
  job.stroke_end = axes(0.021, -0.0016);
  for (const double shank_radius : {0.004, 0.005, 0.006}) {
    job.shank_diameter = 2 * shank_radius;
    const double across = 0.055 - 0.0016 - shank_radius;
    const double expected = 0.021 + std::sqrt(0.05102 * 0.05102 - across * across);
    EXPECT_NEAR(runOutEnd(job), expected, 1e-5) << shank_radius;
  }
}

TEST(CollisionCheck, RefusesWhatIsNoFigureAndAMachineThatDoesNotHoldTheCutter) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MachineShapes machine = shapesOf(SmallMachine().urdf());
  const auto broken = [&](const auto& change) {
    CollisionJob job = plainJob();
    change(job);
    EXPECT_THROW(CollisionCheck(machine, job), std::invalid_argument);
  };
  broken([&](CollisionJob& job) { job.setup.swivel = nan; });
  broken([&](CollisionJob& job) { job.setup.height = nan; });
  broken([&](CollisionJob& job) { job.nominal_radius = nan; });
  broken([&](CollisionJob& job) { job.shank_diameter = 0; });
  broken([&](CollisionJob& job) { job.shank_from = nan; });
  broken([&](CollisionJob& job) { job.stroke_end[kY] = nan; });
  broken([&](CollisionJob& job) { job.clearance = -1; });
  broken([&](CollisionJob& job) { job.work_clearance = nan; });
  broken([&](CollisionJob& job) { job.x_offset = nan; });
  broken([&](CollisionJob& job) { job.cutter.end_diameter = nan; });
  const CollisionCheck check(machine, plainJob());
  EXPECT_THROW(check.closest({}), std::invalid_argument);
  EXPECT_THROW(check.closest({axes(0, 0), axes(nan, 0)}), std::invalid_argument);
  EXPECT_THROW(check.tooCloseToWork({axes(0, 0), axes(nan, 0)}, {true}), std::invalid_argument);
  EXPECT_THROW(check.tooCloseToWork({axes(0, 0), axes(1e-3, 0)}, {}), std::invalid_argument);
  SmallMachine without_holder;
  without_holder.cutter = "";
  EXPECT_THROW(CollisionCheck(shapesOf(without_holder.urdf()), plainJob()), std::invalid_argument);
}

}  // namespace test_collision_check
}  // namespace grinder
