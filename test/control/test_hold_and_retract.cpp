#include "flute_grinder/control/control_loop.h"

#include "control/fixtures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

// What an operator does to a job that runs: hold, resume, retract, cancel, and the feed override.
namespace flute_grinder {
namespace {

using testing::allSetpoints;
using testing::atRestFrom;
using testing::bringTo;
using testing::FakeDrive;
using testing::machineConfig;
using testing::Rig;
using testing::sameBits;
using testing::sameSetpoints;
using testing::smooth;
using ::testing::TestParamInfo;
using ::testing::TestWithParam;
using testing::toAxes;
using ::testing::Values;
using ::testing::ValuesIn;

using S = MachineState;
using E = MachineEvent;

// The paper's job: D1 = 10 mm, C = 5 degrees, S = 30 degrees, r = 8 degrees, 1 mm of overtravel on either side of 30
// mm, 0.5 mm deep, 5 mm of clearance, 600 mm/min.
const double kDegree = std::acos(-1.0) / 180;
const double kTanCone = std::tan(5 * kDegree);
const double kB = 2 * kTanCone / 0.010;
const double kK = 2 * std::tan(30 * kDegree) / 0.010;
const double kClearanceHeight = 0.031 * kTanCone + 0.005;
const double kFeed = 0.010;
const double kEdgePerTravel = std::sqrt(1 + std::pow(kTanCone, 2) + std::pow(std::tan(30 * kDegree), 2));
const double kStrokeTo = 0.031;

SetpointStream paperFromPark() {
  const LoopConfig config = machineConfig();
  return SetpointStream(GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), config.machine, config.machine.park));
}

/// The job's setpoints when nobody interferes.
const std::vector<Setpoint>& planned() {
  static const std::vector<Setpoint> all = allSetpoints(paperFromPark());
  return all;
}

/// Cycles of a planned move, and the position before the first.
struct Span {
  std::uint64_t first, last;
  Axes from, to;
};

Span spanOf(MoveKind move) {
  const auto is_of = [=](const Setpoint& p) { return p.cycle > 0 && p.move == move; };
  const auto first = std::find_if(planned().begin(), planned().end(), is_of);
  const auto last = std::find_if(planned().rbegin(), planned().rend(), is_of);
  return {first->cycle, last->cycle, (first - 1)->position, last->position};
}

/// A moment of the paper's job.
struct Moment {
  MoveKind move;
  int per_mille;  ///< of the move's cycles
  bool mid_pair;  ///< between the two steps of a pair

  std::uint64_t cycle() const {
    const Span span = spanOf(move);
    const std::uint64_t at = span.first + (span.last - span.first) * static_cast<std::uint64_t>(per_mille) / 1000;
    return (at + 1) / 2 * 2 + (mid_pair ? 1 : 0);
  }
};
std::ostream& operator<<(std::ostream& out, const Moment& m) { return out << toString(m.move) << " " << m.per_mille; }

std::string momentName(const TestParamInfo<Moment>& info) {
  return std::string(toString(info.param.move)) + "_" + std::to_string(info.param.per_mille) +
         (info.param.mid_pair ? "_mid_pair" : "_pair_end");
}

std::vector<Moment> moments(const std::vector<int>& per_mille) {
  std::vector<Moment> all;
  for (const MoveKind move : {MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed,
                              MoveKind::kStroke, MoveKind::kRetract, MoveKind::kReturn}) {
    for (const int at : per_mille) {
      for (const bool mid_pair : {false, true}) all.push_back({move, at, mid_pair});
    }
  }
  return all;
}

/// Whether a setpoint lies on the path that the job is to take: on the straight way of its move, or on the helix, 1 um
/// across it at the cutter's surface.
::testing::AssertionResult onPath(const Setpoint& p) {
  const auto failure = [&] {
    return ::testing::AssertionFailure() << "cycle " << p.cycle << " in " << toString(p.move) << ": "
                                         << p.position.transpose();
  };
  if (p.cycle == 0) return ::testing::AssertionSuccess();
  if (p.move == MoveKind::kStroke) {
    const double x = p.position[kX];
    const double radius = 0.005 + x * kTanCone;
    const double off_a = p.position[kA] - kK / kB * std::log1p(kB * x);
    if (!(std::abs(off_a) * radius * std::cos(30 * kDegree) <= 1.01e-6)) return failure() << " is off the helix";
    if (!(std::abs(p.position[kY] - (x * kTanCone - 0.0005)) <= 1e-12)) return failure() << " is off in Y";
    if (!(std::abs(p.position[kZ] - x * kTanCone * std::sin(8 * kDegree)) <= 1e-12)) return failure() << " is off in Z";
    return ::testing::AssertionSuccess();
  }
  const Span span = spanOf(p.move);
  const Axes way = span.to - span.from;
  const double done = ((p.position - span.from) * way).sum() / (way * way).sum();
  if (!(done >= -1e-9 && done <= 1 + 1e-9)) return failure() << " is beyond its move";
  // After the stroke A comes from where the odd-even steps have led it.
  const Axes off = (p.position - span.from - done * way).abs();
  const double a_tolerance = p.move == MoveKind::kRetract ? 1e-6 / (0.008 * std::cos(30 * kDegree)) : 1e-12;
  if (!((off.head<3>() <= 1e-12).all() && off[kA] <= a_tolerance)) return failure() << " is off its straight";
  return ::testing::AssertionSuccess();
}

/// That a job went to its end as if nobody had interfered.
template <typename Drive>
void expectCompleted(const Rig<Drive>& rig) {
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_EQ(rig.jobsEnded(), 1);
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone) << rig.last().fault.text();
  EXPECT_TRUE((rig.last().command == machineConfig().machine.park).all()) << rig.last().command.transpose();
  EXPECT_TRUE(smooth(rig.log));
  const auto setpoints = rig.setpoints();
  const bool ground = std::any_of(setpoints.begin(), setpoints.end(), [](const Setpoint& p) {
    return p.move == MoveKind::kStroke && p.position[kX] == kStrokeTo;
  });
  EXPECT_TRUE(ground) << "the stroke's end was not ground";
}

// ---------------------------------------------------------------------------------------------------------------------
// Hold and resume

class HoldAt : public TestWithParam<Moment> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runToCycle(GetParam().cycle() - 1));
    before_ = rig_.log.size();
    ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  }

  Rig<SimulatedDrive> rig_;
  std::size_t before_ = 0;  ///< records before the request
};

TEST_P(HoldAt, StopsAsAStreamHeldInTheSameCycle) {
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), allSetpoints(paperFromPark(), GetParam().cycle())));
}

TEST_P(HoldAt, IsHoldingUntilTheAxesRestThenHeld) {
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  for (std::size_t i = before_; i + 1 < rig_.log.size(); ++i) {
    ASSERT_EQ(rig_.log[i].state, S::kHolding);
    ASSERT_TRUE(rig_.log[i].has_setpoint);
  }
  EXPECT_FALSE(rig_.last().has_setpoint);
  EXPECT_EQ(rig_.setpoints().back().cycle % 2, 0u) << "rests within a pair";
}

TEST_P(HoldAt, StandsForAsLongAsItIsHeld) {
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  const std::size_t held = rig_.log.size() - 1;
  rig_.run(500);
  EXPECT_TRUE(atRestFrom(rig_.log, held));
  EXPECT_EQ(rig_.last().state, S::kHeld);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(HoldAt, ResumeGoesOnAlongThePathToTheEnd) {
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  rig_.run(50);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) {
    EXPECT_EQ(rig_.last().state, S::kRunning) << "it never left the path";
    rig_.runToEnd();
  }
  expectCompleted(rig_);
  for (const Setpoint& p : rig_.setpoints()) ASSERT_TRUE(onPath(p));
}

TEST_P(HoldAt, ResumeBeforeItRestsGoesOnWithoutARest) {
  if (rig_.last().state == S::kHeld) return;  // the move's last pair was under way
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  expectCompleted(rig_);
  for (std::size_t i = before_; i + 1 < rig_.log.size(); ++i) ASSERT_TRUE(rig_.log[i].has_setpoint) << "record " << i;
}

TEST_P(HoldAt, AgainAndAgainCompletesToo) {
  for (int i = 0; i < 5; ++i) {
    if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
    rig_.run(7);
    ASSERT_TRUE(rig_.ask(E::kResume).accepted);
    rig_.run(31);
    const RequestReply answer = rig_.ask(E::kHold);
    if (!answer.accepted) break;  // the job has ended
  }
  if (rig_.jobsEnded() == 0) {
    if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
    ASSERT_TRUE(rig_.ask(E::kResume).accepted);
    rig_.runToEnd();
  }
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(, HoldAt, ValuesIn(moments({0, 300, 500, 990})), momentName);

TEST(Hold, BeforeTheFirstSetpointKeepsTheAxesWhereTheyAre) {
  Rig<SimulatedDrive> rig;
  rig.cycle();
  rig.startPaper();
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  if (rig.last().state != S::kHeld) rig.runUntil(S::kHeld);
  rig.run(100);
  EXPECT_TRUE(sameBits(rig.last().command, machineConfig().machine.park));
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  rig.runToEnd();
  expectCompleted(rig);
  EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
}

TEST(Hold, TwiceIsAsGoodAsOnce) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kHolding));
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  rig.runUntil(S::kHeld);
  const std::size_t held = rig.log.size() - 1;
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  rig.run(50);
  EXPECT_EQ(rig.last().state, S::kHeld);
  EXPECT_TRUE(atRestFrom(rig.log, held));
}

TEST(Hold, AfterTheLastSetpointStillLetsTheJobEnd) {
  for (const int before_end : {0, 1, 2, 3}) {
    Rig<FakeDrive> rig;
    rig.cycle();
    rig.startPaper();
    rig.runToCycle(planned().back().cycle - static_cast<std::uint64_t>(before_end));
    ASSERT_TRUE(rig.ask(E::kHold).accepted) << before_end;
    if (rig.last().state != S::kHeld) rig.runUntil(S::kHeld);
    EXPECT_EQ(rig.jobsEnded(), 0);
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    if (rig.jobsEnded() == 0) rig.runToEnd();
    expectCompleted(rig);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Retract

class RetractAt : public TestWithParam<Moment> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runToCycle(GetParam().cycle() - 1));
    ASSERT_TRUE(rig_.ask(E::kHold).accepted);
    if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
    rig_.run(10);
    held_ = rig_.log.size() - 1;
    ASSERT_TRUE(rig_.ask(E::kRetract).accepted);
    if (rig_.last().state != S::kRetracted) rig_.runUntil(S::kRetracted);
  }

  Rig<SimulatedDrive> rig_;
  std::size_t held_ = 0;  ///< last record before the request
};

TEST_P(RetractAt, LiftsTheWheelRadiallyUntilItIsClear) {
  Axes last = rig_.log[held_].command;
  const double y_held = last[kY];
  for (std::size_t i = held_ + 1; i + 1 < rig_.log.size(); ++i) {
    const Axes& now = rig_.log[i].command;
    ASSERT_EQ(rig_.log[i].state, S::kRetracting);
    ASSERT_TRUE(rig_.log[i].has_setpoint);
    for (const int axis : {kX, kZ, kA}) ASSERT_EQ(now[axis], last[axis]) << kJointNames[static_cast<std::size_t>(axis)];
    ASSERT_GE(now[kY], last[kY]);
    last = now;
  }
  EXPECT_NEAR(rig_.last().command[kY], std::max(y_held, kClearanceHeight), 1e-12);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(RetractAt, StaysThere) {
  const std::size_t lifted = rig_.log.size() - 1;
  rig_.run(300);
  EXPECT_EQ(rig_.last().state, S::kRetracted);
  EXPECT_TRUE(atRestFrom(rig_.log, lifted));
  EXPECT_EQ(rig_.jobsEnded(), 0);
}

TEST_P(RetractAt, ResumeGoesBackAndCompletesTheJob) {
  rig_.run(20);
  const std::size_t lifted = rig_.log.size();
  const Axes left = rig_.log[held_].command;
  const bool in_stroke = rig_.log[held_].setpoint.move == MoveKind::kStroke;
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  expectCompleted(rig_);
  if (!in_stroke) return;
  // The flute is ground without a gap: the stroke goes on from where it was left, or from before.
  const auto entered = std::find_if(rig_.log.begin() + static_cast<std::ptrdiff_t>(lifted), rig_.log.end(),
                                    [](const CycleRecord& r) { return r.setpoint.move == MoveKind::kStroke; });
  ASSERT_NE(entered, rig_.log.end());
  EXPECT_LE((entered - 1)->command[kX], left[kX]);
  for (auto record = rig_.log.begin() + static_cast<std::ptrdiff_t>(lifted); record != entered; ++record) {
    const bool along = record->has_setpoint && record->command[kX] != (record - 1)->command[kX];
    if (!along) continue;
    ASSERT_GE(record->command[kY], kClearanceHeight - 1e-12) << "goes along the work in it";
  }
  for (auto record = entered; record != rig_.log.end(); ++record) {
    const bool stroke = record->has_setpoint && record->setpoint.move == MoveKind::kStroke;
    ASSERT_TRUE(!stroke || onPath(record->setpoint));
  }
}

TEST_P(RetractAt, IsResumingUntilItIsOnThePathThenRunning) {
  const std::size_t lifted = rig_.log.size();
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  bool running = false;
  for (std::size_t i = lifted; i + 1 < rig_.log.size(); ++i) {
    running |= rig_.log[i].state == S::kRunning;
    ASSERT_EQ(rig_.log[i].state, running ? S::kRunning : S::kResuming) << "record " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(, RetractAt, ValuesIn(moments({0, 300, 990})), momentName);

/// A number of cycles on the way off the work, or back.
class OnTheDetour : public TestWithParam<int> {
 protected:
  void SetUp() override { bringTo(rig_, S::kRetracting); }

  Rig<FakeDrive> rig_;
};

TEST_P(OnTheDetour, HoldWhileRetractingStopsTheLift) {
  rig_.run(GetParam());
  ASSERT_EQ(rig_.last().state, S::kRetracting);
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  const std::size_t held = rig_.log.size() - 1;
  rig_.run(200);
  EXPECT_TRUE(atRestFrom(rig_.log, held));
  EXPECT_LT(rig_.last().command[kY], kClearanceHeight - 1e-4);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(OnTheDetour, RetractAfterThatLiftsTheRest) {
  rig_.run(GetParam());
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  ASSERT_TRUE(rig_.ask(E::kRetract).accepted);
  EXPECT_EQ(rig_.last().state, S::kRetracting);
  rig_.runUntil(S::kRetracted);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(OnTheDetour, ResumeAfterThatGoesBackAllTheWay) {
  rig_.run(GetParam());
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().state, S::kResuming);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(OnTheDetour, HoldWhileResumingStopsAndGoesOn) {
  rig_.runUntil(S::kRetracted);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(4 * GetParam());
  ASSERT_EQ(rig_.last().state, S::kResuming);
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  const std::size_t held = rig_.log.size() - 1;
  rig_.run(100);
  EXPECT_TRUE(atRestFrom(rig_.log, held));
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().state, S::kResuming);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(OnTheDetour, RetractWhileResumingLiftsAgain) {
  rig_.runUntil(S::kRetracted);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(4 * GetParam());
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  ASSERT_TRUE(rig_.ask(E::kRetract).accepted);
  if (rig_.last().state != S::kRetracted) rig_.runUntil(S::kRetracted);
  EXPECT_GE(rig_.last().command[kY], kClearanceHeight - 1e-12);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(AfterCycles, OnTheDetour, Values(1, 2, 3, 10, 25, 50, 75, 76));

TEST(Retract, SeveralTimesInOneStrokeCompletesTheJob) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runTo(MoveKind::kStroke);
  for (int i = 0; i < 5; ++i) {
    rig.run(400);
    ASSERT_TRUE(rig.ask(E::kHold).accepted);
    rig.runUntil(S::kHeld);
    ASSERT_TRUE(rig.ask(E::kRetract).accepted);
    rig.runUntil(S::kRetracted);
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    rig.runUntil(S::kRunning);
  }
  rig.runToEnd();
  expectCompleted(rig);
}

// ---------------------------------------------------------------------------------------------------------------------
// Cancel

std::string stateName(const TestParamInfo<S>& info) { return toString(info.param); }

class CancelIn : public TestWithParam<S> {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, GetParam()));
    before_ = rig_.log.size() - 1;
    ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
    EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
    for (int i = 0; i < 1000 && rig_.last().state == S::kCanceling; ++i) rig_.cycle();
  }

  Rig<FakeDrive> rig_;
  std::size_t before_ = 0;  ///< last record before the request
};

TEST_P(CancelIn, EndsTheJobReadyAndAtRest) {
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(rig_.last().job_ended);
  const std::size_t ended = rig_.log.size() - 1;
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  EXPECT_TRUE(atRestFrom(rig_.log, ended));
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(CancelIn, MovesNothingThatStoodButTheWheelOffTheWork) {
  const Axes& before = rig_.log[before_].command;
  const Axes& now = rig_.last().command;
  EXPECT_GE(now[kY], kClearanceHeight - 1e-12);
  EXPECT_FALSE(rig_.last().wheel_in_work);
  if (GetParam() == S::kStarting || GetParam() == S::kRetracted) {
    EXPECT_TRUE(sameBits(now, before));
  } else if (GetParam() == S::kHeld) {
    EXPECT_TRUE(sameBits(now, Axes(before[kX], now[kY], before[kZ], before[kA])));
  }
}

TEST_P(CancelIn, LetsANewJobRun) {
  rig_.drive.on_read = nullptr;
  rig_.log.erase(rig_.log.begin(), rig_.log.end() - 1);
  rig_.log.front().job_ended = false;
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  rig_.runToEnd();
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(, CancelIn,
                         Values(S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting, S::kRetracted,
                                S::kResuming),
                         stateName);

// ---------------------------------------------------------------------------------------------------------------------
// Faults, in every state under power

class FaultIn : public TestWithParam<S> {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, GetParam()));
    before_ = rig_.log.size() - 1;
    rig_.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kFault);
    rig_.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = false; };
  }

  bool hadJob() const { return GetParam() != S::kReady && GetParam() != S::kHoming; }

  Rig<FakeDrive> rig_;
  std::size_t before_ = 0;  ///< last record before the fault
};

TEST_P(FaultIn, EndsTheJobIfThereIsOne) {
  EXPECT_EQ(rig_.last().job_ended, hadJob());
  rig_.stream.reset();  // it may go now
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), hadJob() ? 1 : 0);
}

TEST_P(FaultIn, NothingMovesUntilResetEnableAndStart) {
  const std::size_t standing = before_;
  const auto expectStanding = [&] {
    rig_.run(50);
    EXPECT_TRUE(atRestFrom(rig_.log, standing + 1));
    EXPECT_TRUE(sameBits(rig_.last().command, rig_.log[standing].command));
    EXPECT_FALSE(rig_.drive.written_drive.spindle);
    EXPECT_FALSE(rig_.drive.written_drive.coolant);
    EXPECT_FALSE(rig_.drive.written_drive.home);
  };
  const auto expectRefused = [&](std::initializer_list<E> events) {
    for (const E event : events) EXPECT_FALSE(rig_.ask(event, &*rig_.stream).accepted) << toString(event);
  };
  rig_.stream.emplace(rig_.paperStream());
  expectStanding();
  expectRefused({E::kEnable, E::kHome, E::kStart, E::kHold, E::kResume, E::kRetract, E::kLift, E::kCancel});
  EXPECT_TRUE(rig_.ask(E::kDisable).accepted);
  expectStanding();
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  ASSERT_TRUE(rig_.ask(E::kReset).accepted);
  expectRefused({E::kHome, E::kStart, E::kHold, E::kResume, E::kRetract, E::kLift, E::kCancel});
  expectStanding();
  EXPECT_EQ(rig_.last().state, S::kDisabled);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  ASSERT_NO_FATAL_FAILURE(rig_.enable());
  expectRefused({E::kHold, E::kResume, E::kRetract, E::kCancel});
  expectStanding();
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), hadJob() ? 1 : 0);

  if (rig_.last().wheel_in_work) {
    expectRefused({E::kHome, E::kStart});
    ASSERT_TRUE(rig_.ask(E::kLift).accepted);
    rig_.runUntil(S::kReady);
  }
  rig_.log.erase(rig_.log.begin(), rig_.log.end() - 1);
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  rig_.runToEnd();
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(, FaultIn,
                         Values(S::kReady, S::kHoming, S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting,
                                S::kRetracted, S::kResuming, S::kCanceling),
                         stateName);

TEST(FaultAtRest, AxisThatIsPushedWhileHeldOrRetractedIsAFollowingError) {
  for (const S state : {S::kHeld, S::kRetracted}) {
    Rig<FakeDrive> rig;
    ASSERT_NO_FATAL_FAILURE(bringTo(rig, state));
    rig.drive.on_read = [](FakeDrive& d) { d.position[kZ] += 0.0011; };
    rig.cycle();
    EXPECT_EQ(rig.last().state, S::kFault);
    EXPECT_EQ(rig.last().fault.kind, FaultKind::kFollowingError);
    EXPECT_EQ(rig.last().fault.axis, kZ);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Feed override

TEST(FeedOverride, IsOneAtFirst) {
  Rig<FakeDrive> rig;
  EXPECT_EQ(rig.cycle().feed_override, 1);
}

TEST(FeedOverride, TakesWhatIsInItsRangeAndRefusesTheRest) {
  Rig<FakeDrive> rig;
  for (const double good : {0.0, 1.2, 0.5, 1.0, 0.7}) {
    EXPECT_TRUE(rig.loop->setFeedOverride(good)) << good;
    EXPECT_EQ(rig.cycle().feed_override, good);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nextafter(1.2, 2.0), std::nextafter(0.0, -1.0), -1.0, 50.0, infinity, -infinity,
                           std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(rig.loop->setFeedOverride(bad)) << bad;
    EXPECT_EQ(rig.cycle().feed_override, 0.7) << "after " << bad;
  }
}

class FeedOverrideOf : public TestWithParam<double> {};

TEST_P(FeedOverrideOf, GoesForInfeedAndStrokeAndNotForRapids) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->setFeedOverride(GetParam()));
  rig.startPaper();
  rig.runToEnd();
  expectCompleted(rig);
  const std::vector<Setpoint> all = rig.setpoints();
  double fastest_infeed = 0;
  double least = 1, most = 0;  // way along X in a pair, well within the stroke
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool rapid_before = all[i].cycle <= spanOf(MoveKind::kApproach).last;
    ASSERT_TRUE(!rapid_before || sameBits(all[i].position, planned()[i].position)) << "cycle " << i;
    if (i == 0) continue;
    const double down = all[i - 1].position[kY] - all[i].position[kY];
    if (all[i].move == MoveKind::kInfeed) fastest_infeed = std::max(fastest_infeed, down / 0.001);
    const double x = all[i].position[kX];
    if (all[i].move == MoveKind::kStroke && all[i].cycle % 2 == 0 && x > 0.005 && x < 0.025) {
      const double way = x - all[i - 2].position[kX];
      least = std::min(least, way);
      most = std::max(most, way);
    }
  }
  EXPECT_NEAR(fastest_infeed, GetParam() * kFeed, 1e-9);
  const double expected = GetParam() * kFeed / kEdgePerTravel * 0.002;
  EXPECT_NEAR(least, expected, 1e-6 * expected);
  EXPECT_NEAR(most, expected, 1e-6 * expected);
}

INSTANTIATE_TEST_SUITE_P(, FeedOverrideOf, Values(0.25, 0.5, 1.0, 1.2), [](const TestParamInfo<double>& info) {
  return std::to_string(static_cast<int>(100 * info.param)) + "_percent";
});

TEST(FeedOverride, StaysForTheJobsToCome) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runTo(MoveKind::kStroke);
  rig.loop->setFeedOverride(0.5);
  rig.runToEnd();
  rig.log.erase(rig.log.begin(), rig.log.end() - 1);
  rig.log.front().job_ended = false;
  rig.stream.emplace(rig.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig.start(*rig.stream));
  rig.runTo(MoveKind::kStroke);
  rig.run(1000);
  EXPECT_EQ(rig.last().feed_override, 0.5);
  EXPECT_NEAR(rig.last().setpoint.feed, 0.5 * kFeed, 1e-6 * kFeed);
}

TEST(FeedOverride, MayChangeAtAnyMoment) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runTo(MoveKind::kInfeed);
  const double fractions[]{0.5, 1.2, 0, 1, 0.1, 0.9, 0, 0.3, 1.1};
  for (int i = 0; i < 90; ++i) {
    rig.loop->setFeedOverride(fractions[i % 9]);
    rig.run(17);
    ASSERT_EQ(rig.last().state, S::kRunning);
  }
  rig.loop->setFeedOverride(1);
  rig.runToEnd();
  expectCompleted(rig);
}

/// Rests at a feed override of 0, in the midst of the stroke.
class FeedOverrideOfZero : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
    rig_.loop->setFeedOverride(0);
    for (int i = 0; i < 1000 && rig_.cycle().has_setpoint; ++i) {
    }
    ASSERT_FALSE(rig_.last().has_setpoint) << "does not come to rest";
    at_rest_ = rig_.log.size() - 1;
  }

  Rig<FakeDrive> rig_;
  std::size_t at_rest_ = 0;
};

TEST_F(FeedOverrideOfZero, RestsInStateRunning) {
  rig_.run(500);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_));
  for (std::size_t i = at_rest_; i < rig_.log.size(); ++i) ASSERT_EQ(rig_.log[i].state, S::kRunning);
  EXPECT_EQ(rig_.last().feed_override, 0);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  EXPECT_TRUE(rig_.drive.written_drive.spindle);
}

TEST_F(FeedOverrideOfZero, GoesOnWithAnother) {
  rig_.run(50);
  rig_.loop->setFeedOverride(0.8);
  EXPECT_TRUE(rig_.cycle().has_setpoint);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_F(FeedOverrideOfZero, CanBeHeldAndResumed) {
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  rig_.cycle();
  EXPECT_EQ(rig_.last().state, S::kHeld);
  rig_.loop->setFeedOverride(1);
  rig_.run(50);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_)) << "the override moves what is held";
  rig_.loop->setFeedOverride(0);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kRunning);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_));
  rig_.loop->setFeedOverride(1);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_F(FeedOverrideOfZero, CanBeRetractedAndRestsAboveTheWorkOnTheWayBack) {
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  ASSERT_TRUE(rig_.ask(E::kRetract).accepted);
  rig_.runUntil(S::kRetracted);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12) << "a lift is no feed";
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(2000);
  EXPECT_EQ(rig_.last().state, S::kResuming);
  EXPECT_FALSE(rig_.last().has_setpoint);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
  rig_.loop->setFeedOverride(1);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_F(FeedOverrideOfZero, CanBeCanceled) {
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  rig_.runToEnd();
  rig_.run(3);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  const Axes& stood = rig_.log[at_rest_].command;
  EXPECT_TRUE(sameBits(rig_.last().command, Axes(stood[kX], rig_.last().command[kY], stood[kZ], stood[kA])));
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
}

TEST(FeedOverride, IsTakenFromAnotherThread) {
  ros::Time::init();
  FakeDrive drive;
  testing::setUp(drive, machineConfig());
  ControlLoop loop(drive, machineConfig());
  loop.startThread();
  // The deadline only ends a test that has failed.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  for (const double fraction : {0.25, 1.2, 0.0}) {
    ASSERT_TRUE(loop.setFeedOverride(fraction));
    CycleRecord record;
    record.feed_override = -1;
    while (record.feed_override != fraction && std::chrono::steady_clock::now() < deadline) {
      if (!loop.pop(record)) std::this_thread::yield();
    }
    EXPECT_EQ(record.feed_override, fraction);
  }
}

}  // namespace
}  // namespace flute_grinder
