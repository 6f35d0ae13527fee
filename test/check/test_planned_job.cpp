#include "flute_grinder/base/units.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"

#include "check/machine.h"
#include "motion/examples.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_planned_job {

using units::kDegree;

Machine machine() {
  Machine m = test_support::plainMachine();
  m.collision_clearance = 1e-3;
  return m;
}

PlannedJob planned(const GrindJob& job, const Machine& on = machine(), const PlanWatch& watch = {}) {
  return planWholeJob(ValidJob(job), on, shippedShapes(), on.park, {}, watch);
}

GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

GrindJob withConstantRake() {
  GrindJob job = paper();
  job.process().z_law = ZLaw::kConstantRake;
  return job;
}

TEST(PlannedJob, HasWhatItsPartsFind) {
  const GrindJob job = withConstantRake();
  const PlannedJob whole = planned(job);
  ASSERT_TRUE(whole.good()) << text(whole.reasons);
  EXPECT_EQ(whole.program->job().digest(), jobDigest(job));
  const ValidJob with_law = withLaws(ValidJob(job));
  EXPECT_EQ(whole.program->job().zCorrectionOf(0).coefficients, with_law.zCorrectionOf(0).coefficients);
  EXPECT_EQ(whole.move_ends, planJob(with_law, machine(), machine().park).move_ends);
  EXPECT_EQ(whole.complete->to, job.cutter.flute_length);
  const CutterFigures figures = checkGroundCutter(with_law).figures;
  EXPECT_EQ(find(whole.figures, ToolFigure::kRake)->largest.value, find(figures, ToolFigure::kRake)->largest.value);
  const auto closest = checkCollision(*whole.program, shippedShapes()).closest;
  EXPECT_EQ(whole.closest->distance, closest->distance);
  EXPECT_EQ(whole.closest->leg, closest->leg);
}

TEST(PlannedJob, OfEveryOperationOfEveryShippedFileIsGood) {
  int count = 0;
  for (const std::string& entry : test_support::shippedJobs()) {
    const GrindJob job = readJobFile(entry, "flute");
    for (int i = 0; i < static_cast<int>(job.operations.size()); ++i, ++count) {
      const PlannedJob whole = planned(job.ofOperation(i));
      EXPECT_TRUE(whole.good()) << entry << ", operation " << i + 1 << text(whole.reasons);
    }
  }
  EXPECT_GE(count, 40);
}

TEST(PlannedJob, WithoutALawOfZThereIsNoProgram) {
  GrindJob job = withConstantRake();
  job.process().setup_swivel += 25 * kDegree;
  const PlannedJob whole = planned(job);
  EXPECT_EQ(whole.fault, PlanFault::kTool);
  EXPECT_EQ(whole.program, nullptr);
  ASSERT_EQ(whole.reasons.size(), 1u);
  EXPECT_EQ(whole.reasons[0].kind, ReasonKind::kUnevenRake);
  EXPECT_TRUE(whole.figures.empty());
}

TEST(PlannedJob, IsGivenUpByItsWatch) {
  for (const GrindJob& job : {paper(), withConstantRake()}) {
    const PlannedJob whole = planned(job, machine(), [](double) { return false; });
    EXPECT_EQ(whole.fault, PlanFault::kGivenUp);
    EXPECT_EQ(whole.reasons.size(), 1u);
    EXPECT_FALSE(whole.complete || whole.closest);
  }
}

/// The passes of an earlier relief are computed once more for the check of the cutter.
TEST(PlannedJob, IsGivenUpAfterItsPlanToo) {
  GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", "secondary");
  GrindProcess& primary = job.operations[1];
  primary.infeed = 0;
  primary.roughing_passes = 2;
  primary.wheel_wear_per_pass = 1e-7;
  double planned_up_to = 0;
  int after = 0;
  const auto watch = [&](double done) {
    EXPECT_GE(done, planned_up_to);
    planned_up_to = done;
    if (done == 1) ++after;
    return after < 10;
  };
  const PlannedJob whole = planned(job, test_support::roomyMachine(), watch);
  EXPECT_EQ(after, 10);
  EXPECT_EQ(whole.fault, PlanFault::kGivenUp) << text(whole.reasons);
  EXPECT_FALSE(whole.closest);
}

TEST(PlannedJob, HasWhatItsPassesRemoveIfThatIsAskedAndItIsGood) {
  PlannedJob whole = planned(paper());
  EXPECT_FALSE(whole.passes);
  measurePasses(whole);
  ASSERT_TRUE(whole.good());
  const std::vector<PassRemoval> passes = removalOfPasses(whole.program->job());
  ASSERT_EQ(whole.passes.value().size(), passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) {
    EXPECT_EQ((*whole.passes)[i].depth, whole.program->job().depths()[i]);
    EXPECT_EQ((*whole.passes)[i].area, passes[i].area);
  }

  PlannedJob given_up = planned(paper());
  measurePasses(given_up, [](double) { return false; });
  EXPECT_EQ(given_up.fault, PlanFault::kGivenUp);
  EXPECT_FALSE(given_up.passes);

  GrindJob job = paper();
  job.cutter.rake_angle = 20 * kDegree;
  PlannedJob refused = planned(job);
  measurePasses(refused);
  EXPECT_EQ(refused.fault, PlanFault::kTool);
  EXPECT_FALSE(refused.passes);
}

TEST(PlannedJob, TheFirstFaultCountsAndAllReasonsAreThere) {
  GrindJob job = paper();
  job.cutter.rake_angle = 20 * kDegree;  // which the set-up does not grind
  job.process().wheel_diameter = 0.5;
  job.cutter.flute_length = 0.16;  // the wheel reaches the chuck
  const PlannedJob whole = planned(job);
  EXPECT_EQ(whole.fault, PlanFault::kTool) << text(whole.reasons);
  ASSERT_GE(whole.reasons.size(), 2u);
  EXPECT_EQ(whole.reasons.front().kind, ReasonKind::kRake);
  EXPECT_EQ(whole.reasons.back().kind, ReasonKind::kCollision);
}

}  // namespace test_planned_job
}  // namespace grinder
