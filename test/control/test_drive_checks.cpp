#include "flute_grinder/control/drive_checks.h"

#include "control/fixtures.h"

#include <limits>

namespace grinder::test_support {
namespace test_drive_checks {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A cycle in which nothing is wrong.
class DriveChecksTest : public testing::Test {
 protected:
  DriveChecksTest() {
    sample_.period = config_.machine.period;
    sample_.drive.enabled = true;
    sample_.drive.underruns = 7;
    sample_.position = sample_.command_in_effect = config_.machine.park;
    checks_.powerOn(sample_.drive);
  }

  FaultKind found(bool moving_unbuffered = true) const {
    const auto fault = checks_.findFault(sample_, moving_unbuffered);
    return fault ? fault->kind : FaultKind::kNone;
  }

  const LoopConfig config_ = machineConfig();
  DriveChecks checks_{config_};
  CycleSample sample_;
};

// Each cause is added to the ones over which it takes precedence.
TEST_F(DriveChecksTest, FindTheCauseBeforeItsConsequences) {
  sample_.position[kY] += 1;
  EXPECT_EQ(found(), FaultKind::kFollowingError);
  sample_.position[kY] = kNan;
  EXPECT_EQ(found(), FaultKind::kInvalidFeedback);
  sample_.feedback_age = 1;
  EXPECT_EQ(found(), FaultKind::kStaleFeedback);
  sample_.drive.enabled = false;
  EXPECT_EQ(found(), FaultKind::kPowerLost);
  sample_.drive.fault = true;
  EXPECT_EQ(found(), FaultKind::kDriveFault);
  sample_.period *= 2 * config_.late_fault;
  EXPECT_EQ(found(), FaultKind::kLate);
  ++sample_.drive.underruns;
  EXPECT_EQ(found(), FaultKind::kUnderrun);
  sample_.drive.emergency_stop = true;
  EXPECT_EQ(found(), FaultKind::kEmergencyStop);
}

/// Lets two seconds of cycles pass. @param period of each [control periods].
void pass(DriveChecks& checks, CycleSample sample, double period) {
  sample.period *= period;
  for (double time = 0; time < 2; time += sample.period) checks.observe(sample);
}

TEST_F(DriveChecksTest, ALoopAtHalfItsRateIsAFaultWhateverTheAxesDo) {
  pass(checks_, sample_, 2);
  for (const bool moving : {true, false}) {
    const auto fault = checks_.findFault(sample_, moving);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->text(), "the control loop takes 0.002 s for a cycle on average, allowed 0.0016 s");
  }
  sample_.drive.enabled = false;
  EXPECT_EQ(found(), FaultKind::kPowerLost) << "which may be why it was slow";
  sample_.drive.enabled = true;
  pass(checks_, sample_, 1);
  EXPECT_EQ(found(), FaultKind::kNone);
  LoopConfig patient = config_;
  patient.late_slow_down = 4;
  DriveChecks checks(patient);
  checks.powerOn(sample_.drive);
  pass(checks, sample_, 3);
  EXPECT_FALSE(checks.findFault(sample_, true));
  pass(checks, sample_, 3.5);
  EXPECT_TRUE(checks.findFault(sample_, true));
}

TEST_F(DriveChecksTest, ALoopThatIsLateNowAndThenIsNotSlow) {
  CycleSample stall = sample_;
  stall.period = 0.5;
  for (int i = 0; i < 3; ++i) {
    checks_.observe(stall);
    pass(checks_, sample_, 1.2);
    EXPECT_EQ(found(false), FaultKind::kNone);
  }
}

TEST_F(DriveChecksTest, RefusePowerWithTheReason) {
  sample_.feedback_age = kNan;
  EXPECT_EQ(checks_.powerRefusal(sample_), Refusal::kFeedback);
  EXPECT_EQ(found(), FaultKind::kStaleFeedback);
  sample_.feedback_age = 0;
  sample_.position[kZ] = kNan;
  EXPECT_EQ(checks_.powerRefusal(sample_), Refusal::kFeedback);
  sample_.drive.fault = true;
  EXPECT_EQ(checks_.powerRefusal(sample_), Refusal::kDriveFault);
  sample_.drive.emergency_stop = true;
  EXPECT_EQ(checks_.powerRefusal(sample_), Refusal::kEmergencyStop);
}

}  // namespace test_drive_checks
}  // namespace grinder::test_support
