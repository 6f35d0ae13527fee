#include "flute_grinder/drive/simulated_drive.h"

#include "fixtures.h"

#include <cmath>

namespace flute_grinder {
namespace {

using testing::driveModel;
using testing::sameBits;
using ::testing::TestWithParam;
using ::testing::Values;

using Fault = SimulatedDrive::Fault;

/// A drive used by its handles alone, as the control loop does.
class Bench {
 public:
  explicit Bench(const SimulatedDrive::Model& model = driveModel(), double period = 0.001) : period_(period) {
    drive.init(model);
    auto* joints = drive.get<PositionJointInterface>();
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = joints->getHandle(kJointNames[i]);
    drive_ = drive.get<DriveInterface>()->getHandle("drive");
  }

  void command(int axis, double position) { joints_[static_cast<std::size_t>(axis)].setCommand(position); }
  void set(bool enable, bool reset = false) { drive_.setCommand({enable, reset}); }
  void read() { drive.read(ros::Time(1), ros::Duration(period_)); }
  void write() { drive.write(ros::Time(1), ros::Duration(period_)); }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      write();
      read();
    }
  }

  double position(int axis) const { return joints_[static_cast<std::size_t>(axis)].getPosition(); }
  double velocity(int axis) const { return joints_[static_cast<std::size_t>(axis)].getVelocity(); }
  Axes positions() const { return {position(kX), position(kY), position(kZ), position(kA)}; }
  const DriveStatus& status() const { return drive_.getStatus(); }

  SimulatedDrive drive;

 private:
  double period_;
  std::array<JointHandle, kAxisCount> joints_;
  DriveHandle drive_;
};

/// All axes at zero, with the same lag and a fine encoder.
SimulatedDrive::Model plainModel(double time_constant = 0.002, double counts_per_unit = 1e12) {
  SimulatedDrive::Model model;
  for (auto& axis : model) axis = {time_constant, counts_per_unit, 0};
  return model;
}

/// Under power, every axis told to go to a place of its own, and on its way there.
class MovingBench : public Bench {
 public:
  MovingBench() : Bench(plainModel()) {
    set(true);
    for (int axis = 0; axis < kAxisCount; ++axis) command(axis, 0.01 * (axis + 1));
    run(3);
  }
};

// ---------------------------------------------------------------------------------------------------------------------
// Set up

TEST(SimulatedDriveInit, OffersTheFourJointsBothWays) {
  const std::vector<std::string> names{"axis_a", "axis_x", "axis_y", "axis_z"};
  Bench bench;
  ASSERT_NE(bench.drive.get<JointStateInterface>(), nullptr);
  EXPECT_EQ(bench.drive.get<JointStateInterface>()->getNames(), names);
  EXPECT_EQ(bench.drive.get<PositionJointInterface>()->getNames(), names);
}

TEST(SimulatedDriveInit, StateAndCommandHandlesReadTheSameJoint) {
  MovingBench bench;
  for (const char* name : kJointNames) {
    const JointStateHandle state = bench.drive.get<JointStateInterface>()->getHandle(name);
    EXPECT_EQ(state.getPosition(), bench.drive.get<PositionJointInterface>()->getHandle(name).getPosition());
    EXPECT_NE(state.getPosition(), 0);
  }
}

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

// With h = T / tau: h - h^2/2 <= ln(1 + h) <= h, and so exp(-n h) <= q^n <= exp(-n h + n h^2 / 2).
TEST(SimulatedDriveMotion, ApproachesTheContinuousLagInShortPeriods) {
  Bench bench{plainModel(0.1), 0.001};
  bench.set(true);
  bench.command(kY, 1);
  const double h = 0.001 / 0.1;
  for (int n = 1; n <= 300; ++n) {
    bench.run(1);
    const double left = 1 - bench.position(kY);
    ASSERT_GE(left, std::exp(-n * h) - 1e-12) << "after " << n << " periods";
    ASSERT_LE(left, std::exp(-n * h + n * h * h / 2) + 1e-12) << "after " << n << " periods";
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

TEST(SimulatedDriveMotion, TurnsOverManyTurns) {
  Bench bench{plainModel(0.002, 1e6)};
  bench.set(true);
  bench.command(kA, -100);
  bench.run(200);
  EXPECT_EQ(bench.position(kA), -100);
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

// ---------------------------------------------------------------------------------------------------------------------
// Faults

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

class StuckAxis : public TestWithParam<int> {};

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

INSTANTIATE_TEST_SUITE_P(Axis, StuckAxis, Values(kX, kY, kZ, kA),
                         [](const ::testing::TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

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

class NanFeedback : public TestWithParam<int> {};

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

INSTANTIATE_TEST_SUITE_P(Axis, NanFeedback, Values(kX, kY, kZ, kA),
                         [](const ::testing::TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

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

}  // namespace
}  // namespace flute_grinder
