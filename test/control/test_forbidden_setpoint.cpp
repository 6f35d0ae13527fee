#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <cmath>
#include <functional>

// A setpoint that a limit forbids: the stream is planned for a stronger machine than the loop's.
namespace grinder::test_support {
namespace test_forbidden_setpoint {

struct LimitCase {
  const char* name;
  std::function<void(LoopConfig&)> tighten;
  LimitedQuantity quantity;
  int axis;
  std::vector<std::string> words;
  /// Index of the first setpoint that breaks the limit, from the positions alone.
  std::function<std::size_t(const std::vector<Setpoint>&)> first;
};
std::ostream& operator<<(std::ostream& out, const LimitCase& c) { return out << c.name; }

/// The first setpoint, of every `stride`-th, whose `order`-th difference over time exceeds the limit.
std::size_t firstBeyond(const std::vector<Setpoint>& all, int axis, int order, std::size_t stride, double limit) {
  const double dt = 0.001 * static_cast<double>(stride);
  const auto at = [&](std::size_t i, std::size_t back) {
    return all[i >= back * stride ? i - back * stride : 0].position[axis];
  };
  for (std::size_t i = 0; i < all.size(); i += stride) {
    double value = at(i, 0);
    if (order == 1) value = (at(i, 0) - at(i, 1)) / dt;
    if (order == 2) value = (at(i, 0) - 2 * at(i, 1) + at(i, 2)) / dt / dt;
    if (order == 3) value = (at(i, 0) - 3 * at(i, 1) + 3 * at(i, 2) - at(i, 3)) / dt / dt / dt;
    if (std::abs(value) > limit) return i;
  }
  return all.size();
}

std::vector<LimitCase> limitCases() {
  std::vector<LimitCase> cases;
  const auto add = [&](const char* name, Axes AxisLimits::*limits, int axis, double limit, LimitedQuantity quantity,
                       const std::vector<std::string>& words,
                       const std::function<std::size_t(const std::vector<Setpoint>&)>& first) {
    const auto tighten = [=](LoopConfig& c) { (c.machine.limits.*limits)[axis] = limit; };
    cases.push_back({name, tighten, quantity, axis, words, first});
  };
  const auto firstWhere = [](const std::function<bool(const Axes&)>& beyond) {
    return [=](const std::vector<Setpoint>& all) {
      const auto at = std::find_if(all.begin(), all.end(), [&](const Setpoint& p) { return beyond(p.position); });
      return static_cast<std::size_t>(at - all.begin());
    };
  };
  const auto firstOf = [](int axis, int order, std::size_t stride, double limit) {
    return [=](const std::vector<Setpoint>& all) { return firstBeyond(all, axis, order, stride, limit); };
  };
  add("PositionX", &AxisLimits::max_position, kX, 0.01, LimitedQuantity::kPosition,
      {"axis X position 10.", "beyond its limit 10 mm", "(stroke, tooth 1, pass 1, X = "},
      firstWhere([](const Axes& at) { return at[kX] > 0.01; }));
  add("PositionY", &AxisLimits::min_position, kY, 0.0213, LimitedQuantity::kPosition,
      {"axis Y position 21.", "beyond its limit 21.3 mm", "(approach, tooth 1, pass 1, X = "},
      firstWhere([](const Axes& at) { return at[kY] < 0.0213; }));
  add("VelocityX", &AxisLimits::max_velocity, kX, 0.05, LimitedQuantity::kVelocity,
      {"axis X velocity 50.", "beyond its limit 50 mm/s", "(position, tooth 1, pass 1, X = "}, firstOf(kX, 1, 1, 0.05));
  add("AccelerationX", &AxisLimits::max_acceleration, kX, 0.21, LimitedQuantity::kAcceleration,
      {"axis X acceleration 2", "beyond its limit 210 mm/s^2", "(position, tooth 1, pass 1, X = "},
      firstOf(kX, 2, 2, 0.21));
  add("JerkY", &AxisLimits::max_jerk, kY, 3, LimitedQuantity::kJerk,
      {"axis Y jerk", "beyond its limit 3000 mm/s^3", "(approach, tooth 1, pass 1, X = "}, firstOf(kY, 3, 2, 3));
  return cases;
}

class ForbiddenSetpoint : public testing::TestWithParam<LimitCase> {
 protected:
  ForbiddenSetpoint() : rig_(tightened()), strong_(machineConfig().machine) {}

  void SetUp() override {
    rig_.enable();
    planned_ = allSetpoints(rig_.paperStream(strong_));
    rig_.stream.emplace(rig_.paperStream(strong_));
    ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
    for (std::size_t i = 0; i < planned_.size() && rig_.last().state == S::kRunning; ++i) rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kFault) << "the limit was not seen";
    forbidden_ = GetParam().first(planned_);
    ASSERT_GT(forbidden_, 0u);
    ASSERT_LT(forbidden_, planned_.size());
  }

  static LoopConfig tightened() {
    LoopConfig config = machineConfig();
    GetParam().tighten(config);
    return config;
  }

  Rig<FakeDrive> rig_;
  Machine strong_;
  std::vector<Setpoint> planned_;
  std::size_t forbidden_ = 0;
};

TEST_P(ForbiddenSetpoint, IsNeverWrittenButAllBeforeItAreAndEndsTheJobWithoutPower) {
  const LoopFault fault = rig_.last().fault;
  EXPECT_EQ(fault.kind, FaultKind::kLimit);
  EXPECT_EQ(fault.axis, GetParam().axis);
  EXPECT_EQ(fault.violation.axis, GetParam().axis);
  EXPECT_EQ(fault.violation.quantity, GetParam().quantity);
  EXPECT_EQ(fault.violation.cycle, forbidden_);
  for (const std::string& word : GetParam().words) EXPECT_CONTAINS(fault.text(), word);
  EXPECT_TRUE(rig_.last().job_ended);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  const std::vector<Setpoint> good(planned_.begin(), planned_.begin() + static_cast<std::ptrdiff_t>(forbidden_));
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), good));
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), good.back().position));
}

INSTANTIATE_TEST_SUITE_P(, ForbiddenSetpoint, testing::ValuesIn(limitCases()),
                         [](const testing::TestParamInfo<LimitCase>& info) { return std::string(info.param.name); });

}  // namespace test_forbidden_setpoint
}  // namespace grinder::test_support
