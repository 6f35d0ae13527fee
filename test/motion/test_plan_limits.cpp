#include "curve/reference.h"
#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace grinder {
namespace test_plan_limits {

using namespace test_support;

/// What a plan should object to: setpoints beyond the upper limit of an axis, counted by moves.
struct Beyond {
  std::uint64_t count = 0;
  double worst = 0;
};

std::map<MoveKind, Beyond> beyondUpperLimit(const std::vector<Setpoint>& setpoints, int axis, double limit) {
  std::map<MoveKind, Beyond> moves;
  for (const Setpoint& p : setpoints) {
    if (p.position[axis] <= limit) continue;
    Beyond& beyond = moves[p.move];
    ++beyond.count;
    beyond.worst = std::max(beyond.worst, p.position[axis]);
  }
  return moves;
}

/// Whether a plan has one reason for each kind of move that is beyond the upper limit of an axis, with its worst and
/// the count, and no other for that axis.
void expectReasons(const JobPlan& plan, const std::vector<Setpoint>& setpoints, int axis, double limit) {
  const auto moves = beyondUpperLimit(setpoints, axis, limit);
  const std::string name = axisName(axis);
  const double scale = axis == kA ? units::kDegree : units::kMillimetre;
  const char* const unit = axis == kA ? " deg" : " mm";
  EXPECT_EQ(reasonsWith(plan, name).size(), moves.size()) << textOf(plan);
  for (const auto& [kind, beyond] : moves) {
    const auto reasons = reasonsWith(plan, std::string("(") + toString(kind) + ", tooth ");
    std::string reason;
    for (const std::string& r : reasons) reason = contains(r, name) ? r : reason;
    std::ostringstream worst;
    worst << name << " position " << beyond.worst / scale << unit << " is ";
    EXPECT_TRUE(contains(reason, worst.str())) << worst.str() << " in\n" << textOf(plan);
    std::ostringstream beyond_limit;
    beyond_limit << "beyond its limit " << limit / scale << unit;
    EXPECT_TRUE(contains(reason, beyond_limit.str())) << reason;
    const std::string others = "; the worst of " + std::to_string(beyond.count) + " setpoints";
    if (beyond.count > 1) {
      EXPECT_TRUE(contains(reason, others)) << others << " in\n" << reason;
    } else {
      EXPECT_FALSE(contains(reason, "worst of")) << reason;
    }
  }
}

TEST(JobPlan, RefusesAWayBeyondAnAxisLimitWithTheAmount) {
  Machine machine = plainMachine();
  machine.limits.max_position[kX] = 0.030;  // the stroke goes to 31 mm
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(ValidJob(paperJob()), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  ASSERT_EQ(plan.reasons.size(), 3u) << textOf(plan);  // stroke, and retract and return from its end
  EXPECT_EQ(textOf(plan).find("axis X position 31 mm is 1 mm beyond its limit 30 mm (stroke, tooth 1, pass 1, X = "),
            0u)
      << textOf(plan);
  expectReasons(plan, visited, kX, 0.030);
  // It goes through to the end.
  EXPECT_TRUE((visited.back().position == machine.park).all());
  EXPECT_EQ(plan.statistics.setpoints, visited.size());
}

TEST(JobPlan, ReportsEveryAxisThatIsBeyondItsLimits) {
  Machine machine = plainMachine();
  machine.limits.max_position << 0.030, 0.04, 0.2, 2;
  machine.limits.min_position[kZ] = -1e-5;  // the stroke begins at -12 um
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(ValidJob(paperJob()), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  expectReasons(plan, visited, kX, 0.030);
  expectReasons(plan, visited, kY, 0.04);
  expectReasons(plan, visited, kA, 2);
  std::set<MoveKind> low;
  for (const Setpoint& p : visited) {
    if (p.position[kZ] < -1e-5) low.insert(p.move);
  }
  EXPECT_EQ(low.size(), reasonsWith(plan, "axis Z").size()) << textOf(plan);
  EXPECT_FALSE(low.empty());
}

TEST(JobPlan, ReportsASingleSetpointWithoutACount) {
  std::vector<double> xs;
  const auto see = [&](const Setpoint& p) {
    if (p.move == MoveKind::kStroke) xs.push_back(p.position[kX]);
  };
  Machine machine = plainMachine();
  planJob(ValidJob(paperJob()), machine, machine.park, see);
  const double last = *std::max_element(xs.begin(), xs.end());
  xs.erase(std::remove(xs.begin(), xs.end(), last), xs.end());
  machine.limits.max_position[kX] = (last + *std::max_element(xs.begin(), xs.end())) / 2;
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(ValidJob(paperJob()), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  ASSERT_EQ(beyondUpperLimit(visited, kX, machine.limits.max_position[kX])[MoveKind::kStroke].count, 1u);
  const auto reasons = reasonsWith(plan, "(stroke, ");
  ASSERT_EQ(reasons.size(), 1u) << textOf(plan);
  EXPECT_FALSE(contains(reasons[0], "worst of")) << reasons[0];
}

TEST(JobPlan, ReportsAllLimitsOfManyTeethInOneTextEach) {
  Machine machine = plainMachine();
  machine.limits.max_position[kX] = 0.030;
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1, 2};
  job.process.spark_out = 1;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(ValidJob(job), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.reasons.size(), 5u) << textOf(plan);  // now index and position leave from beyond the limit too
  expectReasons(plan, visited, kX, 0.030);
}

TEST(JobPlan, RefusesAStartBeyondALimit) {
  const Machine machine = plainMachine();
  Axes start = machine.park;
  start[kX] = -0.5;
  const JobPlan plan = planJob(ValidJob(paperJob()), machine, start);
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  EXPECT_TRUE(contains(textOf(plan), "axis X position -500 mm")) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan), "limit -300 mm")) << textOf(plan);
}

TEST(JobPlan, ReportsToleranceAndLimitsTogether) {
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  Machine machine = strongMachine();
  machine.limits.max_position[kX] = 0.015;
  std::uint64_t off = 0;
  std::vector<Setpoint> visited;
  const Real normal =
      std::cos(std::atan(std::tan(Real(job.cutter.spiral_angle)) * std::cos(Real(job.cutter.cone_angle))));
  const ReferenceCurve curve(job.cutter);
  const JobPlan plan = planJob(ValidJob(job), machine, machine.park, [&](const Setpoint& p) {
    visited.push_back(p);
    if (p.step == StepKind::kNone) return;
    const Real x = p.position[kX];
    const Real radius = Real(job.cutter.end_diameter) / 2 + x * std::tan(Real(job.cutter.cone_angle));
    if (std::abs(curve.a(x) - Real(p.position[kA])) * radius * normal > 0.2e-6L) ++off;
  });
  EXPECT_FALSE(plan.good());
  expectReasons(plan, visited, kX, 0.015);
  const auto tolerance = reasonsWith(plan, "interpolation.tolerance");
  ASSERT_EQ(tolerance.size(), 1u) << textOf(plan);
  ASSERT_GT(off, 1u);
  EXPECT_TRUE(contains(tolerance[0], "; the worst of " + std::to_string(off) + " setpoints")) << tolerance[0];
  std::ostringstream worst;
  worst << "deviates by " << plan.statistics.max_deviation / units::kMicrometre << " um";
  EXPECT_TRUE(contains(tolerance[0], worst.str())) << tolerance[0];
  EXPECT_EQ(plan.reasons.size(), 1 + reasonsWith(plan, "axis X").size());
}

}  // namespace test_plan_limits
}  // namespace grinder
