#pragma once

#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/motion/limit_check.h"

#include <array>
#include <cstdint>
#include <vector>

namespace grinder {

/// Checks the setpoints of a plan, and writes the results into the plan: statistics, ends of moves, fault and reasons.
class PlanChecks {
 public:
  /// @param plan plan with a program; must outlive this object.
  explicit PlanChecks(JobPlan& plan);

  /// Checks the next setpoint.
  /// @return false if it is not finite, so that no further setpoint can be checked.
  bool add(const Setpoint& setpoint);

  /// Counts the next setpoint without checking it; the following setpoints are compared with it.
  void recall(const Setpoint& setpoint);

  /// Counts some cycles of a move without their setpoints. The next setpoints must be recalled.
  void skip(MoveKind move, std::uint64_t cycles);

  /// Writes the results that are known only at the end.
  void finish();

 private:
  /// The worst violation of its kind, and the number of setpoints with one.
  struct Excess {
    LimitViolation worst;
    std::uint64_t count;
  };

  void count(const Setpoint& setpoint);
  void measure(const Setpoint& setpoint);
  /// Adds a feed at which a stroke runs steadily.
  void addFeed(double feed);
  void measureStroke(const Setpoint& setpoint);
  void checkRoom(LimitViolation place, double room);
  void checkBend(const Setpoint& setpoint);
  void checkStrokeEnd(const Move& stroke, std::uint64_t cycle);
  void addViolation(const LimitViolation& violation);
  void addDeviation(const Setpoint& setpoint, double deviation);

  JobPlan& plan_;
  const GrindProgram& program_;
  PathStatistics& statistics_;
  const double period_;
  const double deviation_factor_;
  LimitCheck check_;
  std::array<std::uint64_t, kMoveKindCount> cycles_{};
  Axes last_velocity_ = Axes::Zero();
  Axes max_change_ = Axes::Zero();  ///< maximum change of the velocity from one cycle to the next
  double end_x_ = 0;                ///< X of the last pair's end
  std::vector<Excess> excesses_;
  Reason deviation_;  ///< the largest deviation above the tolerance, if there is one
};

}  // namespace grinder
