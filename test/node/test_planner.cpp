#include "node/planner.h"

#include "check/machine.h"
#include "control/fixtures.h"
#include "flute_grinder/job/job_file.h"
#include "soon.h"

#include <gtest/gtest.h>

#include <functional>
#include <future>

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
ValidJob endless() {
  GrindJob job = paper();
  job.process().depth_end = 0.99 * job.process().depth;
  job.process().feed = kMinFeed;
  job.process().infeed = job.process().depth / 200;
  return ValidJob(job);
}

ValidJob changed(const std::function<void(GrindProcess&)>& change) {
  GrindJob job = paper();
  change(job.process());
  return ValidJob(job);
}

/// A request with its outcome.
struct Asked {
  explicit Asked(const ValidJob& job) : request{job} {
    request.run.at = machine().park;
    request.control = std::make_shared<PlanControl>();
    request.done = [this](std::shared_ptr<const PlannedJob> plan) { promise.set_value(std::move(plan)); };
  }
  std::shared_ptr<const PlannedJob> wait() {
    if (answer.wait_for(kPatience) != std::future_status::ready) throw std::runtime_error("no plan");
    return answer.get();
  }
  bool isDone() const { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

  Planner::Request request;
  std::promise<std::shared_ptr<const PlannedJob>> promise;
  std::future<std::shared_ptr<const PlannedJob>> answer = promise.get_future();
};

class PlannerTest : public testing::Test {
 protected:
  std::shared_ptr<const PlannedJob> plan(const ValidJob& job,
                                         const std::function<void(Planner::Request&)>& change = {}) {
    Asked asked(job);
    if (change) change(asked.request);
    EXPECT_TRUE(planner_.submit(asked.request));
    return asked.wait();
  }

  const ValidJob paper_{paper()};
  Planner planner_{machine(), kShapes};
};

TEST_F(PlannerTest, KeepsThePlanOfPlanJobForTheSameJobFromTheSamePlace) {
  const auto kept = plan(paper_);
  ASSERT_TRUE(kept->good());
  const JobPlan expected = planJob(paper_, machine(), machine().park);
  EXPECT_EQ(kept->statistics.setpoints, expected.statistics.setpoints);
  EXPECT_EQ(kept->move_ends, expected.move_ends);
  const auto programOf = [&](const ValidJob& job, const std::function<void(Planner::Request&)>& change = {}) {
    const auto planned = plan(job, change);
    EXPECT_TRUE(planned->good());
    return planned->program;
  };
  EXPECT_EQ(programOf(paper_), kept->program);
  const ValidJob slower = changed([](GrindProcess&p) { p.feed *= 0.9; }),
                 two_passes = changed([](GrindProcess&p) { p.spark_out = 1; });
  for (const ValidJob& other : {slower, two_passes}) EXPECT_NE(programOf(other), programOf(paper_));
  const std::function<void(Planner::Request&)> changes[]{
      [](Planner::Request& r) { r.run.at[kX] += 1e-9; },
      [](Planner::Request& r) { r.run.offset[kA] += 1e-9; },
      [](Planner::Request& r) {
        r.run.first = {0, 1};
      },
  };
  for (const auto& change : changes) EXPECT_NE(programOf(two_passes, change), programOf(two_passes));
}

// The last relief must leave no heel, which is why the reamer has a secondary one.
TEST_F(PlannerTest, KeepsNoPlanOfAReliefThatIsNowTheLast) {
  GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", "primary");
  const auto planned = plan(ValidJob(job));
  ASSERT_TRUE(planned->good()) << text(planned->reasons);
  EXPECT_EQ(plan(ValidJob(job)), planned);
  job.operations.pop_back();
  EXPECT_EQ(plan(ValidJob(job))->fault, PlanFault::kTool);
}

TEST_F(PlannerTest, MeasuresThePassesOnceWhereAskedAlsoOfAKeptPlan) {
  const auto measured = [](Planner::Request& request) { request.measures_passes = true; };
  const auto kept = plan(paper_);
  ASSERT_TRUE(kept->good());
  EXPECT_FALSE(kept->passes);
  const auto with_passes = plan(paper_, measured);
  EXPECT_EQ(with_passes->program, kept->program);
  ASSERT_EQ(with_passes->passes.value().size(), paper_.depths().size());
  EXPECT_EQ(plan(paper_, measured), with_passes);
  EXPECT_EQ(plan(paper_), with_passes);
}

TEST_F(PlannerTest, OneJobAtATimeWhichReportsItsProgressAndCanBeGivenUpAsItIsAtTheEnd) {
  Asked first(endless()), second(paper_), third(paper_), last(endless());
  ASSERT_TRUE(planner_.submit(first.request));
  EXPECT_TRUE(test_support::soon([&] { return first.request.control->done > 0; }));
  EXPECT_FALSE(planner_.submit(second.request));
  EXPECT_FALSE(first.isDone());
  first.request.control->give_up = true;
  EXPECT_EQ(first.wait()->fault, PlanFault::kGivenUp);
  ASSERT_TRUE(planner_.submit(third.request)) << "who has the answer may ask for the next";
  EXPECT_TRUE(third.wait()->good());
  ASSERT_TRUE(planner_.submit(last.request));
  planner_.end();
  ASSERT_TRUE(last.isDone());
  EXPECT_FALSE(last.wait()->good());
  EXPECT_FALSE(planner_.submit(second.request));
  EXPECT_FALSE(second.isDone());
}

}  // namespace test_planner
}  // namespace grinder
