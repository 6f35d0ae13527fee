#include "control/fixtures.h"
#include "control/paper_stream.h"
#include "flute_grinder/control/control_loop.h"
#include "soon.h"

#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

// Everything that other threads may do to the loop, concurrently and at random times, with drives that fail: no data
// race, no request without an answer, no job that does not end. Made for ThreadSanitizer.
namespace grinder::test_support {
namespace test_loop_threads {

using E = MachineEvent;
constexpr std::uint64_t kCycles = 60000;

/// Fails at times, for a while.
class Unreliable {
 public:
  void operator()(FakeDrive& drive) {
    if (left_-- > 0) return spoil(drive);
    drive.status.emergency_stop = drive.status.fault = false;
    kind_ = static_cast<int>(random_() % 5);
    left_ = random_() % 3000 == 0 ? 30 : 0;
  }

 private:
  void spoil(FakeDrive& drive) const {
    if (kind_ == 0) drive.status.emergency_stop = true;
    if (kind_ == 1) drive.status.fault = true;
    if (kind_ == 2) drive.status.spindle_at_speed = false;
    if (kind_ == 3) drive.status.enabled = false;
    if (kind_ == 4) --drive.status.feedback_count;
  }

  std::mt19937 random_{1};
  int left_ = 0, kind_ = 0;
};

class LoopThreads : public testing::Test {
 protected:
  LoopThreads() {
    setUp(drive_, machineConfig());
    drive_.on_read = Unreliable{};
    loop_ = std::make_unique<ControlLoop>(drive_, machineConfig());
    loop_->postSwivel(kPaperSwivel);
  }

  template <typename Work>
  void spawn(unsigned seed, const Work& work) {
    threads_.emplace_back([this, seed, work] {
      std::mt19937 random(seed);
      while (busy_) work(random);
    });
  }

  /// Starts a job, waits for its end, and destroys its stream.
  void startOne() {
    const LoopStatus before = loop_->status();
    if (before.state != S::kReady) return std::this_thread::yield();
    Axes at;
    std::copy(before.command.begin(), before.command.end(), at.data());
    const auto stream = std::make_unique<SetpointStream>(paperStream(machineConfig().machine, at));
    ASSERT_TRUE(loop_->startJob({stream.get(), wheelOf(stream->program())}));
    std::optional<RequestReply> reply;
    ASSERT_TRUE(soon([&] { return (reply = loop_->startJobReply()).has_value(); }));
    if (!reply->accepted) return;
    ++accepted_;
    ASSERT_TRUE(soon([&] { return loop_->status().jobs_ended == accepted_; }));
  }

  FakeDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
  std::atomic<bool> busy_{true}, cycling_{true};
  std::vector<std::thread> threads_;
  std::uint64_t accepted_ = 0;  ///< jobs
};

TEST_F(LoopThreads, AskAtRandomMoments) {
  std::thread cycles([this] {
    const ros::Duration period(0.001);
    ros::Time time(1000);
    while (cycling_) loop_->cycle(time += period, period);
  });
  spawn(2, [this](std::mt19937&) { startOne(); });
  spawn(3, [this](std::mt19937& random) {
    constexpr std::array<E, 6> events{E::kEnable, E::kReset, E::kLift, E::kResume, E::kRetract, E::kHome};
    const std::size_t i = random() % 40;
    // Home rarely, because this drive does not find its reference.
    EXPECT_TRUE(loop_->request(i < 39 ? events[i % 5] : E::kHome).answered);
  });
  spawn(4, [this](std::mt19937& random) {
    if (random() % 50 == 0) {
      const RequestReply reply = loop_->stop(StopRequests::kStops[random() % 3]);
      EXPECT_TRUE(reply.answered || !reply.accepted) << "a stop that timed out counts as accepted";
    }
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  });
  spawn(5, [this](std::mt19937& random) {
    if (random() % 300 == 0) loop_->postStop(random() % 4 == 0 ? E::kCancel : E::kHold);
    loop_->setFeedOverride(static_cast<double>(random() % 13) / 10);
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  });
  spawn(7, [this](std::mt19937& random) {
    const double part = static_cast<double>(random() % 200) / 100 - 1;
    const auto axis = static_cast<int>(random() % 4);
    EXPECT_TRUE(loop_->jog({axis, random() % 2 == 0, part * 0.01, part * 0.1}).answered);
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  });
  std::atomic<std::uint64_t> bad{0}, taken{0};
  spawn(6, [&](std::mt19937&) {
    const LoopStatus status = loop_->status();
    bad += status.jobs_ended > status.jobs_started || status.jobs_started > status.jobs_ended + 1;
    bad += (status.end == JobEnd::kNone) != (status.jobs_started != status.jobs_ended) && status.jobs_started > 0;
  });
  spawn(7, [&](std::mt19937&) {
    CycleSample sample;
    while (loop_->pop(sample)) {
      ++taken;
      bad += sample.has_setpoint && !sample.drive.enabled;
      bad += sample.state == S::kDisabled && sample.has_setpoint;
    }
  });
  EXPECT_TRUE(soon([&] { return loop_->status().cycles > kCycles && loop_->status().jobs_ended > 2; }));
  busy_ = false;
  // A thread that waits for the end of a job.
  EXPECT_TRUE(soon([&] {
    loop_->postStop(E::kDisable);
    return loop_->status().jobs_ended == loop_->status().jobs_started;
  }));
  for (std::thread& thread : threads_) thread.join();
  // The last requests have taken effect too.
  EXPECT_TRUE(soon([&] {
    loop_->postStop(E::kDisable);
    const S state = loop_->status().state;
    return state == S::kDisabled || state == S::kFault;
  }));
  cycling_ = false;
  cycles.join();
  EXPECT_EQ(bad, 0u);
  EXPECT_GT(taken, 0u);
  const LoopStatus end = loop_->status();
  EXPECT_EQ(end.jobs_started, accepted_);
  EXPECT_EQ(end.jobs_ended, accepted_);
  EXPECT_GT(accepted_, 2u) << "no job ran while all this was asked";
}

}  // namespace test_loop_threads
}  // namespace grinder::test_support
