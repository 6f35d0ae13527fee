#include "flute_grinder/job/job_file.h"
#include "node/planner.h"

#include "check/machine.h"
#include "control/fixtures.h"
#include "flute_grinder/job/grind_job.h"
#include "soon.h"

#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <vector>

namespace grinder {
namespace test_planner {

constexpr std::chrono::seconds kPatience(60);

/// On which a job may take months.
Machine machine() {
  Machine m = test_support::machineConfig().machine;
  m.max_job_duration = 1e7;
  return m;
}

const MachineShapes kShapes = shippedShapes();

GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

/// Takes hours to plan: with a depth that changes along the flute, no pass is like another.
GrindJob endless() {
  GrindJob job = paper();
  job.process().depth_end = 0.99 * job.process().depth;
  job.process().feed = kMinFeed;
  job.process().infeed = job.process().depth / 200;
  return job;
}

ValidJob changed(const std::function<void(GrindProcess&)>& change) {
  GrindJob job = paper();
  change(job.process());
  return ValidJob(job);
}

/// A request with its outcome.
struct Asked {
  explicit Asked(const GrindJob& job) : request{ValidJob(job)} {
    request.run.at = machine().park;
    request.control = std::make_shared<PlanControl>();
    request.done = [this](std::shared_ptr<const PlannedJob> plan) { promise.set_value(std::move(plan)); };
  }
  std::shared_ptr<const PlannedJob> wait() {
    if (answer.wait_for(kPatience) != std::future_status::ready) throw std::runtime_error("no plan");
    return answer.get();
  }
  /// Waits until it is being planned.
  void waitForProgress() const {
    EXPECT_TRUE(test_support::soon([&] { return request.control->done > 0; }));
  }
  bool isDone() const { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

  Planner::Request request;
  std::promise<std::shared_ptr<const PlannedJob>> promise;
  std::future<std::shared_ptr<const PlannedJob>> answer = promise.get_future();
};

TEST(Planner, PlansWhatPlanJobPlans) {
  Planner planner(machine(), kShapes);
  Asked asked(paper());
  ASSERT_TRUE(planner.submit(asked.request));
  const auto plan = asked.wait();
  ASSERT_TRUE(plan->good());
  const JobPlan expected = planJob(ValidJob(paper()), machine(), machine().park);
  EXPECT_EQ(plan->statistics.setpoints, expected.statistics.setpoints);
  EXPECT_EQ(plan->move_ends, expected.move_ends);
}

TEST(Planner, KeepsAPlanForTheSameJobFromTheSamePlace) {
  Planner planner(machine(), kShapes);
  const auto programOf = [&](const std::function<void(Planner::Request&)>& change) {
    Asked asked(paper());
    change(asked.request);
    EXPECT_TRUE(planner.submit(asked.request));
    const auto plan = asked.wait();
    EXPECT_TRUE(plan->good());
    return plan->program;
  };
  const auto unchanged = [](Planner::Request&) {};
  const auto program = programOf(unchanged);
  EXPECT_EQ(programOf(unchanged), program);
  const std::vector<std::function<void(Planner::Request&)>> changes{
      [](Planner::Request& r) { r.job = changed([](GrindProcess& p) { p.feed *= 0.9; }); },
      [](Planner::Request& r) { r.job = changed([](GrindProcess& p) { p.spark_out = 1; }); },
      [](Planner::Request& r) { r.run.at[kX] += 1e-9; },
      [](Planner::Request& r) { r.run.offset[kA] += 1e-9; },
  };
  for (const auto& change : changes) EXPECT_NE(programOf(change), programOf(unchanged));
  const ValidJob two_passes = changed([](GrindProcess& p) { p.spark_out = 1; });
  const auto withFirstPass = [&](int pass) {
    return programOf([&](Planner::Request& r) {
      r.job = two_passes;
      r.run.first = {0, pass};
    });
  };
  EXPECT_NE(withFirstPass(1), withFirstPass(0));
}

// The last relief must leave no heel, which is why the reamer has a secondary one.
TEST(Planner, KeepsNoPlanOfAReliefThatIsNowTheLast) {
  Planner planner(machine(), kShapes);
  const auto planOf = [&](const GrindJob& job) {
    Asked asked(job);
    EXPECT_TRUE(planner.submit(asked.request));
    return asked.wait();
  };
  GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", "primary");
  const auto plan = planOf(job);
  ASSERT_TRUE(plan->good()) << text(plan->reasons);
  job.operations[2].feed *= 0.9;
  EXPECT_EQ(planOf(job), plan);
  job.operations.pop_back();
  EXPECT_EQ(planOf(job)->fault, PlanFault::kTool);
}

TEST(Planner, OneJobAtATimeWhichReportsItsProgressAndCanBeGivenUp) {
  Planner planner(machine(), kShapes);
  Asked first(endless()), second(paper()), third(paper());
  ASSERT_TRUE(planner.submit(first.request));
  first.waitForProgress();
  EXPECT_FALSE(planner.submit(second.request));
  EXPECT_FALSE(first.isDone());
  first.request.control->give_up = true;
  EXPECT_EQ(first.wait()->fault, PlanFault::kGivenUp);
  ASSERT_TRUE(planner.submit(third.request)) << "who has the answer may ask for the next";
  EXPECT_TRUE(third.wait()->good());
  EXPECT_FALSE(second.isDone());
}

TEST(Planner, ItsEndGivesUpAndAnswers) {
  Planner planner(machine(), kShapes);
  Asked plan(endless()), late(paper());
  ASSERT_TRUE(planner.submit(plan.request));
  planner.end();
  ASSERT_TRUE(plan.isDone());
  EXPECT_FALSE(plan.wait()->good());
  EXPECT_FALSE(planner.submit(late.request));
}

}  // namespace test_planner
}  // namespace grinder
