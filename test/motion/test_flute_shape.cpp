// Depth that changes along the flute, and a spiral angle per tooth: the path against its formula, over random jobs.

#include "flute_grinder/motion/job_plan.h"

#include "generators.h"
#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace grinder {
namespace test_flute_shape {

using namespace test_support;

/// Two teeth of different spiral angles in passes to a depth that changes along the flute.
rc::Gen<Work> shapedWork() {
  return rc::gen::exec([] {
    Work work = *test_support::work(2000);
    GrindJob& job = work.job;
    const double growth = std::tan(job.cutter.cone_angle);
    const double end_radius = job.cutter.end_diameter / 2 + job.cutter.flute_length * growth;
    job.process().depth_end = end_radius * *uniform(0.02, 0.4);
    job.process().infeed = std::max(job.process().depth, job.process().depth_end) * *uniform(0.4, 1);
    job.tooth_angles = {0, *uniform(1, 5)};
    job.spiral_angles = {job.cutter.spiral_angle, job.cutter.spiral_angle * *uniform(0.5, 1)};
    job.process().wheel_wear_per_pass = *uniform(0, 1e-6);
    return work;
  });
}

RC_GTEST_PROP(FluteShape, EveryStrokeIsOnItsToothsHelixAtItsDepth, ()) {
  const Work work = *shapedWork();
  const GrindJob& job = work.job;
  RC_PRE(validate(job).empty());
  const double growth = std::tan(job.cutter.cone_angle);
  const double b = 2 * growth / job.cutter.end_diameter;
  const std::vector<double> depths = passDepths(job.process());
  const double deepest = std::max(job.process().depth, job.process().depth_end);
  RC_ASSERT(depths.back() == deepest);
  for (std::size_t i = 1; i < depths.size(); ++i)
    RC_ASSERT(depths[i] - depths[i - 1] <= job.process().infeed * (1 + 1e-9));
  double y_off = 0, deviation = 0, last_x = 0;
  const JobPlan plan = planJob(ValidJob(job), work.machine, work.start, [&](const Setpoint& p) {
    if (p.move != MoveKind::kStroke) return;
    const double x = p.position[kX];
    last_x = x;
    const double done = x / job.cutter.flute_length;
    const double depth =
        depths[p.pass] / deepest * (job.process().depth + (job.process().depth_end - job.process().depth) * done);
    const std::size_t order = p.tooth * depths.size() + p.pass;  // tooth by tooth
    const double wear = static_cast<double>(order) * job.process().wheel_wear_per_pass;
    y_off = std::max(y_off, std::abs(p.position[kY] - (x * growth - depth - wear)));
    const double k = 2 * std::tan(job.spiral_angles[p.tooth]) / job.cutter.end_diameter;
    const double edge_x = x - job.process().setup_x_shift;
    const double a = job.tooth_angles[p.tooth] + (b == 0 ? k * edge_x : k / b * std::log1p(b * edge_x));
    if (p.step != StepKind::kNone) {
      const double radius = job.cutter.end_diameter / 2 + edge_x * growth;
      deviation = std::max(deviation, std::abs(p.position[kA] - a) * radius);
    }
  });
  RC_PRE(plan.program != nullptr);
  // Whatever the taper adds to Y, the axes keep their limits.
  for (const Reason& reason : plan.reasons) RC_ASSERT(reason.kind == ReasonKind::kTolerance);
  RC_ASSERT(y_off < 1e-12);
  if (plan.good()) RC_ASSERT(deviation < 2 * job.interpolation.tolerance + 1e-12);
  if (plan.good()) RC_ASSERT(std::abs(last_x - plan.program->strokeTo()) < 1e-12);
}

TEST(FluteShape, ADepthThatIsTheSameAtBothEndsChangesNoBit) {
  const GrindJob plain = paperJob();
  GrindJob reported = plain;
  reported.process().depth_end = reported.process().depth;
  reported.spiral_angles = {reported.cutter.spiral_angle};
  const Machine machine = plainMachine();
  std::vector<Setpoint> expected;
  planJob(ValidJob(plain), machine, machine.park, [&](const Setpoint& p) { expected.push_back(p); });
  std::size_t i = 0;
  const JobPlan plan = planJob(ValidJob(reported), machine, machine.park, [&](const Setpoint& p) {
    ASSERT_LT(i, expected.size());
    ASSERT_TRUE((p.position == expected[i++].position).all());
  });
  EXPECT_TRUE(plan.good());
  EXPECT_EQ(i, expected.size());
}

}  // namespace test_flute_shape
}  // namespace grinder
