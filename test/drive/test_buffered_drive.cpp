#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>

// The control loop with a drive that buffers commands and plays them by a clock of its own.
namespace grinder::test_support {
namespace test_buffered_drive {

constexpr std::size_t kDepth = 50;

/// Makes a drive play each command kDepth cycles after it was written.
struct Buffer {
  std::deque<Axes> waiting;

  void operator()(FakeDrive& drive) {
    if (!drive.status.enabled) return waiting.clear();
    waiting.push_back(toAxes(drive.written));
    if (waiting.size() > kDepth + 1) waiting.pop_front();
    drive.place(waiting.front());
    drive.status.commands_waiting = static_cast<std::uint32_t>(waiting.size() - 1);
  }
};

class BufferedDrive : public testing::Test {
 protected:
  BufferedDrive() {
    rig_.drive.on_read = [this](FakeDrive& drive) { buffer_(drive); };
  }

  Rig<FakeDrive> rig_{machineConfig(), [](FakeDrive& drive) {
                        setUp(drive, machineConfig());
                        drive.can.buffer = kDepth;
                      }};
  Buffer buffer_;
};

/// In the second job the buffer still holds commands of the first.
TEST_F(BufferedDrive, IsComparedWithWhatTheAxesHaveGotWhichTheStatusReportsToo) {
  for (std::uint64_t job = 1; job <= 2; ++job) {
    SCOPED_TRACE(job);
    ASSERT_NO_FATAL_FAILURE(rig_.startPaper());
    std::vector<Setpoint> written{rig_.last().setpoint};
    std::uint32_t ended = 0;
    for (int i = 0; i < 100000 && !rig_.last().job_ended; ++i) {
      rig_.cycle();
      const LoopStatus status = rig_.loop->status();
      ASSERT_EQ(status.jobs_started, job);
      // As of this cycle's positions; at first no command of this job has reached the axes.
      const auto at = std::find_if(written.rbegin(), written.rend(),
                                   [&](const Setpoint& p) { return sameBits(p.position, rig_.last().position); });
      if (at == written.rend() || written.size() < kDepth + 10) {
        ASSERT_EQ(status.strokes_ended_at, 0u);
      } else {
        ASSERT_EQ(status.place.move_index, at->move_index);
        ASSERT_EQ(status.place.move_fraction, at->move_fraction);
        ASSERT_EQ(status.place.x, rig_.last().position[kX]);
        if (at->move == MoveKind::kStroke && at->move_fraction == 1) ended = at->move_index + 1;
        ASSERT_EQ(status.strokes_ended_at, ended);
        ASSERT_EQ(status.wheel.in_work, at->position[kY] < kClearanceHeight);
      }
      if (rig_.last().has_setpoint) written.push_back(rig_.last().setpoint);
      ASSERT_EQ(status.setpoints_written, written.size());
    }
    EXPECT_GT(ended, 0u);
    EXPECT_EQ(rig_.loop->status().end, JobEnd::kDone) << rig_.last().fault.text();
    // It ends when the axes have got the last setpoint.
    EXPECT_TRUE(sameBits(rig_.last().position, written.back().position));
    const auto& log = rig_.log;
    const auto last = std::find_if(log.rbegin(), log.rend(), [](const CycleSample& r) { return r.has_setpoint; });
    EXPECT_EQ(static_cast<std::size_t>(last - log.rbegin()), kDepth + 1);
  }
}

TEST_F(BufferedDrive, IsHeldWhenTheAxesRest) {
  rig_.startPaper();
  rig_.runTo(MoveKind::kStroke);
  ASSERT_NO_FATAL_FAILURE(rig_.hold());
  EXPECT_TRUE(sameBits(rig_.last().position, rig_.last().command));
}

TEST_F(BufferedDrive, UnderrunIsAFaultWithCountAndSetpoint) {
  rig_.drive.status.underruns = 7;  // of another time
  rig_.startPaper();
  rig_.runTo(MoveKind::kStroke);
  const std::uint64_t cycle = rig_.last().setpoint.cycle;
  rig_.drive.status.underruns += 3;
  const CycleSample& sample = rig_.cycle();
  EXPECT_EQ(sample.state, S::kFault);
  EXPECT_EQ(sample.fault.text(),
            "the axes found no setpoint in 3 servo cycles, after setpoint " + std::to_string(cycle));
}

/// Reports in a state that commands wait, then disables.
const CycleSample& afterDisable(RigIn& rig, std::uint32_t waiting) {
  rig.drive.on_read = [before = rig.drive.on_read, waiting](FakeDrive& d) {
    if (before) before(d);
    d.status.commands_waiting = waiting;
  };
  rig.loop->postStop(E::kDisable);
  for (int i = 0; i < 5000 && rig.drive.written_drive.enable; ++i) rig.cycle();
  return rig.last();
}

TEST(BufferThat, HoldsMoreThanItCanIsAFaultInAnyState) {
  for (const S state : {S::kReady, S::kHoming, S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracted,
                        S::kCanceling, S::kLifting, S::kJogging}) {
    SCOPED_TRACE(toString(state));
    RigIn rig(state, machineConfig(), 50);
    const CycleSample& sample = afterDisable(rig, std::numeric_limits<std::uint32_t>::max());
    EXPECT_EQ(sample.state, S::kFault);
    EXPECT_EQ(sample.fault.text(),
              "the drive reports a fault: it has reported 4294967295 commands waiting; allowed: up to 50");
    EXPECT_EQ(sample.drive.commands_waiting, 50u);
    EXPECT_FALSE(rig.drive.written_drive.enable);
  }
}

TEST(BufferThat, NeverEmptiesDelaysADisableByNoMoreThanItHolds) {
  for (const S state : {S::kStarting, S::kRunning, S::kHeld, S::kRetracted, S::kLifting, S::kJogging}) {
    SCOPED_TRACE(toString(state));
    LoopConfig config = machineConfig();
    config.following_error.setConstant(1);
    RigIn rig(state, config, 50), empty(state, config, 50);
    EXPECT_EQ(afterDisable(rig, 50).state, S::kDisabled);
    EXPECT_EQ(afterDisable(empty, 0).state, S::kDisabled);
    EXPECT_LE(rig.log.size(), empty.log.size() + 2 * 51) << "at the stop, and at the end of the lift";
  }
}

}  // namespace test_buffered_drive
}  // namespace grinder::test_support
