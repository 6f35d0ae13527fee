#include "flute_grinder/motion/feed_schedule.h"

#include "curve/reference.h"
#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace grinder {
namespace test_feed_schedule {

using namespace test_support;

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// A cutter that comes to a thin end: a 1 mm tip on a 12 deg cone.
Cone thinCutter() { return {1e-3, 12 * units::kDegree, 45 * units::kDegree, 8 * units::kDegree, 20e-3}; }

/// Of its curve A = a ln(1 + bX): b, k = a b, and u = 1 + bX where plainStroke() begins.
const double kThinB = std::tan(12 * units::kDegree) / 0.5e-3, kThinK = std::tan(45 * units::kDegree) / 0.5e-3;
const double kThinU = 1 - 0.5e-3 * kThinB;

/// Limits that hinder nothing.
Machine boundless() {
  Machine m = plainMachine();
  m.limits.max_velocity.setConstant(1e6);
  m.limits.max_acceleration.setConstant(1e12);
  m.limits.max_jerk.setConstant(1e18);
  return m;
}

FeedSchedule::Stroke plainStroke(double feed = 0.01) { return {-0.5e-3, 20e-3, feed, 1e-3}; }

/// A cutter, a stroke along it either way, and a machine.
struct Case {
  Cone cutter;
  FeedSchedule::Stroke stroke;
  Machine machine;

  static Case draw() {
    Case c;
    c.cutter = *test_support::cone();
    c.machine = *test_support::machine();
    double from = -test_support::openLength(c.cutter, -1, *uniform(0, 2e-3));
    double to = c.cutter.flute_length;
    if (*rc::gen::arbitrary<bool>()) std::swap(from, to);
    c.stroke = {from, to, *test_support::logUniform(1e-3, 0.1), *test_support::logUniform(0.1e-6, 1e-3)};
    return c;
  }

  FeedSchedule schedule() const { return FeedSchedule(ConicalCutter(cutter), stroke, machine); }
};

/// Where the axes are at X, by the paper's equations. [m], A [rad]
struct Pose {
  Real axis[kAxisCount];
};

Pose poseAt(const Cone& g, const ReferenceCurve& curve, Real x) {
  const Real y = x * std::tan(Real(g.cone_angle));
  return {{x, y, y * test_support::zPerY(g), curve.a(x)}};
}

/// The worst of velocity, acceleration and jerk over their limits, by differences of the axes over the time `h` between
/// the places given; what rounding of X makes of the differences is let pass.
struct Excess {
  double worst = 0;
  std::string what;
};

Excess excessOf(const Case& c, const std::vector<double>& xs, double h) {
  const ReferenceCurve curve(c.cutter);
  const AxisLimits& l = c.machine.limits;
  const Real x_noise = 2 * kEps * std::max(std::abs(c.stroke.from), std::abs(c.stroke.to));
  std::vector<Pose> poses;
  for (const double x : xs) poses.push_back(poseAt(c.cutter, curve, x));
  Excess result;
  const auto see = [&](const char* what, int axis, Real value, Real limit, Real noise) {
    const auto excess = static_cast<double>((std::abs(value) - noise) / limit);
    if (excess <= result.worst) return;
    result.worst = excess;
    result.what = std::string(kJointNames[static_cast<std::size_t>(axis)]) + " " + what;
  };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Real per_x[kAxisCount]{1, 1, 1, std::abs(curve.slope(xs[i])) * Real(1.2) + 1};
    for (int axis = 0; axis < kAxisCount; ++axis) {
      const auto p = [&](std::size_t back) { return poses[i - back].axis[axis]; };
      const Real noise = x_noise * per_x[axis];
      if (i >= 1) see("velocity", axis, (p(0) - p(1)) / h, l.max_velocity[axis], 2 * noise / h);
      if (i >= 2)
        see("acceleration", axis, (p(0) - 2 * p(1) + p(2)) / (h * h), l.max_acceleration[axis], 4 * noise / (h * h));
      if (i >= 3)
        see("jerk", axis, (p(0) - 3 * p(1) + 3 * p(2) - p(3)) / (h * h * h), l.max_jerk[axis], 8 * noise / (h * h * h));
    }
  }
  return result;
}

RC_GTEST_PROP(FeedScheduleProperty, GoesOneWayOnlyFromOneEndOfTheStrokeExactlyToTheOther, ()) {
  const Case c = Case::draw();
  const FeedSchedule schedule = c.schedule();
  const double from = c.stroke.from, to = c.stroke.to, length = schedule.length();
  RC_ASSERT(schedule.x(0) == from);
  RC_ASSERT(schedule.x(length) == to);
  RC_ASSERT(length >= std::abs(to - from) * (1 - 4 * kEps));
  const double before_the_end = schedule.x(length * (1 - 2 * kEps));
  RC_ASSERT(std::abs(before_the_end - to) <= 1e-14 * std::abs(to - from) + 8 * kEps * (std::abs(from) + std::abs(to)));
  const double direction = to > from ? 1 : -1;
  const int steps = *whole(1000, 3000);
  for (int i = 1; i <= steps; ++i) {
    RC_ASSERT(direction * (schedule.x(length * i / steps) - schedule.x(length * (i - 1) / steps)) > 0);
    const double rate = schedule.rate(length * i / steps);
    RC_ASSERT(rate > 0);
    RC_ASSERT(rate <= 1 + 4 * kEps);
  }
  RC_ASSERT(schedule.rate(0) > 0);
  RC_ASSERT(schedule.rate(0) <= 1 + 4 * kEps);
}

RC_GTEST_PROP(FeedScheduleProperty, RateIsTheDerivativeOfX, ()) {
  const Case c = Case::draw();
  const FeedSchedule schedule = c.schedule();
  const double direction = c.stroke.to > c.stroke.from ? 1 : -1;
  const double h = schedule.length() * 1e-4;
  for (int i = 0; i < 100; ++i) {
    const double s = h + (schedule.length() - 2 * h) * (i + 0.5) / 100;
    const double derivative = direction * (schedule.x(s + h) - schedule.x(s - h)) / (2 * h);
    const double low = std::min(schedule.rate(s - h), schedule.rate(s + h));
    const double high = std::max(schedule.rate(s - h), schedule.rate(s + h));
    const double noise = 1e-9;
    // A mean of a rate that only rises, or only falls, over the interval; the blend may lie within.
    RC_ASSERT(derivative >= low - noise);
    RC_ASSERT(derivative <= high + noise);
    RC_ASSERT(high - low <= 0.1);
  }
}

RC_GTEST_PROP(FeedScheduleProperty, AFeedThatNoAxisHindersIsNotCutAtAll, ()) {
  Case c = Case::draw();
  c.machine.limits = boundless().limits;
  c.machine.period = 1e-6;
  c.stroke.tolerance = 1e-3;
  const FeedSchedule schedule = c.schedule();
  RC_ASSERT(schedule.feedLimits().empty());
  const double edge = test_support::edgePerTravel(c.cutter);
  const double feed = c.stroke.surface_feed;
  RC_ASSERT(std::abs(schedule.feedSpeed() * edge - feed) <= 4 * kEps * feed);
  RC_ASSERT(std::abs(schedule.limits().velocity * edge - 1.2 * feed) <= 8 * kEps * feed);
  RC_ASSERT(std::abs(schedule.length() - std::abs(c.stroke.to - c.stroke.from)) <= 4 * kEps * schedule.length());
  for (int i = 0; i <= 20; ++i) RC_ASSERT(schedule.rate(schedule.length() * i / 20) == 1);
}

RC_GTEST_PROP(FeedScheduleProperty, ReportsWhereAHoldsTheFeedBack, ()) {
  Case c = Case::draw();
  c.machine.limits.max_velocity[kA] *= *test_support::logUniform(0.01, 1);
  const FeedSchedule schedule = c.schedule();
  const bool forward = c.stroke.to > c.stroke.from;
  const auto ahead = [&](double x, double of) { return forward ? x > of : x < of; };
  for (const FeedLimit& cut : schedule.feedLimits()) {
    RC_ASSERT(ahead(cut.to_x, cut.from_x));
    RC_ASSERT(!ahead(c.stroke.from, cut.from_x));
    RC_ASSERT(!ahead(cut.to_x, c.stroke.to));
  }
  bool slower = false;
  for (int i = 0; i <= 1000; ++i) slower = slower || schedule.rate(schedule.length() * i / 1000) < 1 - 1e-6;
  RC_PRE(slower);  // and not next to a cylinder, which is as thin everywhere
  const FeedLimit& cut = schedule.feedLimits().back();
  RC_ASSERT(cut.from_x == c.stroke.from || cut.to_x == c.stroke.to);
  const double range = cut.to_x - cut.from_x;
  // The feed nears the full one evenly where the cut ends, and is all but there in the last part of the range.
  const bool ends_early = cut.to_x != c.stroke.to;
  const bool begins_late = cut.from_x != c.stroke.from;
  for (int i = 0; i <= 1000; ++i) {
    const double s = schedule.length() * i / 1000;
    const double x = schedule.x(s);
    const double from = cut.from_x + (begins_late ? 0.1 : 0) * range;
    const double to = cut.to_x - (ends_early ? 0.1 : 0) * range;
    if (ahead(x, from) && ahead(to, x)) RC_ASSERT(schedule.rate(s) < 1);
    const double rounding = 1e-12 * range;
    if (ahead(cut.from_x - rounding, x) || ahead(x, cut.to_x + rounding)) RC_ASSERT(schedule.rate(s) >= 1 - 4 * kEps);
  }
}

RC_GTEST_PROP(FeedScheduleProperty, TheRunUpIsTheWayToTheFeedFromRest, ()) {
  const FeedSchedule schedule = Case::draw().schedule();
  const MotionLimits l = schedule.limits();
  const double speed = schedule.feedSpeed();
  SCurveProfile law(l, 1e3 * (schedule.runUp() + schedule.length()), speed);
  // Time is cut until the law has just come to its speed.
  const double all_of_it = speed / l.acceleration + 2 * std::sqrt(speed / l.jerk) + l.acceleration / l.jerk;
  for (int i = 0; i < 100000 && !law.cruising(); ++i) law.advance(all_of_it / 10000);
  RC_ASSERT(law.cruising());
  RC_ASSERT(law.position() >= schedule.runUp() * (1 - 1e-9));
  RC_ASSERT(law.position() <= schedule.runUp() * (1 + 1e-9) + speed * all_of_it / 10000 * (1 + 1e-9));
}

TEST(FeedSchedule, TurnsAEvenlyAtItsLimitWhereThatCutsTheFeed) {
  Machine machine = boundless();
  machine.period = 1e-4;
  for (const double limit : {0.5, 2.0, 5.0}) {  // 0.01 m/s / 1.43 makes 15 rad/s at the tip, 2 rad/s at the shank
    SCOPED_TRACE(limit);
    machine.limits.max_velocity[kA] = limit;
    const FeedSchedule schedule(ConicalCutter(thinCutter()), plainStroke(), machine);
    const ReferenceCurve curve(thinCutter());
    const auto a_speed = [&](double s) {
      return schedule.limits().velocity * schedule.rate(s) * static_cast<double>(curve.slope(schedule.x(s)));
    };
    EXPECT_LE(a_speed(0), limit);
    EXPECT_GE(a_speed(0), 0.99 * limit) << "but for the ripple of the odd-even steps";
    EXPECT_NEAR(a_speed(0.5e-3), a_speed(0), 1e-9 * limit);
    EXPECT_NEAR(a_speed(1e-3), a_speed(0), 1e-9 * limit);
    EXPECT_LT(schedule.rate(0), 0.5);
    EXPECT_EQ(schedule.rate(schedule.length()), 1);
  }
}

/// On a turn at constant speed of X, half of A's acceleration is for k b (v/u)^2 of the path, and a tenth of its jerk
/// for 2 k b^2 (v/u)^3; the rest is for the feed law and the blend.
TEST(FeedSchedule, TurnsAWithItsShareOfAccelerationAndJerk) {
  const double b = kThinB, k = kThinK;
  for (const bool by_jerk : {false, true}) {
    SCOPED_TRACE(by_jerk);
    Machine machine = boundless();
    (by_jerk ? machine.limits.max_jerk : machine.limits.max_acceleration)[kA] = 1;
    const FeedSchedule schedule(ConicalCutter(thinCutter()), plainStroke(), machine);
    const double v_per_u = schedule.limits().velocity * schedule.rate(0) / kThinU;
    const double share = by_jerk ? 2 * k * b * b * std::pow(v_per_u, 3) : k * b * v_per_u * v_per_u;
    EXPECT_NEAR(share, by_jerk ? 0.1 : 0.5, 1e-9);
  }
}

/// Where nothing cuts the feed, the path may take half as much again as its jerk of 2 k b^2 (v/u)^3, and the feed law's
/// acceleration a quarter of the limit.
TEST(FeedSchedule, LeavesTheFeedLawWhatThePathDoesNotTakeOfTheJerkOfA) {
  const double b = kThinB, k = kThinK, u = kThinU;
  const double v = 1.2 * 0.01 / test_support::edgePerTravel(thinCutter());
  Machine machine = boundless();
  machine.period = 1e-7;
  const double path = 3 * k * b * b * std::pow(v / u, 3);
  machine.limits.max_jerk[kA] = 10 * path;
  const FeedSchedule schedule(ConicalCutter(thinCutter()), plainStroke(), machine);
  ASSERT_TRUE(schedule.feedLimits().empty());
  const double left = (10 * path * 3 / 4 - path) / (k / u);
  EXPECT_NEAR(schedule.limits().jerk, left, 1e-9 * left);
}

/// The steps of a pair differ from their mean by b v T/u, at the highest speed that the job or the axis allows.
TEST(FeedSchedule, LeavesWhatTheStepsOfAPairDifferBy) {
  const double b = kThinB, u = kThinU;
  const double asked = 0.01 / test_support::edgePerTravel(thinCutter());
  FeedSchedule::Stroke stroke = plainStroke();
  stroke.tolerance = 1;  // not in the way
  for (const double allowed : {0.9, 1.25}) {
    SCOPED_TRACE(allowed);
    Machine machine = boundless();
    machine.period = 0.02;
    machine.limits.max_velocity[kX] = allowed * asked;
    const FeedSchedule schedule(ConicalCutter(thinCutter()), stroke, machine);
    const double fastest = std::min(allowed, 1.2) * asked;
    const double expected = allowed * asked / (1 + b * fastest * machine.period / u);
    EXPECT_NEAR(schedule.limits().velocity, expected, 1e-9 * expected);
  }
}

/// A chord of d is off the curve of A by k b (d/u)^2 / 2 and, by the next term of the series, b d/u of that.
TEST(FeedSchedule, TakesTheStepsThatTheToleranceAllows) {
  FeedSchedule::Stroke stroke = plainStroke();
  stroke.tolerance = 0.5e-6;
  const ConicalCutter cutter(thinCutter());
  const double b = kThinB, k = kThinK, u = kThinU;
  Machine machine = boundless();
  machine.period = 0.01;
  const FeedSchedule schedule(cutter, stroke, machine);
  ASSERT_EQ(causesOf(schedule.feedLimits()), "interpolation tolerance");
  const double a_error = stroke.tolerance / (0.5e-3 * u * cutter.cosHelixToGeneratrix());
  const double d = u * std::sqrt(2 * a_error / (k * b));
  const double expected = d / (1 + b * d / u) / machine.period;
  EXPECT_NEAR(schedule.feedSpeed(), expected, 1e-9 * expected);
}

TEST(FeedSchedule, CutsTheFeedFurtherWhereXYOrZCannotGainSpeedAsAAllows) {
  // A allows the feed to grow along the cone faster than X may: dv/dt = b c v, and d2v/dt2 = (b c)^2 v. Y and Z follow
  // X in proportion, by tan C and tan C sin r.
  Case c;
  c.cutter = {1e-3, 20 * units::kDegree, 10 * units::kDegree, 8 * units::kDegree, 20e-3};
  c.stroke = {0, 20e-3, 0.01, 1e-3};
  const double growth = std::tan(20 * units::kDegree);
  const double per_x[]{1, growth, growth * std::sin(8 * units::kDegree)};
  const char* const names[]{"axis X", "axis Y", "axis Z"};
  for (const int axis : {kX, kY, kZ}) {
    for (const bool by_jerk : {true, false}) {
      SCOPED_TRACE(names[axis]);
      c.machine = boundless();
      c.machine.limits.max_velocity[kA] = 2.5;
      (by_jerk ? c.machine.limits.max_jerk : c.machine.limits.max_acceleration)[axis] =
          (by_jerk ? 0.1 : 0.02) * per_x[axis];
      const FeedSchedule schedule = c.schedule();
      EXPECT_EQ(causesOf(schedule.feedLimits()), std::string(names[axis]) + (by_jerk ? " jerk" : " acceleration"));
      // Half of the acceleration, or a quarter of the jerk, is for that growth; of the jerk a quarter more is for the
      // feed law's acceleration on it, 3 b c dv/dt.
      const double v = schedule.limits().velocity, b_c = growth / 0.5e-3 * v * schedule.rate(0);
      const double share = by_jerk ? 0.1 / 4 : 0.02 / 2;
      EXPECT_NEAR(by_jerk ? b_c * b_c * v : b_c * v, share, 1e-9 * share);
      EXPECT_NEAR(schedule.limits().acceleration, by_jerk ? share / (3 * b_c) : share, 1e-9);
      EXPECT_GT(schedule.limits().jerk, 0);
      if (by_jerk) {
        EXPECT_NEAR(schedule.limits().jerk, 0.1 / 2, 1e-9);
      }
      std::vector<double> xs;
      const double h = 2e-3;
      for (double s = 0; s < schedule.length(); s += h * schedule.limits().velocity) xs.push_back(schedule.x(s));
      const Excess excess = excessOf(c, xs, h);
      EXPECT_LE(excess.worst, 1 + 1e-6) << excess.what;
    }
  }
}

/// X reaches its full feed by a parabola of the rate, whose jerk is a quarter of what X or A may have.
TEST(FeedSchedule, BlendsIntoTheFullFeedWithAQuarterOfTheJerk) {
  constexpr double kJerk = 20;
  for (const int axis : {kX, kA}) {
    SCOPED_TRACE(axis);
    Machine machine = boundless();
    machine.limits.max_velocity[kA] = 5;
    const FeedSchedule free(ConicalCutter(thinCutter()), plainStroke(), machine);
    const double end = free.feedLimits().back().to_x;
    const double turn = std::abs(static_cast<double>(ReferenceCurve(thinCutter()).slope(end)));
    machine.limits.max_jerk[axis] = kJerk * (axis == kA ? turn : 1);
    const FeedSchedule schedule(ConicalCutter(thinCutter()), plainStroke(), machine);
    ASSERT_EQ(causesOf(schedule.feedLimits()), "axis A velocity");
    double full = 0;
    for (double step = schedule.length() / 2; step > 1e-15; step /= 2) {
      if (schedule.x(full + step) < schedule.feedLimits().back().to_x) full += step;
    }
    const double before = 1e-6, v = schedule.limits().velocity;
    const double jerk = 2 * (1 - schedule.rate(full - before)) / (before * before) * v * v * v;
    EXPECT_NEAR(jerk, kJerk / 4, 0.01 * kJerk);
  }
}

TEST(FeedSchedule, ReportsEveryCauseWithItsRange) {
  // X allows half of what is asked for, all along; A allows 5 rad/s, and so v = 5 rad/s R / tan S: 2.5 mm/s at the tip,
  // and as much as X where the radius is v tan S / 5 rad/s.
  Machine machine = boundless();
  const double asked = 0.01 / test_support::edgePerTravel(thinCutter());
  machine.limits.max_velocity[kX] = asked / 2;
  machine.limits.max_velocity[kA] = 5;
  machine.period = 1e-6;
  for (const bool backward : {false, true}) {
    FeedSchedule::Stroke stroke = plainStroke();
    if (backward) std::swap(stroke.from, stroke.to);
    const FeedSchedule schedule(ConicalCutter(thinCutter()), stroke, machine);
    ASSERT_EQ(causesOf(schedule.feedLimits()), "axis X velocity, axis A velocity");
    const FeedLimit& along = schedule.feedLimits()[0];
    const FeedLimit& tip = schedule.feedLimits()[1];
    EXPECT_EQ(along.from_x, stroke.from);
    EXPECT_EQ(along.to_x, stroke.to);
    const double end = (asked / 2 / 5 - 0.5e-3) / std::tan(12 * units::kDegree);
    EXPECT_EQ(backward ? tip.to_x : tip.from_x, -0.5e-3);
    EXPECT_NEAR(backward ? tip.from_x : tip.to_x, end, 0.01e-3);
  }
}

TEST(FeedSchedule, LeavesTheOverrideWhatAAllows) {
  Machine machine = boundless();
  machine.period = 1e-7;
  const double asked = 0.01 / test_support::edgePerTravel(thinCutter());
  const auto turn = static_cast<double>(ReferenceCurve(thinCutter()).slope(-0.5e-3));
  machine.limits.max_velocity[kA] = 1.1 * asked * std::abs(turn);
  const FeedSchedule schedule(ConicalCutter(thinCutter()), plainStroke(), machine);
  EXPECT_TRUE(schedule.feedLimits().empty());
  EXPECT_NEAR(schedule.feedSpeed(), asked, 1e-9 * asked);
  EXPECT_NEAR(schedule.limits().velocity, 1.1 * asked, 1e-4 * asked);
}

/// Z'' v^2 is of Z's acceleration, and Z''' v^3 + 3 Z'' v a of its jerk, of which the last term takes at most a
/// quarter.
TEST(FeedSchedule, LeavesXWhatTheBendsOfZDoNotTake) {
  FeedSchedule::Stroke stroke = plainStroke();
  ZCorrection& z = stroke.z_correction;
  z.from = stroke.from;
  z.pieces = 4;
  z.piece = (stroke.to - stroke.from) / 4;
  for (std::size_t i = 0; i < 9; ++i) z.coefficients[i] = i % 2 == 0 ? 0.1e-3 : -0.1e-3;
  const ZCorrection::Bounds bends = z.bounds();
  const double cone = std::tan(12 * units::kDegree) * static_cast<double>(zPerY(thinCutter()));
  const double slope = std::max(std::abs(cone + bends.min_first), std::abs(cone + bends.max_first));
  const double v = 1.2 * 0.01 / test_support::edgePerTravel(thinCutter());
  for (const bool by_jerk : {false, true}) {
    SCOPED_TRACE(by_jerk);
    Machine machine = boundless();
    machine.period = 1e-7;
    double& acceleration = machine.limits.max_acceleration[kZ];
    double& jerk = machine.limits.max_jerk[kZ];
    if (!by_jerk) acceleration = 8 * bends.second * v * v;
    const double beside = (acceleration - bends.second * v * v) / slope;
    jerk = 8 * bends.third * v * v * v + (by_jerk ? 0 : 24 * bends.second * v * beside);
    const double left = by_jerk ? jerk / 4 / (3 * bends.second * v) : beside;
    const FeedSchedule schedule(ConicalCutter(thinCutter()), stroke, machine);
    ASSERT_EQ(causesOf(schedule.feedLimits()), "");
    EXPECT_NEAR(schedule.limits().velocity, v, 1e-9 * v);
    EXPECT_NEAR(schedule.limits().acceleration, left, 1e-9 * left);
    const double jerk_left = (jerk - bends.third * v * v * v - 3 * bends.second * v * left) / slope;
    EXPECT_NEAR(schedule.limits().jerk, jerk_left, 1e-9 * jerk_left);
  }
}

TEST(FeedSchedule, NamesWhatLimitsTheFeed) {
  const double x_speed = 0.01 / test_support::edgePerTravel(thinCutter());
  const struct {
    const char* cause;
    Axes AxisLimits::*limits;
    int axis;
    double limit;
  } rows[]{{"axis X velocity", &AxisLimits::max_velocity, kX, x_speed / 2},
           {"axis Y velocity", &AxisLimits::max_velocity, kY, x_speed / 10},
           {"axis Z velocity", &AxisLimits::max_velocity, kZ, x_speed / 100},
           {"axis A velocity", &AxisLimits::max_velocity, kA, 1},
           {"axis A acceleration", &AxisLimits::max_acceleration, kA, 1},
           {"axis A jerk", &AxisLimits::max_jerk, kA, 1}};
  for (const auto& row : rows) {
    Machine machine = boundless();
    (machine.limits.*row.limits)[row.axis] = row.limit;
    EXPECT_EQ(causesOf(FeedSchedule(ConicalCutter(thinCutter()), plainStroke(), machine).feedLimits()), row.cause);
  }
  // On a core taper Y goes with X by tan 12 deg + 0.5.
  FeedSchedule::Stroke tapered = plainStroke();
  tapered.taper = 0.5;
  Machine machine = boundless();
  machine.limits.max_velocity[kY] = 0.6 * x_speed;
  EXPECT_EQ(causesOf(FeedSchedule(ConicalCutter(thinCutter()), tapered, machine).feedLimits()), "axis Y velocity");
  FeedSchedule::Stroke tight = plainStroke();
  tight.tolerance = 1e-9;
  EXPECT_EQ(causesOf(FeedSchedule(ConicalCutter(thinCutter()), tight, boundless()).feedLimits()),
            "interpolation tolerance");
}

}  // namespace test_feed_schedule
}  // namespace grinder
