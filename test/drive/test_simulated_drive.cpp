#include "control/fixtures.h"
#include "drive/simulated_bench.h"

#include <cmath>

// Set-up, motion and encoders of the simulated drive.
namespace grinder::test_support {
namespace test_simulated_drive {

// ---------------------------------------------------------------------------------------------------------------------
// Set up

TEST(SimulatedDriveInit, IsHomedWithoutPower) {
  Bench bench;
  EXPECT_TRUE(bench.status().homed);
  EXPECT_FALSE(bench.status().enabled);
  bench.read();
  EXPECT_TRUE(bench.status().homed);
  EXPECT_FALSE(bench.status().enabled);
}

TEST(SimulatedDriveInit, ReadsDecimalStartPositionsToTheLastBit) {
  SimulatedDrive::Model model = plainModel(0.002, 1e7);
  const Axes start(-0.05, 0.05, 0.1234567, -125.6637061);
  for (std::size_t i = 0; i < model.size(); ++i) model[i].start_position = start[static_cast<int>(i)];
  Bench bench(model);
  EXPECT_TRUE(sameBits(bench.positions(), start)) << "before the first read";
  bench.read();
  EXPECT_TRUE(sameBits(bench.positions(), start)) << "after the first read";
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

// From x toward c, each period takes the fraction 1 / (1 + tau/T) of what is left: with q = tau / (tau + T), after n
// periods the axis is at c - (c - x) q^n.
TEST(SimulatedDriveMotion, IsAFirstOrderLag) {
  Bench bench{plainModel(0.002)};
  bench.set(true);
  bench.command(kX, 0.1);
  for (int n = 1; n <= 20; ++n) {
    bench.run(1);
    EXPECT_NEAR(bench.position(kX), 0.1 * (1 - std::pow(2.0 / 3, n)), 1e-12) << "after " << n << " periods";
  }
}

TEST(SimulatedDriveMotion, SettlesAtTheCommand) {
  Bench bench{plainModel(0.002, 1e7)};
  bench.set(true);
  const Axes target(0.0123, -0.004, 0.05, 17.25);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, target[axis]);
  bench.run(100);
  EXPECT_TRUE((bench.positions() == target).all()) << bench.positions().transpose();
}

TEST(SimulatedDriveMotion, WithoutLagIsAtTheCommandAtOnce) {
  Bench bench{plainModel(0)};
  bench.set(true);
  bench.command(kZ, 0.25);
  bench.run(1);
  EXPECT_EQ(bench.position(kZ), 0.25);
}

TEST(SimulatedDriveMotion, EveryAxisHasItsOwnLag) {
  SimulatedDrive::Model model = plainModel();
  for (std::size_t i = 0; i < model.size(); ++i) model[i].time_constant = 0.001 * static_cast<double>(i);
  Bench bench(model);
  bench.set(true);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, 1);
  bench.run(1);
  // One period of 1 ms: 1 / (1 + tau / T).
  EXPECT_NEAR(bench.position(kX), 1.0, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.0 / 2, 1e-12);
  EXPECT_NEAR(bench.position(kZ), 1.0 / 3, 1e-12);
  EXPECT_NEAR(bench.position(kA), 1.0 / 4, 1e-12);
}

TEST(SimulatedDriveMotion, VelocityIsTheMeanOverThePeriod) {
  Bench bench{plainModel(0.002)};
  bench.set(true);
  bench.command(kX, 0.3);
  bench.run(1);
  EXPECT_NEAR(bench.velocity(kX), 0.3 / 3 / 0.001, 1e-9);
  bench.run(200);
  EXPECT_NEAR(bench.velocity(kX), 0, 1e-9);
}

TEST(SimulatedDriveMotion, NeedsPower) {
  Bench bench{plainModel()};
  bench.command(kX, 0.1);
  bench.run(10);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_FALSE(bench.status().enabled);
  bench.set(true);
  bench.run(1);
  EXPECT_TRUE(bench.status().enabled);
  EXPECT_GT(bench.position(kX), 0);
}

TEST(SimulatedDriveMotion, EndsWithThePower) {
  MovingBench bench;
  const Axes before = bench.positions();
  bench.set(false);
  bench.run(10);
  EXPECT_TRUE(sameBits(bench.positions(), before));
  EXPECT_FALSE(bench.status().enabled);
}

TEST(SimulatedDriveMotion, NeedsTheCommandToBeWritten) {
  Bench bench{plainModel()};
  bench.set(true);
  bench.command(kX, 0.1);
  for (int i = 0; i < 10; ++i) bench.read();
  EXPECT_EQ(bench.position(kX), 0);
  bench.write();
  bench.read();
  EXPECT_GT(bench.position(kX), 0);
}

TEST(SimulatedDriveMotion, NoTimeIsNoMotionAndNoDivisionByZero) {
  Bench bench(plainModel(), 0);
  bench.set(true);
  bench.command(kX, 0.1);
  bench.run(1);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_EQ(bench.velocity(kX), 0);
}

TEST(SimulatedDriveEncoder, RoundsToTheNearestCount) {
  Bench bench{plainModel(0, 1000)};
  bench.set(true);
  for (const auto& [commanded, counted] :
       {std::pair(0.0124, 0.012), {0.0126, 0.013}, {-0.0124, -0.012}, {-0.0126, -0.013}}) {
    bench.command(kX, commanded);
    bench.run(1);
    EXPECT_EQ(bench.position(kX), counted) << commanded;
  }
}

TEST(SimulatedDriveEncoder, DoesNotHoldTheMotorBack) {
  Bench bench{plainModel(0.002, 10)};  // counts of 0.1
  bench.set(true);
  for (int i = 1; i <= 100; ++i) {
    bench.command(kX, 0.01 * i);  // steps far below a count
    bench.run(1);
  }
  bench.run(100);
  EXPECT_EQ(bench.position(kX), 1);
}

TEST(SimulatedDriveFeedback, CountGoesUpWithEveryRead) {
  Bench bench;
  const std::uint64_t before = bench.status().feedback_count;
  for (std::uint64_t n = 1; n <= 5; ++n) {
    bench.read();
    EXPECT_EQ(bench.status().feedback_count, before + n);
  }
}

}  // namespace test_simulated_drive
}  // namespace grinder::test_support
