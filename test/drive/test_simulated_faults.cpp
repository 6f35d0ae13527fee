#include "control/fixtures.h"
#include "drive/simulated_bench.h"

#include <cmath>

// Faults that the simulated drive injects.
namespace grinder::test_support {
namespace test_simulated_faults {

TEST(SimulatedDriveFault, EmergencyStopTakesPowerAndMotionAway) {
  MovingBench bench;
  const Axes before = bench.positions();
  bench.drive.inject(Fault::kEmergencyStop);
  bench.run(10);
  EXPECT_TRUE(bench.status().emergency_stop);
  EXPECT_FALSE(bench.status().enabled);
  EXPECT_FALSE(bench.status().fault);
  EXPECT_TRUE(sameBits(bench.positions(), before));
}

TEST(SimulatedDriveFault, EmergencyStopGoesWhenTakenBack) {
  MovingBench bench;
  bench.drive.inject(Fault::kEmergencyStop);
  bench.run(1);
  bench.drive.inject(Fault::kNone);
  bench.run(1);
  EXPECT_FALSE(bench.status().emergency_stop);
}

class StuckAxis : public testing::TestWithParam<int> {};

TEST_P(StuckAxis, StandsAlone) {
  MovingBench bench;
  const Axes before = bench.positions();
  bench.drive.inject(Fault::kStuckAxis, GetParam());
  bench.run(3);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    if (axis == GetParam()) {
      EXPECT_EQ(bench.position(axis), before[axis]);
    } else {
      EXPECT_GT(bench.position(axis), before[axis]) << kJointNames[static_cast<std::size_t>(axis)];
    }
  }
  EXPECT_TRUE(bench.status().enabled) << "the drive must not know of it";
  EXPECT_FALSE(bench.status().fault);
}

INSTANTIATE_TEST_SUITE_P(Axis, StuckAxis, testing::Values(kX, kY, kZ, kA),
                         [](const testing::TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

TEST(SimulatedDriveFault, StaleFeedbackStandsWhileTheAxesGoOn) {
  MovingBench bench;
  const Axes before = bench.positions();
  const double velocity = bench.velocity(kX);
  const std::uint64_t count = bench.status().feedback_count;
  bench.drive.inject(Fault::kStaleFeedback);
  bench.run(100);
  EXPECT_EQ(bench.status().feedback_count, count);
  EXPECT_TRUE(sameBits(bench.positions(), before));
  EXPECT_EQ(bench.velocity(kX), velocity);
  bench.drive.inject(Fault::kNone);
  bench.run(1);
  EXPECT_EQ(bench.status().feedback_count, count + 1);
  EXPECT_NEAR(bench.position(kX), 0.01, 1e-12) << "the axes have gone on meanwhile";
}

class NanFeedback : public testing::TestWithParam<int> {};

TEST_P(NanFeedback, IsOfOneAxisAndGoesWhenTakenBack) {
  MovingBench bench;
  bench.drive.inject(Fault::kNanFeedback, GetParam());
  bench.run(1);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    EXPECT_EQ(std::isnan(bench.position(axis)), axis == GetParam()) << kJointNames[static_cast<std::size_t>(axis)];
  }
  bench.drive.inject(Fault::kNone);
  bench.run(100);
  EXPECT_NEAR(bench.position(GetParam()), 0.01 * (GetParam() + 1), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Axis, NanFeedback, testing::Values(kX, kY, kZ, kA),
                         [](const testing::TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

TEST(SimulatedDriveFault, DriveFaultTakesPowerAndMotionAway) {
  MovingBench bench;
  const Axes before = bench.positions();
  bench.drive.inject(Fault::kDriveFault);
  bench.run(10);
  EXPECT_TRUE(bench.status().fault);
  EXPECT_FALSE(bench.status().enabled);
  EXPECT_FALSE(bench.status().emergency_stop);
  EXPECT_TRUE(sameBits(bench.positions(), before));
}

TEST(SimulatedDriveFault, DriveFaultStaysAfterItIsTakenBack) {
  MovingBench bench;
  bench.drive.inject(Fault::kDriveFault);
  bench.run(1);
  bench.drive.inject(Fault::kNone);
  bench.run(10);
  EXPECT_TRUE(bench.status().fault);
  EXPECT_FALSE(bench.status().enabled);
}

TEST(SimulatedDriveFault, DriveFaultGoesWithAResetOnceItIsTakenBack) {
  MovingBench bench;
  bench.drive.inject(Fault::kDriveFault);
  bench.run(1);
  bench.drive.inject(Fault::kNone);
  bench.set(false, true);
  bench.run(1);
  EXPECT_FALSE(bench.status().fault);
  bench.set(true);
  bench.run(1);
  EXPECT_FALSE(bench.status().fault);
  EXPECT_TRUE(bench.status().enabled);
}

TEST(SimulatedDriveFault, DriveFaultOutlastsAResetWhileItsCauseIsThere) {
  MovingBench bench;
  bench.drive.inject(Fault::kDriveFault);
  bench.set(false, true);
  bench.run(3);
  EXPECT_TRUE(bench.status().fault);
  bench.drive.inject(Fault::kNone);
  bench.set(false);
  bench.run(1);
  EXPECT_TRUE(bench.status().fault);
}

TEST(SimulatedDriveFault, OneTakesThePlaceOfAnother) {
  MovingBench bench;
  bench.drive.inject(Fault::kNanFeedback, kY);
  bench.run(1);
  bench.drive.inject(Fault::kStuckAxis, kZ);
  bench.run(1);
  const double stuck = bench.position(kZ);
  bench.run(3);
  EXPECT_FALSE(std::isnan(bench.position(kY)));
  EXPECT_EQ(bench.position(kZ), stuck);
}

}  // namespace test_simulated_faults
}  // namespace grinder::test_support
