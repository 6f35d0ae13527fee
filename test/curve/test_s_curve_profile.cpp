#include "flute_grinder/curve/s_curve_profile.h"

#include "curve/generators.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_s_curve_profile {

using namespace test_support;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Sample {
  double position, speed, acceleration;
};

Sample sampleOf(const SCurveProfile& law) { return {law.position(), law.speed(), law.acceleration()}; }

/// Runs through a law in equal steps until it rests; `change` may change the target, and so end a rest, before each.
template <typename Change>
std::vector<Sample> run(SCurveProfile& law, double dt, int most, Change change) {
  std::vector<Sample> samples{sampleOf(law)};
  for (int i = 0; i < most; ++i) {
    change(i);
    if (law.resting()) break;
    law.advance(dt);
    samples.push_back(sampleOf(law));
  }
  return samples;
}

struct Motion {
  MotionLimits limits;
  double distance;
  double dt;  ///< some hundred steps for the whole motion at full speed

  static Motion draw() {
    Motion m;
    m.limits = {*logUniform(1e-3, 1), *logUniform(1e-2, 10), *logUniform(0.1, 1000)};
    m.distance = *logUniform(1e-5, 1);
    m.dt = SCurveProfile(m.limits, m.distance, m.limits.velocity).timeLeft() / *uniform(20, 400);
    return m;
  }
};

/// Position, speed and acceleration, and the sampled differences of position, against the limits. By the mean value
/// theorem a difference quotient is a value, or a mean, of the derivative, and so has the same bound.
void checkBounds(const Motion& m, const std::vector<Sample>& samples) {
  const double h = m.dt;
  const double noise = 1e-15 * m.distance;  // of a position
  const MotionLimits& l = m.limits;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    RC_ASSERT(s.position <= m.distance);
    RC_ASSERT(s.speed >= -1e-9 * l.velocity);
    RC_ASSERT(s.speed <= l.velocity * (1 + 1e-9));
    RC_ASSERT(std::abs(s.acceleration) <= l.acceleration * (1 + 1e-9));
    const auto p = [&](std::size_t back) { return samples[i - back].position; };
    if (i < 1) continue;
    RC_ASSERT(p(0) >= p(1) - noise);
    RC_ASSERT(p(0) - p(1) <= l.velocity * h * (1 + 1e-9) + 2 * noise);
    RC_ASSERT(std::abs(s.speed - samples[i - 1].speed) <= l.acceleration * h * (1 + 1e-9) + 1e-12 * l.velocity);
    RC_ASSERT(std::abs(s.acceleration - samples[i - 1].acceleration) <=
              l.jerk * h * (1 + 1e-9) + 1e-9 * l.acceleration);
    if (i < 2) continue;
    RC_ASSERT(std::abs(p(0) - 2 * p(1) + p(2)) <= l.acceleration * h * h * (1 + 1e-9) + 4 * noise);
    if (i < 3) continue;
    RC_ASSERT(std::abs(p(0) - 3 * p(1) + 3 * p(2) - p(3)) <= l.jerk * h * h * h * (1 + 1e-9) + 8 * noise);
  }
}

void assertFinished(const SCurveProfile& law, const Motion& m) {
  RC_ASSERT(law.resting());
  RC_ASSERT(law.finished());
  RC_ASSERT(law.position() == m.distance);
  RC_ASSERT(law.speed() == 0);
  RC_ASSERT(law.acceleration() == 0);
}

/// Way and time of the quickest stop from a state, of which only the bound is needed: take the acceleration back, then
/// brake as from the highest speed reached.
double stoppingBound(const MotionLimits& l, double speed, double acceleration) {
  const double a = std::max(0.0, acceleration);
  const double back = a / l.jerk;
  const double peak = speed + a * back / 2;
  const double brake = peak * l.jerk >= l.acceleration * l.acceleration
                           ? peak / l.acceleration + l.acceleration / l.jerk
                           : 2 * std::sqrt(peak / l.jerk);
  return peak * back + peak * brake / 2;
}

/// It cruises from 3 s to 5 s, and skips two steps at a time, from a margin after the one to two before the other.
TEST(SCurveProfile, SkipsStepsOfTheCruiseAsIfItWentThem) {
  constexpr double kStep = 1.0 / 64, kMargin = 0.12;
  const struct {
    double from;  ///< [s]
    std::uint64_t at_most, count;
  } rows[]{{2.5, 1000, 0},      {3.09375, 1000, 0}, {3.15625, 1000, 102}, {3.15625, 101, 100},
           {3.15625, 102, 102}, {3.15625, 1, 0},    {4.6875, 1000, 4},    {4.75, 1000, 0}};
  for (const auto& row : rows) {
    SCOPED_TRACE(::testing::Message() << row.from << ' ' << row.at_most);
    SCurveProfile law({2, 1, 1}, 10, 2);
    for (double t = 0; t < row.from; t += kStep) law.advance(kStep);
    SCurveProfile step = law;
    EXPECT_EQ(law.skipCruise(kStep, kMargin, row.at_most), row.count);
    for (std::uint64_t i = 0; i < row.count; ++i) step.advance(kStep);
    EXPECT_EQ(law.position(), step.position());
    EXPECT_EQ(law.timeLeft(), step.timeLeft());
  }
}

TEST(SCurveProfile, RefusesBadArgumentsByName) {
  const auto expectRefused = [](const MotionLimits& limits, double distance, double target, const std::string& name) {
    const std::string said =
        test_support::refusalOf<std::invalid_argument>([&] { SCurveProfile(limits, distance, target); });
    EXPECT_NE(said.find(name), std::string::npos) << said << "\nnot: " << name;
  };
  for (const double bad : {0.0, -1.0, kNan, kInf, -kInf}) {
    expectRefused({bad, 1, 1}, 1, 0, "velocity");
    expectRefused({1, bad, 1}, 1, 0, "acceleration");
    expectRefused({1, 1, bad}, 1, 0, "jerk");
  }
  for (const double bad : {-1e-9, kNan, kInf}) expectRefused({1, 1, 1}, bad, 0, "distance");
  for (const double bad : {-1e-9, 1.0000001, kNan, kInf}) expectRefused({1, 1, 1}, 1, bad, "target");
}

TEST(SCurveProfile, BeginsWithGoodArgumentsOnly) {
  SCurveProfile law({2, 1, 1}, 10, 2);
  law.advance(1);
  const double position = law.position();
  EXPECT_FALSE(law.begin({2, 1, kNan}, 10, 2));
  EXPECT_FALSE(law.begin({2, 1, 1}, kInf, 2));
  EXPECT_FALSE(law.begin({2, 1, 1}, 10, 3));
  EXPECT_EQ(law.position(), position);
  ASSERT_TRUE(law.begin({1, 1, 1}, 5, 1));
  SCurveProfile made({1, 1, 1}, 5, 1);
  EXPECT_EQ(law.timeLeft(), made.timeLeft());
  for (int i = 0; i < 90; ++i) {
    law.advance(0.1);
    made.advance(0.1);
    ASSERT_EQ(law.position(), made.position());
  }
  EXPECT_EQ(law.position(), 5);
}

/// One motion for each of the double-S law's four cases: velocity, and acceleration, reached or not.
RC_GTEST_PROP(SCurveProfileProperty, TakesTheDoubleSTimeInEachOfTheFourCases, ()) {
  const double a = *logUniform(0.01, 10);
  const double j = *logUniform(0.1, 1000);
  const double knee = a * a / j;  // speed from which on the full acceleration is reached
  const bool velocity_reached = *rc::gen::arbitrary<bool>();
  const bool acceleration_reached = *rc::gen::arbitrary<bool>();
  const double peak = knee * (acceleration_reached ? *uniform(1.1, 20) : *uniform(0.05, 0.9));
  const double ramp = acceleration_reached ? peak / a + a / j : 2 * std::sqrt(peak / j);
  const double cruise = velocity_reached ? *uniform(0.01, 5) * ramp : 0;
  const double v = velocity_reached ? peak : peak * *uniform(1.01, 3);
  const SCurveProfile law({v, a, j}, peak * (ramp + cruise), v);
  RC_ASSERT(std::abs(law.timeLeft() - (2 * ramp + cruise)) <= 1e-9 * (2 * ramp + cruise));
}

RC_GTEST_PROP(SCurveProfileProperty, KeepsTheLimitsAndFinishesWhateverTheTargetsWere, ()) {
  const Motion m = Motion::draw();
  SCurveProfile law(m.limits, m.distance, m.limits.velocity);
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> fraction(0, 1);
  std::uniform_real_distribution<double> target(-0.3, 1.2);  // 0 and full speed have their share
  const double chance = *logUniform(0.002, 1);
  const int calm_from = *whole(0, 1000);
  const auto samples = run(law, m.dt, 20000, [&](int i) {
    const bool change = i < calm_from && fraction(random) < chance;
    if (change) RC_ASSERT(law.setTarget(m.limits.velocity * std::min(1.0, std::max(0.0, target(random)))));
    if (i < calm_from && !law.resting()) return;
    if (i == calm_from || (law.resting() && !law.finished())) {
      RC_ASSERT(i == calm_from || law.target() == 0);  // nothing else makes it rest short of the end
      RC_ASSERT(law.setTarget(m.limits.velocity));
    }
  });
  checkBounds(m, samples);
  assertFinished(law, m);
}

RC_GTEST_PROP(SCurveProfileProperty, StopsWithinTheDistanceAndRestsAndResumes, ()) {
  const Motion m = Motion::draw();
  SCurveProfile law(m.limits, m.distance, m.limits.velocity);
  law.advance(law.timeLeft() * *uniform(0, 1));
  const double from = law.position();
  const double bound = stoppingBound(m.limits, law.speed(), law.acceleration());
  RC_ASSERT(law.setTarget(0));
  const auto stop = run(law, m.dt, 100000, [](int) {});
  checkBounds(m, stop);
  RC_ASSERT(law.resting());
  RC_ASSERT(law.speed() == 0);
  RC_ASSERT(law.acceleration() == 0);
  RC_ASSERT(law.position() <= m.distance);
  RC_ASSERT(law.position() - from <= bound * (1 + 1e-9) + 1e-15 * m.distance);
  const double rest = law.position();
  law.advance(1);
  RC_ASSERT(law.position() == rest);
  RC_PRE(!law.finished());
  RC_ASSERT(law.setTarget(m.limits.velocity));
  RC_ASSERT(!law.resting());
  checkBounds(m, run(law, m.dt, 100000, [](int) {}));
  assertFinished(law, m);
}

RC_GTEST_PROP(SCurveProfileProperty, SlowedDownAtAnyMomentItKeepsTheLimitsAndComesToRestAtTheEnd, ()) {
  const Motion m = Motion::draw();
  SCurveProfile law(m.limits, m.distance, m.limits.velocity);
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> fraction(0, 1), factor(0.01, 0.99);
  const double from = *uniform(0, 1) * law.timeLeft();  // the final braking has its share
  const double chance = *logUniform(0.01, 1);
  int left = *whole(1, 20);
  std::vector<Sample> samples{sampleOf(law)};
  for (int i = 0; i < 200000 && !law.resting(); ++i) {
    if (left > 0 && i * m.dt >= from && fraction(random) < chance) {
      --left;
      checkBounds(m, samples);
      const double f = factor(random);
      const Sample before = samples.back();
      law.slowDown(f);
      RC_ASSERT(law.position() == before.position);
      RC_ASSERT(law.speed() == f * before.speed);
      RC_ASSERT(law.acceleration() == f * f * before.acceleration);
      samples = {sampleOf(law)};
      // There is always a stop within the way left.
      SCurveProfile stop = law;
      stop.setTarget(0);
      checkBounds(m, run(stop, m.dt, 100000, [](int) {}));
      RC_ASSERT(stop.resting());
    }
    law.advance(m.dt);
    samples.push_back(sampleOf(law));
  }
  checkBounds(m, samples);
  assertFinished(law, m);
}

/// Braking from 2 m/s for 0.6 s at 1 m/s^3, it is at 1.82 m/s, and would settle at 1.64 m/s if it stopped braking.
/// Asked for a little more, it swings from -0.6 to 0.2 m/s^2 and back to 0.
TEST(SCurveProfile, SpeedsUpToATargetBelowItsSpeedIfItWouldSettleLower) {
  SCurveProfile law({2, 1, 1}, 100, 2);
  law.advance(3.5);
  ASSERT_TRUE(law.cruising());
  law.setTarget(0);
  law.advance(0.6);
  law.setTarget(1.64 + 0.2 * 0.2);
  law.advance(0.8);
  EXPECT_NEAR(law.acceleration(), 0.2, 1e-9);
  EXPECT_NEAR(law.speed(), 1.64 + 0.2 * 0.2 / 2, 1e-9);
}

TEST(SCurveProfile, WhatIsNoFactorDoesNotSlowItDown) {
  for (const double factor : {0.0, -0.5, 1.0, 1.5, kNan, kInf, -kInf}) {
    SCurveProfile law({1, 2, 8}, 10, 1);
    law.advance(2);
    const double left = law.timeLeft();
    law.slowDown(factor);
    EXPECT_EQ(law.speed(), 1) << factor;
    EXPECT_EQ(law.timeLeft(), left) << factor;
  }
  SCurveProfile resting;
  resting.slowDown(0.5);
  EXPECT_TRUE(resting.finished());
}

TEST(SCurveProfile, ARefusedTargetChangesNothing) {
  for (const double bad : {kNan, -1e-9, 2.0000001, kInf, -kInf}) {
    SCOPED_TRACE(bad);
    SCurveProfile law({2, 1, 1}, 10, 2);
    SCurveProfile untouched({2, 1, 1}, 10, 2);
    for (int i = 0; i < 90; ++i) {
      EXPECT_FALSE(law.setTarget(bad));
      law.advance(0.1);
      untouched.advance(0.1);
      ASSERT_EQ(law.position(), untouched.position());
      ASSERT_EQ(law.speed(), untouched.speed());
      ASSERT_EQ(law.target(), 2);
      ASSERT_EQ(law.timeLeft(), untouched.timeLeft());
    }
    EXPECT_TRUE(law.finished());
  }
}

}  // namespace test_s_curve_profile
}  // namespace grinder
