#include "check/machine.h"
#include "control/fixtures.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "node/job_gate.h"
#include "node/planner.h"
#include "random_cases.h"
#include "soon.h"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <random>
#include <thread>
#include <vector>

// Goals that are planned and started while stops, requests and faults come at random moments from other threads,
// through the very parts of the node that they go through: no data race, and no job that a stop has missed. Made for
// ThreadSanitizer.
namespace grinder {
namespace test_job_threads {

using test_support::FakeDrive;
using test_support::machineConfig;
using test_support::soon;

using E = MachineEvent;
using S = MachineState;

constexpr int kMaxGoals = 10000;  ///< until all kinds of ends have been seen
constexpr std::chrono::seconds kPatience(60);

actionlib_msgs::GoalID id(int number) {
  actionlib_msgs::GoalID id;
  id.id = std::to_string(number);
  return id;
}

class JobThreads : public ::testing::Test {
 protected:
  JobThreads() : planner_(machineConfig().machine, shippedShapes()) {
    test_support::setUp(drive_, machineConfig());
    drive_.on_read = [this](FakeDrive& drive) { drive.status.emergency_stop = emergency_stop_; };
    loop_ = std::make_unique<ControlLoop>(drive_, machineConfig());
    loop_->postSwivel(job_->process().setup_swivel);
  }

  template <typename Work>
  void spawn(unsigned seed, const Work& work) {
    threads_.emplace_back([this, seed, work] {
      std::mt19937 random(seed);
      while (busy_) work(random);
    });
  }

  /// As the goals' thread does.
  void runGoal(int number) {
    ASSERT_TRUE(soon([&] { return loop_->status().state == S::kReady && !loop_->status().wheel.in_work; }));
    const LoopStatus before = loop_->status();
    auto control = std::make_shared<PlanControl>();
    ASSERT_TRUE(gate_.open(id(number), [control] { control->give_up = true; }));
    newest_ = number;
    std::promise<std::shared_ptr<const PlannedJob>> promise;
    auto answer = promise.get_future();
    Planner::Request request{job_};
    request.run.at = Eigen::Map<const Axes>(before.command.data());
    request.control = control;
    request.done = [&](std::shared_ptr<const PlannedJob> plan) { promise.set_value(std::move(plan)); };
    ASSERT_TRUE(planner_.submit(std::move(request)));
    ASSERT_EQ(answer.wait_for(kPatience), std::future_status::ready);
    const std::shared_ptr<const PlannedJob> plan = answer.get();
    start(number, *plan, before.jobs_started);
    gate_.close();
  }

  void start(int number, const PlannedJob& plan, std::uint64_t jobs_before) {
    if (!plan.good()) {
      EXPECT_TRUE(gate_.canceled());
      return;
    }
    SetpointStream stream(plan.program);
    const bool started = gate_.start([&](bool held) {
      ASSERT_TRUE(loop_->startJob({&stream, wheelOf(stream.program())}));
      if (held) loop_->postStop(E::kHold);
    });
    if (!started) {
      ++given_up_;
      EXPECT_TRUE(gate_.canceled());
      EXPECT_EQ(loop_->status().jobs_started, jobs_before);
      return;
    }
    std::optional<RequestReply> reply;
    ASSERT_TRUE(soon([&] { return (reply = loop_->startJobReply()).has_value(); }));
    if (!reply->accepted) return;
    ASSERT_TRUE(soon([&] { return loop_->status().jobs_ended == jobs_before + 1; }));
    const JobEnd end = loop_->status().end;
    EXPECT_FALSE(canceled_amid_ == number && end == JobEnd::kDone);
    ++ended_[static_cast<std::size_t>(end)];
  }

  int ended(JobEnd how) const { return ended_[static_cast<std::size_t>(how)]; }
  bool seenAll() const { return given_up_ > 0 && ended(JobEnd::kCanceled) > 0 && ended(JobEnd::kFault) > 0; }

  /// As the stops' thread does.
  void cancel() {
    const int number = newest_;
    if (!gate_.cancel(id(number))) return;
    loop_->postStop(E::kCancel);
    // A job that is still in its first moves cannot come to its end any more.
    const LoopStatus status = loop_->status();
    if (status.jobs_started > status.jobs_ended && status.place.move_index < 3) canceled_amid_ = number;
  }

  const ValidJob job_{readJobFile("test/jobs/paper.yaml")};
  FakeDrive drive_;
  std::atomic<bool> emergency_stop_{false};
  std::unique_ptr<ControlLoop> loop_;
  JobGate gate_;
  Planner planner_;
  std::atomic<bool> busy_{true}, cycling_{true};
  std::vector<std::thread> threads_;
  std::atomic<int> newest_{-1}, canceled_amid_{-1};
  int given_up_ = 0;
  std::array<int, 4> ended_{};  ///< by JobEnd
};

TEST_F(JobThreads, NoStopMissesItsJob) {
  std::thread cycles([this] {
    const ros::Duration period(0.001);
    ros::Time time(1000);
    while (cycling_) loop_->cycle(time += period, period);
  });
  spawn(2, [this](std::mt19937&) {
    for (const E event : {E::kReset, E::kEnable, E::kLift, E::kResume}) loop_->request(event);
  });
  spawn(3, [this](std::mt19937& random) {
    // About as long as planning takes, with ThreadSanitizer.
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 100000));
    if (random() % 3 == 0) return cancel();
    if (!gate_.hold()) loop_->postStop(E::kHold);
  });
  spawn(4, [this](std::mt19937& random) {
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 4000));
    emergency_stop_ = random() % 4 == 0;
  });
  const int goals = test_support::randomCases(300);
  for (int number = 0; (number < goals || !seenAll()) && number < kMaxGoals && !HasFatalFailure(); ++number) {
    runGoal(number);
  }
  busy_ = false;
  for (std::thread& thread : threads_) thread.join();
  cycling_ = false;
  cycles.join();
  EXPECT_TRUE(seenAll()) << given_up_ << ' ' << ended(JobEnd::kCanceled) << ' ' << ended(JobEnd::kFault);
}

}  // namespace test_job_threads
}  // namespace grinder
