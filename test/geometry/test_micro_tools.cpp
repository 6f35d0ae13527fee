// The walls of tools much smaller than the wheel's reach along them, against trying every pose of the stroke.

#include "brute_force.h"

#include "flute_grinder/geometry/wheel_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace grinder {
namespace test_micro_tools {

using units::kDegree;
using units::kMillimetre;

/// A right-hand cutter under a wheel, in the shop's units.
struct Tool {
  SetupRequest request;
  double depth, swivel, height, from, to;

  Tool(const brute::Shop& shop, const WheelProfile& profile, double swivel, double height, double from, double to)
      : request(shop.request()),
        depth(shop.depth * kMillimetre),
        swivel(swivel * kDegree),
        height(height * kMillimetre),
        from(from * kMillimetre),
        to((shop.length + to) * kMillimetre) {
    request.wheel = profile;
  }

  WheelSweep sweep() const {
    return {ConicalCutter(request.cutter),
            request.wheel,
            request.nominal_radius,
            {swivel, height},
            {from, to, -depth, 0, 0}};
  }

  /// The end of the arc that the wheel removes of a circle: the farthest of all poses of the stroke.
  /// @param side 1 for the upper end, -1 for the lower one. @return the angle times the side.
  double bruteEnd(double x, double r, int side) const {
    constexpr int kPoses = 1500, kPlaces = 200, kCloser = 14;
    const brute::Bench bench{request, swivel, height, depth, kPoses, kPlaces};
    double step = (to - from) / kPoses;
    double best = -std::numeric_limits<double>::infinity(), best_at = 0;
    const auto tryAll = [&](double first, int count) {
      for (int i = 0; i <= count; ++i) {
        const double at = std::clamp(first + i * step, from, to);
        const double end = bench.endAt(x, r, at, side).angle;
        if (end > best) best = end, best_at = at;
      }
    };
    tryAll(from, kPoses);
    for (int i = 0; i < kCloser; ++i) {
      step /= 6;
      tryAll(best_at - 6 * step, 12);
    }
    return best;
  }
};

struct Compared {
  int walls = 0, rakes = 0;
};

/// Brute force may miss a narrow arc, but never finds one that is not there; where both agree, so must the rake, unless
/// the wall has a corner there.
void compare(const Tool& tool, const std::vector<double>& places, Compared& count) {
  const WheelSweep sweep = tool.sweep();
  const ConicalCutter cutter(tool.request.cutter);
  constexpr double kSame = 1e-3 * kDegree, kExact = 1e-7;
  for (const double part : places) {
    const double x = part * cutter.geometry().flute_length, r = cutter.radius(x), h = 1e-3 * r;
    for (const int side : {1, -1}) {
      SCOPED_TRACE(testing::Message() << "X = " << x / kMillimetre << " mm, side " << side);
      const double expected = tool.bruteEnd(x, r, side);
      const auto wall = sweep.wall(x, r, side > 0);
      if (!std::isfinite(expected)) continue;
      ASSERT_TRUE(wall.has_value());
      ++count.walls;
      EXPECT_GT(side * wall->angle, expected - kSame);
      const double below = tool.bruteEnd(x, r - h, side), above = tool.bruteEnd(x, r + h, side);
      const double corner = std::abs(above - 2 * expected + below) / h * r;
      if (!(std::abs(side * wall->angle - expected) < kExact && corner < 0.01)) continue;
      ++count.rakes;
      EXPECT_NEAR(std::atan(-side * r * wall->slope), std::atan(r * (below - above) / (2 * h)), 0.02 * kDegree);
    }
  }
}

Tool randomTool(std::mt19937& random, int i) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double diameter = uniform(0.1, 1);
  const double cone = i % 3 == 0 ? 0 : uniform(-2, 12), spiral = i % 5 == 0 ? 0 : uniform(-10, 55);
  // On the way to the apex, half of it at most.
  const double open = cone == 0 ? 100 : 0.25 * diameter / std::abs(std::tan(cone * kDegree));
  const double length = cone < 0 ? std::min(uniform(0.5, 6) * diameter, open) : uniform(0.5, 6) * diameter;
  const double wheel = uniform(40, 125), width = i % 2 == 0 ? uniform(0.2, 6) : uniform(0.3, 1) * diameter;
  const double swivel = std::clamp(i % 7 == 0 ? uniform(-60, 60) : spiral + uniform(-8, 12), -60.0, 60.0);
  const double face = diameter / 2 * std::sin(uniform(-10, 30) * kDegree);
  const std::array<double, 2> corners{0.15 * width * kMillimetre, 0.15 * width * kMillimetre};
  const double w = width * kMillimetre, d = wheel * kMillimetre;
  const brute::Shop shop{diameter, cone, spiral, uniform(-5, 20), length, uniform(0.06, 0.28) * diameter, wheel, width};
  const double from = -(cone > 0 ? std::min(uniform(0.1, 3), open) : uniform(0.1, 3));
  const double to = cone < 0 ? std::min(uniform(0.1, 3), open / 2) : uniform(0.1, 3);
  const WheelProfile profile = i % 4 == 0   ? WheelProfile::straight(d, w)
                               : i % 4 == 1 ? WheelProfile::angled(d, w, uniform(5, 40) * kDegree)
                               : i % 4 == 2 ? WheelProfile::straight(d, w, corners)
                                            : WheelProfile::fullRadius(d, w);
  return {shop, profile, swivel, face - width / 2 / std::cos(swivel * kDegree), from, to};
}

TEST(MicroTools, AWallIsWhereEveryPoseOfTheStrokeIsTried) {
  // The rake came out as 27.93, -21.09 or -61.6 deg, depending on X.
  const Tool angled({0.387, 0, 45.938, 16.809, 1.2, 0.0604, 125},
                    WheelProfile::angled(0.125, 0.281e-3, 24.131 * kDegree), 43.952, -0.1218, -0.82, 2.06);
  std::vector<double> sections;
  for (int i = 0; i < 25; ++i) sections.push_back(i / 24.0);
  Compared count;
  compare(angled, sections, count);
  EXPECT_EQ(count.walls, 50);
  EXPECT_GT(count.rakes, 40);
}

TEST(MicroTools, RandomOnesAreMeasuredAsByTryingEveryPose) {
  std::mt19937 random(11);
  Compared count;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    compare(randomTool(random, i), {0.6}, count);
  }
  EXPECT_GT(count.walls, 30);
  EXPECT_GT(count.rakes, 20);
}

}  // namespace test_micro_tools
}  // namespace grinder
