#include "drive/simulated_bench.h"

#include <cmath>
#include <vector>

// Spindle, coolant, swivel, reference and homing of the simulated drive.
namespace grinder::test_support {
namespace test_simulated_homing {

/// With a spindle that reaches its speed in 7.5 periods, and turns.
class SpindleBench : public Bench {
 public:
  SpindleBench() : Bench(plainModel(), 0.001, {true, 0.0075}) {
    expectToRunUp();
    run(50);
    EXPECT_TRUE(status().spindle_at_speed);
  }
  /// From rest.
  void expectToRunUp() {
    asked.spindle = true;
    for (int i = 1; i <= 8; ++i) {
      run(1);
      EXPECT_EQ(status().spindle_at_speed, i == 8) << "after " << i << " periods";
    }
  }
};

TEST(SimulatedDriveSpindle, RunsDownAsItRanUp) {
  SpindleBench bench;
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
}

TEST(SimulatedDriveSpindle, ThatIsLostRunsUpAnew) {
  SpindleBench bench;
  bench.drive.inject(Fault::kSpindleLost);
  bench.run(20);
  EXPECT_FALSE(bench.status().spindle_at_speed);
  bench.drive.inject(Fault::kNone);
  bench.expectToRunUp();
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

TEST(SimulatedDriveHoming, GoesHomeWithTheHomingVelocity) {
  HomingBench bench;
  bench.home(6);
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
  bench.home(1);
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
  bench.run(6);
  bench.expectAtHome();
  bench.run(30);
  bench.expectAtHome();
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

TEST(SimulatedDriveHoming, LosesTheReferenceThatItHadUntilItHasItAnew) {
  HomingBench bench(true);
  EXPECT_TRUE(bench.status().homed);
  EXPECT_NEAR(bench.position(kX), 0.513, 1e-12);
  EXPECT_NEAR(bench.position(kY), 1.488, 1e-12);
  bench.home(5);
  EXPECT_FALSE(bench.status().homed);
  bench.run(50);
  EXPECT_TRUE(bench.status().homed);
}

TEST(SimulatedDriveHoming, EndsUnhomedWhenTheCommandIsTakenBack) {
  HomingBench bench;
  bench.home(5);
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, bench.position(axis));
  bench.asked.home = false;
  const Axes before = bench.positions();
  bench.run(20);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_FALSE(bench.status().homed);
  EXPECT_TRUE(((bench.positions() - before).abs() < 1e-12).all());
}

TEST(SimulatedDriveHoming, NeedsPowerEndsWithItAndDoesNotGoOnWithIt) {
  HomingBench bench;
  bench.asked.enable = false;
  bench.home(50);
  EXPECT_FALSE(bench.status().homing);
  EXPECT_TRUE((bench.positions() == 0).all());
  bench.asked.home = false;
  bench.asked.enable = true;
  bench.run(1);
  bench.home(5);
  EXPECT_TRUE(bench.status().homing);
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
  bench.home(80);
  EXPECT_TRUE(bench.status().homed);
}

}  // namespace test_simulated_homing
}  // namespace grinder::test_support
