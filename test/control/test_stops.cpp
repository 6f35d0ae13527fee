#include "control/checks.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>
#include <deque>

// Stops in every state, and the job in the loop's status.
namespace grinder::test_support {
namespace test_stops {

// ---------------------------------------------------------------------------------------------------------------------
// Hold before the first setpoint

class HoldWhileStarting : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kStarting));
    ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  }

  void spindleComes() { rig_.drive.on_read = nullptr; }

  Rig<FakeDrive> rig_;
};

TEST_F(HoldWhileStarting, LetsSpindleAndCoolantRunUpIsHeldThenAndResumedGrindsTheWholeJob) {
  rig_.run(5);
  EXPECT_EQ(rig_.last().state, S::kStarting);
  EXPECT_TRUE(rig_.drive.written_drive.spindle);
  EXPECT_TRUE(rig_.drive.written_drive.coolant);
  spindleComes();
  rig_.runUntil(S::kHeld);
  rig_.run(500);
  EXPECT_EQ(rig_.last().state, S::kHeld);
  EXPECT_TRUE(rig_.drive.written_drive.spindle);
  // No axis was commanded to move.
  for (const CycleSample& sample : rig_.log) {
    EXPECT_NE(sample.state, S::kRunning);
    ASSERT_TRUE(sameBits(sample.command, machineConfig().machine.park)) << toString(sample.state);
  }
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), allSetpoints(SetpointStream(rig_.stream->program()))));
}

TEST_F(HoldWhileStarting, ResumeWhileStartingTakesItBack) {
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().state, S::kStarting);
  spindleComes();
  rig_.runUntil(S::kRunning);
  rig_.runToEnd();
  EXPECT_EQ(rig_.loop->status().end, JobEnd::kDone);
  for (const CycleSample& sample : rig_.log) EXPECT_NE(sample.state, S::kHeld);
}

TEST_F(HoldWhileStarting, CancelEndsTheJobWithoutASetpoint) {
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.loop->status().end, JobEnd::kCanceled);
  EXPECT_TRUE(rig_.setpoints().empty());
}

// ---------------------------------------------------------------------------------------------------------------------
// Disable

class DisableIn : public testing::TestWithParam<S> {
 protected:
  void SetUp() override { ASSERT_NO_FATAL_FAILURE(bringTo(rig_, GetParam())); }

  Rig<FakeDrive> rig_;
};

TEST_P(DisableIn, StopsOnThePathLiftsTheWheelSwitchesOffOnceItIsUpAndIsDoneWithTheNextEnable) {
  ASSERT_TRUE(rig_.ask(E::kDisable).accepted);
  for (int i = 0; i < 5000 && rig_.last().state == S::kCanceling; ++i) {
    ASSERT_TRUE(rig_.drive.written_drive.enable) << "power off before the axes rest";
    ASSERT_TRUE(rig_.drive.written_drive.spindle);
    rig_.cycle();
  }
  EXPECT_EQ(rig_.last().state, S::kDisabled);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  EXPECT_FALSE(rig_.last().wheel_in_work);
  EXPECT_GE(rig_.last().command[kY], kClearanceHeight - 1e-12);
  EXPECT_TRUE(smooth(rig_.log));
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.loop->status().end, JobEnd::kCanceled);
  const std::size_t off = rig_.log.size() - 1;
  rig_.run(50);
  EXPECT_TRUE(atRestFrom(rig_.log, off));
  EXPECT_EQ(rig_.last().state, S::kDisabled);

  rig_.drive.on_read = nullptr;
  ASSERT_NO_FATAL_FAILURE(rig_.startPaper());
  rig_.run(300);
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  rig_.runUntil(S::kReady);
  rig_.run(5);
  EXPECT_EQ(rig_.last().state, S::kReady) << "the disable of the job before has come again";
}

INSTANTIATE_TEST_SUITE_P(, DisableIn,
                         testing::Values(S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting,
                                         S::kRetracted, S::kResuming, S::kCanceling),
                         stateName);

TEST(Disable, WhilePowerIsAwaitedTakesTheEnableBack) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.cycle();
  ASSERT_FALSE(rig.loop->reply());
  const std::uint32_t ticket = rig.loop->postStopWithReply(E::kDisable);
  rig.cycle();
  const auto stopped = rig.loop->stopReply(E::kDisable, ticket);
  ASSERT_TRUE(stopped) << "a stop waits for an enable";
  EXPECT_TRUE(stopped->accepted);
  const auto enabled = rig.loop->reply();
  ASSERT_TRUE(enabled);
  EXPECT_EQ(enabled->text, "enable refused: disable came before the power");
  rig.drive.on_read = nullptr;
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
}

class EndsHoming : public testing::TestWithParam<E> {};

TEST_P(EndsHoming, ByThePower) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kHoming));
  ASSERT_TRUE(rig.ask(GetParam()).accepted);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  EXPECT_FALSE(rig.drive.written_drive.home);
}

INSTANTIATE_TEST_SUITE_P(, EndsHoming, testing::Values(E::kHold, E::kCancel, E::kDisable),
                         [](const testing::TestParamInfo<E>& info) { return std::string(toString(info.param)); });

// ---------------------------------------------------------------------------------------------------------------------
// Cancel

TEST(CancelWithLift, LiftsTheWheelWhileSpindleAndCoolantRunAlsoWithoutThem) {
  for (const bool lost : {false, true}) {
    Rig<FakeDrive> rig;
    ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kCanceling));
    EXPECT_TRUE(rig.last().wheel_in_work);
    if (lost) rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = d.status.coolant_on = false; };
    while (rig.cycle().state == S::kCanceling) {
      ASSERT_TRUE(rig.drive.written_drive.spindle);
      ASSERT_TRUE(rig.drive.written_drive.coolant);
    }
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_FALSE(rig.drive.written_drive.spindle);
    EXPECT_FALSE(rig.drive.written_drive.coolant);
    EXPECT_NEAR(rig.last().command[kY], kClearanceHeight, 1e-12);
    EXPECT_FALSE(rig.last().wheel_in_work);
    EXPECT_TRUE(smooth(rig.log));
  }
}

TEST(CancelWithLift, AgainDuringTheLiftChangesNothing) {
  Rig<FakeDrive> once, often;
  ASSERT_NO_FATAL_FAILURE(bringTo(once, S::kCanceling));
  ASSERT_NO_FATAL_FAILURE(bringTo(often, S::kCanceling));
  while (once.cycle().state == S::kCanceling) {
  }
  while (often.last().state == S::kCanceling) {
    often.loop->postStop(E::kCancel);
    often.cycle();
  }
  EXPECT_TRUE(sameSetpoints(often.setpoints(), once.setpoints()));
}

/// Every motion can be stopped.
TEST(CancelWithLift, AHoldDuringTheLiftStopsItAndTheJobEndsWithTheWheelInTheWork) {
  for (const double lifted : {0.0, 1e-4, 1e-3}) {
    Rig<FakeDrive> rig;
    ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kCanceling));
    const double stopped_at = rig.last().command[kY];
    while (rig.last().command[kY] < stopped_at + lifted) rig.cycle();
    ASSERT_TRUE(rig.ask(E::kHold).accepted);
    rig.runUntil(S::kReady);
    EXPECT_LT(rig.last().command[kY], kClearanceHeight - 1e-4);
    EXPECT_TRUE(smooth(rig.log));
    const LoopStatus status = rig.loop->status();
    EXPECT_EQ(status.end, JobEnd::kCanceled);
    EXPECT_TRUE(status.wheel.in_work);
    ASSERT_TRUE(rig.ask(E::kLift).accepted);
    rig.runUntil(S::kReady);
    EXPECT_FALSE(rig.last().wheel_in_work);
  }
}

TEST(CancelWithLift, AFaultDuringTheLiftEndsTheJobAsAFault) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kCanceling));
  const double stopped_at = rig.last().command[kY];
  while (rig.last().command[kY] < stopped_at + 1e-3) rig.cycle();
  rig.drive.status.emergency_stop = true;
  rig.cycle();
  const LoopStatus status = rig.loop->status();
  EXPECT_EQ(status.state, S::kFault);
  EXPECT_EQ(status.end, JobEnd::kFault);
  EXPECT_EQ(status.fault.kind, FaultKind::kEmergencyStop);
  EXPECT_TRUE(status.wheel.in_work);
}

TEST(CancelWithLift, InTheCycleOfTheStartEndsTheJobBeforeAnythingMoves) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.loop->startJob(&*rig.stream));
  rig.loop->postStop(E::kCancel);
  rig.cycle();
  const auto started = rig.loop->startJobReply();
  ASSERT_TRUE(started);
  EXPECT_TRUE(started->accepted) << started->text;
  rig.run(20);
  const LoopStatus status = rig.loop->status();
  EXPECT_EQ(status.state, S::kReady);
  EXPECT_EQ(status.jobs_started, 1u);
  EXPECT_EQ(status.jobs_ended, 1u);
  EXPECT_EQ(status.end, JobEnd::kCanceled);
  EXPECT_EQ(status.setpoints_written, 0u);
}

TEST(Stops, WinOverARequestOfTheSameCycleWhicheverCameFirst) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kHeld));
  rig.loop->postStop(E::kHold);
  ASSERT_TRUE(rig.loop->post(E::kResume));
  const std::size_t before = rig.log.size();
  rig.cycle();
  rig.runUntil(S::kHeld);
  rig.run(50);
  EXPECT_EQ(rig.last().state, S::kHeld);
  EXPECT_TRUE(sameBits(rig.last().command, rig.log[before - 1].command)) << "it moved, though held";
}

TEST(Stops, AllAtOnceAreAllCarriedOutAndAllAnswered) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  const std::uint32_t ticket = rig.loop->postStopWithReply(E::kHold);
  rig.loop->postStop(E::kCancel);
  rig.loop->postStop(E::kDisable);
  rig.cycle();
  EXPECT_EQ(rig.last().state, S::kCanceling);
  const auto answer = rig.loop->stopReply(E::kHold, ticket);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted);
  rig.runUntil(S::kDisabled);
}

TEST(Stops, OfAnotherThreadAreNoAnswerToOnesOwn) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kReady));
  rig.loop->postStop(E::kCancel);  // refused, to nobody
  rig.cycle();
  const std::uint32_t ticket = rig.loop->postStopWithReply(E::kCancel);
  EXPECT_FALSE(rig.loop->stopReply(E::kCancel, ticket));
  rig.cycle();
  const auto answer = rig.loop->stopReply(E::kCancel, ticket);
  ASSERT_TRUE(answer);
  EXPECT_EQ(
      answer->text,
      "cancel refused: the machine is in state ready; allowed: enable, disable, home, start (grind run), lift, jog");
}

TEST(Stops, WhatIsNoneIsNotTaken) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  for (const E event : {E::kEnable, E::kHome, E::kStart, E::kReset, E::kDone, E::kFault, static_cast<E>(99)}) {
    rig.loop->postStop(event);
  }
  rig.run(3);
  EXPECT_EQ(rig.last().state, S::kRunning);
}

// ---------------------------------------------------------------------------------------------------------------------
// The status

TEST(Status, ReportsAWholeJob) {
  Rig<SimulatedDrive> rig;
  rig.cycle();
  EXPECT_EQ(rig.loop->status().cycles, 1u);
  EXPECT_EQ(rig.loop->status().jobs_started, 0u);
  rig.startPaper();
  rig.runToEnd();
  const LoopStatus status = rig.loop->status();
  EXPECT_EQ(status.cycles, rig.log.size());
  EXPECT_DOUBLE_EQ(status.time, rig.last().time);
  EXPECT_EQ(status.state, S::kReady);
  EXPECT_TRUE(status.homed);
  EXPECT_TRUE(sameBits(toAxes(status.command), rig.last().command));
  EXPECT_EQ(status.jobs_started, 1u);
  EXPECT_EQ(status.jobs_ended, 1u);
  EXPECT_EQ(status.end, JobEnd::kDone);
  EXPECT_EQ(status.setpoints_written, rig.setpoints().size());
  const auto& moves = rig.stream->program().moves();
  EXPECT_EQ(status.place.move_index + 1, moves.size());
  EXPECT_EQ(status.place.move_fraction, 1);
  const auto stroke =
      std::find_if(moves.begin(), moves.end(), [](const Move& m) { return m.kind == MoveKind::kStroke; });
  EXPECT_EQ(status.strokes_ended_at, static_cast<std::uint32_t>(stroke - moves.begin()) + 1);
  EXPECT_FALSE(status.wheel.in_work);
  EXPECT_NEAR(status.wheel.clear_y, kClearanceHeight, 1e-15);
  EXPECT_NEAR(status.wheel.lift, kClearanceHeight - (-0.001 * kTanCone - 0.0016), 1e-15);
  EXPECT_EQ(rig.last().job, 1u);
}

TEST(Status, KeepsTheCauseOfAJobsEndUntilTheNextStarts) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kFault));
  ASSERT_TRUE(rig.ask(E::kReset).accepted);
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
  EXPECT_EQ(rig.loop->status().end, JobEnd::kFault);
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kDriveFault);
  rig.enable();
  ASSERT_TRUE(rig.ask(E::kLift).accepted);
  rig.runUntil(S::kReady);
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kDriveFault);
  rig.stream.emplace(rig.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig.start(*rig.stream));
  EXPECT_EQ(rig.loop->status().end, JobEnd::kNone);
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kNone);
  EXPECT_EQ(rig.loop->status().jobs_started, 2u);
  EXPECT_EQ(rig.loop->status().place.move_index, 0u);
  EXPECT_EQ(rig.loop->status().strokes_ended_at, 0u);
}

TEST(Status, OfASpindleThatDidNotComeReportsIt) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kStarting));
  rig.runUntil(S::kReady);
  EXPECT_EQ(rig.loop->status().end, JobEnd::kFault);
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kInterlock);
}

// Held while it brakes at its end, the stroke rests exactly there, and the retraction enters it again.
TEST(Status, AStrokeThatHasEndedStaysEndedWhenARetractionEntersItAgain) {
  Rig<FakeDrive> probe;
  probe.cycle();
  probe.startPaper();
  probe.runTo(MoveKind::kRetract);
  const std::uint64_t last = probe.last().setpoint.cycle - 1;
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runToCycle(last - 2);
  ASSERT_NO_FATAL_FAILURE(rig.hold());
  rig.cycle();
  ASSERT_EQ(rig.last().setpoint.move, MoveKind::kStroke);
  const std::uint32_t ended = rig.last().setpoint.move_index + 1;
  EXPECT_EQ(rig.loop->status().strokes_ended_at, ended);
  ASSERT_NO_FATAL_FAILURE(rig.retract());
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  bool entered_again = false;
  while (rig.last().state != S::kReady) {
    rig.cycle();
    ASSERT_EQ(rig.loop->status().strokes_ended_at, ended);
    entered_again |= rig.last().has_setpoint && rig.last().setpoint.move == MoveKind::kStroke &&
                     rig.last().setpoint.move_fraction < 1;
  }
  EXPECT_TRUE(entered_again);
}

/// Plays each command `depth` cycles after it was written.
struct Delay {
  std::size_t depth;
  std::deque<Axes> waiting{};

  void operator()(FakeDrive& drive) {
    if (!drive.status.enabled) return waiting.clear();
    waiting.push_back(toAxes(drive.written));
    if (waiting.size() > depth + 1) waiting.pop_front();
    drive.place(waiting.front());
    drive.status.commands_waiting = static_cast<std::uint32_t>(waiting.size() - 1);
  }
};

TEST(Status, OfADriveThatBuffersReportsWhereTheAxesAre) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = Delay{50};
  rig.cycle();
  for (int job = 1; job <= 2; ++job) {
    rig.last().state == S::kDisabled ? rig.startPaper() : [&] {
      rig.stream.emplace(rig.paperStream());
      rig.start(*rig.stream);
    }();
    std::vector<Setpoint> written{rig.last().setpoint};
    std::uint32_t ended = 0;
    for (int i = 0; i < 100000 && !rig.last().job_ended; ++i) {
      rig.cycle();
      const LoopStatus status = rig.loop->status();
      ASSERT_EQ(status.jobs_started, static_cast<std::uint64_t>(job));
      // As of this cycle's positions; at first no command of this job has reached the axes.
      const auto at = std::find_if(written.rbegin(), written.rend(),
                                   [&](const Setpoint& p) { return sameBits(p.position, rig.last().position); });
      if (at == written.rend() || written.size() < 60) {
        ASSERT_EQ(status.strokes_ended_at, 0u);
      } else {
        ASSERT_EQ(status.place.move_index, at->move_index);
        ASSERT_EQ(status.place.move_fraction, at->move_fraction);
        ASSERT_EQ(status.place.x, rig.last().position[kX]);
        if (at->move == MoveKind::kStroke && at->move_fraction == 1) ended = at->move_index + 1;
        ASSERT_EQ(status.strokes_ended_at, ended);
        ASSERT_EQ(status.wheel.in_work, at->position[kY] < kClearanceHeight);
      }
      if (rig.last().has_setpoint) written.push_back(rig.last().setpoint);
      ASSERT_EQ(status.setpoints_written, written.size());
    }
    EXPECT_GT(ended, 0u);
    EXPECT_EQ(rig.loop->status().end, JobEnd::kDone) << rig.last().fault.text();
  }
}

}  // namespace test_stops
}  // namespace grinder::test_support
