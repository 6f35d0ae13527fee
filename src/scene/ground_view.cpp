#include "flute_grinder/scene/ground_view.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace grinder {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNice = 15;
constexpr std::chrono::duration<double> kMinPause{1};
constexpr double kPausePerWork = 20;

visualization_msgs::MarkerArray markersOf(const ValidJob& job, const std::optional<Reached>& reached) {
  const Reached end{job.passes().back().place, PassPhase::kAfter, 0};
  return groundMarkers(groundSoFar(job, reached.value_or(end)), job, reached ? "ground" : "planned", reached);
}

}  // namespace

GroundView::GroundView(ros::NodeHandle private_nh)
    : publisher_(private_nh.advertise<visualization_msgs::MarkerArray>("ground_cutter", 1, true)),
      thread_([this] { run(); }) {
  // Remove what an earlier process left in rviz.
  publisher_.publish(clearedArray());
}

GroundView::~GroundView() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void GroundView::show(const std::optional<ValidJob>& job, const std::optional<Reached>& reached) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    request_ = Request{job, reached};
  }
  changed_.notify_one();
}

std::optional<GroundView::Request> GroundView::next(Clock::time_point earliest) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_until(lock, earliest, [this] { return ended_ || (request_ && !request_->reached); });
  changed_.wait(lock, [this] { return ended_ || request_; });
  // A request to clear is carried out even at the end.
  const bool clears = request_ && !request_->job;
  if (ended_ && !clears) return std::nullopt;
  return std::exchange(request_, std::nullopt);
}

void GroundView::run() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
  Clock::time_point earliest = Clock::now();
  while (const std::optional<Request> request = next(earliest)) {
    const Clock::time_point begin = Clock::now();
    publisher_.publish(request->job ? markersOf(*request->job, request->reached) : clearedArray());
    // All cores compute: each rests for as many times as long.
    const std::chrono::duration<double> took = Clock::now() - begin;
    const auto pause = std::max(kMinPause, kPausePerWork * took);
    earliest = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
  }
}

}  // namespace grinder
