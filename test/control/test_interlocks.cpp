#include "control/checks.h"
#include "control/interlock_parts.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <set>

// What a job waits for before it begins, and what the loop commands to spindle and coolant.
namespace grinder::test_support {
namespace test_interlocks {

TEST(InterlockText, SaysWhatIsWrong) {
  EXPECT_STREQ(toString(Interlock::kNone), "");
  for (const Part& part : parts()) EXPECT_STREQ(toString(part.interlock), part.words);
  EXPECT_STREQ(toString(static_cast<Interlock>(99)), "unknown");
}

// ---------------------------------------------------------------------------------------------------------------------
// Before a job

/// With a job that waits for spindle and coolant, and for a part that is lost.
struct WaitingRig : Rig<FakeDrive> {
  explicit WaitingRig(const Part& part) {
    enable();
    EXPECT_TRUE(askToStartPaper().accepted);
    EXPECT_EQ(last().state, S::kStarting);
    drive.on_read = part.lose;
  }

  void expectToWait() {
    for (int i = 0; i < 15; ++i) {
      cycle();
      ASSERT_EQ(last().state, S::kStarting);
      ASSERT_TRUE(drive.written_drive.spindle);
      ASSERT_TRUE(drive.written_drive.coolant);
    }
  }
};

TEST(WaitsFor, EachPartWithSpindleAndCoolantAndStreamsTheWholeJobOnceItIsThere) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    WaitingRig rig(part);
    const std::size_t from = rig.log.size() - 1;
    ASSERT_NO_FATAL_FAILURE(rig.expectToWait());
    EXPECT_TRUE(atRestFrom(rig.log, from));
    rig.drive.on_read = restoreParts;
    EXPECT_EQ(rig.cycle().state, S::kRunning);
    EXPECT_TRUE(rig.last().has_setpoint);
    EXPECT_EQ(rig.last().setpoint.cycle, 0u);
    rig.runToEnd();
    expectCompleted(rig);
    EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
  }
}

TEST(WaitsFor, EachPartUntilTheTimeoutAndIsReadyThenWithEverythingOffForANewJob) {
  for (const Part& part : parts()) {
    SCOPED_TRACE(part.name);
    WaitingRig rig(part);
    const Axes before = rig.last().command;
    // 20.5 periods, and the cycle of the start counts.
    for (int i = 2; i <= 20; ++i) {
      rig.cycle();
      ASSERT_EQ(rig.last().state, S::kStarting) << "in cycle " << i;
      ASSERT_FALSE(rig.last().job_ended);
    }
    rig.cycle();
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_TRUE(rig.last().job_ended);
    EXPECT_EQ(rig.last().fault.kind, FaultKind::kInterlock);
    EXPECT_EQ(rig.last().fault.interlock, part.interlock);
    EXPECT_EQ(rig.last().fault.text(),
              std::string(part.words) + " 0.021 s after the job was started, allowed 0.0205 s");
    EXPECT_EQ(rig.loop->status().end, JobEnd::kFault);
    EXPECT_EQ(rig.loop->status().fault.kind, FaultKind::kInterlock);
    EXPECT_FALSE(rig.drive.written_drive.spindle);
    EXPECT_FALSE(rig.drive.written_drive.coolant);
    EXPECT_TRUE(rig.drive.written_drive.enable);
    rig.stream.reset();
    rig.drive.on_read = restoreParts;
    rig.run(100);
    EXPECT_EQ(rig.last().state, S::kReady) << "what comes late starts nothing";
    EXPECT_EQ(rig.jobsEnded(), 1);
    EXPECT_TRUE(rig.setpoints().empty());
    EXPECT_TRUE(sameBits(rig.last().command, before));
    EXPECT_EQ(rig.last().fault.kind, FaultKind::kInterlock) << "reported until the next job";
    ASSERT_NO_FATAL_FAILURE(rig.startPaper());
    EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
    rig.runToEnd();
    EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
  }
}

TEST(BeforeAJob, TheFirstThatIsMissingIsReported) {
  for (std::size_t first = 0; first < parts().size(); ++first) {
    Rig<FakeDrive> rig;
    rig.enable();
    ASSERT_TRUE(rig.askToStartPaper().accepted);
    rig.drive.on_read = [=](FakeDrive& d) {
      for (std::size_t i = first; i < parts().size(); ++i) parts()[i].lose(d);
    };
    rig.runUntil(S::kReady);
    EXPECT_EQ(rig.last().fault.interlock, parts()[first].interlock);
  }
}

TEST(WaitsForJournal, OfTheJobItselfAndNoLongerThanTheTimeout) {
  for (const bool comes : {true, false}) {
    RigIn rig(S::kReady);
    rig.stream.emplace(rig.paperStream());
    ASSERT_TRUE(rig.loop->startJob(&*rig.stream, false));
    const RequestReply answer = rig.answerOf([&] { return rig.loop->startJobReply(); });
    ASSERT_TRUE(answer.accepted) << answer.text;
    rig.loop->confirmJournal(rig.loop->status().jobs_started - 1);  // of the job before
    for (int i = 0; i < 15; ++i) {
      ASSERT_EQ(rig.cycle().state, S::kStarting);
      ASSERT_TRUE(rig.drive.written_drive.spindle);
      ASSERT_TRUE(rig.drive.written_drive.coolant);
    }
    EXPECT_TRUE(rig.setpoints().empty());
    if (comes) {
      rig.loop->confirmJournal(rig.loop->status().jobs_started);
      EXPECT_EQ(rig.cycle().state, S::kRunning);
      rig.runToEnd();
      expectCompleted(rig);
      EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
    } else {
      rig.runUntil(S::kReady);
      EXPECT_EQ(rig.last().fault.interlock, Interlock::kJournal);
      EXPECT_EQ(rig.last().fault.text(),
                "the journal does not contain the job 0.021 s after the job was started, allowed 0.0205 s");
      EXPECT_TRUE(rig.setpoints().empty());
      EXPECT_FALSE(rig.drive.written_drive.spindle);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Commands to the drive

TEST(SpindleAndCoolant, TurnTheWheelWhileAJobHasTheMachine) {
  const std::set<S> without_job{S::kDisabled, S::kReady, S::kHoming, S::kFault, S::kLifting, S::kJogging};
  for (const StateRow& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    RigIn rig(row.value);
    const bool on = without_job.count(row.value) == 0;
    EXPECT_EQ(rig.drive.written_drive.spindle, on);
    EXPECT_EQ(rig.drive.written_drive.coolant, on);
    EXPECT_EQ(rig.drive.written_drive.home, row.value == S::kHoming);
    EXPECT_EQ(rig.drive.written_drive.enable, row.value != S::kDisabled && row.value != S::kFault);
  }
}

TEST(SpindleAndCoolant, AreOffForAStartThatIsRefused) {
  RigIn rig(S::kReady);
  rig.drive.status.homed = false;
  EXPECT_EQ(rig.askToStartPaper().text, "start refused: the axes are not homed");
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  EXPECT_FALSE(rig.drive.written_drive.coolant);
}

}  // namespace test_interlocks
}  // namespace grinder::test_support
