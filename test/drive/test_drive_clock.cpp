#include "control/fixtures.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <vector>

// Replaces the C library's clock by one that stands still unless a test moves it: nothing here waits, and nothing
// depends on how fast the computer is.
namespace {

bool fake_clock = false;
std::int64_t clock_ns = 0;
std::int64_t processor_ns = 0;        ///< that the thread has used
int interruptions = 0;                ///< of the next sleeps
std::vector<std::int64_t> sleeps_ns;  ///< until when was slept

}  // namespace

extern "C" {

int clock_gettime(clockid_t id, timespec* time) noexcept {
  if (!fake_clock || (id != CLOCK_MONOTONIC && id != CLOCK_THREAD_CPUTIME_ID)) {
    return static_cast<int>(syscall(SYS_clock_gettime, id, time));
  }
  const std::int64_t now_ns = id == CLOCK_MONOTONIC ? clock_ns : processor_ns;
  *time = {static_cast<time_t>(now_ns / 1000000000), static_cast<long>(now_ns % 1000000000)};
  return 0;
}

int clock_nanosleep(clockid_t id, int flags, const timespec* until, timespec* left) {
  if (!fake_clock || id != CLOCK_MONOTONIC || flags != TIMER_ABSTIME) {
    return syscall(SYS_clock_nanosleep, id, flags, until, left) == 0 ? 0 : errno;
  }
  if (interruptions > 0) {
    --interruptions;
    return EINTR;
  }
  const std::int64_t until_ns = until->tv_sec * 1000000000LL + until->tv_nsec;
  sleeps_ns.push_back(until_ns);
  if (until_ns > clock_ns) clock_ns = until_ns;
  return 0;
}

}  // extern "C"

namespace grinder::test_support {
namespace {

class EmptyDrive : public Drive {
 public:
  void init(ros::NodeHandle&, ros::NodeHandle&) override {}
  DriveCapabilities capabilities() const override { return {}; }
  void read(const DriveCycle&, DriveFeedback&) override {}
  void write(const DriveCycle&, const DriveCommand&) override {}
};

constexpr std::int64_t kMillisecond = 1000000, kMicrosecond = 1000;
const ros::Duration kPeriod(0.001);
constexpr std::int64_t kStart = 5000 * 1000 * kMillisecond + 999 * kMillisecond;  ///< just before a full second

class Pacing : public testing::Test {
 protected:
  Pacing() {
    clock_ns = kStart;
    interruptions = 0;
    fake_clock = true;
    wait();  // takes the clock as it finds it
    sleeps_ns.clear();
  }
  ~Pacing() override { fake_clock = false; }

  /// @return whether it slept.
  bool wait() {
    const std::size_t before = sleeps_ns.size();
    drive_.wait(kPeriod);
    return sleeps_ns.size() > before;
  }

  EmptyDrive drive_;
};

TEST_F(Pacing, SleepsUntilEveryPeriodsEndWithoutDriftAlsoOfAPeriodThatChanges) {
  for (int i = 1; i <= 5; ++i) {
    clock_ns += kMillisecond / 3 * (i % 3);  // what the cycle took
    ASSERT_TRUE(wait());
    EXPECT_EQ(sleeps_ns.back(), kStart + i * kMillisecond);
  }
  drive_.wait(ros::Duration(0.004));
  EXPECT_EQ(sleeps_ns.back(), kStart + 9 * kMillisecond);
}

TEST_F(Pacing, AfterAStallOneCycleComesAtOnceAndTheRestInTime) {
  ASSERT_TRUE(wait());
  for (const std::int64_t late : {24 * kMillisecond + 12345, std::int64_t{1}}) {
    const std::int64_t stalled_until = clock_ns + kMillisecond + late;
    clock_ns = stalled_until;
    const std::size_t slept = sleeps_ns.size();
    EXPECT_EQ(drive_.wait(kPeriod).toNSec(), kMillisecond + late) << "the time since the cycle before";
    EXPECT_EQ(sleeps_ns.size(), slept);
    for (int i = 1; i <= 10; ++i) {
      EXPECT_EQ(drive_.wait(kPeriod).toNSec(), kMillisecond);
      ASSERT_EQ(sleeps_ns.size(), slept + static_cast<std::size_t>(i)) << "a missed cycle is made up for";
      EXPECT_EQ(sleeps_ns.back(), stalled_until + i * kMillisecond);
    }
  }
}

TEST_F(Pacing, StartsWithAPeriodButWithoutASleepAndWithoutMakingUpForTheTimeBefore) {
  EmptyDrive fresh;
  EXPECT_EQ(fresh.wait(ros::Duration(0.004)).toNSec(), 4 * kMillisecond);
  EXPECT_TRUE(sleeps_ns.empty());
  fresh.wait(kPeriod);
  EXPECT_EQ(sleeps_ns, std::vector<std::int64_t>{kStart + kMillisecond});
}

TEST_F(Pacing, ASignalDoesNotShortenTheWait) {
  interruptions = 3;
  ASSERT_TRUE(wait());
  EXPECT_EQ(interruptions, 0);
  EXPECT_EQ(sleeps_ns.back(), kStart + kMillisecond);
}

void setPace(SimulatedDrive& drive, double pace) {
  SimulatedDrive::Equipment equipment;
  equipment.pace = pace;
  drive.init(driveModel(), equipment);
}

TEST_F(Pacing, ASimulationMayRunFasterThanTheClock) {
  SimulatedDrive drive;
  setPace(drive, 10);
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) EXPECT_EQ(drive.wait(kPeriod).toNSec(), kMillisecond);
  };
  cycles(10);
  const std::size_t before = sleeps_ns.size();
  cycles(50);
  ASSERT_EQ(sleeps_ns.size(), before + 5) << "a rest for the cycles of a period";
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(sleeps_ns[before + i - 1], kStart + i * kMillisecond);
  clock_ns += 25 * kMillisecond;
  cycles(10);  // a stall of the host is not in the simulated time
}

TEST_F(Pacing, AFastSimulationTakesHalfACore) {
  SimulatedDrive drive;
  setPace(drive, 100);
  for (int i = 0; i < 100; ++i) drive.wait(kPeriod);
  for (const std::int64_t used : {3, 30, 500}) {
    const std::int64_t before = clock_ns;
    for (int i = 0; i < 100; ++i) {
      clock_ns += used * kMicrosecond;
      processor_ns += used * kMicrosecond;
      EXPECT_EQ(drive.wait(kPeriod).toNSec(), kMillisecond);
    }
    EXPECT_EQ(clock_ns - before, 100 * std::max(10 * kMicrosecond, 2 * used * kMicrosecond));
  }
}

}  // namespace
}  // namespace grinder::test_support
