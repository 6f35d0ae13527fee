#include "control/paper_job.h"

#include <algorithm>

// Stops in every state, and the job in the loop's status.
namespace grinder::test_support {
namespace test_stops {

TEST(HoldWhileStarting, IsTakenBackByAResume) {
  RigIn rig(S::kStarting);
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  EXPECT_EQ(rig.last().state, S::kStarting);
  rig.drive.on_read = nullptr;  // the spindle comes
  rig.runUntil(S::kRunning);
  rig.runToEnd();
  EXPECT_EQ(rig.loop->status().end, JobEnd::kDone);
  for (const CycleSample& sample : rig.log) EXPECT_NE(sample.state, S::kHeld);
}

TEST(Cancel, StopsAsAStreamHeldInTheSameCycleAndLiftsTheWheelOffTheWork) {
  for (const MoveKind move : kAllMoves) {
    for (const int cycles : {40, 41}) {
      SCOPED_TRACE(testing::Message() << toString(move) << " " << cycles);
      Rig<SimulatedDrive> rig;
      rig.startPaper();
      ASSERT_NO_FATAL_FAILURE(rig.runTo(move));
      rig.run(cycles);
      ASSERT_EQ(rig.last().setpoint.move, move);
      const std::uint64_t last_before = rig.last().setpoint.cycle;
      ASSERT_TRUE(rig.ask(E::kCancel).accepted);
      rig.runToEnd();
      SetpointStream stream = paperFromPark();
      std::vector<Setpoint> expected;
      Setpoint p;
      while (expected.size() <= last_before && stream.next(p)) expected.push_back(p);
      stream.hold();
      while (stream.next(p)) expected.push_back(p);
      if (expected.back().position[kY] < kClearanceHeight - 1e-12) {
        stream.retract();
        while (stream.next(p)) expected.push_back(p);
      }
      EXPECT_NEAR(std::min(expected.back().position[kY], kClearanceHeight), kClearanceHeight, 1e-12);
      EXPECT_LT(expected.size(), planned().size());
      EXPECT_TRUE(sameSetpoints(rig.setpoints(), expected));
    }
  }
}

/// The power stays on until the axes rest, and spindle and coolant stay with them.
TEST(CancelAndDisable, EndTheJobAtRestWithTheWheelOffTheWorkAndAreDoneThen) {
  for (const S state :
       {S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting, S::kRetracted, S::kResuming, S::kCanceling}) {
    for (const E stop : {E::kCancel, E::kDisable}) {
      SCOPED_TRACE(testing::Message() << toString(stop) << " in " << toString(state));
      RigIn rig(state);
      const Axes before = rig.last().command;
      ASSERT_TRUE(rig.ask(stop).accepted);
      EXPECT_EQ(rig.last().interlock, Interlock::kNone);
      for (int i = 0; i < 5000 && rig.last().state == S::kCanceling; ++i) {
        ASSERT_TRUE(rig.drive.written_drive.enable) << "power off before the axes rest";
        ASSERT_TRUE(rig.drive.written_drive.spindle);
        ASSERT_TRUE(rig.drive.written_drive.coolant);
        rig.cycle();
      }
      const S end = stop == E::kCancel ? S::kReady : S::kDisabled;
      EXPECT_EQ(rig.last().state, end);
      EXPECT_TRUE(rig.last().job_ended);
      EXPECT_EQ(rig.loop->status().end, JobEnd::kCanceled);
      EXPECT_FALSE(rig.last().wheel_in_work);
      const DriveCommand& command = rig.drive.written_drive;
      EXPECT_EQ(command.enable, stop == E::kCancel);
      EXPECT_FALSE(command.spindle || command.coolant);
      const std::size_t ended = rig.log.size() - 1;
      rig.run(100);
      EXPECT_TRUE(atRestFrom(rig.log, ended));
      EXPECT_TRUE(smooth(rig.log));
      EXPECT_EQ(rig.last().state, end);
      EXPECT_EQ(rig.jobsEnded(), 1);
      EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
      const Axes& now = rig.last().command;
      EXPECT_GE(now[kY], kClearanceHeight - 1e-12);
      if (state == S::kStarting || state == S::kRetracted) {
        EXPECT_TRUE(sameBits(now, before));
      } else if (state == S::kHeld) {
        EXPECT_TRUE(sameBits(now, Axes(before[kX], now[kY], before[kZ], before[kA])));
      }
      EXPECT_EQ(rig.setpoints().empty(), state == S::kStarting);

      rig.drive.on_read = nullptr;
      ASSERT_NO_FATAL_FAILURE(rig.startPaper());
      rig.run(300);
      ASSERT_TRUE(rig.ask(E::kCancel).accepted);
      rig.runUntil(S::kReady);
      rig.run(5);
      EXPECT_EQ(rig.last().state, S::kReady) << "the disable of the job before has come again";
    }
  }
}

TEST(Stops, EndHomingByThePower) {
  for (const E stop : {E::kHold, E::kCancel, E::kDisable}) {
    SCOPED_TRACE(toString(stop));
    RigIn rig(S::kHoming);
    ASSERT_TRUE(rig.ask(stop).accepted);
    EXPECT_EQ(rig.last().state, S::kDisabled);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    EXPECT_FALSE(rig.drive.written_drive.home);
  }
}

TEST(Stops, LetASingleAxisBrakeAndAllButAHoldEndItsJob) {
  // 0.05 m/s is lost in 0.05 / 2 * (0.05 / 0.5 + 0.5 / 10) m, after a few cycles more.
  constexpr double kFarthest = 0.00375 + 0.001;
  for (const S state : {S::kLifting, S::kJogging, S::kJoggingRetracted}) {
    for (const E stop : {E::kHold, E::kCancel, E::kDisable}) {
      SCOPED_TRACE(testing::Message() << toString(stop) << " in " << toString(state));
      RigIn rig(state);
      const bool in_job = isInJob(state), ends_job = in_job && stop != E::kHold;
      const int ended = rig.jobsEnded() + (ends_job ? 1 : 0);
      const double from = rig.last().command[kY];
      ASSERT_TRUE(rig.ask(stop).accepted);
      EXPECT_EQ(rig.last().state, ends_job ? S::kCanceling : state) << "an axis does not stop at once";
      EXPECT_TRUE(rig.drive.written_drive.enable);
      rig.runUntil(stop == E::kDisable ? S::kDisabled : in_job && !ends_job ? S::kRetracted : S::kReady);
      EXPECT_EQ(rig.drive.written_drive.enable, stop != E::kDisable);
      EXPECT_LE(rig.last().command[kY] - from, kFarthest);
      const std::size_t rest = rig.log.size() - 1;
      rig.run(100);
      EXPECT_TRUE(atRestFrom(rig.log, rest));
      EXPECT_TRUE(smooth(rig.log));
      EXPECT_EQ(rig.jobsEnded(), ended);
      EXPECT_TRUE(!ends_job || rig.loop->status().end == JobEnd::kCanceled);
      EXPECT_EQ(rig.last().wheel_in_work, state == S::kLifting);
    }
  }
}

TEST(CancelWithLift, AgainDuringTheLiftChangesNothing) {
  RigIn once(S::kCanceling), often(S::kCanceling);
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
    RigIn rig(S::kCanceling);
    const double stopped_at = rig.last().command[kY];
    while (rig.last().command[kY] < stopped_at + lifted) rig.cycle();
    ASSERT_TRUE(rig.ask(E::kHold).accepted);
    rig.runUntil(S::kReady);
    EXPECT_LT(rig.last().command[kY], kClearanceHeight - 1e-4);
    EXPECT_TRUE(smooth(rig.log));
    EXPECT_EQ(rig.loop->status().end, JobEnd::kCanceled);
    EXPECT_TRUE(rig.loop->status().wheel.in_work);
    ASSERT_NO_FATAL_FAILURE(rig.lift());
    EXPECT_FALSE(rig.last().wheel_in_work);
  }
}

TEST(Cancel, InTheCycleOfTheStartEndsTheJobBeforeAnythingMoves) {
  RigIn rig(S::kReady);
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.loop->startJob({&*rig.stream, wheelOf(rig.stream->program())}));
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
  RigIn rig(S::kHeld);
  rig.loop->postStop(E::kHold);
  ASSERT_TRUE(rig.loop->post(E::kResume));
  const Axes before = rig.last().command;
  rig.cycle();
  rig.runUntil(S::kHeld);
  rig.run(50);
  EXPECT_EQ(rig.last().state, S::kHeld);
  EXPECT_TRUE(sameBits(rig.last().command, before)) << "it moved, though held";
}

TEST(Stops, AllAtOnceAreAllCarriedOutAndAllAnswered) {
  RigIn rig(S::kRunning);
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
  RigIn rig(S::kReady);
  rig.loop->postStop(E::kCancel);  // refused, to nobody
  rig.cycle();
  const std::uint32_t ticket = rig.loop->postStopWithReply(E::kCancel);
  EXPECT_FALSE(rig.loop->stopReply(E::kCancel, ticket));
  rig.cycle();
  const auto answer = rig.loop->stopReply(E::kCancel, ticket);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->accepted);
}

TEST(Status, KeepsTheCauseOfAJobsEndUntilTheNextStarts) {
  RigInTheWork rig;
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
  EXPECT_EQ(rig.loop->status().end, JobEnd::kFault);
  ASSERT_NO_FATAL_FAILURE(rig.lift());
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kDriveFault);
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  EXPECT_EQ(rig.loop->status().end, JobEnd::kNone);
  EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kNone);
  EXPECT_EQ(rig.loop->status().jobs_started, 2u);
  EXPECT_EQ(rig.loop->status().place.move_index, 0u);
  EXPECT_EQ(rig.loop->status().strokes_ended_at, 0u);
}

TEST(Status, OfAJobThatHasNotBegunHasNoWheelInTheWorkWhereverTheAxesStand) {
  Rig<FakeDrive> rig;
  rig.drive.position[kY] = kClearanceHeight - 1e-3;
  rig.enable();
  rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
  ASSERT_TRUE(rig.askToStartPaper().accepted);
  EXPECT_EQ(rig.run(5).state, S::kStarting);
  EXPECT_FALSE(rig.last().wheel_in_work);
}

// Held while it brakes at its end, the stroke rests exactly there, and the retraction enters it again.
TEST(Status, AStrokeThatHasEndedStaysEndedWhenARetractionEntersItAgain) {
  const auto is_of_stroke = [](const Setpoint& p) { return p.move == MoveKind::kStroke; };
  const std::uint64_t last = std::find_if(planned().rbegin(), planned().rend(), is_of_stroke)->cycle;
  Rig<FakeDrive> rig;
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

}  // namespace test_stops
}  // namespace grinder::test_support
