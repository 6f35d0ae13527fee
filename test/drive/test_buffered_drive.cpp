#include "control/rig.h"

#include <deque>

// The control loop with a drive that buffers commands and plays them by a clock of its own.
namespace grinder::test_support {
namespace test_buffered_drive {

constexpr std::size_t kDepth = 50;

/// Makes a drive play each command kDepth cycles after it was written.
struct Buffer {
  std::deque<Axes> waiting;
  bool reports = true;  ///< how many wait

  void operator()(FakeDrive& drive) {
    if (!drive.status.enabled) return waiting.clear();
    waiting.push_back(toAxes(drive.written));
    if (waiting.size() > kDepth + 1) waiting.pop_front();
    drive.place(waiting.front());
    drive.status.commands_waiting = reports ? static_cast<std::uint32_t>(waiting.size() - 1) : 0;
  }
};

class BufferedDrive : public testing::Test {
 protected:
  BufferedDrive() {
    rig_.drive.status.spindle_at_speed = rig_.drive.status.coolant_on = true;
    rig_.drive.on_read = [this](FakeDrive& drive) { buffer_(drive); };
    rig_.cycle();
  }

  Rig<FakeDrive> rig_;
  Buffer buffer_;
};

TEST_F(BufferedDrive, IsComparedWithTheCommandThatTheAxesHaveGot) {
  rig_.startPaper();
  rig_.runToEnd();
  EXPECT_EQ(rig_.last().state, S::kReady) << rig_.last().fault.text();
}

TEST_F(BufferedDrive, ThatDoesNotReportItsBufferFallsBehind) {
  buffer_.reports = false;
  rig_.startPaper();
  rig_.runToEnd();
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kFollowingError);
}

TEST_F(BufferedDrive, EndsTheJobWhenTheAxesHaveGotTheLastSetpoint) {
  rig_.startPaper();
  rig_.runToEnd();
  const std::vector<Setpoint> setpoints = rig_.setpoints();
  EXPECT_TRUE(sameBits(rig_.last().position, setpoints.back().position));
  const auto& log = rig_.log;
  const auto last = std::find_if(log.rbegin(), log.rend(), [](const CycleSample& r) { return r.has_setpoint; });
  EXPECT_EQ(static_cast<std::size_t>(last - log.rbegin()), kDepth + 1);
}

TEST_F(BufferedDrive, IsHeldWhenTheAxesRest) {
  rig_.startPaper();
  rig_.runTo(MoveKind::kStroke);
  ASSERT_TRUE(rig_.ask(MachineEvent::kHold).accepted);
  while (rig_.last().state == S::kHolding) rig_.cycle();
  ASSERT_EQ(rig_.last().state, S::kHeld);
  EXPECT_TRUE(sameBits(rig_.last().position, rig_.last().command));
}

TEST_F(BufferedDrive, UnderrunIsAFaultWithCountAndSetpoint) {
  rig_.drive.status.underruns = 7;  // of another time
  rig_.startPaper();
  rig_.runTo(MoveKind::kStroke);
  const std::uint64_t cycle = rig_.last().setpoint.cycle;
  rig_.drive.status.underruns += 3;
  rig_.drive.status.fault = true;  // which is what the drive makes of it
  const CycleSample& sample = rig_.cycle();
  EXPECT_EQ(sample.state, S::kFault);
  EXPECT_TRUE(sample.job_ended);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  EXPECT_EQ(sample.fault.kind, FaultKind::kUnderrun);
  EXPECT_EQ(sample.fault.text(),
            "the axes found no setpoint in 3 servo cycles, after setpoint " + std::to_string(cycle));
}

TEST_F(BufferedDrive, FollowsPositionsAnewAfterAFault) {
  rig_.startPaper();
  rig_.runTo(MoveKind::kStroke);
  rig_.drive.status.emergency_stop = true;
  ASSERT_EQ(rig_.cycle().state, S::kFault);
  rig_.drive.status.emergency_stop = false;
  ASSERT_TRUE(rig_.ask(MachineEvent::kReset).accepted);
  rig_.enable();
  EXPECT_TRUE(sameBits(rig_.last().command, rig_.last().position));
  rig_.run(2 * kDepth);
  EXPECT_EQ(rig_.last().state, S::kReady) << rig_.last().fault.text();
}

}  // namespace test_buffered_drive
}  // namespace grinder::test_support
