#include "control/fixtures.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/loop_watchdog.h"
#include "soon.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

// The thread.
namespace grinder::test_support {
namespace test_loop_thread {

class ControlLoopThread : public testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  ControlLoopThread() {
    setUp(drive_, machineConfig());
    loop_ = std::make_unique<ControlLoop>(drive_, machineConfig());
  }

  bool popInTime(CycleSample& sample) {
    return soon([&] { return loop_->pop(sample); });
  }

  FakeDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
};

TEST_F(ControlLoopThread, ThePeriodsAddUpToTheTime) {
  loop_->startThread();
  CycleSample sample;
  ASSERT_TRUE(popInTime(sample));
  const double first = sample.time;
  double sum = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(popInTime(sample));
    EXPECT_GT(sample.period, 0);
    sum += sample.period;
  }
  // Seconds since 1970 have a resolution of a quarter of a microsecond as a double.
  EXPECT_NEAR(sample.time - first, sum, 1e-6);
}

TEST_F(ControlLoopThread, OfADriveWithAClockOfItsOwnThatThrowsAgainLaterKeepsTheTime) {
  using Clock = std::chrono::steady_clock;
  static constexpr int kFailures[]{3, 60};
  int waits = 0;
  Clock::time_point waited_until;  // before the failure
  std::atomic<double> passed{0};   // since then, when the failure is read
  const auto fails = [&] { return waits == kFailures[0] || waits == kFailures[1]; };
  drive_.waited = ros::Duration(0.001);
  drive_.on_wait = [&] {
    ++waits;
    if (fails()) throw std::runtime_error("no clock");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    waited_until = Clock::now();
  };
  drive_.on_read = [&](FakeDrive&) {
    if (fails()) passed = std::chrono::duration<double>(Clock::now() - waited_until).count();
  };
  loop_->startThread();
  CycleSample sample;
  int cycle = 0;
  for (const int failure : kFailures) {
    for (; cycle < failure; ++cycle) ASSERT_TRUE(popInTime(sample));
    EXPECT_TRUE(sample.drive.fault);
    EXPECT_GT(sample.period, 0);
    EXPECT_LE(sample.period, passed) << failure;
  }
  loop_->stopThread();
}

TEST_F(ControlLoopThread, GoesOnWhenTheDriveReturnsATimeThatCannotHavePassed) {
  const std::int32_t least = std::numeric_limits<std::int32_t>::min(), most = std::numeric_limits<std::int32_t>::max();
  for (const auto& [seconds, nanoseconds] : {std::pair(least, 0), {-1, 0}, {3600, 1}, {most, 0}}) {
    drive_.on_wait = [] {};
    drive_.waited = ros::Duration(seconds, nanoseconds);
    ControlLoop loop(drive_, machineConfig());
    loop.startThread();
    CycleSample sample;
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(test_support::soon([&] { return loop.pop(sample); }));
      EXPECT_EQ(sample.drive.fault_text.text(),
                "its wait() has returned " + std::to_string(seconds) + " s; allowed: 0 to 3600 s");
      EXPECT_GT(sample.period, 0);
      EXPECT_LT(sample.period, 10);
    }
  }
}

TEST_F(ControlLoopThread, StampsEndWithTheClock) {
  drive_.on_wait = [] {};
  drive_.waited = ros::Duration(3600, 0);
  loop_->startThread();
  // The samples are too many for the queue.
  EXPECT_TRUE(soon([&] { return loop_->status().time == std::numeric_limits<std::uint32_t>::max(); }));
  const std::uint64_t cycles = loop_->status().cycles;
  EXPECT_TRUE(soon([&] { return loop_->status().cycles > cycles + 10; }));
}

TEST_F(ControlLoopThread, TheWatchdogSwitchesThePowerOffOfADriveThatHangs) {
  std::atomic<bool> hangs{false};
  drive_.on_read = [&](FakeDrive&) {
    while (hangs) std::this_thread::yield();
  };
  loop_->startThread();
  const LoopWatchdog watchdog(*loop_, drive_);
  const std::uint64_t before = loop_->status().cycles;
  ASSERT_TRUE(soon([&] { return loop_->status().cycles > before + 500; }));  // longer than it waits
  EXPECT_FALSE(watchdog.loopHangs());
  EXPECT_FALSE(drive_.power_off);
  hangs = true;
  ASSERT_TRUE(soon([&] { return watchdog.finding() == LoopWatchdog::Finding::kHangsPowerIsOff; }));
  EXPECT_TRUE(drive_.power_off);
  hangs = false;
  ASSERT_TRUE(soon([&] { return watchdog.finding() == LoopWatchdog::Finding::kRuns; }));
  drive_.power_off_fails = true;
  hangs = true;
  ASSERT_TRUE(soon([&] { return watchdog.finding() == LoopWatchdog::Finding::kHangs; }));
  loop_->requestEnd();
  EXPECT_FALSE(loop_->hasEnded());
  hangs = false;
  EXPECT_TRUE(soon([&] { return loop_->hasEnded(); }));
  drive_.power_off = false;
  FakeDrive other;
  ControlLoop never_started(other, machineConfig());
  for (int i = 0; i < 2; ++i) {  // for longer than the first one waits
    const LoopWatchdog later(never_started, other);
    ASSERT_TRUE(soon([&] { return later.loopHangs(); }));
  }
  EXPECT_FALSE(watchdog.loopHangs() || drive_.power_off) << "a loop that has ended does not hang";
}

TEST_F(ControlLoopThread, OfADriveThatReturnsHasNoPowerBeforeItsPowerOffHasReturned) {
  LoopConfig config = machineConfig();
  config.following_error.setConstant(1);
  config.feedback_timeout = config.enable_timeout = 30;  // the machine may be busy with other things
  std::atomic<bool> hangs{false}, power_off_hangs{true};
  drive_.on_read = [&](FakeDrive&) {
    while (hangs) std::this_thread::yield();
  };
  drive_.on_power_off = [&] {
    while (power_off_hangs) std::this_thread::yield();
  };
  loop_ = std::make_unique<ControlLoop>(drive_, config);
  loop_->startThread();
  const LoopWatchdog watchdog(*loop_, drive_);
  ASSERT_TRUE(loop_->request(E::kEnable).accepted);
  hangs = true;
  ASSERT_TRUE(soon([&] { return watchdog.finding() == LoopWatchdog::Finding::kSwitchingOff; }));
  hangs = false;
  EXPECT_TRUE(soon([&] { return loop_->status().state == S::kFault; })) << "power after a hang";
  EXPECT_EQ(watchdog.finding(), LoopWatchdog::Finding::kRuns);
  EXPECT_TRUE(loop_->request(E::kReset).accepted);
  EXPECT_EQ(loop_->request(E::kEnable).text,
            "enable refused: the drive still reports a fault after the reset: it has returned to the control loop too "
            "late; its powerOff() has not returned; remove its cause");
  EXPECT_TRUE(loop_->isPoweringOff());
  power_off_hangs = false;
  ASSERT_TRUE(soon([&] { return !loop_->isPoweringOff(); }));
  ASSERT_TRUE(soon([&] { return loop_->request(E::kEnable).accepted; }));
  EXPECT_EQ(loop_->status().state, S::kReady);
}

TEST_F(ControlLoopThread, ReportsHowLongTheCycleBeforeTookWithoutTheWait) {
  using Clock = std::chrono::steady_clock;
  // By value, as the thread goes on after the test.
  static constexpr std::chrono::milliseconds taken{2};
  const auto spend = [] {
    for (const auto start = Clock::now(); Clock::now() - start < taken;) {
    }
  };
  drive_.on_read = [spend](FakeDrive&) { spend(); };
  drive_.on_wait = spend;
  loop_->startThread();
  CycleSample sample;
  ASSERT_TRUE(popInTime(sample));
  EXPECT_EQ(sample.busy, 0);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(popInTime(sample));
    EXPECT_GE(sample.busy, 0.002);
    EXPECT_LE(sample.busy, sample.period - 0.002);
  }
}

TEST_F(ControlLoopThread, StopEndsTheCyclesAndLeavesTheDriveWithEverythingOff) {
  LoopConfig config = machineConfig();
  config.following_error.setConstant(1);
  config.feedback_timeout = config.enable_timeout = 30;  // the machine may be busy with other things
  loop_ = std::make_unique<ControlLoop>(drive_, config);
  static std::atomic<bool> has_ended;
  has_ended = false;
  drive_.on_read = [](FakeDrive&) {
    struct AtEnd {
      ~AtEnd() { has_ended = true; }
    };
    static const thread_local AtEnd at_end;  // of the loop's thread
  };
  loop_->startThread();
  const RequestReply answer = loop_->request(E::kEnable);
  ASSERT_TRUE(answer.accepted) << answer.text;
  ASSERT_TRUE(loop_->request(E::kSpindleOn).accepted);
  ASSERT_TRUE(loop_->request(E::kCoolantOn).accepted);
  loop_->stopThread();
  const DriveCommand& last = drive_.written_drive;
  EXPECT_FALSE(last.enable || last.spindle || last.coolant);
  EXPECT_TRUE(sameBits(toAxes(drive_.written), machineConfig().machine.park)) << "stopping moved an axis";
  EXPECT_TRUE(has_ended) << "the cycles may go on";
}

TEST_F(ControlLoopThread, KeepsTheComputersTime) {
  ros::Time::setNow(ros::Time(5));  // as of a simulation
  const double before = ros::WallTime::now().toSec();
  loop_->startThread();
  CycleSample sample;
  const bool popped = popInTime(sample);
  loop_->stopThread();
  ros::Time::init();
  ASSERT_TRUE(popped);
  EXPECT_GE(sample.time, before - 1e-3);
  EXPECT_LE(sample.time, ros::WallTime::now().toSec());
  EXPECT_GE(loop_->status().time, sample.time);
}

TEST_F(ControlLoopThread, TakesNoSignalAndIsKnownAsItsOwn) {
  std::atomic<int> open{-1};
  std::atomic<bool> is_own{false};
  drive_.on_read = [&](FakeDrive&) {
    is_own = loop_->isOwnThread();
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    int count = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGALRM, SIGUSR1}) {
      count += sigismember(&blocked, signal) == 0;
    }
    open = count;
  };
  loop_->startThread();
  CycleSample sample;
  ASSERT_TRUE(popInTime(sample));
  EXPECT_FALSE(loop_->isOwnThread());
  loop_->stopThread();
  EXPECT_TRUE(is_own);
  EXPECT_EQ(open, 0);
}

/// Resident memory [bytes].
std::size_t resident() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, pages = 0;
  statm >> size >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(ControlLoopThread, LockedMemoryTakesNoneThatIsOnlyClaimed) {
  loop_->startThread();
  if (!loop_->memoryLocked()) GTEST_SKIP() << "the system does not grant locked memory";
  constexpr std::size_t claim = std::size_t{1} << 28;
  const std::size_t before = resident();
  void* const memory = mmap(nullptr, claim, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  EXPECT_LT(resident(), before + claim / 4);
  munmap(memory, claim);
}

TEST_F(ControlLoopThread, AnswersAStopAndARequestAndReportsItsStatus) {
  loop_->startThread();
  CycleSample sample;
  ASSERT_TRUE(popInTime(sample));
  const RequestReply done = loop_->stop(E::kDisable);
  EXPECT_TRUE(done.accepted && done.answered);
  const RequestReply answer = loop_->stop(E::kCancel);
  EXPECT_TRUE(answer.answered);
  EXPECT_EQ(answer.text, "cancel refused: the machine is in state disabled; allowed: enable, disable, reset");
  EXPECT_EQ(loop_->request(E::kLift).text,
            "lift refused: the machine is in state disabled; allowed: enable, disable, reset");
  EXPECT_GT(loop_->status().cycles, 0u);
}

TEST_F(ControlLoopThread, RefusesOnEachRoadWhatBelongsOnAnother) {
  const RequestReply stop = loop_->stop(E::kEnable);
  EXPECT_EQ(stop.text, "enable refused: allowed: hold, cancel, disable");
  EXPECT_TRUE(stop.answered && !stop.accepted);
  for (const E event : {E::kHold, E::kStart, E::kFault}) {
    const RequestReply reply = loop_->request(event);
    EXPECT_CONTAINS(reply.text, "allowed: enable, home, reset, retract, resume, lift");
    EXPECT_TRUE(reply.answered && !reply.accepted);
  }
}

TEST_F(ControlLoopThread, AStopToALoopThatDoesNotRunIsNotAnswered) {
  const RequestReply answer = loop_->stop(E::kHold);
  EXPECT_FALSE(answer.accepted);
  EXPECT_FALSE(answer.answered);
  EXPECT_EQ(answer.text, "hold: the control loop does not answer");
}

TEST_F(ControlLoopThread, ARequestThatNobodyWaitsForAnyLongerIsNotExecuted) {
  EXPECT_EQ(loop_->confirmSwivel(0.3).text, "confirm-swivel: the control loop does not answer");
  loop_->cycle(ros::Time(1), ros::Duration(1e-3));
  EXPECT_FALSE(loop_->swivelReply().has_value());
  EXPECT_FALSE(loop_->status().swivel.isAt(0.3));
}

}  // namespace test_loop_thread
}  // namespace grinder::test_support
