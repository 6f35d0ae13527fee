#include "flute_grinder/control/control_loop.h"

#include "control/fixtures.h"

#include <algorithm>
#include <cmath>
#include <tuple>

// Reference, spindle, coolant and probe: what a job waits for, what it asks for, and what becomes of it when one is
// lost.
namespace flute_grinder {
namespace {

using testing::allSetpoints;
using testing::atRestFrom;
using testing::bringTo;
using ::testing::Combine;
using testing::driveModel;
using testing::FakeDrive;
using testing::machineConfig;
using testing::Rig;
using testing::sameBits;
using testing::smooth;
using ::testing::TestParamInfo;
using ::testing::TestWithParam;
using ::testing::Values;
using ::testing::ValuesIn;

using S = MachineState;
using E = MachineEvent;

/// Of the paper's cutter: 5 mm over its radius where the stroke ends, 31 mm from the small end, over that at the end.
const double kClearanceHeight = 0.031 * std::tan(5 * std::acos(-1.0) / 180) + 0.005;

/// One that can be lost.
struct Part {
  const char* name;
  Interlock interlock;
  std::function<void(FakeDrive&)> lose;
  const char* words;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"Reference", Interlock::kNotHomed, [](FakeDrive& d) { d.status.homed = false; }, "the axes are not homed"},
      {"Spindle", Interlock::kSpindle, [](FakeDrive& d) { d.status.spindle_at_speed = false; },
       "the spindle is not at speed"},
      {"Coolant", Interlock::kCoolant, [](FakeDrive& d) { d.status.coolant_on = false; }, "no coolant flows"},
      {"Probe", Interlock::kProbe, [](FakeDrive& d) { d.status.probe_free = false; },
       "the measuring probe is in the way"}};
  return all;
}
std::ostream& operator<<(std::ostream& out, const Part& part) { return out << part.name; }

/// All is well: spindle and coolant are there when they are asked for, as the drive has them anyway.
void allWell(FakeDrive& drive) { drive.status.homed = drive.status.probe_free = true; }

std::string partName(const TestParamInfo<Part>& info) { return info.param.name; }

void expectCompleted(const Rig<FakeDrive>& rig) {
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_EQ(rig.jobsEnded(), 1);
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone) << rig.last().fault.text();
  EXPECT_EQ(rig.last().interlock, Interlock::kNone);
  EXPECT_TRUE((rig.last().command == machineConfig().machine.park).all()) << rig.last().command.transpose();
  EXPECT_TRUE(smooth(rig.log));
  const auto setpoints = rig.setpoints();
  const bool ground = std::any_of(setpoints.begin(), setpoints.end(), [](const Setpoint& p) {
    return p.move == MoveKind::kStroke && p.position[kX] == 0.031;
  });
  EXPECT_TRUE(ground) << "the stroke's end was not ground";
}

TEST(InterlockText, SaysWhatIsAmiss) {
  EXPECT_STREQ(toString(Interlock::kNone), "");
  for (const Part& part : parts()) EXPECT_STREQ(toString(part.interlock), part.words);
  EXPECT_STREQ(toString(static_cast<Interlock>(99)), "unknown");
}

// ---------------------------------------------------------------------------------------------------------------------
// Before a job

class WaitsFor : public TestWithParam<Part> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.enable();
    rig_.stream.emplace(rig_.paperStream());
    ASSERT_TRUE(rig_.loop->postStart(&*rig_.stream));
    rig_.cycle();
    const auto answer = rig_.loop->startReply();
    ASSERT_TRUE(answer && answer->accepted);
    ASSERT_EQ(rig_.last().state, S::kStarting);
    rig_.drive.on_read = GetParam().lose;
  }

  Rig<FakeDrive> rig_;
};

TEST_P(WaitsFor, AsksForSpindleAndCoolantAndStreamsNothing) {
  const std::size_t from = rig_.log.size() - 1;
  for (int i = 0; i < 15; ++i) {
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kStarting);
    ASSERT_TRUE(rig_.drive.written_drive.spindle);
    ASSERT_TRUE(rig_.drive.written_drive.coolant);
  }
  EXPECT_TRUE(atRestFrom(rig_.log, from));
}

TEST_P(WaitsFor, StreamsTheWholeJobOnceItIsThere) {
  rig_.run(15);
  rig_.drive.on_read = allWell;
  EXPECT_EQ(rig_.cycle().state, S::kRunning);
  EXPECT_FALSE(rig_.last().has_setpoint);
  rig_.cycle();
  EXPECT_TRUE(rig_.last().has_setpoint);
  EXPECT_EQ(rig_.last().setpoint.cycle, 0u);
  rig_.runToEnd();
  expectCompleted(rig_);
  const LoopConfig config = machineConfig();
  const SetpointStream stream(
      GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), config.machine, config.machine.park));
  EXPECT_TRUE(testing::sameSetpoints(rig_.setpoints(), allSetpoints(stream)));
}

TEST_P(WaitsFor, GivesUpAfterTheTimeout) {
  // 20.5 periods, and the cycle of the start counts.
  for (int i = 2; i <= 20; ++i) {
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kStarting) << "in cycle " << i;
    ASSERT_FALSE(rig_.last().job_ended);
  }
  rig_.cycle();
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(rig_.last().job_ended);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kInterlock);
  EXPECT_EQ(rig_.last().fault.interlock, GetParam().interlock);
  EXPECT_EQ(rig_.last().fault.text(),
            std::string(GetParam().words) + " 0.021 s after the job was started, allowed 0.0205 s");
}

TEST_P(WaitsFor, AfterGivingUpTheMachineIsReadyWithEverythingOff) {
  const Axes before = rig_.last().command;
  rig_.runUntil(S::kReady);
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
  EXPECT_FALSE(rig_.drive.written_drive.coolant);
  EXPECT_TRUE(rig_.drive.written_drive.enable);
  rig_.stream.reset();
  rig_.drive.on_read = allWell;
  rig_.run(100);
  EXPECT_EQ(rig_.last().state, S::kReady) << "what comes late starts nothing";
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_TRUE(rig_.setpoints().empty());
  EXPECT_TRUE(sameBits(rig_.last().command, before));
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kInterlock) << "told until the next job";
}

TEST_P(WaitsFor, AfterGivingUpANewJobRuns) {
  rig_.runUntil(S::kReady);
  rig_.drive.on_read = allWell;
  rig_.log.erase(rig_.log.begin(), rig_.log.end() - 1);
  rig_.log.front().job_ended = false;
  rig_.cycle();
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(WaitsFor, CancelEndsTheWait) {
  rig_.run(5);
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  if (rig_.last().state != S::kReady) rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
}

INSTANTIATE_TEST_SUITE_P(, WaitsFor, ValuesIn(parts()), partName);

TEST(BeforeAJob, TheFirstThatIsMissingIsTold) {
  for (std::size_t first = 0; first < parts().size(); ++first) {
    Rig<FakeDrive> rig;
    rig.cycle();
    rig.enable();
    rig.stream.emplace(rig.paperStream());
    ASSERT_TRUE(rig.askToStart(*rig.stream).accepted);
    rig.drive.on_read = [=](FakeDrive& d) {
      for (std::size_t i = first; i < parts().size(); ++i) parts()[i].lose(d);
    };
    rig.runUntil(S::kReady);
    EXPECT_EQ(rig.last().fault.interlock, parts()[first].interlock);
  }
}

Rig<SimulatedDrive> simulatedRig(double spindle_run_up_time) {
  return {machineConfig(), [=](SimulatedDrive& d) { d.init(driveModel(), {true, spindle_run_up_time}); }};
}

TEST(BeforeAJob, SpindleRunsUpOnTheSimulatedDrive) {
  Rig<SimulatedDrive> rig = simulatedRig(0.0145);
  rig.cycle();
  rig.enable();
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.askToStart(*rig.stream).accepted);
  // At speed with the 15th reading after the one in which it was started.
  rig.run(14);
  EXPECT_EQ(rig.last().state, S::kStarting);
  EXPECT_TRUE(rig.last().drive.coolant_on);
  EXPECT_EQ(rig.cycle().state, S::kRunning);
  rig.runToEnd();
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_FALSE(rig.cycle().drive.spindle_at_speed);
  EXPECT_FALSE(rig.last().drive.coolant_on);
}

TEST(BeforeAJob, SpindleThatIsTooSlowOnTheSimulatedDriveEndsIt) {
  Rig<SimulatedDrive> rig = simulatedRig(0.0300);
  rig.cycle();
  rig.enable();
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.askToStart(*rig.stream).accepted);
  rig.runUntil(S::kReady);
  EXPECT_EQ(rig.last().fault.interlock, Interlock::kSpindle);
  EXPECT_TRUE(rig.setpoints().empty());
}

// ---------------------------------------------------------------------------------------------------------------------
// What the drive is told

class ToldIn : public TestWithParam<std::tuple<S, bool>> {};

TEST_P(ToldIn, TurnsTheWheelWhileAJobHasTheMachine) {
  const auto [state, on] = GetParam();
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, state));
  EXPECT_EQ(rig.drive.written_drive.spindle, on);
  EXPECT_EQ(rig.drive.written_drive.coolant, on);
  EXPECT_EQ(rig.drive.written_drive.home, state == S::kHoming);
  EXPECT_EQ(rig.drive.written_drive.enable, state != S::kDisabled && state != S::kFault);
}

INSTANTIATE_TEST_SUITE_P(
    , ToldIn,
    Values(std::tuple(S::kDisabled, false), std::tuple(S::kReady, false), std::tuple(S::kHoming, false),
           std::tuple(S::kStarting, true), std::tuple(S::kRunning, true), std::tuple(S::kHolding, true),
           std::tuple(S::kHeld, true), std::tuple(S::kRetracting, true), std::tuple(S::kRetracted, true),
           std::tuple(S::kResuming, true), std::tuple(S::kCanceling, true), std::tuple(S::kFault, false)),
    [](const TestParamInfo<std::tuple<S, bool>>& info) { return std::string(toString(std::get<0>(info.param))); });

TEST(Told, SpindleAndCoolantThroughAWholeJob) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.loop->postStart(&*rig.stream));
  for (int i = 0; i < 100000; ++i) {
    rig.cycle();
    ASSERT_EQ(rig.drive.written_drive.spindle, !rig.last().job_ended) << "record " << i;
    ASSERT_EQ(rig.drive.written_drive.coolant, !rig.last().job_ended) << "record " << i;
    if (rig.last().job_ended) break;
  }
  EXPECT_EQ(rig.last().state, S::kReady);
}

TEST(Told, SpindleAndCoolantAreOffOnceACanceledJobHasComeToRest) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kCanceling));
  while (rig.cycle().state == S::kCanceling) {
    ASSERT_TRUE(rig.drive.written_drive.spindle);
    ASSERT_TRUE(rig.drive.written_drive.coolant);
  }
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  EXPECT_FALSE(rig.drive.written_drive.coolant);
}

TEST(Told, NothingIsOnForAStartThatIsRefused) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  rig.drive.status.homed = false;
  SetpointStream stream = rig.paperStream();
  EXPECT_FALSE(rig.askToStart(stream).accepted);
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  EXPECT_FALSE(rig.drive.written_drive.coolant);
}

TEST(Told, NothingIsOnAfterTheLoopWasStopped) {
  ros::Time::init();
  FakeDrive drive;
  LoopConfig config = machineConfig();
  config.following_error.setConstant(1);
  config.feedback_timeout = config.enable_timeout = 30;  // the machine may be busy with other things
  testing::setUp(drive, config);
  SetpointStream stream(GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), config.machine, config.machine.park));
  ControlLoop loop(drive, config);
  loop.startThread();
  ASSERT_TRUE(loop.request(E::kEnable).accepted);
  ASSERT_TRUE(loop.postStart(&stream));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (loop.status().jobs_started == 0 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(loop.status().jobs_started, 1u);
  loop.stopThread();
  EXPECT_FALSE(drive.written_drive.enable);
  EXPECT_FALSE(drive.written_drive.spindle);
  EXPECT_FALSE(drive.written_drive.coolant);
}

// ---------------------------------------------------------------------------------------------------------------------
// Lost in the midst of a job

/// A moment at which something is lost, and the state of the cycle that sees it.
struct Moment {
  std::string name;
  std::function<void(Rig<FakeDrive>&)> bring;
  S then;
};
std::ostream& operator<<(std::ostream& out, const Moment& moment) { return out << moment.name; }

std::vector<Moment> moments() {
  std::vector<Moment> all;
  for (const MoveKind move : {MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed,
                              MoveKind::kStroke, MoveKind::kRetract, MoveKind::kReturn}) {
    for (const int cycles : {50, 51}) {
      const auto bring = [=](Rig<FakeDrive>& rig) {
        rig.cycle();
        rig.startPaper();
        rig.runTo(move);
        rig.run(cycles);
        ASSERT_EQ(rig.last().setpoint.move, move);
      };
      all.push_back({std::string(toString(move)) + (cycles % 2 ? "_odd" : "_even"), bring, S::kHolding});
    }
  }
  const std::vector<std::pair<S, S>> states{{S::kRunning, S::kHolding},     {S::kHolding, S::kHolding},
                                            {S::kHeld, S::kRetracting},     {S::kRetracting, S::kRetracting},
                                            {S::kRetracted, S::kRetracted}, {S::kResuming, S::kHolding}};
  for (const auto& [state, then] : states) {
    const S in = state;
    all.push_back({std::string("in_") + toString(in), [=](Rig<FakeDrive>& rig) { bringTo(rig, in); }, then});
  }
  all.push_back({"before_the_first_setpoint",
                 [](Rig<FakeDrive>& rig) {
                   rig.cycle();
                   rig.startPaper();
                 },
                 S::kHolding});
  all.push_back({"on_the_way_back_to_the_work",
                 [](Rig<FakeDrive>& rig) {
                   bringTo(rig, S::kResuming);
                   rig.runTo(MoveKind::kInfeed);
                   rig.run(300);
                   ASSERT_EQ(rig.last().setpoint.move, MoveKind::kInfeed);
                   ASSERT_EQ(rig.last().state, S::kResuming);
                 },
                 S::kHolding});
  all.push_back({"at_a_feed_override_of_0",
                 [](Rig<FakeDrive>& rig) {
                   bringTo(rig, S::kRunning);
                   rig.loop->setFeedOverride(0);
                   rig.run(500);
                   ASSERT_FALSE(rig.last().has_setpoint);
                 },
                 S::kHeld});
  for (const int before_end : {0, 1, 2, 9}) {
    all.push_back({std::to_string(before_end) + "_before_the_end",
                   [=](Rig<FakeDrive>& rig) {
                     rig.cycle();
                     rig.startPaper();
                     const std::uint64_t last = allSetpoints(*rig.stream).back().cycle;
                     rig.runToCycle(last - static_cast<std::uint64_t>(before_end));
                   },
                   before_end == 0 ? S::kHeld : S::kHolding});
  }
  return all;
}

class Lost : public TestWithParam<std::tuple<Part, Moment>> {
 protected:
  const Part part_ = std::get<0>(GetParam());

  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(std::get<1>(GetParam()).bring(rig_));
    rig_.drive.on_read = part_.lose;
    before_ = rig_.log.size() - 1;
    rig_.cycle();
  }

  void awaitRetracted() {
    if (rig_.last().state != S::kRetracted) rig_.runUntil(S::kRetracted);
    rig_.loop->setFeedOverride(1);
  }

  Rig<FakeDrive> rig_;
  std::size_t before_ = 0;  ///< last record before the loss
};

TEST_P(Lost, IsToldAndActedUponInTheSameCycle) {
  EXPECT_EQ(rig_.log[before_].interlock, Interlock::kNone);
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  EXPECT_EQ(rig_.last().state, std::get<1>(GetParam()).then);
  EXPECT_FALSE(rig_.last().job_ended);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
}

TEST_P(Lost, TakesTheWheelOffTheWorkByItself) {
  awaitRetracted();
  EXPECT_GE(rig_.last().command[kY], kClearanceHeight - 1e-12);
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  // Nowhere but along the path that it was on, and then radially.
  bool lifting = false;
  for (std::size_t i = before_ + 1; i < rig_.log.size(); ++i) {
    lifting |= rig_.log[i].state == S::kRetracting;
    if (!lifting) continue;
    for (const int axis : {kX, kZ, kA}) ASSERT_EQ(rig_.log[i].command[axis], rig_.log[i - 1].command[axis]);
  }
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(Lost, ResumeIsRefusedWithTheReasonUntilItIsBack) {
  const auto expectRefused = [&] {
    const RequestReply answer = rig_.ask(E::kResume);
    EXPECT_FALSE(answer.accepted);
    EXPECT_EQ(answer.text, std::string("resume refused: ") + part_.words);
  };
  awaitRetracted();
  const std::size_t lifted = rig_.log.size() - 1;
  expectRefused();
  rig_.run(100);
  expectRefused();
  EXPECT_EQ(rig_.last().state, S::kRetracted);
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  EXPECT_TRUE(atRestFrom(rig_.log, lifted));
}

TEST_P(Lost, NothingMovesByItselfWhenItIsBack) {
  awaitRetracted();
  const std::size_t lifted = rig_.log.size() - 1;
  rig_.drive.on_read = allWell;
  rig_.run(200);
  EXPECT_EQ(rig_.last().state, S::kRetracted);
  EXPECT_EQ(rig_.last().interlock, part_.interlock) << "told until the job is resumed";
  EXPECT_TRUE(atRestFrom(rig_.log, lifted));
}

TEST_P(Lost, ResumeCompletesTheJobOnceItIsBack) {
  awaitRetracted();
  rig_.drive.on_read = allWell;
  rig_.run(20);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(Lost, ForASinglePeriodIsAsGoodAsForLong) {
  rig_.drive.on_read = allWell;
  awaitRetracted();
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(Lost, CancelEndsTheJob) {
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  if (rig_.last().state != S::kReady) rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
  EXPECT_TRUE(smooth(rig_.log));
}

INSTANTIATE_TEST_SUITE_P(, Lost, Combine(ValuesIn(parts()), ValuesIn(moments())),
                         [](const TestParamInfo<std::tuple<Part, Moment>>& info) {
                           return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param).name;
                         });

class LostPart : public TestWithParam<Part> {
 protected:
  Rig<FakeDrive> rig_;
};

TEST_P(LostPart, WhileCancelingDoesNotKeepTheJobFromEnding) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kCanceling));
  rig_.drive.on_read = GetParam().lose;
  rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  for (const CycleRecord& record : rig_.log) {
    ASSERT_NE(record.state, S::kRetracting);
    ASSERT_EQ(record.interlock, Interlock::kNone) << "it was not the loop that stopped the job";
  }
}

TEST_P(LostPart, WithoutAJobIsNothing) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kReady));
  rig_.drive.on_read = GetParam().lose;
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
}

TEST_P(LostPart, RefusesToResumeFromHoldingToo) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  rig_.drive.on_read = GetParam().lose;
  rig_.run(3);
  ASSERT_EQ(rig_.last().state, S::kHolding);
  EXPECT_EQ(rig_.ask(E::kResume).text, std::string("resume refused: ") + GetParam().words);
  EXPECT_EQ(rig_.last().state, S::kHolding);
}

TEST_P(LostPart, BackBeforeItRestsLetsItResumeWithoutARetraction) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  rig_.drive.on_read = GetParam().lose;
  rig_.run(3);
  rig_.drive.on_read = allWell;
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
  EXPECT_EQ(rig_.last().state, S::kRunning);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(LostPart, AHoldDuringTheRetractionDoesNotLeaveTheWheelAtTheWork) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  rig_.drive.on_read = GetParam().lose;
  rig_.runUntil(S::kRetracting);
  rig_.run(20);
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  EXPECT_EQ(rig_.last().state, S::kHolding);
  rig_.runUntil(S::kRetracted);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(LostPart, AgainAfterResumeRetractsAgain) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  for (int i = 0; i < 4; ++i) {
    rig_.drive.on_read = GetParam().lose;
    rig_.runUntil(S::kRetracted);
    EXPECT_EQ(rig_.last().interlock, GetParam().interlock);
    rig_.drive.on_read = allWell;
    rig_.cycle();
    ASSERT_TRUE(rig_.ask(E::kResume).accepted);
    EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
    rig_.run(500 * i);
  }
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(LostPart, DoesNotLetANewJobInheritTheReason) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  rig_.drive.on_read = GetParam().lose;
  rig_.runUntil(S::kRetracted);
  rig_.drive.on_read = allWell;
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  if (rig_.last().state != S::kReady) rig_.runUntil(S::kReady);
  rig_.log.erase(rig_.log.begin(), rig_.log.end() - 1);
  rig_.log.front().job_ended = false;
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  rig_.runToEnd();
  expectCompleted(rig_);
  for (const CycleRecord& record : rig_.log) ASSERT_EQ(record.interlock, Interlock::kNone);
}

INSTANTIATE_TEST_SUITE_P(, LostPart, ValuesIn(parts()), partName);

TEST(LostParts, TheFirstStaysToldAndResumeTellsWhatIsAmissNow) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
  rig.run(5);
  rig.drive.on_read = [](FakeDrive& d) { d.status.coolant_on = false; };
  rig.runUntil(S::kRetracted);
  EXPECT_EQ(rig.last().interlock, Interlock::kSpindle);
  EXPECT_EQ(rig.ask(E::kResume).text, "resume refused: no coolant flows");
}

// ---------------------------------------------------------------------------------------------------------------------
// On the simulated drive, as an operator can bring them about

class LostOnTheSimulatedDrive : public TestWithParam<std::tuple<SimulatedDrive::Fault, Interlock>> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    rig_.runTo(MoveKind::kStroke);
    rig_.run(700);
    rig_.drive.inject(std::get<0>(GetParam()));
    rig_.runUntil(S::kRetracted);
    EXPECT_EQ(rig_.last().interlock, std::get<1>(GetParam()));
    EXPECT_FALSE(rig_.ask(E::kResume).accepted);
    rig_.drive.inject(SimulatedDrive::Fault::kNone);
    rig_.run(10);
  }

  Rig<SimulatedDrive> rig_;
};

TEST_P(LostOnTheSimulatedDrive, TheJobGoesOnOnceItIsBack) {
  const bool accepted = rig_.ask(E::kResume).accepted;
  if (std::get<1>(GetParam()) == Interlock::kNotHomed) {
    EXPECT_FALSE(accepted) << "a reference comes back by homing only";
    return;
  }
  ASSERT_TRUE(accepted);
  rig_.runToEnd();
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE((rig_.last().command == machineConfig().machine.park).all());
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(LostOnTheSimulatedDrive, CancelLetsTheMachineHomeAndGrindAgain) {
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  if (rig_.last().state != S::kReady) rig_.runUntil(S::kReady);
  rig_.run(50);
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 1000 && rig_.last().state == S::kHoming; ++i) rig_.cycle();
  ASSERT_EQ(rig_.last().state, S::kReady) << rig_.last().fault.text();
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  rig_.runToEnd();
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE((rig_.last().command == machineConfig().machine.park).all());
}

INSTANTIATE_TEST_SUITE_P(, LostOnTheSimulatedDrive,
                         Values(std::tuple(SimulatedDrive::Fault::kReferenceLost, Interlock::kNotHomed),
                                std::tuple(SimulatedDrive::Fault::kSpindleLost, Interlock::kSpindle),
                                std::tuple(SimulatedDrive::Fault::kCoolantLost, Interlock::kCoolant)),
                         [](const TestParamInfo<std::tuple<SimulatedDrive::Fault, Interlock>>& info) {
                           return std::string(parts()[static_cast<std::size_t>(std::get<1>(info.param)) - 1].name);
                         });

}  // namespace
}  // namespace flute_grinder
