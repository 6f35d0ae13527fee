#include "control/paper_job.h"

#include <limits>

// The loop without power, a whole job, and the samples.
namespace grinder::test_support {
namespace test_control_loop {

TEST(ControlLoopDisabled, ReportsWhatWasRead) {
  Rig<FakeDrive> rig;
  rig.drive.place({0.01, 0.02, 0.03, 0.04});
  rig.drive.velocity = {1, 2, 3, 4};
  rig.drive.status.emergency_stop = true;
  const CycleSample sample = rig.cycle();
  EXPECT_TRUE(sameBits(sample.position, Axes(0.01, 0.02, 0.03, 0.04)));
  EXPECT_TRUE(sameBits(sample.velocity, Axes(1, 2, 3, 4)));
  EXPECT_TRUE(sample.drive.emergency_stop);
  EXPECT_TRUE(sample.drive.homed);
  EXPECT_EQ(sample.drive.feedback_count, 1u);
  EXPECT_DOUBLE_EQ(sample.time, 1000.001);
  EXPECT_DOUBLE_EQ(sample.period, 0.001);
  EXPECT_TRUE(sameBits(toAxes(rig.loop->status().position), sample.position));
  EXPECT_TRUE(rig.loop->status().position_valid);
  rig.drive.position[kZ] = std::numeric_limits<double>::quiet_NaN();
  rig.cycle();
  EXPECT_FALSE(rig.loop->status().position_valid);
  rig.drive.position[kZ] = 0;
  rig.drive.on_read = [](FakeDrive& d) { --d.status.feedback_count; };
  rig.cycle();
  EXPECT_TRUE(rig.loop->status().position_valid) << "as yet";
  rig.run(3);
  EXPECT_FALSE(rig.loop->status().position_valid) << "not fresh for 3 periods; 2.5 are allowed";
}

TEST(PaperJob, IsStreamedBitForBitAsPlannedASetpointACycle) {
  Rig<SimulatedDrive> rig;
  rig.startPaper();
  rig.runToEnd();
  ASSERT_GT(planned().size(), 3000u);
  EXPECT_TRUE(sameSetpoints(rig.setpoints(), planned()));
  const std::size_t first = rig.log.size() - 1 - planned().size();
  for (std::size_t i = 0; i < planned().size(); ++i) {
    const CycleSample& sample = rig.log[first + i];
    ASSERT_TRUE(sample.has_setpoint) << i;
    ASSERT_EQ(sample.state, S::kRunning);
    ASSERT_TRUE(sameBits(sample.command, sample.setpoint.position));
  }
  const LoopStatus status = rig.loop->status();
  EXPECT_EQ(status.cycles, rig.log.size());
  EXPECT_DOUBLE_EQ(status.time, rig.last().time);
  EXPECT_TRUE(status.homed);
  EXPECT_TRUE(sameBits(toAxes(status.command), rig.last().command));
  EXPECT_NEAR(status.wheel.clear_y, kClearanceHeight, 1e-15);
}

TEST(ControlLoopSamples, ThoseNobodyTakesAreCountedAndTheLoopGoesOn) {
  Rig<FakeDrive> rig;
  rig.runUnseen(8192 + 7);
  EXPECT_EQ(rig.drive.status.feedback_count, 8192u + 7);
  CycleSample sample;
  int taken = 0;
  while (rig.loop->pop(sample)) {
    EXPECT_EQ(sample.samples_lost, 0u);
    ++taken;
  }
  EXPECT_EQ(taken, 8192);
  EXPECT_EQ(rig.cycle().samples_lost, 7u);
  EXPECT_EQ(rig.cycle().samples_lost, 7u);
}

TEST(ControlLoopSamples, AJobIsStreamedWholeWithoutRoomForThemAndItsEndIsReportedLater) {
  RigIn rig(S::kReady);
  SetpointStream stream = rig.paperStream();
  rig.runUnseen(8192);
  ASSERT_TRUE(rig.loop->startJob({&stream, wheelOf(stream.program())}));
  rig.runUnseen(planned().size() + 10);
  EXPECT_EQ(rig.loop->status().jobs_ended, 1u);
  EXPECT_EQ(rig.loop->status().end, JobEnd::kDone);
  EXPECT_EQ(rig.loop->status().setpoints_written, planned().size());
  CycleSample sample;
  while (rig.loop->pop(sample)) EXPECT_FALSE(sample.job_ended);
  const CycleSample& first = rig.cycle();
  EXPECT_TRUE(first.job_ended);
  EXPECT_EQ(first.state, S::kReady);
  EXPECT_TRUE((first.command == machineConfig().machine.park).all());
  EXPECT_FALSE(rig.cycle().job_ended);
}

TEST(ControlLoopSamples, OfAJobThatRunsDoNotReportTheEndOfTheOneBefore) {
  RigIn rig(S::kReady);
  SetpointStream first = rig.paperStream(), second = rig.paperStream();
  rig.runUnseen(8192);
  for (SetpointStream* stream : {&first, &second}) {
    ASSERT_TRUE(rig.loop->startJob({stream, wheelOf(stream->program())}));
    rig.runUnseen(stream == &first ? planned().size() + 10 : 10);
  }
  for (CycleSample sample; rig.loop->pop(sample);) EXPECT_FALSE(sample.job_ended);
  EXPECT_FALSE(rig.cycle().job_ended);
  EXPECT_EQ(rig.last().state, S::kRunning);
}

}  // namespace test_control_loop
}  // namespace grinder::test_support
