#include "flute_grinder/curve/stroke.h"

#include "curve/generators.h"
#include "reference.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_stroke {

using namespace test_support;

constexpr double kAcceleration = 0.5, kJerk = 50;

std::vector<StrokePoint> all(Stroke& stroke) {
  std::vector<StrokePoint> points;
  for (StrokePoint p; stroke.next(p);) points.push_back(p);
  return points;
}

/// A stroke along a cone, in some thousand cycles.
struct Case {
  Cone cone;
  double from, to;
  StrokeFeed feed;

  static Case draw() {
    const Cone g = *test_support::cone();
    const double thin = std::min(g.end_diameter / 2, g.end_diameter / 2 + g.flute_length * std::tan(g.cone_angle));
    const double apex = thin / std::max(1e-3, std::abs(std::tan(g.cone_angle)));
    const double speed = std::min(g.flute_length * *uniform(0.5, 5), apex / 9e-3);
    Case c{g, g.flute_length * *uniform(0, 0.3), g.flute_length, {speed * edgePerTravel(g), kAcceleration, kJerk}};
    c.feed.rule = *rc::gen::element(EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact);
    if (*rc::gen::arbitrary<bool>()) std::swap(c.from, c.to);
    return c;
  }
  Stroke stroke() const { return Stroke(cone, from, to, feed); }
};

RC_GTEST_PROP(StrokeProperty, IsWhatItsPartsGive, ()) {
  const Case c = Case::draw();
  Stroke stroke = c.stroke();
  const std::vector<StrokePoint> points = all(stroke);
  const ConicalCutter cutter(c.cone);
  OddEvenInterpolator interpolator(LogCurve(cutter), c.feed.rotary_scale, c.feed.rule, c.from);
  const double speed = c.feed.feed / cutter.edgePerTravel();
  SCurveProfile law({speed, kAcceleration, kJerk}, std::abs(c.to - c.from), speed);
  RC_ASSERT(stroke.finished());
  RC_ASSERT(points.front().x == c.from && points.size() % 2 == 1);
  for (std::size_t i = 1; i < points.size(); i += 2) {
    RC_ASSERT(!law.finished());
    law.advance(2 * c.feed.period);
    const double x = c.from + (c.from < c.to ? 1 : -1) * law.position();
    const OddEvenPair pair = interpolator.advance(x - interpolator.position().x);
    RC_ASSERT(points[i].x == pair.odd.x && points[i].a == pair.odd.a);
    RC_ASSERT(points[i + 1].x == pair.even.x && points[i + 1].a == pair.even.a);
  }
  RC_ASSERT(law.finished());
}

RC_GTEST_PROP(StrokeProperty, FollowsTheClosedFormFromEndToEnd, ()) {
  Case c = Case::draw();
  c.feed.rule = EvenStepRule::kExact;
  Stroke stroke = c.stroke();
  const ReferenceCurve curve(c.cone);
  const std::vector<StrokePoint> points = all(stroke);
  const double longest = std::max(std::abs(c.from), std::abs(c.to));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const StrokePoint& p = points[i];
    const Real y = Real(p.x) * std::tan(Real(c.cone.cone_angle));
    RC_ASSERT(std::abs(p.y - y) <= 1e-15L * Real(longest));
    RC_ASSERT(std::abs(p.z - y * zPerY(c.cone)) <= 1e-15L * Real(longest));
    const Real rounding = 1e-14L * (std::abs(curve.a(c.to)) + std::abs(curve.a(c.from)) + 1);
    RC_ASSERT(std::abs(p.error - (curve.a(p.x) - Real(p.a))) <= rounding);
    if (i % 2 == 0) RC_ASSERT(std::abs(curve.a(p.x) - Real(p.a)) <= rounding);
  }
  RC_ASSERT(std::abs(points.back().x - c.to) <= 1e-15 * longest);
}

/// The paper's cutter at 600 mm/min, in cycles of 1 ms.
Stroke papersStroke() { return Stroke(paperCone(), 0, 30e-3, {0.010, kAcceleration, kJerk}); }

// With the edge's length in space between two even points, of which it is next to the chord.
TEST(Stroke, RunsAtTheFeedAlongTheEdge) {
  Stroke stroke = papersStroke();
  const std::vector<StrokePoint> points = all(stroke);
  const auto place = [](const StrokePoint& p) {
    const double r = 5e-3 + p.x * std::tan(5 * units::kDegree);
    return Eigen::Vector3d(p.x, r * std::cos(p.a), r * std::sin(p.a));
  };
  for (std::size_t i = 400; i < 3000; i += 200) {
    EXPECT_NEAR((place(points[i + 2]) - place(points[i])).norm() / 2e-3, 0.010, 1e-8) << i;
  }
}

TEST(Stroke, HeldItRestsOnTheCurveAndGoesOnFromThere) {
  Stroke stroke = papersStroke();
  const ReferenceCurve curve(paperCone());
  StrokePoint p;
  while (p.x < 15e-3) ASSERT_TRUE(stroke.next(p));
  stroke.setFeedOverride(0);
  const StrokePoint held = all(stroke).back();
  EXPECT_LE(std::abs(curve.a(held.x) - Real(held.a)), 1e-9L);
  // Braking from v within the jerk: v sqrt(v / j).
  const double v = 0.010 / edgePerTravel(paperCone());
  EXPECT_NEAR(held.x - p.x, v * std::sqrt(v / kJerk), 2e-3 * v);
  EXPECT_FALSE(stroke.finished());
  EXPECT_FALSE(stroke.next(p));
  for (const double not_taken : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    stroke.setFeedOverride(not_taken);
    EXPECT_FALSE(stroke.next(p)) << not_taken;
  }
  stroke.setFeedOverride(0.5);
  const std::vector<StrokePoint> onward = all(stroke);
  EXPECT_NEAR(onward.front().x, held.x, 1e-6);
  EXPECT_NEAR(onward.back().x, 30e-3, 1e-17);
  double fastest = 0;
  for (std::size_t i = 2; i < onward.size(); i += 2) fastest = std::max(fastest, onward[i].x - onward[i - 2].x);
  EXPECT_NEAR(fastest / 2e-3, v / 2, 1e-9);
}

std::string refusalOf(double from, double to, const StrokeFeed& feed) {
  return test_support::refusalOf<std::invalid_argument>([&] { Stroke(paperCone(), from, to, feed); });
}

TEST(Stroke, RefusesWhatItCannotRun) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto names = [](const char* name, double from, double to, const StrokeFeed& feed) {
    return refusalOf(from, to, feed).find("stroke: " + std::string(name) + " = ") == 0;
  };
  const double apex = -5e-3 / std::tan(5 * units::kDegree);
  EXPECT_EQ(refusalOf(0, 30e-3, {0.01, kAcceleration, kJerk}), "");
  EXPECT_TRUE(names("from", 1.001 * apex, 30e-3, {0.01, kAcceleration, kJerk}));
  EXPECT_TRUE(names("to", 0, kNan, {0.01, kAcceleration, kJerk}));
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(names("feed", 0, 30e-3, {bad, kAcceleration, kJerk}));
    EXPECT_TRUE(names("acceleration", 0, 30e-3, {0.01, bad, kJerk}));
    EXPECT_TRUE(names("jerk", 0, 30e-3, {0.01, kAcceleration, bad}));
    EXPECT_TRUE(names("period", 0, 30e-3, {0.01, kAcceleration, kJerk, bad}));
    StrokeFeed feed{0.01, kAcceleration, kJerk};
    feed.rotary_scale = bad;
    EXPECT_TRUE(names("rotary_scale", 0, 30e-3, feed));
  }
  // An eighth of the way to the apex within a cycle.
  const double fastest = -apex / 8 / 1e-3 * edgePerTravel(paperCone());
  EXPECT_EQ(refusalOf(0, 30e-3, {0.999 * fastest, kAcceleration, kJerk}), "");
  EXPECT_TRUE(names("feed", 0, 30e-3, {1.001 * fastest, kAcceleration, kJerk}));
}

}  // namespace test_stroke
}  // namespace grinder
