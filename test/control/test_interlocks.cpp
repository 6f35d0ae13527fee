#include "control/checks.h"
#include "control/interlock_parts.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <chrono>
#include <set>
#include <thread>

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

class WaitsFor : public testing::TestWithParam<Part> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.enable();
    rig_.stream.emplace(rig_.paperStream());
    ASSERT_TRUE(rig_.loop->startJob(&*rig_.stream));
    rig_.cycle();
    const auto answer = rig_.loop->startJobReply();
    ASSERT_TRUE(answer && answer->accepted);
    ASSERT_EQ(rig_.last().state, S::kStarting);
    rig_.drive.on_read = GetParam().lose;
  }

  Rig<FakeDrive> rig_;
};

TEST_P(WaitsFor, WithSpindleAndCoolantAndStreamsTheWholeJobOnceItIsThere) {
  const std::size_t from = rig_.log.size() - 1;
  for (int i = 0; i < 15; ++i) {
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kStarting);
    ASSERT_TRUE(rig_.drive.written_drive.spindle);
    ASSERT_TRUE(rig_.drive.written_drive.coolant);
  }
  EXPECT_TRUE(atRestFrom(rig_.log, from));
  rig_.drive.on_read = restoreParts;
  EXPECT_EQ(rig_.cycle().state, S::kRunning);
  EXPECT_TRUE(rig_.last().has_setpoint);
  EXPECT_EQ(rig_.last().setpoint.cycle, 0u);
  rig_.runToEnd();
  expectCompleted(rig_);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), planned()));
}

TEST_P(WaitsFor, GivesUpAfterTheTimeoutReadyWithEverythingOffForANewJob) {
  const Axes before = rig_.last().command;
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
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
  EXPECT_FALSE(rig_.drive.written_drive.coolant);
  EXPECT_TRUE(rig_.drive.written_drive.enable);
  rig_.stream.reset();
  rig_.drive.on_read = restoreParts;
  rig_.run(100);
  EXPECT_EQ(rig_.last().state, S::kReady) << "what comes late starts nothing";
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_TRUE(rig_.setpoints().empty());
  EXPECT_TRUE(sameBits(rig_.last().command, before));
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kInterlock) << "reported until the next job";
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  rig_.runToEnd();
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), planned()));
}

TEST_P(WaitsFor, CancelEndsTheWait) {
  rig_.run(5);
  ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  if (rig_.last().state != S::kReady) rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
}

INSTANTIATE_TEST_SUITE_P(, WaitsFor, testing::ValuesIn(parts()), partName);

TEST(BeforeAJob, TheFirstThatIsMissingIsReported) {
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

class WaitsForJournal : public testing::Test {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.enable();
    rig_.stream.emplace(rig_.paperStream());
    ASSERT_TRUE(rig_.loop->startJob(&*rig_.stream, false));
    const RequestReply answer = rig_.answerOf([this] { return rig_.loop->startJobReply(); });
    ASSERT_TRUE(answer.accepted) << answer.text;
  }

  Rig<FakeDrive> rig_;
};

TEST_F(WaitsForJournal, WithTheSpindleAndStreamsTheWholeJobOnceItIsThere) {
  rig_.loop->confirmJournal(rig_.loop->status().jobs_started - 1);  // of the job before
  for (int i = 0; i < 15; ++i) {
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kStarting);
    ASSERT_TRUE(rig_.drive.written_drive.spindle);
    ASSERT_TRUE(rig_.drive.written_drive.coolant);
  }
  EXPECT_TRUE(rig_.setpoints().empty());
  rig_.loop->confirmJournal(rig_.loop->status().jobs_started);
  EXPECT_EQ(rig_.cycle().state, S::kRunning);
  rig_.runToEnd();
  expectCompleted(rig_);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), planned()));
}

TEST_F(WaitsForJournal, GivesUpAfterTheTimeout) {
  rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.last().fault.interlock, Interlock::kJournal);
  EXPECT_EQ(rig_.last().fault.text(),
            "the journal does not contain the job 0.021 s after the job was started, allowed 0.0205 s");
  EXPECT_TRUE(rig_.setpoints().empty());
  EXPECT_FALSE(rig_.drive.written_drive.spindle);
}

// ---------------------------------------------------------------------------------------------------------------------
// Commands to the drive

TEST(SpindleAndCoolant, TurnTheWheelWhileAJobHasTheMachine) {
  const std::set<S> without_job{S::kDisabled, S::kReady, S::kHoming, S::kFault, S::kLifting, S::kJogging};
  for (const StateRow& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    Rig<FakeDrive> rig;
    ASSERT_NO_FATAL_FAILURE(bringTo(rig, row.value));
    const bool on = without_job.count(row.value) == 0;
    EXPECT_EQ(rig.drive.written_drive.spindle, on);
    EXPECT_EQ(rig.drive.written_drive.coolant, on);
    EXPECT_EQ(rig.drive.written_drive.home, row.value == S::kHoming);
    EXPECT_EQ(rig.drive.written_drive.enable, row.value != S::kDisabled && row.value != S::kFault);
  }
}

TEST(SpindleAndCoolant, AreCommandedThroughAWholeJob) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.loop->startJob(&*rig.stream));
  for (int i = 0; i < 100000; ++i) {
    rig.cycle();
    ASSERT_EQ(rig.drive.written_drive.spindle, !rig.last().job_ended) << "sample " << i;
    ASSERT_EQ(rig.drive.written_drive.coolant, !rig.last().job_ended) << "sample " << i;
    if (rig.last().job_ended) break;
  }
  EXPECT_EQ(rig.last().state, S::kReady);
}

TEST(SpindleAndCoolant, AreOffForAStartThatIsRefused) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  rig.drive.status.homed = false;
  SetpointStream stream = rig.paperStream();
  EXPECT_FALSE(rig.askToStart(stream).accepted);
  EXPECT_FALSE(rig.drive.written_drive.spindle);
  EXPECT_FALSE(rig.drive.written_drive.coolant);
}

TEST(SpindleAndCoolant, AreOffAfterTheLoopWasStopped) {
  ros::Time::init();
  FakeDrive drive;
  LoopConfig config = machineConfig();
  config.following_error.setConstant(1);
  config.feedback_timeout = config.enable_timeout = 30;  // the machine may be busy with other things
  setUp(drive, config);
  SetpointStream stream = paperFromPark();
  ControlLoop loop(drive, config);
  loop.startThread();
  ASSERT_TRUE(loop.request(E::kEnable).accepted);
  ASSERT_TRUE(loop.confirmSwivel(kPaperSwivel).accepted);
  ASSERT_TRUE(loop.startJob(&stream));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (loop.status().jobs_started == 0 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(loop.status().jobs_started, 1u);
  loop.stopThread();
  EXPECT_FALSE(drive.written_drive.enable);
  EXPECT_FALSE(drive.written_drive.spindle);
  EXPECT_FALSE(drive.written_drive.coolant);
}

}  // namespace test_interlocks
}  // namespace grinder::test_support
