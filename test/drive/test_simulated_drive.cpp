#include "flute_grinder/drive/simulated_drive.h"

#include "control/fixtures.h"

#include <cmath>
#include <vector>

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
  explicit Bench(const SimulatedDrive::Model& model = driveModel(), double period = 0.001,
                 const SimulatedDrive::Equipment& equipment = {})
      : period_(period) {
    drive.init(model, equipment);
    auto* joints = drive.get<PositionJointInterface>();
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = joints->getHandle(kJointNames[i]);
    drive_ = drive.get<DriveInterface>()->getHandle("drive");
  }

  void command(int axis, double position) { joints_[static_cast<std::size_t>(axis)].setCommand(position); }
  void set(const DriveCommand& command) { drive_.setCommand(command); }
  void set(bool enable, bool reset = false) { set(DriveCommand{enable, reset}); }
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
  for (auto& axis : model) axis = {time_constant, counts_per_unit};
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

// ---------------------------------------------------------------------------------------------------------------------
// Spindle and coolant

DriveCommand spindleOn() {
  DriveCommand command;
  command.spindle = true;
  return command;
}

DriveCommand coolantOn() {
  DriveCommand command;
  command.coolant = true;
  return command;
}

/// With a spindle that comes to speed in 7.5 periods.
class SpindleBench : public Bench {
 public:
  SpindleBench() : Bench(plainModel(), 0.001, {true, 0.0075}) {}
};

TEST(SimulatedDriveSpindle, RunsUpInItsTime) {
  SpindleBench bench;
  bench.set(spindleOn());
  for (int i = 1; i <= 7; ++i) {
    bench.run(1);
    EXPECT_FALSE(bench.status().spindle_at_speed) << "after " << i << " periods";
  }
  bench.run(1);
  EXPECT_TRUE(bench.status().spindle_at_speed);
  bench.run(100);
  EXPECT_TRUE(bench.status().spindle_at_speed);
}

TEST(SimulatedDriveSpindle, IsNotAtSpeedOnceItIsSwitchedOff) {
  SpindleBench bench;
  bench.set(spindleOn());
  bench.run(50);
  bench.set(DriveCommand{});
  bench.run(1);
  EXPECT_FALSE(bench.status().spindle_at_speed);
}

TEST(SimulatedDriveSpindle, RunsDownAsItRanUp) {
  SpindleBench bench;
  bench.set(spindleOn());
  bench.run(50);
  bench.set(DriveCommand{});
  bench.run(3);
  // Three periods down are three periods up again.
  bench.set(spindleOn());
  bench.run(2);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.run(2);
  EXPECT_TRUE(bench.status().spindle_at_speed);
}

TEST(SimulatedDriveSpindle, WithoutATimeIsThereAtOnceAndGoneAtOnce) {
  Bench bench(plainModel());
  bench.run(5);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.set(spindleOn());
  bench.run(1);
  EXPECT_TRUE(bench.status().spindle_at_speed);
  bench.set(DriveCommand{});
  bench.run(1);
  EXPECT_FALSE(bench.status().spindle_at_speed);
}

TEST(SimulatedDriveSpindle, ThatIsLostRunsUpAnew) {
  SpindleBench bench;
  bench.set(spindleOn());
  bench.run(50);
  bench.drive.inject(Fault::kSpindleLost);
  bench.run(20);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.drive.inject(Fault::kNone);
  bench.run(7);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.run(1);
  EXPECT_TRUE(bench.status().spindle_at_speed);
}

TEST(SimulatedDriveCoolant, FlowsWhileItIsAskedFor) {
  Bench bench(plainModel());
  bench.run(1);
  EXPECT_FALSE(bench.status().coolant_on);
  bench.set(coolantOn());
  bench.run(1);
  EXPECT_TRUE(bench.status().coolant_on);
  EXPECT_FALSE(bench.status().spindle_at_speed) << "the one is not the other";
  bench.set(DriveCommand{});
  bench.run(1);
  EXPECT_FALSE(bench.status().coolant_on);
}

TEST(SimulatedDriveCoolant, ThatIsLostFlowsAgainWhenItIsTakenBack) {
  Bench bench(plainModel());
  bench.set(coolantOn());
  bench.drive.inject(Fault::kCoolantLost);
  bench.run(3);
  EXPECT_FALSE(bench.status().coolant_on);
  bench.drive.inject(Fault::kNone);
  bench.run(1);
  EXPECT_TRUE(bench.status().coolant_on);
}

// ---------------------------------------------------------------------------------------------------------------------
// Reference and homing

/// Every axis 10 mm and more from home, and as many periods as millimetres to go.
SimulatedDrive::Model farModel() {
  SimulatedDrive::Model model = plainModel();
  for (std::size_t i = 0; i < model.size(); ++i) {
    model[i].home_position = 0.5 + static_cast<double>(i);
    model[i].start_position = model[i].home_position + (i % 2 == 0 ? 1 : -1) * 0.001 * (13 - static_cast<double>(i));
    model[i].homing_velocity = 1;
  }
  return model;
}

class HomingBench : public Bench {
 public:
  explicit HomingBench(bool absolute = false) : Bench(farModel(), 0.001, {absolute, 0}) {
    set(DriveCommand{true, false});
    run(2);
  }

  void home(bool on = true) {
    DriveCommand command;
    command.enable = true;
    command.home = on;
    set(command);
  }
};

TEST(SimulatedDriveHoming, IncrementalEncodersReadZeroAndKnowNoReference) {
  HomingBench bench;
  EXPECT_FALSE(bench.status().homed);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE((bench.positions() == 0).all()) << bench.positions().transpose();
}

TEST(SimulatedDriveHoming, AbsoluteEncodersReadWhereTheAxesStand) {
  HomingBench bench(true);
  EXPECT_TRUE(bench.status().homed);
  EXPECT_NEAR(bench.position(kX), 0.513, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.488, 1e-12);
}

TEST(SimulatedDriveHoming, IncrementalEncodersCountFromWhereTheAxesStood) {
  HomingBench bench;
  bench.command(kZ, 0.004);
  bench.run(100);
  EXPECT_NEAR(bench.position(kZ), 0.004, 1e-12);
}

TEST(SimulatedDriveHoming, GoesHomeWithTheHomingVelocity) {
  HomingBench bench;
  bench.home();
  bench.run(6);
  EXPECT_TRUE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  // The first reading only shows that it has begun.
  const Axes way(0, 0.005, 0, 0);
  EXPECT_TRUE(((bench.positions() - way).abs() < 1e-12).all()) << bench.positions().transpose();
  EXPECT_NEAR(bench.velocity(kY), 1, 1e-9);
  EXPECT_EQ(bench.velocity(kX), 0);
}

TEST(SimulatedDriveHoming, TakesOneAxisAfterTheOtherAndFirstTheWheelFromTheWork) {
  HomingBench bench;
  bench.home();
  bench.run(1);
  std::vector<int> order;
  Axes last = bench.positions();
  while (bench.status().homing) {
    bench.run(1);
    const Axes now = bench.positions();
    for (int axis = 0; axis < kAxisCount && bench.status().homing; ++axis) {
      if (now[axis] != last[axis] && (order.empty() || order.back() != axis)) order.push_back(axis);
    }
    last = now;
  }
  EXPECT_EQ(order, (std::vector<int>{kY, kX, kZ, kA}));
}

TEST(SimulatedDriveHoming, EndsAtHomeWhenTheLastAxisIsThere) {
  HomingBench bench;
  bench.home();
  bench.run(46);
  EXPECT_TRUE(bench.status().homing) << "it has 46 periods to go";
  EXPECT_NEAR(bench.position(kX), -0.013, 1e-12) << "X is there, and waits";
  bench.run(6);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE(bench.status().homed);
  EXPECT_TRUE((bench.positions() == Axes(0.5, 1.5, 2.5, 3.5)).all()) << bench.positions().transpose();
}

TEST(SimulatedDriveHoming, ShowsInOneReadingHoweverShortTheWay) {
  SimulatedDrive::Model model = farModel();
  for (auto& axis : model) axis.start_position = axis.home_position;
  Bench bench(model, 0.001, {false, 0});
  DriveCommand command;
  command.enable = command.home = true;
  bench.set(command);
  bench.run(1);
  EXPECT_TRUE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  bench.run(2);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE(bench.status().homed);
}

TEST(SimulatedDriveHoming, DoesNotFollowCommandsMeanwhileNorBeginAnewByItself) {
  HomingBench bench;
  bench.home();
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, 9);
  bench.run(80);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE((bench.positions() == Axes(0.5, 1.5, 2.5, 3.5)).all()) << bench.positions().transpose();
}

TEST(SimulatedDriveHoming, CommandsReferToTheReferenceAfterwards) {
  HomingBench bench;
  bench.home();
  bench.run(50);
  bench.home(false);
  bench.command(kX, 0.45);
  bench.command(kY, 1.5);
  bench.run(100);
  EXPECT_NEAR(bench.position(kX), 0.45, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.5, 1e-12);
}

TEST(SimulatedDriveHoming, EndsUnhomedWhenTheCommandIsTakenBack) {
  HomingBench bench;
  bench.home();
  bench.run(5);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, bench.position(axis));
  bench.home(false);
  const Axes before = bench.positions();
  bench.run(20);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE(((bench.positions() - before).abs() < 1e-12).all());
}

TEST(SimulatedDriveHoming, LosesTheReferenceThatItHadUntilItHasItAnew) {
  HomingBench bench(true);
  bench.home();
  bench.run(5);
  EXPECT_FALSE(bench.status().homed);
  bench.run(50);
  EXPECT_TRUE(bench.status().homed);
}

TEST(SimulatedDriveHoming, NeedsPower) {
  HomingBench bench;
  DriveCommand command;
  command.home = true;
  bench.set(command);
  bench.run(50);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE((bench.positions() == 0).all());
}

TEST(SimulatedDriveHoming, EndsWithThePowerAndDoesNotGoOnWithIt) {
  HomingBench bench;
  bench.home();
  bench.run(5);
  bench.drive.inject(Fault::kEmergencyStop);
  bench.run(1);
  const Axes before = bench.positions();
  EXPECT_FALSE(bench.status().homing);
  bench.drive.inject(Fault::kNone);
  bench.run(50);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE(sameBits(bench.positions(), before));
}

TEST(SimulatedDriveFault, ALostReferenceStaysLostUntilHomed) {
  HomingBench bench(true);
  bench.drive.inject(Fault::kReferenceLost);
  bench.run(1);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE(bench.status().enabled);
  bench.drive.inject(Fault::kNone);
  bench.run(20);
  EXPECT_FALSE(bench.status().homed);
  bench.home();
  bench.run(80);
  EXPECT_TRUE(bench.status().homed);
}

}  // namespace
}  // namespace flute_grinder
