#include "flute_grinder/control/drive_checks.h"

#include "control/fixtures.h"

#include <cmath>
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

  const LoopConfig config_ = [] {
    LoopConfig config = machineConfig();
    config.following_error << 0.001, 0.002, 0.003, 0.05;
    return config;
  }();
  DriveChecks checks_{config_};
  CycleSample sample_;
};

// Each cause is added to the ones over which it takes precedence.
TEST_F(DriveChecksTest, FindTheCauseBeforeItsConsequencesAndRefusePowerForIt) {
  const auto refusal = [&] { return checks_.powerRefusal(sample_); };
  sample_.position[kY] += 1;
  EXPECT_EQ(found(), FaultKind::kFollowingError);
  EXPECT_EQ(refusal(), Refusal::kNone);
  sample_.position[kY] = kNan;
  EXPECT_EQ(found(), FaultKind::kInvalidFeedback);
  EXPECT_EQ(refusal(), Refusal::kFeedback);
  for (const double age : {1.0, kNan}) {
    sample_.feedback_age = age;
    EXPECT_EQ(found(), FaultKind::kStaleFeedback);
    EXPECT_EQ(refusal(), Refusal::kFeedback);
  }
  sample_.drive.enabled = false;
  EXPECT_EQ(found(), FaultKind::kPowerLost);
  sample_.drive.fault = true;
  EXPECT_EQ(found(), FaultKind::kDriveFault);
  EXPECT_EQ(refusal(), Refusal::kDriveFault);
  sample_.period *= 2 * config_.late_fault;
  EXPECT_EQ(found(), FaultKind::kLate);
  ++sample_.drive.underruns;
  EXPECT_EQ(found(), FaultKind::kUnderrun);
  sample_.drive.emergency_stop = true;
  EXPECT_EQ(found(), FaultKind::kEmergencyStop);
  EXPECT_EQ(refusal(), Refusal::kEmergencyStop);
}

TEST_F(DriveChecksTest, LetTheFollowingErrorOfEachAxisBeItsLimitAndNoMore) {
  sample_.position = sample_.command_in_effect = Axes::Zero();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const double side : {1.0, -1.0}) {
      sample_.position[axis] = side * config_.following_error[axis];
      EXPECT_EQ(found(), FaultKind::kNone) << axis;
      sample_.position[axis] = side * std::nextafter(config_.following_error[axis], 1.0);
      EXPECT_EQ(found(), FaultKind::kFollowingError) << axis;
    }
    sample_.position[axis] = 0;
  }
}

/// Lets a second of cycles pass, over which they are averaged. @param period of each [control periods].
void pass(DriveChecks& checks, CycleSample sample, double period) {
  sample.period *= period;
  for (double time = 0; time < 1.01; time += sample.period) checks.observe(sample);
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
  for (int i = 0; i < 10; ++i) pass(checks_, sample_, 1);
  EXPECT_EQ(found(), FaultKind::kNone);
  pass(checks_, sample_, 2);
  EXPECT_EQ(found(), FaultKind::kSlow) << "the good seconds before do not count";
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

}  // namespace test_drive_checks
}  // namespace grinder::test_support
