#include "control/checks.h"
#include "control/interlock_parts.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>
#include <tuple>

// A reference, spindle, coolant or probe that is lost in the middle of a job.
namespace grinder::test_support {
namespace test_lost_interlocks {

/// When a part is lost, and the state in the cycle that detects it.
struct LossMoment {
  std::string name;
  std::function<void(Rig<FakeDrive>&)> bring;
  S then;
};
std::ostream& operator<<(std::ostream& out, const LossMoment& moment) { return out << moment.name; }

std::vector<LossMoment> lossMoments() {
  std::vector<LossMoment> all;
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
  all.push_back({"at_rest_at_the_first_setpoint",
                 [](Rig<FakeDrive>& rig) {
                   rig.cycle();
                   rig.startPaper();
                 },
                 S::kHeld});
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

class Lost : public testing::TestWithParam<std::tuple<Part, LossMoment>> {
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
  std::size_t before_ = 0;  ///< last sample before the loss
};

TEST_P(Lost, TakesTheWheelOffTheWorkUntilItIsBackAndTheJobIsResumed) {
  EXPECT_EQ(rig_.log[before_].interlock, Interlock::kNone);
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  EXPECT_EQ(rig_.last().state, std::get<1>(GetParam()).then);
  EXPECT_FALSE(rig_.last().job_ended);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  awaitRetracted();
  EXPECT_GE(rig_.last().command[kY], kClearanceHeight - 1e-12);
  EXPECT_EQ(rig_.last().interlock, part_.interlock);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  const std::size_t lifted = rig_.log.size() - 1;
  const auto expectRefused = [&] {
    const RequestReply answer = rig_.ask(E::kResume);
    EXPECT_FALSE(answer.accepted);
    EXPECT_EQ(answer.text, std::string("resume refused: ") + part_.words);
  };
  expectRefused();
  rig_.run(100);
  expectRefused();
  rig_.drive.on_read = restoreParts;
  rig_.run(200);
  EXPECT_EQ(rig_.last().state, S::kRetracted);
  EXPECT_EQ(rig_.last().interlock, part_.interlock) << "reported until the job is resumed";
  EXPECT_TRUE(atRestFrom(rig_.log, lifted));
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(Lost, ForASinglePeriodIsAsGoodAsForLong) {
  rig_.drive.on_read = restoreParts;
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

INSTANTIATE_TEST_SUITE_P(, Lost, testing::Combine(testing::ValuesIn(parts()), testing::ValuesIn(lossMoments())),
                         [](const testing::TestParamInfo<std::tuple<Part, LossMoment>>& info) {
                           return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param).name;
                         });

class LostPart : public testing::TestWithParam<Part> {
 protected:
  Rig<FakeDrive> rig_;
};

TEST_P(LostPart, WhileCancelingDoesNotKeepTheJobFromEnding) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kCanceling));
  rig_.drive.on_read = GetParam().lose;
  rig_.runUntil(S::kReady);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  for (const CycleSample& sample : rig_.log) {
    ASSERT_NE(sample.state, S::kRetracting);
    ASSERT_EQ(sample.interlock, Interlock::kNone) << "it was not the loop that stopped the job";
  }
}

TEST_P(LostPart, WithoutAJobIsNothing) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kReady));
  rig_.drive.on_read = GetParam().lose;
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
}

TEST_P(LostPart, RefusesToResumeFromHoldingButNotOnceItIsBackBeforeItRests) {
  ASSERT_NO_FATAL_FAILURE(bringTo(rig_, S::kRunning));
  rig_.drive.on_read = GetParam().lose;
  rig_.run(3);
  EXPECT_EQ(rig_.ask(E::kResume).text, std::string("resume refused: ") + GetParam().words);
  EXPECT_EQ(rig_.last().state, S::kHolding);
  rig_.drive.on_read = restoreParts;
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
    rig_.drive.on_read = restoreParts;
    rig_.cycle();
    ASSERT_TRUE(rig_.ask(E::kResume).accepted);
    rig_.run(500 * i);
  }
  rig_.runToEnd();
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(, LostPart, testing::ValuesIn(parts()), partName);

TEST(LostParts, TheFirstStaysReportedAndResumeReportsWhatIsAmissNow) {
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
// On the simulated drive

class LostOnTheSimulatedDrive : public testing::TestWithParam<std::tuple<SimulatedDrive::Fault, Interlock>> {
 protected:
  void SetUp() override {
    if (std::get<1>(GetParam()) == Interlock::kSwivel) {
      SimulatedDrive::Equipment encoder = equipment();
      encoder.swivel = kPaperSwivel;
      rig_.drive.init(driveModel(), encoder);
    }
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
                         testing::Values(std::tuple(SimulatedDrive::Fault::kReferenceLost, Interlock::kNotHomed),
                                         std::tuple(SimulatedDrive::Fault::kSpindleLost, Interlock::kSpindle),
                                         std::tuple(SimulatedDrive::Fault::kCoolantLost, Interlock::kCoolant),
                                         std::tuple(SimulatedDrive::Fault::kSwivelSlipped, Interlock::kSwivel)),
                         [](const testing::TestParamInfo<std::tuple<SimulatedDrive::Fault, Interlock>>& info) {
                           return std::string(parts()[static_cast<std::size_t>(std::get<1>(info.param)) - 1].name);
                         });

}  // namespace test_lost_interlocks
}  // namespace grinder::test_support
