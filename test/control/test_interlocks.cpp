#include "control/paper_job.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

// What a job needs to grind, how it waits for that before it begins, and how it loses it; what the loop commands to
// spindle and coolant.
namespace grinder::test_support {
namespace test_interlocks {

/// A part of the machine that grinding needs and that can be lost.
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
       "the measuring probe is in the way"},
      {"Swivel", Interlock::kSwivel, [](FakeDrive& d) { d.status.swivel = kPaperSwivel + 0.001; },
       "the swivel is not at the job's angle"}};
  return all;
}

/// Restores every part; spindle and coolant follow their commands by themselves.
void restoreParts(FakeDrive& drive) {
  drive.status.homed = drive.status.probe_free = true;
  drive.status.swivel = kPaperSwivel;
}

TEST(WaitsFor, EachPartAndTheJournalWithSpindleAndCoolantAndEndsTheJobAtTheTimeoutWithEverythingOff) {
  std::vector<Part> awaited = parts();
  awaited.push_back({"Journal", Interlock::kJournal, nullptr, "the journal does not contain the job"});
  for (const Part& part : awaited) {
    for (const bool comes : {true, false}) {
      SCOPED_TRACE(testing::Message() << part.name << (comes ? "" : ", never"));
      const bool is_journal = part.interlock == Interlock::kJournal;
      RigIn rig(S::kReady);
      const Axes before = rig.last().command;
      rig.stream.emplace(rig.paperStream());
      ASSERT_TRUE(rig.loop->startJob({&*rig.stream, wheelOf(rig.stream->program()), !is_journal}));
      const RequestReply answer = rig.answerOf([&] { return rig.loop->startJobReply(); });
      ASSERT_TRUE(answer.accepted) << answer.text;
      if (is_journal) rig.loop->confirmJournal(rig.loop->status().jobs_started - 1);  // of the job before
      rig.drive.on_read = part.lose;
      // 20.5 periods, and the cycle of the start counts.
      for (int i = 2; i <= (comes ? 15 : 20); ++i) {
        rig.cycle();
        ASSERT_EQ(rig.last().state, S::kStarting) << "in cycle " << i;
        ASSERT_FALSE(rig.last().job_ended);
        ASSERT_TRUE(rig.drive.written_drive.spindle);
        ASSERT_TRUE(rig.drive.written_drive.coolant);
      }
      if (comes) {
        rig.drive.on_read = restoreParts;
        if (is_journal) rig.loop->confirmJournal(rig.loop->status().jobs_started);
        EXPECT_EQ(rig.cycle().state, S::kRunning);
        EXPECT_TRUE(rig.last().has_setpoint);
        EXPECT_EQ(rig.last().setpoint.cycle, 0u);
        EXPECT_TRUE(sameBits(rig.last().command, before));
        rig.runToEnd();
        expectCompleted(rig);
        EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
        continue;
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
      rig.drive.on_read = restoreParts;
      rig.run(100);
      EXPECT_EQ(rig.last().state, S::kReady) << "what comes late starts nothing";
      EXPECT_EQ(rig.jobsEnded(), 1);
      EXPECT_TRUE(rig.setpoints().empty());
      EXPECT_EQ(rig.last().fault.kind, FaultKind::kInterlock) << "reported until the next job";
      ASSERT_NO_FATAL_FAILURE(rig.startPaper());
      EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone);
    }
  }
}

/// When a part is lost, and the state in the cycle that detects it. At any moment of any job test/rides lose them.
struct LossMoment {
  std::string name;
  std::function<void(Rig<FakeDrive>&)> bring;
  S then;
};

std::vector<LossMoment> lossMoments() {
  std::vector<LossMoment> all{{"at rest at a feed override of 0",
                               [](Rig<FakeDrive>& rig) {
                                 bringTo(rig, S::kRunning);
                                 rig.loop->setFeedOverride(0);
                                 rig.run(500);
                                 ASSERT_FALSE(rig.last().has_setpoint);
                                 rig.loop->setFeedOverride(1);
                               },
                               S::kHeld}};
  for (const auto& [state, then] : {std::pair(S::kRunning, S::kHolding),
                                    {S::kHolding, S::kHolding},
                                    {S::kHeld, S::kRetracting},
                                    {S::kRetracting, S::kRetracting},
                                    {S::kRetracted, S::kRetracted},
                                    {S::kResuming, S::kHolding}}) {
    all.push_back({toString(state), [in = state](Rig<FakeDrive>& rig) { bringTo(rig, in); }, then});
  }
  const std::uint64_t last = planned().back().cycle;
  for (const std::uint64_t cycle : {std::uint64_t{0}, last - 2, last}) {
    all.push_back({std::to_string(cycle),
                   [=](Rig<FakeDrive>& rig) {
                     rig.startPaper();
                     rig.runToCycle(cycle);
                   },
                   cycle == last - 2 ? S::kHolding : S::kHeld});
  }
  return all;
}

TEST(Lost, TakesTheWheelOffTheWorkUntilItIsBackAndTheJobIsResumed) {
  for (const Part& part : parts()) {
    for (const LossMoment& moment : lossMoments()) {
      SCOPED_TRACE(part.name + (" in " + moment.name));
      Rig<FakeDrive> rig;
      moment.bring(rig);
      EXPECT_EQ(rig.last().interlock, Interlock::kNone);
      rig.drive.on_read = part.lose;
      EXPECT_EQ(rig.cycle().interlock, part.interlock);
      EXPECT_EQ(rig.last().state, moment.then);
      if (rig.last().state != S::kRetracted) rig.runUntil(S::kRetracted);
      EXPECT_GE(rig.last().command[kY], kClearanceHeight - 1e-12);
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
      if (rig.jobsEnded() == 0) rig.runToEnd();
      expectCompleted(rig);
    }
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

TEST(LostParts, TheFirstStaysReportedAndResumeReportsWhatIsAmissNow) {
  RigIn rig(S::kRunning);
  rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
  rig.run(5);
  rig.drive.on_read = [](FakeDrive& d) { d.status.coolant_on = false; };
  rig.runUntil(S::kRetracted);
  EXPECT_EQ(rig.last().interlock, Interlock::kSpindle);
  EXPECT_EQ(rig.ask(E::kResume).text, "resume refused: no coolant flows");
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

}  // namespace test_interlocks
}  // namespace grinder::test_support
