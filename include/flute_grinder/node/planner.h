#pragma once

#include "flute_grinder/core/job_plan.h"
#include "flute_grinder/scene/path_markers.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace flute_grinder {

/// A plan with all that its job needs to be run and to be shown.
struct Preview {
  JobPlan plan;
  ToothPass first;                         ///< to grind
  std::optional<PathErrorMarkers> errors;  ///< of its first stroke; of a job whose figures are allowed
  std::unique_ptr<SetpointStream> stream;  ///< of a good plan
};

/// What somebody who waits for a plan and the planner tell each other. Thread safe.
struct PlanControl {
  std::atomic<bool> give_up{false};  ///< set where the plan is wanted no more
  std::atomic<double> done{0};       ///< part of the job that is generated and checked, 0..1
};

/// Plans one job at a time, in a thread of its own, so that nobody waits for it who has not asked.
class Planner {
 public:
  struct Order {
    GrindJob job;
    Axes start = Axes::Zero();  ///< where the axes stand [m], A [rad]
    ToothPass first;            ///< to grind
    std::shared_ptr<PlanControl> control;
    std::function<void(std::unique_ptr<Preview>)> done;  ///< called once, in the planner's thread; must not wait
  };

  explicit Planner(const Machine& machine);
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;
  ~Planner() { end(); }

  /// Gives up what is being planned; its `done` is called. From then on nothing is taken any more.
  void end();

  /// @return false, with nothing done, while another job is being planned.
  bool submit(Order order);

 private:
  void run();
  std::optional<Order> next();
  std::unique_ptr<Preview> plan(const Order& order) const;

  const Machine machine_;
  std::mutex mutex_;  ///< guards the next three
  std::condition_variable changed_;
  std::optional<Order> order_;  ///< until it is carried out
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace flute_grinder
