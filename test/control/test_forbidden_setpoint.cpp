#include "control/checks.h"
#include "control/rig.h"

#include <string>
#include <vector>

// A setpoint that a limit forbids: the stream is planned for a stronger machine than the loop's.
namespace grinder::test_support {
namespace test_forbidden_setpoint {

struct LimitCase {
  Axes AxisLimits::*limits;
  int axis;
  double limit;
  LimitedQuantity quantity;
  const char* value;  ///< how the fault's text begins
  const char* bound;
  const char* place;
};

TEST(ForbiddenSetpoint, IsNeverWrittenButAllBeforeItAreAndEndsTheJobWithoutPower) {
  using L = AxisLimits;
  using Q = LimitedQuantity;
  const LimitCase rows[]{
      {&L::max_position, kX, 0.01, Q::kPosition, "axis X position 10.", "limit 10 mm", "(stroke,"},
      {&L::min_position, kY, 0.0213, Q::kPosition, "axis Y position 21.", "limit 21.3 mm", "(approach,"},
      {&L::max_velocity, kX, 0.05, Q::kVelocity, "axis X velocity 50.", "limit 50 mm/s", "(position,"},
      {&L::max_acceleration, kX, 0.21, Q::kAcceleration, "axis X acceleration 2", "limit 210 mm/s^2", "(position,"},
      {&L::max_jerk, kY, 3, Q::kJerk, "axis Y jerk", "limit 3000 mm/s^3", "(approach,"}};
  for (const LimitCase& c : rows) {
    SCOPED_TRACE(c.value);
    LoopConfig tightened = machineConfig();
    (tightened.machine.limits.*c.limits)[c.axis] = c.limit;
    const Machine strong = machineConfig().machine;
    Rig<FakeDrive> rig(tightened);
    rig.enable();
    const std::vector<Setpoint> planned = allSetpoints(rig.paperStream(strong));
    rig.stream.emplace(rig.paperStream(strong));
    ASSERT_NO_FATAL_FAILURE(rig.start(*rig.stream));
    for (std::size_t i = 0; i < planned.size() && rig.last().state == S::kRunning; ++i) rig.cycle();
    ASSERT_EQ(rig.last().state, S::kFault) << "the limit was not seen";
    const LoopFault fault = rig.last().fault;
    EXPECT_EQ(fault.kind, FaultKind::kLimit);
    EXPECT_EQ(fault.axis, c.axis);
    EXPECT_EQ(fault.violation.axis, c.axis);
    EXPECT_EQ(fault.violation.quantity, c.quantity);
    const std::size_t forbidden = fault.violation.cycle;
    ASSERT_GT(forbidden, 0u);
    ASSERT_LT(forbidden, planned.size());
    // Of the other quantities the check's own tests see which setpoint it is.
    if (c.quantity == Q::kPosition) {
      const double sign = c.limits == &L::max_position ? 1 : -1;
      EXPECT_GT(sign * planned[forbidden].position[c.axis], sign * c.limit);
      EXPECT_LE(sign * planned[forbidden - 1].position[c.axis], sign * c.limit);
    }
    EXPECT_EQ(fault.text().find(c.value), 0u) << fault.text();
    EXPECT_CONTAINS(fault.text(), std::string("beyond its ") + c.bound);
    EXPECT_CONTAINS(fault.text(), std::string(c.place) + " tooth 1, pass 1, X = ");
    EXPECT_TRUE(rig.last().job_ended);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    rig.run(100);
    EXPECT_EQ(rig.jobsEnded(), 1);
    const std::vector<Setpoint> good(planned.begin(), planned.begin() + static_cast<std::ptrdiff_t>(forbidden));
    EXPECT_TRUE(sameSetpoints(rig.setpoints(), good));
    EXPECT_TRUE(sameBits(toAxes(rig.drive.written), good.back().position));
  }
}

}  // namespace test_forbidden_setpoint
}  // namespace grinder::test_support
