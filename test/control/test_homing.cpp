#include "flute_grinder/control/control_loop.h"

#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <cmath>

// Homing: the drive finds the machine's reference by itself while the loop only monitors it.
namespace grinder::test_support {
namespace test_homing {

using S = MachineState;
using E = MachineEvent;
using Fault = SimulatedDrive::Fault;

// ---------------------------------------------------------------------------------------------------------------------
// A simulated drive with incremental encoders, away from home when it is switched on

const Axes kFromHome(0.02, -0.01, 0.004, 0.5);  // where the axes stand at the start

SimulatedDrive::Model awayFromHome() {
  SimulatedDrive::Model model = driveModel();
  for (std::size_t i = 0; i < model.size(); ++i) {
    model[i].start_position = model[i].home_position + kFromHome[static_cast<int>(i)];
    model[i].homing_velocity = i == kA ? 50 : 1.25;  // Y, X, Z, A: 8, 16, 4 and 10 periods
  }
  return model;
}

class Incremental : public testing::Test {
 protected:
  Incremental()
      : rig_(machineConfig(),
             [](SimulatedDrive& d) {
               d.init(awayFromHome(), {false, 0.0045});
             }),
        home_(machineConfig().machine.park) {}

  void SetUp() override {
    rig_.run(3);
    rig_.enable();
  }

  void home() {
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    for (int i = 0; i < 1000 && rig_.last().state == S::kHoming; ++i) rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kReady) << rig_.last().fault.text();
  }

  /// True positions of the axes, which the encoders do not know yet.
  Axes reading(const Axes& at) const { return at - (home_ + kFromHome); }

  Rig<SimulatedDrive> rig_;
  const Axes home_;
};

TEST_F(Incremental, ReadsZeroAndStartsNoJobAtFirst) {
  EXPECT_FALSE(rig_.last().drive.homed);
  EXPECT_TRUE((rig_.last().position == 0).all()) << rig_.last().position.transpose();
  rig_.stream.emplace(rig_.paperStream());
  EXPECT_EQ(rig_.askToStart(*rig_.stream).text, "start refused: the axes are not homed");
  EXPECT_EQ(rig_.last().state, S::kReady) << "power needs no reference";
}

TEST_F(Incremental, HomingLeadsToTheHomePositionWhereTheAxesThenStand) {
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  EXPECT_EQ(rig_.last().state, S::kHoming);
  int cycles = 0;
  while (rig_.cycle().state == S::kHoming && cycles < 1000) ++cycles;
  EXPECT_EQ(rig_.last().state, S::kReady);
  // 38 periods, and a few for command and answer.
  EXPECT_GE(cycles, 37);
  EXPECT_LE(cycles, 42);
  EXPECT_TRUE(rig_.last().drive.homed);
  EXPECT_FALSE(rig_.last().drive.homing);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  const std::size_t homed = rig_.log.size() - 1;
  rig_.run(100);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(atRestFrom(rig_.log, homed));
  EXPECT_TRUE((rig_.last().position == home_).all()) << rig_.last().position.transpose();
  EXPECT_TRUE((rig_.last().command == home_).all());
}

TEST_F(Incremental, DisableEndsHomingAtOnceAndTheAxesStandUntilTheyAreHomedAnew) {
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  rig_.run(20);
  ASSERT_TRUE(rig_.ask(E::kDisable).accepted);
  EXPECT_EQ(rig_.last().state, S::kDisabled);
  const Axes stopped = rig_.cycle().position;
  EXPECT_GT((stopped - reading(home_ + kFromHome)).abs().maxCoeff(), 0.005) << "it was on its way";
  rig_.run(100);
  EXPECT_TRUE(sameBits(rig_.last().position, stopped));
  EXPECT_FALSE(rig_.last().drive.homing);
  EXPECT_FALSE(rig_.last().drive.homed);
  EXPECT_FALSE(rig_.last().drive.enabled);
  ASSERT_NO_FATAL_FAILURE(rig_.enable());
  rig_.run(50);
  EXPECT_TRUE(sameBits(rig_.last().position, stopped)) << "power on goes on with homing";
  rig_.stream.emplace(rig_.paperStream());
  EXPECT_FALSE(rig_.askToStart(*rig_.stream).accepted);
  ASSERT_NO_FATAL_FAILURE(home());
  EXPECT_TRUE((rig_.last().position == home_).all());
}

struct InjectedCase {
  const char* name;
  Fault fault;
  FaultKind kind;
};
std::ostream& operator<<(std::ostream& out, const InjectedCase& c) { return out << c.name; }

class IncrementalFault : public Incremental, public testing::WithParamInterface<InjectedCase> {};

TEST_P(IncrementalFault, EndsHomingForGood) {
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  rig_.run(20);
  rig_.drive.inject(GetParam().fault, kX);
  for (int i = 0; i < 1000 && rig_.last().state == S::kHoming; ++i) rig_.cycle();
  ASSERT_EQ(rig_.last().state, S::kFault);
  EXPECT_EQ(rig_.last().fault.kind, GetParam().kind);
  EXPECT_FALSE(rig_.last().job_ended);
  rig_.drive.inject(Fault::kNone);
  const Axes stopped = rig_.run(2).position;
  rig_.run(50);
  EXPECT_TRUE(sameBits(rig_.last().position, stopped));
  ASSERT_TRUE(rig_.ask(E::kReset).accepted);
  rig_.run(50);
  ASSERT_NO_FATAL_FAILURE(rig_.enable());
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(sameBits(rig_.last().position, stopped)) << "something moved without a request";
  EXPECT_FALSE(rig_.last().drive.homed);
  ASSERT_NO_FATAL_FAILURE(home());
  EXPECT_TRUE((rig_.last().position == home_).all());
}

INSTANTIATE_TEST_SUITE_P(
    , IncrementalFault,
    testing::Values(InjectedCase{"EmergencyStop", Fault::kEmergencyStop, FaultKind::kEmergencyStop},
                    InjectedCase{"DriveFault", Fault::kDriveFault, FaultKind::kDriveFault},
                    InjectedCase{"StaleFeedback", Fault::kStaleFeedback, FaultKind::kStaleFeedback},
                    InjectedCase{"NanFeedback", Fault::kNanFeedback, FaultKind::kInvalidFeedback},
                    InjectedCase{"StuckAxis", Fault::kStuckAxis, FaultKind::kHoming}),
    [](const testing::TestParamInfo<InjectedCase>& info) { return std::string(info.param.name); });

// As config/grinder.yaml has it: the axes are switched on where they are to go.
TEST(Homing, OfAxesThatStandAtHomeEndsToo) {
  for (const bool absolute : {false, true}) {
    Rig<SimulatedDrive> rig(machineConfig(), [=](SimulatedDrive& d) { d.init(driveModel(), {absolute, 0}); });
    rig.cycle();
    rig.enable();
    ASSERT_TRUE(rig.ask(E::kHome).accepted);
    for (int i = 0; i < 1000 && rig.last().state == S::kHoming; ++i) rig.cycle();
    EXPECT_EQ(rig.last().state, S::kReady) << rig.last().fault.text();
    EXPECT_TRUE(rig.last().drive.homed);
    EXPECT_TRUE((rig.last().position == machineConfig().machine.park).all());
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Drives that fail to home

class HomingFake : public testing::Test {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.enable();
  }

  /// Changes what the drive reports while it is commanded to home.
  /// @param change gets the number of the reading, from 1.
  void changeHoming(const std::function<void(FakeDrive&, int)>& change) {
    rig_.drive.on_read = [=, reading = 0](FakeDrive& d) mutable {
      if (d.written_drive.home) change(d, ++reading);
    };
  }

  void expectFaultFor(const std::string& time) {
    ASSERT_EQ(rig_.last().state, S::kFault);
    EXPECT_EQ(rig_.last().fault.kind, FaultKind::kHoming);
    EXPECT_EQ(rig_.last().fault.text(), "the drive has not found its reference after " + time + " s, allowed 0.0505 s");
    EXPECT_FALSE(rig_.drive.written_drive.home);
    EXPECT_FALSE(rig_.drive.written_drive.enable);
  }

  Rig<FakeDrive> rig_;
};

TEST_F(HomingFake, IsCommandedToHomeAsLongAsItDoes) {
  changeHoming([](FakeDrive& d, int reading) { d.status.homing = reading <= 7; });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 7; ++i) {
    EXPECT_TRUE(rig_.drive.written_drive.home);
    EXPECT_EQ(rig_.cycle().state, S::kHoming);
  }
  EXPECT_EQ(rig_.cycle().state, S::kReady);
  EXPECT_FALSE(rig_.drive.written_drive.home);
  EXPECT_TRUE(rig_.drive.written_drive.enable);
  EXPECT_FALSE(rig_.last().has_setpoint);
  EXPECT_EQ(rig_.jobsEnded(), 0);
}

TEST_F(HomingFake, CommandsFollowThePositionsHoweverTheyJump) {
  changeHoming([](FakeDrive& d, int reading) {
    d.status.homing = reading <= 10;
    d.place({0.1 * reading, -0.01 * reading, 0.02 * reading, -3.0 * reading});
  });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 11; ++i) {
    rig_.cycle();
    ASSERT_TRUE(sameBits(toAxes(rig_.drive.written), toAxes(rig_.drive.position))) << "cycle " << i;
  }
  EXPECT_EQ(rig_.last().state, S::kReady);
  const Axes homed = toAxes(rig_.drive.position);
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), homed));
}

TEST_F(HomingFake, ThatNeverEndsOrNeverBeginsFaultsAfterTheTimeout) {
  for (const bool begins : {true, false}) {
    SCOPED_TRACE(begins);
    // Throughout it reports that it is homed, as before.
    changeHoming([=](FakeDrive& d, int) { d.status.homing = begins; });
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    // 50.5 periods, and the cycle of the request counts.
    for (int i = 2; i <= 50; ++i) ASSERT_EQ(rig_.cycle().state, S::kHoming) << "in cycle " << i;
    rig_.cycle();
    expectFaultFor("0.051");
    ASSERT_TRUE(rig_.ask(E::kReset).accepted);
    rig_.enable();
  }
}

TEST_F(HomingFake, ThatEndsWithoutTheReferenceFaultsAtOnce) {
  changeHoming([](FakeDrive& d, int reading) {
    d.status.homing = reading <= 6;
    d.status.homed = false;
  });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 6; ++i) ASSERT_EQ(rig_.cycle().state, S::kHoming);
  rig_.cycle();
  expectFaultFor("0.008");
}

TEST_F(HomingFake, TheTimeCountsAnewForEveryRequest) {
  for (int i = 0; i < 3; ++i) {
    changeHoming([](FakeDrive& d, int reading) { d.status.homing = reading <= 40; });
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    for (int cycle = 0; cycle < 100 && rig_.last().state == S::kHoming; ++cycle) rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kReady) << "round " << i;
  }
}

TEST_F(HomingFake, ThatWasSeenInAnEarlierRequestDoesNotCount) {
  changeHoming([](FakeDrive& d, int reading) { d.status.homing = reading <= 4; });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  rig_.runUntil(S::kReady);
  // Now it takes three periods to begin.
  changeHoming([](FakeDrive& d, int reading) { d.status.homing = reading > 3 && reading <= 8; });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 8; ++i) ASSERT_EQ(rig_.cycle().state, S::kHoming);
  EXPECT_EQ(rig_.cycle().state, S::kReady);
}

TEST_F(HomingFake, LosingPowerIsAFault) {
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  rig_.run(5);
  rig_.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig_.cycle();
  EXPECT_EQ(rig_.last().state, S::kFault);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kPowerLost);
  EXPECT_FALSE(rig_.drive.written_drive.home);
}

TEST_F(HomingFake, AFollowingErrorCountsAgainAfterwards) {
  changeHoming([](FakeDrive& d, int reading) { d.status.homing = reading <= 4; });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  rig_.runUntil(S::kReady);
  rig_.drive.on_read = [](FakeDrive& d) { d.position[kX] += 0.0011; };
  rig_.cycle();
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kFollowingError);
}

}  // namespace test_homing
}  // namespace grinder::test_support
