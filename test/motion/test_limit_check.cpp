#include "flute_grinder/motion/limit_check.h"

#include "generators.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grinder {
namespace test_limit_check {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kPeriod = 1.0 / 1024;  // exact in binary, as are the limits below

AxisLimits plainLimits() {
  AxisLimits l;
  l.min_position << -0.25, -0.5, -0.125, -16;
  l.max_position << 0.5, 0.25, 0.25, 32;
  l.max_velocity << 0.125, 0.25, 0.5, 8;
  l.max_acceleration << 1, 2, 4, 64;
  l.max_jerk << 64, 128, 256, 4096;
  return l;
}

/// Feeds positions of one axis to a check, the others at rest at zero.
class Feeder {
 public:
  explicit Feeder(int axis, const AxisLimits& limits = plainLimits()) : axis_(axis), check_(limits, kPeriod) {}

  std::optional<LimitViolation> feed(double position) {
    Setpoint p;
    p.cycle = cycle_++;
    p.position[axis_] = position;
    p.move = MoveKind::kStroke;
    return check_.check(p);
  }

  /// The first violation of a course of positions.
  std::optional<LimitViolation> feedAll(const std::vector<double>& positions) {
    for (const double position : positions) {
      if (auto violation = feed(position)) return violation;
    }
    return std::nullopt;
  }

  LimitCheck& check() { return check_; }

 private:
  int axis_;
  LimitCheck check_;
  std::uint64_t cycle_ = 0;
};

/// Pair ends, with points half way between.
std::vector<double> withMiddles(const std::vector<double>& ends) {
  std::vector<double> positions{ends.front()};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    positions.push_back((ends[i - 1] + ends[i]) / 2);
    positions.push_back(ends[i]);
  }
  return positions;
}

void expectViolation(const std::optional<LimitViolation>& found, int axis, LimitedQuantity quantity, double value,
                     double limit, double noise = 0) {
  ASSERT_TRUE(found);
  EXPECT_EQ(found->axis, axis);
  EXPECT_EQ(found->quantity, quantity);
  EXPECT_NEAR(found->value, value, noise);
  EXPECT_EQ(found->limit, limit);
}

class LimitCheckAxis : public ::testing::TestWithParam<int> {};

TEST_P(LimitCheckAxis, LetsPassTheEndsOfItsRangeAndCatchesWhatIsBeyond) {
  const int axis = GetParam();
  const AxisLimits l = plainLimits();
  for (const double end : {l.max_position[axis], l.min_position[axis]}) {
    // A stroke that is begun again may end there by other sums.
    for (const double at : {end, std::nextafter(end, kInf), std::nextafter(end, -kInf)})
      EXPECT_FALSE(Feeder(axis).feed(at));
    const double beyond = end * (1 + 1e-12);
    expectViolation(Feeder(axis).feed(beyond), axis, LimitedQuantity::kPosition, beyond, end);
  }
}

TEST_P(LimitCheckAxis, CatchesWhatIsNotFinite) {
  const int axis = GetParam();
  for (const double bad : {kNan, kInf, -kInf}) {
    SCOPED_TRACE(bad);
    for (const std::vector<double>& before : {std::vector<double>{}, {0, 0, 0}}) {
      Feeder feeder(axis);
      EXPECT_FALSE(feeder.feedAll(before));
      const auto violation = feeder.feed(bad);
      ASSERT_TRUE(violation);
      EXPECT_EQ(violation->axis, axis);
      EXPECT_EQ(violation->quantity, LimitedQuantity::kNotFinite);
      EXPECT_EQ(violation->cycle, before.size());
      EXPECT_NE(text(reasonOf(*violation)).find("is not a finite number"), std::string::npos);
      EXPECT_EQ(reasonOf(*violation).unit, unitOf(axis, 0));
    }
  }
}

TEST_P(LimitCheckAxis, LetsPassAndCatchesSpeed) {
  const int axis = GetParam();
  AxisLimits l = plainLimits();
  l.max_acceleration.setConstant(1e9);
  l.max_jerk.setConstant(1e12);
  const double v = l.max_velocity[axis];
  EXPECT_FALSE(Feeder(axis, l).feedAll({0, v * kPeriod, 2 * v * kPeriod, v * kPeriod, 0}));
  const double faster = v * (1 + 1e-6);
  const auto violation = Feeder(axis, l).feedAll({0, 0, 0, -faster * kPeriod});
  expectViolation(violation, axis, LimitedQuantity::kVelocity, -faster, v, 1e-12);
  EXPECT_EQ(reasonOf(*violation).unit, unitOf(axis, 1));
  EXPECT_EQ(violation->cycle, 3u);
}

TEST_P(LimitCheckAxis, LetsPassAndCatchesAccelerationOfPairEnds) {
  const int axis = GetParam();
  AxisLimits l = plainLimits();
  l.max_velocity.setConstant(1e9);
  l.max_jerk.setConstant(1e12);
  const double pair = 2 * kPeriod;
  const double a = l.max_acceleration[axis];
  // p = a t^2 / 2 sampled gives second differences a pair^2 exactly.
  const auto course = [&](double acceleration) {
    std::vector<double> ends{0, 0, 0};
    for (int i = 1; i < 5; ++i) ends.push_back(acceleration * pair * pair * i * i / 2);
    return withMiddles(ends);
  };
  EXPECT_FALSE(Feeder(axis, l).feedAll(course(a)));
  EXPECT_FALSE(Feeder(axis, l).feedAll(course(-a)));
  const auto violation = Feeder(axis, l).feedAll(course(-a * (1 + 1e-6)));
  expectViolation(violation, axis, LimitedQuantity::kAcceleration, -a * (1 + 1e-6), a, 1e-9 * a);
  EXPECT_EQ(violation->cycle % 2, 0u);
}

TEST_P(LimitCheckAxis, LetsPassAndCatchesJerkOfPairEnds) {
  const int axis = GetParam();
  AxisLimits l = plainLimits();
  l.max_velocity.setConstant(1e9);
  l.max_acceleration.setConstant(1e9);
  const double pair = 2 * kPeriod;
  const double j = l.max_jerk[axis];
  // p = j t (t^2 - pair^2) / 6 has third differences j pair^3 exactly, from rest at -pair, 0 and pair.
  const auto course = [&](double jerk) {
    std::vector<double> ends{0, 0, 0};
    for (int i = 2; i < 6; ++i) ends.push_back(jerk * pair * pair * pair * i * (i * i - 1) / 6);
    return withMiddles(ends);
  };
  EXPECT_FALSE(Feeder(axis, l).feedAll(course(j)));
  EXPECT_FALSE(Feeder(axis, l).feedAll(course(-j)));
  expectViolation(Feeder(axis, l).feedAll(course(j * (1 + 1e-6))), axis, LimitedQuantity::kJerk, j * (1 + 1e-6), j,
                  1e-9 * j);
}

INSTANTIATE_TEST_SUITE_P(All, LimitCheckAxis, ::testing::Range(0, kAxisCount), [](const auto& info) {
  return std::string(kJointNames[static_cast<std::size_t>(info.param)]);
});

TEST(LimitCheck, ForgetsThePastAtARestart) {
  Feeder feeder(kX);
  EXPECT_FALSE(feeder.feedAll({0, 0, 0, 0}));
  feeder.check().restart();
  EXPECT_FALSE(feeder.feedAll({0.25, 0.25, 0.25}));
  Feeder unreported(kX);
  EXPECT_FALSE(unreported.feedAll({0, 0, 0, 0}));
  EXPECT_TRUE(unreported.feed(0.25));
}

/// A tenth of the highest speed, in pairs.
constexpr double kWay = 0.0125 * 2 * kPeriod;

/// Smoothly up to that speed in 40 pairs, and on at it: by c (wt - sin wt) up to wt = pi.
std::vector<double> upToSpeed() {
  std::vector<double> ends;
  for (int i = 0; i <= 40; ++i) ends.push_back(kWay / 2 * (i - 40 / units::kPi * std::sin(units::kPi * i / 40)));
  for (int i = 0; i < 5; ++i) ends.push_back(ends.back() + kWay);
  return withMiddles(ends);
}

TEST(LimitCheck, KnowsThatAxesWhichStoodGoOnMoreSlowlyAndCatchesTheirFullSpeed) {
  const std::vector<double> ends = upToSpeed();
  for (const double factor : {0.5, 0.2, 0.1}) {
    SCOPED_TRACE(factor);
    Feeder slowly(kX), fully(kX);
    for (Feeder* feeder : {&slowly, &fully}) {
      ASSERT_FALSE(feeder->feedAll(ends));
      feeder->check().slowDown(factor);
    }
    for (int i = 1; i <= 10; ++i) ASSERT_FALSE(slowly.feed(ends.back() + i * factor * kWay / 2)) << i;
    EXPECT_FALSE(fully.feed(ends.back() + kWay / 2));
    const double change = (1 - factor) * 0.0125;
    expectViolation(fully.feed(ends.back() + kWay), kX, LimitedQuantity::kAcceleration, change / (2 * kPeriod), 1,
                    1e-6);
  }
}

TEST(LimitCheck, ASlowDownAmidAPairIsOfTheNext) {
  Feeder feeder(kX);
  const std::vector<double> ends = upToSpeed();
  ASSERT_FALSE(feeder.feedAll(ends));
  EXPECT_FALSE(feeder.feed(ends.back() + kWay / 2));
  feeder.check().slowDown(0.5);
  EXPECT_FALSE(feeder.feed(ends.back() + kWay)) << "this pair goes on as it was begun";
  EXPECT_FALSE(feeder.feed(ends.back() + kWay + kWay / 4));
  EXPECT_FALSE(feeder.feed(ends.back() + kWay + kWay / 2));
}

/// All violations of the last setpoint checked, as "axis quantity".
std::vector<std::string> allOf(const LimitCheck& check) {
  static const char* const quantities[]{"position", "velocity", "acceleration", "jerk", "not finite"};
  std::vector<std::string> all;
  for (const LimitViolation& v : check) {
    all.push_back(std::string(kJointNames[static_cast<std::size_t>(v.axis)]) + " " +
                  quantities[static_cast<std::size_t>(v.quantity)]);
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(LimitCheck, HasEveryKindOfEveryAxisAtOnceAndNoneOfTheSetpointBefore) {
  LimitCheck check(plainLimits(), kPeriod);
  Setpoint p;
  for (p.cycle = 0; p.cycle < 2; ++p.cycle) EXPECT_FALSE(check.check(p));
  EXPECT_EQ(check.begin(), check.end());
  p.position.setConstant(100);  // from 0 within a pair
  const auto reported = check.check(p);
  ASSERT_TRUE(reported);
  EXPECT_EQ(reported->axis, check.begin()->axis);
  EXPECT_EQ(reported->quantity, check.begin()->quantity);
  EXPECT_EQ(reported->value, check.begin()->value);
  std::vector<std::string> expected;
  for (const char* const axis : {"axis_a", "axis_x", "axis_y", "axis_z"}) {
    for (const char* const quantity : {"acceleration", "jerk", "position", "velocity"}) {
      expected.push_back(std::string(axis) + " " + quantity);
    }
  }
  EXPECT_EQ(allOf(check), expected);
  for (const LimitViolation& v : check) {
    EXPECT_EQ(v.cycle, 2u);
    EXPECT_EQ(v.x, 100);
  }
  ++p.cycle;
  EXPECT_TRUE(check.check(p));
  EXPECT_EQ(allOf(check),
            (std::vector<std::string>{"axis_a position", "axis_x position", "axis_y position", "axis_z position"}));
}

// At 16 rad a position is exact to 3.6e-15 rad at best, which over a period makes 3.6e-12 rad/s; the limit of 1e-3
// rad/s lets 1e-12 rad/s of its own pass.
TEST(LimitCheck, LetsAsManyRoundingsPassAsItIsGiven) {
  AxisLimits l = plainLimits();
  l.max_velocity[kA] = 1.0 / 1024;
  const auto passes = [&](double roundings, int epsilons) {
    LimitCheck check(l, kPeriod, roundings);
    Setpoint p;
    p.position[kA] = 16;
    check.check(p);
    p.cycle = 1;
    p.position[kA] += l.max_velocity[kA] * kPeriod + epsilons * 16 * std::numeric_limits<double>::epsilon();
    return !check.check(p);
  };
  EXPECT_TRUE(passes(1, 2));
  EXPECT_FALSE(passes(1, 4));
  EXPECT_TRUE(passes(LimitCheck::kUnplannedRoundings, 6));
  EXPECT_FALSE(passes(LimitCheck::kUnplannedRoundings, 8));
}

TEST(LimitCheck, LetsTheRoundingOfThePositionsTermsPassALimitOfPositions) {
  AxisLimits l = plainLimits();
  l.max_position[kZ] = 1e-5;
  Axes terms = Axes::Zero();
  terms[kZ] = 0.5;
  const auto passes = [&](double roundings, int epsilons, const Axes& terms) {
    LimitCheck check(l, kPeriod, roundings);
    check.restart(terms);
    Setpoint p;
    p.position[kZ] = l.max_position[kZ] + epsilons * 0.5 * std::numeric_limits<double>::epsilon();
    return !check.check(p);
  };
  EXPECT_TRUE(passes(1, 1, terms));
  EXPECT_FALSE(passes(1, 3, terms));
  EXPECT_FALSE(passes(1, 1, Axes::Zero()));
  EXPECT_TRUE(passes(LimitCheck::kUnplannedRoundings, 5, terms));
  EXPECT_FALSE(passes(LimitCheck::kUnplannedRoundings, 7, terms));
}

/// Acceleration and jerk are differences of three and four positions, which add up to 4 and 8 times the rounding of
/// one.
TEST(LimitCheck, LetsTheRoundingOfThePositionsTermsPassAtPairEnds) {
  for (const bool jerk : {false, true}) {
    SCOPED_TRACE(jerk);
    AxisLimits l = plainLimits();
    (jerk ? l.max_acceleration : l.max_jerk)[kA] = 1e12;
    (jerk ? l.max_jerk : l.max_acceleration)[kA] = 1.0 / 1024;
    const auto passes = [&](int epsilons) {
      LimitCheck check(l, kPeriod);
      Axes terms = Axes::Zero();
      terms[kA] = 16;
      check.restart(terms);
      Setpoint p;
      check.check(p);
      p.cycle = 2;
      const double way = std::pow(2 * kPeriod, jerk ? 3 : 2) / 1024;
      p.position[kA] = way + epsilons * 16 * std::numeric_limits<double>::epsilon();
      return !check.check(p);
    };
    EXPECT_TRUE(passes(jerk ? 15 : 7));
    EXPECT_FALSE(passes(jerk ? 17 : 9));
  }
}

TEST(LimitCheck, LetsTheRoundingOfThePositionsTermsPass) {
  AxisLimits l = plainLimits();
  l.max_velocity[kA] = 1.0 / 1024;
  LimitCheck check(l, kPeriod);
  Setpoint p;
  const auto passes = [&](int epsilons) {
    p.cycle = 0, p.position[kA] = 0;
    check.check(p);
    p.cycle = 1;
    p.position[kA] = l.max_velocity[kA] * kPeriod + epsilons * 16 * std::numeric_limits<double>::epsilon();
    return !check.check(p);
  };
  Axes terms = Axes::Zero();
  terms[kA] = 16;
  check.restart(terms);
  EXPECT_TRUE(passes(2));
  check.restart(terms);
  EXPECT_FALSE(passes(4));
  check.restart();
  EXPECT_FALSE(passes(2));
}

}  // namespace test_limit_check
}  // namespace grinder
