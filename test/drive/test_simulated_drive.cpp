#include "control/fixtures.h"
#include "drive/simulated_drive.h"

#include <cmath>
#include <functional>
#include <vector>

namespace grinder::test_support {
namespace test_simulated_drive {

using Fault = SimulatedDrive::Fault;

/// Uses a drive as the control loop does.
class Bench {
 public:
  explicit Bench(const SimulatedDrive::Model& model = driveModel(), double period = 0.001,
                 const SimulatedDrive::Equipment& equipment = {})
      : cycle_{ros::Time(1), ros::Duration(period), ros::Duration(period)} {
    drive.init(model, equipment);
    read();
    asked.position = feedback_.position;
  }

  void command(int axis, double position) { asked.position[static_cast<std::size_t>(axis)] = position; }
  void read() { drive.read(cycle_, feedback_); }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      drive.write(cycle_, asked);
      read();
    }
  }

  double position(int axis) const { return feedback_.position[static_cast<std::size_t>(axis)]; }
  double velocity(int axis) const { return feedback_.velocity[static_cast<std::size_t>(axis)]; }
  Axes positions() const { return {position(kX), position(kY), position(kZ), position(kA)}; }
  const DriveStatus& status() const { return feedback_.status; }

  SimulatedDrive drive;
  DriveCommand asked;  ///< in every cycle

 private:
  DriveCycle cycle_;
  DriveFeedback feedback_;
};

/// All axes at zero, with the same lag and a fine encoder.
SimulatedDrive::Model plainModel(double time_constant = 0.002, double counts_per_unit = 1e12) {
  SimulatedDrive::Model model;
  for (auto& axis : model) axis = {time_constant, counts_per_unit};
  return model;
}

/// Under power, every axis on its way to a position of its own.
class MovingBench : public Bench {
 public:
  MovingBench() : Bench(plainModel()) {
    asked.enable = true;
    for (int axis = 0; axis < kAxisCount; ++axis) command(axis, 0.01 * (axis + 1));
    run(3);
  }
};

// ---------------------------------------------------------------------------------------------------------------------
// Motion, encoders and faults

TEST(SimulatedDriveInit, IsHomedAndReadsDecimalStartPositionsToTheLastBit) {
  SimulatedDrive::Model model = plainModel(0.002, 1e7);
  const Axes start(-0.05, 0.05, 0.1234567, -125.6637061);
  for (std::size_t i = 0; i < model.size(); ++i) model[i].start_position = start[static_cast<int>(i)];
  Bench bench(model);
  for (int i = 1; i <= 2; ++i) {
    EXPECT_TRUE(sameBits(bench.positions(), start)) << "reading " << i;
    EXPECT_TRUE(bench.status().homed);
    EXPECT_FALSE(bench.status().probe_contact) << "without a blank";
    EXPECT_EQ(bench.status().feedback_count, static_cast<std::uint64_t>(i));
    bench.read();
  }
}

// From x toward c, each period takes the fraction 1 / (1 + tau/T) of what is left: with q = tau / (tau + T), after n
// periods the axis is at c - (c - x) q^n. The velocity is the mean over the period.
TEST(SimulatedDriveMotion, EveryAxisHasAFirstOrderLagOfItsOwn) {
  SimulatedDrive::Model model = plainModel();
  for (std::size_t i = 0; i < model.size(); ++i) model[i].time_constant = 0.001 * static_cast<double>(i);
  Bench bench(model);
  bench.asked.enable = true;
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, 1);
  for (int n = 1; n <= 20; ++n) {
    SCOPED_TRACE(n);
    const Axes before = bench.positions();
    bench.run(1);
    EXPECT_EQ(bench.position(kX), 1) << "without lag at once";
    for (int axis = kY; axis < kAxisCount; ++axis) {
      EXPECT_NEAR(bench.position(axis), 1 - std::pow(axis / (axis + 1.0), n), 1e-12);
      EXPECT_NEAR(bench.velocity(axis), (bench.position(axis) - before[axis]) / 0.001, 1e-8);
    }
  }
}

TEST(SimulatedDriveMotion, NeedsPowerAndTheCommandToBeWritten) {
  Bench bench{plainModel()};
  bench.command(kX, 0.1);
  bench.run(10);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_FALSE(bench.status().enabled);
  bench.asked.enable = true;
  for (int i = 0; i < 10; ++i) bench.read();
  EXPECT_EQ(bench.position(kX), 0);
  bench.run(1);
  EXPECT_TRUE(bench.status().enabled);
  const Axes before = bench.positions();
  EXPECT_GT(before[kX], 0);
  bench.asked.enable = false;
  bench.run(10);
  EXPECT_TRUE(sameBits(bench.positions(), before));
  EXPECT_FALSE(bench.status().enabled);
}

TEST(SimulatedDriveMotion, NoTimeIsNoMotionAndNoDivisionByZero) {
  Bench bench(plainModel(), 0);
  bench.asked.enable = true;
  bench.command(kX, 0.1);
  bench.run(1);
  EXPECT_EQ(bench.position(kX), 0);
  EXPECT_EQ(bench.velocity(kX), 0);
}

TEST(SimulatedDriveEncoder, RoundsToTheNearestCountAndDoesNotHoldTheMotorBack) {
  Bench coarse{plainModel(0, 1000)};
  coarse.asked.enable = true;
  for (const auto& [commanded, counted] :
       {std::pair(0.0124, 0.012), {0.0126, 0.013}, {-0.0124, -0.012}, {-0.0126, -0.013}}) {
    coarse.command(kX, commanded);
    coarse.run(1);
    EXPECT_EQ(coarse.position(kX), counted) << commanded;
  }
  Bench coarser{plainModel(0.002, 10)};  // counts of 0.1
  coarser.asked.enable = true;
  for (int i = 1; i <= 100; ++i) {
    coarser.command(kX, 0.01 * i);  // steps far below a count
    coarser.run(1);
  }
  coarser.run(100);
  EXPECT_EQ(coarser.position(kX), 1);
}

TEST(SimulatedDriveFault, EmergencyStopAndDriveFaultTakePowerAndMotionAwayTheLatterUntilReset) {
  for (const Fault fault : {Fault::kEmergencyStop, Fault::kDriveFault}) {
    const bool stays = fault == Fault::kDriveFault;
    MovingBench bench;
    const Axes before = bench.positions();
    bench.drive.inject(fault);
    bench.run(10);
    EXPECT_EQ(bench.status().emergency_stop, !stays);
    EXPECT_EQ(bench.status().fault, stays);
    EXPECT_FALSE(bench.status().enabled);
    EXPECT_TRUE(sameBits(bench.positions(), before));
    // A reset while the cause is there.
    bench.asked.enable = !stays;
    bench.asked.reset = true;
    bench.run(3);
    EXPECT_EQ(bench.status().fault, stays);
    bench.asked.reset = false;
    bench.drive.inject(Fault::kNone);
    bench.run(10);
    EXPECT_FALSE(bench.status().emergency_stop);
    EXPECT_EQ(bench.status().fault, stays);
    bench.asked.reset = true;
    bench.run(1);
    EXPECT_FALSE(bench.status().fault);
    bench.asked.enable = true;
    bench.asked.reset = false;
    bench.run(1);
    EXPECT_FALSE(bench.status().fault);
    EXPECT_TRUE(bench.status().enabled);
  }
}

TEST(SimulatedDriveFault, AStuckAxisStandsAlone) {
  for (int stuck = 0; stuck < kAxisCount; ++stuck) {
    SCOPED_TRACE(axisLetter(stuck));
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

TEST(SimulatedDriveFault, NanFeedbackIsOfOneAxisUntilAnotherTakesItsPlace) {
  for (int failing = 0; failing < kAxisCount; ++failing) {
    SCOPED_TRACE(axisLetter(failing));
    MovingBench bench;
    bench.drive.inject(Fault::kNanFeedback, failing);
    bench.run(1);
    for (int axis = 0; axis < kAxisCount; ++axis) EXPECT_EQ(std::isnan(bench.position(axis)), axis == failing) << axis;
    const int stuck = (failing + 1) % kAxisCount;
    const double before = bench.position(stuck);
    bench.drive.inject(Fault::kStuckAxis, stuck);
    bench.run(100);
    EXPECT_NEAR(bench.position(failing), 0.01 * (failing + 1), 1e-12);
    EXPECT_EQ(bench.position(stuck), before);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Spindle, coolant, swivel, reference and homing

TEST(SimulatedDriveSpindle, RunsDownAsItRunsUpAndAnewWhenItWasLost) {
  Bench bench(plainModel(), 0.001, {true, 0.0075});
  const auto expectAtSpeedAfter = [&](int periods) {
    for (int i = 1; i <= periods; ++i) {
      bench.run(1);
      EXPECT_EQ(bench.status().spindle_at_speed, i == periods) << "after " << i << " periods";
    }
  };
  bench.asked.spindle = true;
  expectAtSpeedAfter(8);
  bench.run(50);
  EXPECT_TRUE(bench.status().spindle_at_speed);
  bench.asked.spindle = false;
  bench.run(1);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.run(2);
  // Three periods down are three periods up again.
  bench.asked.spindle = true;
  bench.run(2);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.run(2);
  EXPECT_TRUE(bench.status().spindle_at_speed);
  bench.drive.inject(Fault::kSpindleLost);
  bench.run(20);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.drive.inject(Fault::kNone);
  expectAtSpeedAfter(8);
}

TEST(SimulatedDriveSpindle, AndCoolantWithoutATimeAreThereAtOnceAndGoneAtOnce) {
  Bench bench(plainModel());
  const auto expectAfterACycle = [&](bool spindle, bool coolant) {
    bench.run(1);
    EXPECT_EQ(bench.status().spindle_at_speed, spindle);
    EXPECT_EQ(bench.status().coolant_on, coolant);
  };
  bench.run(5);
  expectAfterACycle(false, false);
  bench.asked.spindle = true;
  expectAfterACycle(true, false);
  bench.asked.spindle = false;
  bench.asked.coolant = true;
  expectAfterACycle(false, true);
  bench.drive.inject(Fault::kCoolantLost);
  expectAfterACycle(false, false);
  bench.drive.inject(Fault::kNone);
  expectAfterACycle(false, true);
  bench.asked.coolant = false;
  expectAfterACycle(false, false);
}

TEST(SimulatedDriveSwivel, ThatSlipsReadsMoreUntilItIsTakenBackAndNothingWithoutAnEncoder) {
  Bench measured(plainModel(), 0.001, {true, 0, -0.4});
  Bench bare(plainModel());
  for (const auto& [fault, reading] :
       {std::pair(Fault::kNone, -0.4), {Fault::kSwivelSlipped, -0.398}, {Fault::kNone, -0.4}}) {
    measured.drive.inject(fault);
    measured.run(3);
    EXPECT_DOUBLE_EQ(measured.status().swivel, reading);
    bare.drive.inject(fault);
    bare.run(1);
    EXPECT_TRUE(std::isnan(bare.status().swivel));
  }
}

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
  explicit HomingBench(bool absolute = false, const SimulatedDrive::Model& model = farModel())
      : Bench(model, 0.001, {absolute, 0}) {
    asked.enable = true;
    run(2);
  }

  void home(int cycles) {
    asked.home = true;
    run(cycles);
  }
  void expectAtHome() const {
    EXPECT_FALSE(status().homing);
    EXPECT_TRUE(status().homed);
    EXPECT_TRUE((positions() == Axes(0.5, 1.5, 2.5, 3.5)).all()) << positions().transpose();
  }
};

TEST(SimulatedDriveHoming, IncrementalEncodersCountFromWhereTheAxesStoodAndKnowNoReference) {
  HomingBench bench;
  EXPECT_FALSE(bench.status().homed);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE((bench.positions() == 0).all()) << bench.positions().transpose();
  bench.command(kZ, 0.004);
  bench.run(100);
  EXPECT_NEAR(bench.position(kZ), 0.004, 1e-12);
}

TEST(SimulatedDriveHoming, TakesOneAxisAfterTheOtherWithItsVelocityAndFirstTheWheelFromTheWork) {
  HomingBench bench;
  bench.home(6);
  EXPECT_TRUE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  // The first reading only shows that it has begun.
  const Axes way(0, 0.005, 0, 0);
  EXPECT_TRUE(((bench.positions() - way).abs() < 1e-12).all()) << bench.positions().transpose();
  EXPECT_NEAR(bench.velocity(kY), 1, 1e-9);
  EXPECT_EQ(bench.velocity(kX), 0);
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

TEST(SimulatedDriveHoming, EndsAtHomeWhateverIsCommandedAndFollowsTheCommandsFromThere) {
  HomingBench bench;
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, 9);
  bench.home(46);
  EXPECT_TRUE(bench.status().homing) << "it has 46 periods to go";
  EXPECT_NEAR(bench.position(kX), -0.013, 1e-12) << "X is there, and waits";
  for (const int cycles : {6, 30}) {
    bench.run(cycles);
    bench.expectAtHome();
  }
  bench.asked.home = false;
  bench.command(kX, 0.45);
  bench.command(kY, 1.5);
  bench.run(100);
  EXPECT_NEAR(bench.position(kX), 0.45, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.5, 1e-12);
}

TEST(SimulatedDriveHoming, ShowsInOneReadingHoweverShortTheWay) {
  SimulatedDrive::Model model = farModel();
  for (auto& axis : model) axis.start_position = axis.home_position;
  HomingBench bench(false, model);
  bench.home(1);
  EXPECT_TRUE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  bench.run(2);
  bench.expectAtHome();
}

TEST(SimulatedDriveHoming, FindsTheReferenceAnewThatItHasLostByAFaultOrByTheRequest) {
  HomingBench bench(true);
  EXPECT_TRUE(bench.status().homed);
  EXPECT_NEAR(bench.position(kX), 0.513, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.488, 1e-12);
  bench.home(5);
  EXPECT_FALSE(bench.status().homed);
  bench.run(50);
  EXPECT_TRUE(bench.status().homed);
  bench.asked.home = false;
  bench.drive.inject(Fault::kReferenceLost);
  bench.run(1);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE(bench.status().enabled);
  bench.drive.inject(Fault::kNone);
  bench.run(20);
  EXPECT_FALSE(bench.status().homed) << "though its cause is gone";
  bench.home(80);
  EXPECT_TRUE(bench.status().homed);
}

TEST(SimulatedDriveHoming, EndsUnhomedWithTheCommandAndWithPowerAndDoesNotGoOnWithThat) {
  HomingBench bench;
  const auto expectRest = [&](int cycles) {
    const Axes before = bench.positions();
    bench.run(cycles);
    EXPECT_FALSE(bench.status().homing);
    EXPECT_FALSE(bench.status().homed);
    EXPECT_TRUE(((bench.positions() - before).abs() < 1e-12).all());
  };
  bench.asked.home = true;
  bench.asked.enable = false;
  expectRest(50);
  bench.asked.home = false;
  bench.asked.enable = true;
  bench.run(1);
  bench.home(5);
  EXPECT_TRUE(bench.status().homing);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, bench.position(axis));
  bench.asked.home = false;
  expectRest(20);
  bench.home(5);
  bench.drive.inject(Fault::kEmergencyStop);
  expectRest(1);
  bench.drive.inject(Fault::kNone);
  expectRest(50);
}

// ---------------------------------------------------------------------------------------------------------------------
// What the probe touches

constexpr double kBall = 0.001;

/// The ball stands on the axis of the work spindle, 60 mm before the blank's end face, with the axes at zero.
SimulatedDrive::Blank blank() {
  SimulatedDrive::Blank blank;
  blank.end_face = 0.06;
  blank.diameter = 0.01;
  blank.ball_diameter = kBall;
  return blank;
}

/// Whether the probe touches with the axes at a place.
bool touches(const SimulatedDrive::Blank& blank, const Axes& at) {
  Bench bench(plainModel(0));
  bench.drive.clamp(blank);
  bench.asked.enable = true;
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, at[axis]);
  bench.run(3);
  return bench.status().probe_contact;
}

/// The place between two at which the probe begins to touch; it does so at the second.
double edge(double free, double touching, const std::function<bool(double)>& touches_at) {
  EXPECT_FALSE(touches_at(free));
  EXPECT_TRUE(touches_at(touching));
  while (std::abs(touching - free) > 1e-10) {
    const double middle = (free + touching) / 2;
    (touches_at(middle) ? touching : free) = middle;
  }
  return touching;
}

TEST(SimulatedProbe, TouchesEndFaceAndCylinderBeforeItsCentreIsThere) {
  const auto end = [](double y) { return edge(0, 0.07, [y](double x) { return touches(blank(), Axes(x, y, 0, 0)); }); };
  EXPECT_NEAR(end(0), 0.0595, 1e-9);
  EXPECT_NEAR(end(0.005), 0.0595, 1e-9);
  // Over the face's edge, by 0.3 of the ball's 0.5 mm.
  EXPECT_NEAR(end(0.0053), 0.0596, 1e-9);
  EXPECT_FALSE(touches(blank(), Axes(0.07, 0.00551, 0, 0)));
  const auto side = [](double z) {
    return edge(0.02, 0, [z](double y) { return touches(blank(), Axes(0.1, y, z, 0)); });
  };
  EXPECT_NEAR(side(0), 0.0055, 1e-9);
  EXPECT_NEAR(side(0.0033), 0.0044, 1e-9);
  EXPECT_NEAR(side(-0.0033), 0.0044, 1e-9);
}

TEST(SimulatedProbe, TheRunOutTurnsWithTheWork) {
  SimulatedDrive::Blank eccentric = blank();
  eccentric.run_out = 2e-4;
  const auto at = [&](double a) {
    return edge(0.02, 0, [&](double y) { return touches(eccentric, Axes(0.1, y, 0, a)); });
  };
  EXPECT_NEAR(at(0), 0.0056, 1e-9);
  EXPECT_NEAR(at(M_PI), 0.0054, 1e-9);
  EXPECT_NEAR(at(M_PI / 2), std::sqrt(0.0055 * 0.0055 - 1e-8), 1e-9);
}

TEST(SimulatedProbe, TheRakeFaceComesDownAsATurns) {
  SimulatedDrive::Blank tooth = blank();
  tooth.rake_face = {0.001, 0.3};
  // At radius 4.5 mm, the plane at 1 mm less the ball's radius: sin(A - 0.3) = 0.5 / 4.5.
  const double angle = edge(-0.5, 0.6, [&](double a) { return touches(tooth, Axes(0.1, 0.0045, 0, a)); });
  EXPECT_NEAR(angle, 0.3 + std::asin(0.5 / 4.5), 1e-9);
  EXPECT_TRUE(touches(tooth, Axes(0.1, 0.0045, 0, M_PI / 2))) << "in the half that is left";
}

/// In a single reading each time that it comes within 0.2 mm, as through a film of coolant.
TEST(SimulatedProbe, ThatFlickersTouchesBeforeTheSurfaceToo) {
  Bench bench(plainModel(0));
  bench.drive.clamp(blank());
  bench.drive.inject(SimulatedDrive::Fault::kProbeFlickers);
  bench.asked.enable = true;
  const auto touches_at = [&](double x) {
    bench.command(kX, x);
    bench.run(1);
    return bench.status().probe_contact;
  };
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(touches_at(0.05925));
    EXPECT_TRUE(touches_at(0.05935));
    EXPECT_FALSE(touches_at(0.0594));
  }
  EXPECT_TRUE(touches_at(0.0596));
}

}  // namespace test_simulated_drive
}  // namespace grinder::test_support
