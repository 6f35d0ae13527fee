#pragma once

#include "flute_grinder/check/planned_job.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace grinder {

/// State shared by the planner and the thread that waits for the plan. Thread safe.
struct PlanControl {
  std::atomic<bool> give_up{false};  ///< set to abandon the plan
  std::atomic<double> done{0};       ///< fraction of the job generated and checked, 0..1
};

/// Plans one job at a time in its own thread. Keeps the last good plan, and reuses it for the same job from the same
/// place, as after a dry run or for the next tool.
class Planner {
 public:
  struct Request {
    ValidJob job;
    RunStart run{};
    std::shared_ptr<PlanControl> control{};
    bool measures_passes = false;  ///< see measurePasses()
    /// Called once, in the planner's thread; must not block.
    std::function<void(std::shared_ptr<const PlannedJob>)> done{};
  };

  Planner(const Machine& machine, const MachineShapes& shapes);
  ~Planner() { end(); }

  /// Abandons the current plan; its `done` is called. Later requests are refused.
  void end();

  /// @return false, and does nothing, while another job is being planned.
  bool submit(Request request);

 private:
  void run();
  std::optional<Request> next();
  std::shared_ptr<const PlannedJob> plan(const Request& request);
  bool isKept(const Request& request) const;
  PlannedJob makePlan(const Request& request) const;  ///< from the kept plan, if it is this job's

  const Machine machine_;
  const MachineShapes shapes_;
  std::mutex mutex_;  ///< guards the next three members
  std::condition_variable changed_;
  std::optional<Request> request_;  ///< present until it is done
  bool ended_ = false;

  std::shared_ptr<const PlannedJob> kept_;  ///< the last good plan; used by the thread only
  std::thread thread_;
};

}  // namespace grinder
