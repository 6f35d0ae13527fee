#include "flute_grinder/core/lift_move.h"

#include "flute_grinder/core/limit_check.h"

#include "generators.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace flute_grinder {
namespace {

using namespace test_support;

const Axes kFrom(0.01, -0.002, 0.003, 4);

std::vector<Setpoint> all(LiftMove& lift) {
  std::vector<Setpoint> setpoints;
  Setpoint p;
  while (lift.next(p)) setpoints.push_back(p);
  return setpoints;
}

TEST(LiftMove, HasNothingToDoBeforeItBegins) {
  LiftMove lift(plainMachine());
  Setpoint p;
  EXPECT_FALSE(lift.next(p));
  EXPECT_TRUE(lift.finished());
}

TEST(LiftMove, RefusesAMachineWithoutLimitsOfY) {
  Machine machine = plainMachine();
  machine.limits.max_jerk[kY] = 0;
  EXPECT_THROW(LiftMove{machine}, std::invalid_argument);
}

TEST(LiftMove, GoesStraightUpExactlyToItsHeight) {
  LiftMove lift(plainMachine());
  lift.begin(kFrom, 0.007);
  const auto setpoints = all(lift);
  ASSERT_GT(setpoints.size(), 10u);
  EXPECT_TRUE((setpoints.front().position == kFrom).all());
  double y = kFrom[kY];
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    ASSERT_EQ(p.cycle, i);
    ASSERT_EQ(p.move, MoveKind::kLift);
    ASSERT_TRUE((p.position == Axes(kFrom[kX], p.position[kY], kFrom[kZ], kFrom[kA])).all());
    ASSERT_GE(p.position[kY], y);
    ASSERT_NEAR(p.velocity[kY], (p.position[kY] - y) / 1e-3, 1e-12);
    y = p.position[kY];
  }
  EXPECT_EQ(y, 0.007);
  EXPECT_EQ(setpoints.back().move_fraction, 1);
  EXPECT_TRUE(lift.finished());
}

TEST(LiftMove, FromAboveNothingMoves) {
  LiftMove lift(plainMachine());
  lift.begin(kFrom, -0.01);
  for (const Setpoint& p : all(lift)) EXPECT_TRUE((p.position == kFrom).all());
  EXPECT_TRUE(lift.finished());
}

RC_GTEST_PROP(LiftMoveProperty, KeepsTheLimitsHeldAndSlowedDownAtAnyMoment, ()) {
  const Machine machine = *test_support::machine();
  LiftMove lift(machine);
  LimitCheck check(machine.limits, machine.period);
  const double to = kFrom[kY] + *test_support::logUniform(1e-6, 0.1);
  lift.begin(kFrom, to);
  const int slow_down_at = *whole(1, 60);
  const int hold_at = *whole(0, 200);
  bool held = false;
  Setpoint p;
  int cycle = 0;
  for (; lift.next(p); ++cycle) {
    RC_ASSERT(!check.check(p));
    if (cycle == slow_down_at) {
      const double factor = *uniform(0.1, 0.5);
      lift.slowDown(factor);
      check.slowDown(factor);
    }
    if (cycle == hold_at) {
      held = true;
      lift.hold();
    }
    RC_ASSERT(cycle < 1000000);
  }
  RC_ASSERT(p.cycle % 2 == 0u);
  RC_ASSERT(p.position[kY] <= to);
  RC_ASSERT(held || lift.finished());
  if (lift.finished()) RC_ASSERT(p.position[kY] == to);
}

}  // namespace
}  // namespace flute_grinder
