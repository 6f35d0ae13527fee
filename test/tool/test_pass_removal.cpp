// What passes remove: a straight slot in closed form, and whole tools beside the volume that a simulation measures.

#include "flute_grinder/tool/pass_removal.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_tool.h"
#include "flute_grinder/tool/z_law.h"

#include "jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

namespace grinder {
namespace test_pass_removal {

using test_support::jobOf;
using units::kMillimetre;

constexpr double kWidth = 3 * kMillimetre, kRadius = 6 * kMillimetre;

/// Straight slots of a straight wheel in a cylinder.
/// @param from least Z of the slot [m].
GrindJob slots(double from) {
  GrindJob job = jobOf("roughing_d10_t4");
  job.cutter.end_diameter = job.cutter.shank_diameter = 2 * kRadius;
  job.cutter.core_diameter = job.cutter.core_diameter_end = 5 * kMillimetre;
  job.cutter.spiral_angle = job.cutter.rake_angle = 0;
  GrindProcess& p = job.process();
  p.depth = 2.5 * kMillimetre;
  p.infeed = 0.5 * kMillimetre;
  p.wheel_width = kWidth;
  p.wheel_corner_radius_lower = p.wheel_corner_radius_upper = 0;
  p.setup_swivel = 0;
  p.setup_height = from + kWidth / 2;
  p.overtravel_end = p.overtravel_shank = 30 * kMillimetre;
  return job;
}

/// The area of such a slot: of the circle's segment above its floor, between its walls.
double slotArea(double from, double depth) {
  const double floor = kRadius - depth, half = std::sqrt(kRadius * kRadius - floor * floor);
  const auto under_circle = [](double z) {
    return (z * std::sqrt(kRadius * kRadius - z * z) + kRadius * kRadius * std::asin(z / kRadius)) / 2;
  };
  const double low = std::clamp(from, -half, half), high = std::clamp(from + kWidth, -half, half);
  return under_circle(high) - under_circle(low) - floor * (high - low);
}

TEST(PassRemoval, OfAStraightSlotIsThatOfTheCirclesSegment) {
  for (const double from : {-1.5 * kMillimetre, -4.5 * kMillimetre, -6 * kMillimetre}) {
    SCOPED_TRACE(from);
    const ValidJob job(slots(from));
    const std::vector<PassRemoval> passes = removalOfPasses(job);
    ASSERT_EQ(passes.size(), job.depths().size());
    double last = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const double area = slotArea(from, job.depths()[i]);
      EXPECT_EQ(passes[i].depth, job.depths()[i]);
      EXPECT_NEAR(passes[i].area, area - last, 3e-4 * slotArea(from, job.deepest())) << i;
      EXPECT_NEAR(passes[i].rate, passes[i].area * job->process().feed, 1e-18) << i;
      EXPECT_NEAR(passes[i].volume, 4 * passes[i].area * job->cutter.flute_length, 1e-15) << i;
      last = area;
    }
    // A wheel beside the axis touches later.
    EXPECT_EQ(passes.front().area == 0, from < -5 * kMillimetre);
  }
}

TEST(PassRemoval, AddsUpToTheVolumeOfTheGroundTool) {
  for (const std::string name : {"taper_d6_t6", "end_mill_d10_t4"}) {
    double before = 0;
    GrindJob whole = readJobFile("jobs/" + name + ".yaml", "1");
    whole.tooth_angles.resize(1);
    for (const GrindJob& job : whole.ofAllOperations()) {
      if (isStraight(job.process().kind)) continue;
      SCOPED_TRACE(name + ", " + job.operationText());
      const ValidJob with_laws = withLaws(ValidJob(job));
      double sum = 0;
      for (const PassRemoval& pass : removalOfPasses(with_laws)) sum += pass.volume;
      const double after = measure(with_laws, name, groundCutterOf(with_laws), {}).volume_removed;
      EXPECT_NEAR(before + sum, after, 1e-3 * after);
      before = after;
    }
  }
}

// Along a helix the wheel goes slower along the axis than along the edge.
TEST(PassRemoval, HasTheRateOfTheSpeedAlongTheAxis) {
  const ValidJob job(jobOf("roughing_d10_t4"));
  const double slower = std::cos(job->cutter.spiral_angle);
  for (const PassRemoval& pass : removalOfPasses(job)) {
    EXPECT_NEAR(pass.rate, pass.area * job->process().feed * slower, 1e-6 * pass.rate);
  }
}

/// That job, its roughing passes by what they remove.
GrindJob byRemoval(GrindJob job, int roughing_passes, double removal) {
  job.process().infeed = 0;
  job.process().roughing_passes = roughing_passes;
  job.process().removal = removal;
  return job;
}

TEST(PassRemoval, IsTheSameForEachOfSomeRoughingPassesOfASlot) {
  for (const double from : {-4.5 * kMillimetre, -6 * kMillimetre}) {
    SCOPED_TRACE(from);
    const ValidJob job = withLaws(ValidJob(byRemoval(slots(from), 4, 0)));
    const double roughing = job.deepest() - job->process().finish_infeed, all = slotArea(from, roughing);
    ASSERT_EQ(job.depths().size(), 6u);
    EXPECT_EQ(job.depths()[3], roughing);
    EXPECT_EQ(job.depths()[4], job.deepest());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(slotArea(from, job.depths()[i]), static_cast<double>(i + 1) / 4 * all, 2e-3 * all) << i;
    }
    EXPECT_EQ(withLaws(ValidJob(*job)).depths(), job.depths());
  }
}

TEST(PassRemoval, NeedsAsManyRoughingPassesAsItsLimitTakes) {
  const double from = -4.5 * kMillimetre;
  const GrindJob slot = slots(from);
  const double roughing = slot.process().depth - slot.process().finish_infeed;
  const double all = slotArea(from, roughing) * slot.process().feed;
  for (const double parts : {2.9, 3.1}) {
    const ValidJob job = withLaws(ValidJob(byRemoval(slot, 0, all / parts)));
    EXPECT_EQ(job.depths().size(), std::ceil(parts) + 2) << parts;
    for (const PassRemoval& pass : removalOfPasses(job)) EXPECT_LT(pass.rate, 1.002 * all / parts);
  }
  try {
    withLaws(ValidJob(byRemoval(slot, 0, all / 201)));
    FAIL();
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("process.removal_mm3_s = "), std::string::npos);
    EXPECT_NE(std::string(refusal.what()).find("mm^3/s; allowed: enough for 200 roughing passes"), std::string::npos);
  }
}

TEST(PassRemoval, IsTheSameForEachRoughingPassOfAnyTool) {
  GrindJob reamer = readJobFile("jobs/taper_reamer_d6_t6.yaml", "1");
  reamer.tooth_angles = {0};
  for (const GrindJob& asked : reamer.ofAllOperations()) {
    SCOPED_TRACE(asked.operationText());
    const std::vector<PassRemoval> passes = removalOfPasses(withLaws(ValidJob(byRemoval(asked, 3, 0))));
    ASSERT_GE(passes.size(), 3u);
    const double mean = (passes[0].rate + passes[1].rate + passes[2].rate) / 3;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(passes[i].rate, mean, 0.02 * mean) << i;
  }
}

// A roughing pass that would only grind air is left out.
TEST(PassRemoval, LeavesOutRoughingBeforeTheWheelTouches) {
  GrindJob slot = byRemoval(slots(-6 * kMillimetre), 3, 0);
  slot.process().finish_infeed = slot.process().depth - 0.5 * kMillimetre;
  EXPECT_EQ(withLaws(ValidJob(slot)).depths(), (std::vector<double>{slot.process().depth, slot.process().depth}));
}

/// The reason for which a computation ends, once its watch has said so often that the plan is wanted.
template <typename Computation>
ReasonKind stopped(int wanted, const Computation& computation) {
  std::atomic<int> asked{0};
  try {
    computation([&](double) { return ++asked <= wanted; });
  } catch (const ReasonError& error) {
    return error.reason().kind;
  }
  return ReasonKind::kOther;
}

TEST(PassRemoval, IsGivenUpByItsWatch) {
  const ValidJob job(slots(-1.5 * kMillimetre));
  for (const int wanted : {0, 40}) {
    EXPECT_EQ(stopped(wanted, [&](const PlanWatch& watch) { removalOfPasses(job, watch); }), ReasonKind::kGivenUp);
  }
}

}  // namespace test_pass_removal
}  // namespace grinder
