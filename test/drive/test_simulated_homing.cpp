#include "control/fixtures.h"
#include "drive/simulated_bench.h"

#include <cmath>
#include <vector>

// Spindle, coolant, swivel, reference and homing of the simulated drive.
namespace grinder::test_support {
namespace test_simulated_homing {

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

/// With a spindle that reaches its speed in 7.5 periods.
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

TEST(SimulatedDriveSwivel, IsNotMeasuredUnlessItHasAnEncoder) {
  Bench bench(plainModel());
  bench.run(2);
  EXPECT_TRUE(std::isnan(bench.status().swivel));
  bench.drive.inject(Fault::kSwivelSlipped);
  bench.run(1);
  EXPECT_TRUE(std::isnan(bench.status().swivel));
}

TEST(SimulatedDriveSwivel, ThatSlipsReadsMoreUntilItIsTakenBack) {
  Bench bench(plainModel(), 0.001, {true, 0, -0.4});
  bench.run(1);
  EXPECT_EQ(bench.status().swivel, -0.4);
  bench.drive.inject(Fault::kSwivelSlipped);
  bench.run(3);
  EXPECT_DOUBLE_EQ(bench.status().swivel, -0.398);
  bench.drive.inject(Fault::kNone);
  bench.run(1);
  EXPECT_EQ(bench.status().swivel, -0.4);
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

}  // namespace test_simulated_homing
}  // namespace grinder::test_support
