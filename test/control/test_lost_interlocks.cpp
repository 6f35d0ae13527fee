#include "control/checks.h"
#include "control/interlock_parts.h"
#include "control/paper_job.h"
#include "control/rig.h"

// A reference, spindle, coolant or probe that is lost in the middle of a job.
namespace grinder::test_support {
namespace test_lost_interlocks {

/// When a part is lost, and the state in the cycle that detects it.
struct LossMoment {
  std::string name;
  std::function<void(Rig<FakeDrive>&)> bring;
  S then;
};

std::vector<LossMoment> lossMoments() {
  std::vector<LossMoment> all;
  for (const MoveKind move : kAllMoves) {
    for (const int cycles : {50, 51}) {
      const auto bring = [=](Rig<FakeDrive>& rig) {
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
  all.push_back({"at_rest_at_the_first_setpoint", [](Rig<FakeDrive>& rig) { rig.startPaper(); }, S::kHeld});
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
                     rig.startPaper();
                     rig.runToCycle(planned().back().cycle - static_cast<std::uint64_t>(before_end));
                   },
                   before_end == 0 ? S::kHeld : S::kHolding});
  }
  return all;
}

/// With a part that was lost in the last cycle.
struct LostRig : Rig<FakeDrive> {
  LostRig(const Part& part, const LossMoment& moment) {
    moment.bring(*this);
    EXPECT_EQ(last().interlock, Interlock::kNone);
    drive.on_read = part.lose;
    cycle();
  }

  void awaitRetracted() {
    if (last().state != S::kRetracted) runUntil(S::kRetracted);
    loop->setFeedOverride(1);
  }
};

TEST(Lost, TakesTheWheelOffTheWorkUntilItIsBackAndTheJobIsResumed) {
  for (const Part& part : parts()) {
    for (const LossMoment& moment : lossMoments()) {
      SCOPED_TRACE(part.name + (" " + moment.name));
      LostRig rig(part, moment);
      EXPECT_EQ(rig.last().interlock, part.interlock);
      EXPECT_EQ(rig.last().state, moment.then);
      EXPECT_FALSE(rig.last().job_ended);
      EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
      ASSERT_NO_FATAL_FAILURE(rig.awaitRetracted());
      EXPECT_GE(rig.last().command[kY], kClearanceHeight - 1e-12);
      EXPECT_EQ(rig.last().interlock, part.interlock);
      EXPECT_EQ(rig.jobsEnded(), 0);
      const std::size_t lifted = rig.log.size() - 1;
      for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(rig.ask(E::kResume).text, std::string("resume refused: ") + part.words);
        rig.run(100);
      }
      rig.drive.on_read = restoreParts;
      rig.run(200);
      EXPECT_EQ(rig.last().state, S::kRetracted);
      EXPECT_EQ(rig.last().interlock, part.interlock) << "reported until the job is resumed";
      EXPECT_TRUE(atRestFrom(rig.log, lifted));
      ASSERT_TRUE(rig.ask(E::kResume).accepted);
      EXPECT_EQ(rig.last().interlock, Interlock::kNone);
      if (rig.jobsEnded() == 0) rig.runToEnd();
      expectCompleted(rig);
    }
  }
}

TEST(Lost, ForASinglePeriodIsAsGoodAsForLong) {
  for (const Part& part : parts()) {
    for (const LossMoment& moment : lossMoments()) {
      SCOPED_TRACE(part.name + (" " + moment.name));
      LostRig rig(part, moment);
      rig.drive.on_read = restoreParts;
      ASSERT_NO_FATAL_FAILURE(rig.awaitRetracted());
      EXPECT_EQ(rig.last().interlock, part.interlock);
      expectResumedAndCompleted(rig);
    }
  }
}

TEST(Lost, CancelEndsTheJob) {
  for (const Part& part : parts()) {
    for (const LossMoment& moment : lossMoments()) {
      SCOPED_TRACE(part.name + (" " + moment.name));
      LostRig rig(part, moment);
      ASSERT_TRUE(rig.ask(E::kCancel).accepted);
      if (rig.last().state != S::kReady) rig.runUntil(S::kReady);
      EXPECT_EQ(rig.jobsEnded(), 1);
      EXPECT_EQ(rig.last().interlock, Interlock::kNone);
      EXPECT_FALSE(rig.drive.written_drive.spindle);
      EXPECT_TRUE(smooth(rig.log));
    }
  }
}

TEST(LostPart, WhileCancelingDoesNotKeepTheJobFromEnding) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kCanceling);
    rig.drive.on_read = part.lose;
    rig.runUntil(S::kReady);
    EXPECT_EQ(rig.jobsEnded(), 1);
    for (const CycleSample& sample : rig.log) {
      ASSERT_NE(sample.state, S::kRetracting);
      ASSERT_EQ(sample.interlock, Interlock::kNone) << "it was not the loop that stopped the job";
    }
  }
}

TEST(LostPart, WithoutAJobIsNothing) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kReady);
    rig.drive.on_read = part.lose;
    rig.run(50);
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_EQ(rig.last().interlock, Interlock::kNone);
  }
}

TEST(LostPart, RefusesToResumeFromHoldingButNotOnceItIsBackBeforeItRests) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kRunning);
    rig.drive.on_read = part.lose;
    rig.run(3);
    EXPECT_EQ(rig.ask(E::kResume).text, std::string("resume refused: ") + part.words);
    EXPECT_EQ(rig.last().state, S::kHolding);
    rig.drive.on_read = restoreParts;
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    EXPECT_EQ(rig.last().interlock, Interlock::kNone);
    EXPECT_EQ(rig.last().state, S::kRunning);
    rig.runToEnd();
    expectCompleted(rig);
  }
}

TEST(LostPart, AHoldDuringTheRetractionDoesNotLeaveTheWheelAtTheWork) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kRunning);
    rig.drive.on_read = part.lose;
    rig.runUntil(S::kRetracting);
    rig.run(20);
    ASSERT_TRUE(rig.ask(E::kHold).accepted);
    EXPECT_EQ(rig.last().state, S::kHolding);
    rig.runUntil(S::kRetracted);
    EXPECT_NEAR(rig.last().command[kY], kClearanceHeight, 1e-12);
    EXPECT_TRUE(smooth(rig.log));
  }
}

TEST(LostPart, AgainAfterResumeRetractsAgain) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kRunning);
    for (int i = 0; i < 4; ++i) {
      rig.drive.on_read = part.lose;
      rig.runUntil(S::kRetracted);
      EXPECT_EQ(rig.last().interlock, part.interlock);
      rig.drive.on_read = restoreParts;
      rig.cycle();
      ASSERT_TRUE(rig.ask(E::kResume).accepted);
      rig.run(500 * i);
    }
    rig.runToEnd();
    expectCompleted(rig);
  }
}

TEST(LostParts, TheFirstStaysReportedAndResumeReportsWhatIsAmissNow) {
  RigIn rig(S::kRunning);
  rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
  rig.run(5);
  rig.drive.on_read = [](FakeDrive& d) { d.status.coolant_on = false; };
  rig.runUntil(S::kRetracted);
  EXPECT_EQ(rig.last().interlock, Interlock::kSpindle);
  EXPECT_EQ(rig.ask(E::kResume).text, "resume refused: no coolant flows");
}

}  // namespace test_lost_interlocks
}  // namespace grinder::test_support
