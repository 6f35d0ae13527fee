#include "control/paper_job.h"

#include <cmath>
#include <limits>

// Where the swivel stands: confirmed by an operator or measured by the drive, and what a job makes of it.
namespace grinder::test_support {
namespace test_swivel {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// With a loop to which nothing has been confirmed.
struct Unconfirmed : Rig<FakeDrive> {
  Unconfirmed() {
    loop = std::make_unique<ControlLoop>(drive, machineConfig());
    cycle();
    enable();
  }
};

/// Sets what the drive measures from the next cycle on.
void measure(Rig<FakeDrive>& rig, double angle) {
  rig.drive.on_read = [angle](FakeDrive& d) { d.status.swivel = angle; };
}

TEST(Swivel, ConfirmedOrMeasuredLetsAJobStartAndGoOnWithinTheToleranceOnly) {
  for (const auto& [degrees, within] :
       {std::pair(-63.538, false), {-0.0501, false}, {-0.0499, true}, {0.0, true}, {0.0499, true}, {0.0501, false}}) {
    SCOPED_TRACE(degrees);
    const double angle = kPaperSwivel + degrees * kDegree;
    Unconfirmed confirmed;
    ASSERT_TRUE(confirmed.confirm(angle).accepted);
    EXPECT_EQ(confirmed.loop->status().swivel.angle, angle);
    EXPECT_EQ(confirmed.last().swivel.angle, angle);
    EXPECT_FALSE(confirmed.last().swivel.measured);
    EXPECT_EQ(confirmed.askToStartPaper().accepted, within);

    Unconfirmed measured;
    measure(measured, angle);
    measured.cycle();
    EXPECT_EQ(measured.loop->status().swivel.angle, angle);
    EXPECT_TRUE(measured.loop->status().swivel.measured);
    EXPECT_EQ(measured.askToStartPaper().accepted, within);

    RigIn amid(S::kRunning);
    measure(amid, angle);
    amid.run(20);
    EXPECT_EQ(amid.last().state, within ? S::kRunning : S::kHolding);
    EXPECT_EQ(amid.last().interlock, within ? Interlock::kNone : Interlock::kSwivel);
  }
}

TEST(Swivel, UnknownOrAtAnotherAngleIsAskedForAndToBeConfirmedUnlessItIsMeasured) {
  const std::string refused = "start refused: process.setup.swivel_deg = 31.769 deg: the swivel ";
  const std::string angle = "set it to 31.769 deg", confirmation = " and confirm it: grind confirm-swivel 31.769";
  const std::string remedy = "; allowed: within 0.05 deg of that; " + angle;
  Unconfirmed rig;
  EXPECT_TRUE(std::isnan(rig.loop->status().swivel.angle));
  EXPECT_EQ(rig.askToStartPaper().text, refused + "is not confirmed; " + angle + confirmation);
  ASSERT_TRUE(rig.confirm(-20.5 * kDegree).accepted);
  EXPECT_EQ(rig.askToStartPaper().text, refused + "is confirmed at -20.5 deg" + remedy + confirmation);
  measure(rig, 32 * kDegree);
  EXPECT_EQ(rig.askToStartPaper().text, refused + "is at 32 deg" + remedy);
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_FALSE(rig.drive.written_drive.spindle);
}

TEST(Swivel, IsNotConfirmedAtAnAngleThatItCannotHave) {
  FakeDrive drive;
  setUp(drive, machineConfig());
  ControlLoop loop(drive, machineConfig());
  for (const double angle : {kNan, HUGE_VAL, -HUGE_VAL, 90.001 * kDegree, -90.001 * kDegree}) {
    const RequestReply answer = loop.confirmSwivel(angle);
    EXPECT_FALSE(answer.accepted);
    EXPECT_TRUE(answer.answered);
    EXPECT_CONTAINS(answer.text, "confirm-swivel refused: ");
    EXPECT_CONTAINS(answer.text, " deg; allowed: -90 deg to 90 deg");
  }
  loop.cycle(ros::Time(1000), ros::Duration(0.001));
  EXPECT_TRUE(std::isnan(loop.status().swivel.angle)) << "the refused request came back to life";
}

TEST(Swivel, IsConfirmedByTheStartOfAJobUnlessItIsMeasured) {
  for (const bool measured : {false, true}) {
    Unconfirmed rig;
    if (measured) measure(rig, 32 * kDegree);
    rig.cycle();
    rig.stream.emplace(rig.paperStream());
    ASSERT_TRUE(rig.loop->startJob({&*rig.stream, wheelOf(rig.stream->program()), true, true}));
    EXPECT_EQ(rig.answerOf([&] { return rig.loop->startJobReply(); }).accepted, !measured);
    EXPECT_EQ(rig.loop->status().swivel.angle, measured ? 32 * kDegree : kPaperSwivel);
    EXPECT_EQ(rig.loop->status().swivel.measured, measured);
  }
}

TEST(Swivel, IsNotTurnedBeforeAJobHasEnded) {
  for (const S state :
       {S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting, S::kRetracted, S::kResuming, S::kCanceling}) {
    SCOPED_TRACE(toString(state));
    RigIn rig(state);
    const RequestReply refused = rig.confirm(31.7 * kDegree);
    EXPECT_FALSE(refused.accepted);
    EXPECT_EQ(refused.text,
              "confirm-swivel refused: a job is in progress that needs 31.769 deg; allowed: that angle, or to end the "
              "job first");
    EXPECT_EQ(rig.last().swivel.angle, kPaperSwivel);
    EXPECT_TRUE(rig.confirm(kPaperSwivel).accepted);
    EXPECT_EQ(rig.last().interlock, Interlock::kNone);
    if (state != S::kCanceling) continue;
    rig.runUntil(S::kReady);
    EXPECT_TRUE(rig.confirm(0.1).accepted);
  }
}

TEST(MeasuredSwivel, IsNotConfirmedAndOnceLostItIsUnknownEvenIfItWasConfirmedBefore) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_EQ(rig.last().swivel.angle, kPaperSwivel) << "confirmed";
  for (const double lost : {kNan, HUGE_VAL}) {
    measure(rig, 0.25);
    EXPECT_TRUE(rig.cycle().swivel.measured);
    EXPECT_EQ(rig.confirm(0.25).text,
              "confirm-swivel refused: the drive measures the swivel, which is at 14.3239 deg; nothing is to be "
              "confirmed");
    measure(rig, lost);
    EXPECT_TRUE(std::isnan(rig.cycle().swivel.angle));
    EXPECT_FALSE(rig.last().swivel.measured);
  }
}

}  // namespace test_swivel
}  // namespace grinder::test_support
