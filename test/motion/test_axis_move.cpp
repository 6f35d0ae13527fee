#include "flute_grinder/motion/axis_move.h"

#include "generators.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// That a jog keeps the limits at any speeds, and slowed down at any moment, the rides show.
namespace grinder {
namespace test_axis_move {

using namespace test_support;

const Axes kFrom(0.01, -0.002, 0.003, 4);

std::vector<Setpoint> all(AxisMove& move) {
  std::vector<Setpoint> setpoints;
  Setpoint p;
  while (move.next(p)) setpoints.push_back(p);
  return setpoints;
}

class AxisMoveAlong : public ::testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(AxisMoveAlong, GoesStraightExactlyToItsEnd) {
  const auto [axis, direction] = GetParam();
  AxisMove move(plainMachine());
  const double to = kFrom[axis] + direction * (axis == kA ? 0.5 : 0.009);
  const double speed = 0.1 * plainMachine().limits.max_velocity[axis];
  move.begin(MoveKind::kLift, kFrom, axis, to, speed);
  EXPECT_EQ(move.axis(), axis);
  EXPECT_EQ(move.direction(), direction);
  const auto setpoints = all(move);
  ASSERT_GT(setpoints.size(), 10u);
  EXPECT_EQ(setpoints.back().cycle % 2, 0u);
  EXPECT_TRUE((setpoints.front().position == kFrom).all());
  double at = kFrom[axis], fastest = 0;
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    ASSERT_EQ(p.cycle, i);
    ASSERT_EQ(p.move, MoveKind::kLift);
    Axes expected = kFrom;
    expected[axis] = p.position[axis];
    ASSERT_TRUE((p.position == expected).all());
    ASSERT_GE(direction * (p.position[axis] - at), 0);
    ASSERT_NEAR(p.velocity[axis], (p.position[axis] - at) / 1e-3, 1e-9);
    ASSERT_NEAR(p.move_fraction, std::abs(p.position[axis] - kFrom[axis]) / std::abs(to - kFrom[axis]), 1e-12);
    // The feed at the end of the cycle, of which the velocity is the mean.
    const double change = plainMachine().limits.max_acceleration[axis] * 1e-3;
    ASSERT_NEAR(p.feed, axis == kA ? 0 : direction * p.velocity[axis], axis == kA ? 0 : change);
    at = p.position[axis];
    fastest = std::max(fastest, direction * p.velocity[axis]);
  }
  EXPECT_EQ(at, to);
  EXPECT_NEAR(fastest, speed, 1e-9);
  EXPECT_EQ(setpoints.back().move_fraction, 1);
  EXPECT_TRUE(move.finished());
}

INSTANTIATE_TEST_SUITE_P(, AxisMoveAlong,
                         ::testing::Combine(::testing::Values(kX, kY, kZ, kA), ::testing::Values(1, -1)));

TEST(AxisMove, StopsAtSpeedZeroAndGoesOnAtAnother) {
  AxisMove move(plainMachine());
  move.begin(MoveKind::kPosition, kFrom, kZ, kFrom[kZ] + 0.02, 0.02);
  Setpoint p;
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(move.next(p));
  move.setSpeed(0);
  const double before = p.position[kZ];
  while (move.next(p)) {
  }
  // From 20 mm/s at 50 m/s^3, below 2 m/s^2: over v sqrt(v/j); at most a pair is begun before.
  const double braking = 0.02 * std::sqrt(0.02 / 50);
  EXPECT_GT(p.position[kZ], before);
  EXPECT_LT(p.position[kZ], before + braking + 2e-3 * 0.02 + 1e-9);
  EXPECT_FALSE(move.finished());
  move.setSpeed(std::nan(""));
  move.setSpeed(-0.01);
  move.setSpeed(99);
  EXPECT_FALSE(move.next(p)) << "a speed that is not allowed was taken";
  move.setSpeed(0.01);
  while (move.next(p)) {
  }
  EXPECT_TRUE(move.finished());
  EXPECT_EQ(p.position[kZ], kFrom[kZ] + 0.02);
}

/// The distance of two positions is rounded, and so is their sum. Between round numbers a setpoint often comes within
/// rounding of the end before the move is finished.
RC_GTEST_PROP(AxisMoveProperty, EndsExactlyAtItsEndAndIsNeverBeyond, ()) {
  Machine machine = plainMachine();
  machine.limits.max_acceleration[kZ] = 0.5;
  machine.limits.max_jerk[kZ] = 10;
  AxisMove move(machine);
  for (int i = 0; i < 10; ++i) {
    const double from = 0.5e-3 * *whole(-200, 200), to = 0.5e-3 * *whole(-200, 200);
    move.begin(MoveKind::kPosition, Axes(from, from, from, from), kZ, to, 5e-3 * *whole(1, 20));
    Setpoint p;
    while (move.next(p)) {
      const bool within = to < from ? p.position[kZ] >= to : p.position[kZ] <= to;
      RC_ASSERT(within);
    }
    RC_ASSERT(p.position[kZ] == to);
  }
}

}  // namespace test_axis_move
}  // namespace grinder
