#include "drive/simulated_bench.h"

#include <cmath>

// Motion, encoders and faults of the simulated drive.
namespace grinder::test_support {
namespace test_simulated_drive {

TEST(SimulatedDriveInit, IsHomedAndReadsDecimalStartPositionsToTheLastBit) {
  SimulatedDrive::Model model = plainModel(0.002, 1e7);
  const Axes start(-0.05, 0.05, 0.1234567, -125.6637061);
  for (std::size_t i = 0; i < model.size(); ++i) model[i].start_position = start[static_cast<int>(i)];
  Bench bench(model);
  for (int i = 1; i <= 2; ++i) {
    EXPECT_TRUE(sameBits(bench.positions(), start)) << "reading " << i;
    EXPECT_TRUE(bench.status().homed);
    EXPECT_EQ(bench.status().feedback_count, static_cast<std::uint64_t>(i));
    bench.read();
  }
}

// From x toward c, each period takes the fraction 1 / (1 + tau/T) of what is left: with q = tau / (tau + T), after n
// periods the axis is at c - (c - x) q^n.
TEST(SimulatedDriveMotion, EveryAxisHasAFirstOrderLagOfItsOwn) {
  SimulatedDrive::Model model = plainModel();
  for (std::size_t i = 0; i < model.size(); ++i) model[i].time_constant = 0.001 * static_cast<double>(i);
  Bench bench(model);
  bench.asked.enable = true;
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, 1);
  for (int n = 1; n <= 20; ++n) {
    SCOPED_TRACE(n);
    bench.run(1);
    EXPECT_EQ(bench.position(kX), 1) << "without lag at once";
    EXPECT_NEAR(bench.position(kY), 1 - std::pow(1.0 / 2, n), 1e-12);
    EXPECT_NEAR(bench.position(kZ), 1 - std::pow(2.0 / 3, n), 1e-12);
    EXPECT_NEAR(bench.position(kA), 1 - std::pow(3.0 / 4, n), 1e-12);
  }
}

TEST(SimulatedDriveMotion, SettlesAtTheCommand) {
  Bench bench{plainModel(0.002, 1e7)};
  bench.asked.enable = true;
  const Axes target(0.0123, -0.004, 0.05, 17.25);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, target[axis]);
  bench.run(100);
  EXPECT_TRUE((bench.positions() == target).all()) << bench.positions().transpose();
}

TEST(SimulatedDriveMotion, VelocityIsTheMeanOverThePeriod) {
  Bench bench{plainModel(0.002)};
  bench.asked.enable = true;
  bench.command(kX, 0.3);
  bench.run(1);
  EXPECT_NEAR(bench.velocity(kX), 0.3 / 3 / 0.001, 1e-9);
  bench.run(200);
  EXPECT_NEAR(bench.velocity(kX), 0, 1e-9);
}

TEST(SimulatedDriveMotion, NeedsPowerAndEndsWithIt) {
  Bench bench{plainModel()};
  bench.command(kX, 0.1);
  bench.run(10);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_FALSE(bench.status().enabled);
  bench.asked.enable = true;
  bench.run(1);
  EXPECT_TRUE(bench.status().enabled);
  const Axes before = bench.positions();
  EXPECT_GT(before[kX], 0);
  bench.asked.enable = false;
  bench.run(10);
  EXPECT_TRUE(sameBits(bench.positions(), before));
  EXPECT_FALSE(bench.status().enabled);
}

TEST(SimulatedDriveMotion, NeedsTheCommandToBeWritten) {
  Bench bench{plainModel()};
  bench.asked.enable = true;
  bench.command(kX, 0.1);
  for (int i = 0; i < 10; ++i) bench.read();
  EXPECT_EQ(bench.position(kX), 0);
  bench.run(1);
  EXPECT_GT(bench.position(kX), 0);
}

TEST(SimulatedDriveMotion, NoTimeIsNoMotionAndNoDivisionByZero) {
  Bench bench(plainModel(), 0);
  bench.asked.enable = true;
  bench.command(kX, 0.1);
  bench.run(1);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_EQ(bench.velocity(kX), 0);
}

TEST(SimulatedDriveEncoder, RoundsToTheNearestCount) {
  Bench bench{plainModel(0, 1000)};
  bench.asked.enable = true;
  for (const auto& [commanded, counted] :
       {std::pair(0.0124, 0.012), {0.0126, 0.013}, {-0.0124, -0.012}, {-0.0126, -0.013}}) {
    bench.command(kX, commanded);
    bench.run(1);
    EXPECT_EQ(bench.position(kX), counted) << commanded;
  }
}

TEST(SimulatedDriveEncoder, DoesNotHoldTheMotorBack) {
  Bench bench{plainModel(0.002, 10)};  // counts of 0.1
  bench.asked.enable = true;
  for (int i = 1; i <= 100; ++i) {
    bench.command(kX, 0.01 * i);  // steps far below a count
    bench.run(1);
  }
  bench.run(100);
  EXPECT_EQ(bench.position(kX), 1);
}

/// Injects a fault that takes power and motion away.
void expectToStop(MovingBench& bench, Fault fault) {
  const Axes before = bench.positions();
  bench.drive.inject(fault);
  bench.run(10);
  EXPECT_EQ(bench.status().emergency_stop, fault == Fault::kEmergencyStop);
  EXPECT_EQ(bench.status().fault, fault == Fault::kDriveFault);
  EXPECT_FALSE(bench.status().enabled);
  EXPECT_TRUE(sameBits(bench.positions(), before));
  bench.drive.inject(Fault::kNone);
}

TEST(SimulatedDriveFault, EmergencyStopTakesPowerAndMotionAwayUntilItIsTakenBack) {
  MovingBench bench;
  expectToStop(bench, Fault::kEmergencyStop);
  bench.run(1);
  EXPECT_FALSE(bench.status().emergency_stop);
}

TEST(SimulatedDriveFault, DriveFaultTakesThemAwayUntilItIsTakenBackAndReset) {
  MovingBench bench;
  expectToStop(bench, Fault::kDriveFault);
  bench.run(10);
  EXPECT_TRUE(bench.status().fault);
  EXPECT_FALSE(bench.status().enabled);
  bench.asked.enable = false;
  bench.asked.reset = true;
  bench.run(1);
  EXPECT_FALSE(bench.status().fault);
  bench.asked.enable = true;
  bench.asked.reset = false;
  bench.run(1);
  EXPECT_FALSE(bench.status().fault);
  EXPECT_TRUE(bench.status().enabled);
}

TEST(SimulatedDriveFault, DriveFaultOutlastsAResetWhileItsCauseIsThere) {
  MovingBench bench;
  bench.drive.inject(Fault::kDriveFault);
  bench.asked.enable = false;
  bench.asked.reset = true;
  bench.run(3);
  EXPECT_TRUE(bench.status().fault);
  bench.drive.inject(Fault::kNone);
  bench.asked.reset = false;
  bench.run(1);
  EXPECT_TRUE(bench.status().fault);
}

TEST(SimulatedDriveFault, AStuckAxisStandsAlone) {
  for (int stuck = 0; stuck < kAxisCount; ++stuck) {
    SCOPED_TRACE("XYZA"[stuck]);
    MovingBench bench;
    const Axes before = bench.positions();
    bench.drive.inject(Fault::kStuckAxis, stuck);
    bench.run(3);
    for (int axis = 0; axis < kAxisCount; ++axis) EXPECT_EQ(bench.position(axis) > before[axis], axis != stuck) << axis;
    EXPECT_EQ(bench.position(stuck), before[stuck]);
    EXPECT_TRUE(bench.status().enabled) << "the drive must not know of it";
    EXPECT_FALSE(bench.status().fault);
  }
}

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

TEST(SimulatedDriveFault, NanFeedbackIsOfOneAxisAndGoesWhenTakenBack) {
  for (int failing = 0; failing < kAxisCount; ++failing) {
    SCOPED_TRACE("XYZA"[failing]);
    MovingBench bench;
    bench.drive.inject(Fault::kNanFeedback, failing);
    bench.run(1);
    for (int axis = 0; axis < kAxisCount; ++axis) EXPECT_EQ(std::isnan(bench.position(axis)), axis == failing) << axis;
    bench.drive.inject(Fault::kNone);
    bench.run(100);
    EXPECT_NEAR(bench.position(failing), 0.01 * (failing + 1), 1e-12);
  }
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

}  // namespace test_simulated_drive
}  // namespace grinder::test_support
