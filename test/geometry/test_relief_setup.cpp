#include "geometry/relief_setup.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/ground_job.h"

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_relief_setup {

using units::kDegree;
using units::kMillimetre;

struct Tool {
  GrindJob job;
  GroundCutter cutter;
  ReliefRequest request;

  Tool(const std::string& file, double clearance, double width)
      : job(readJobFile(file)), cutter(groundCutterOf(ValidJob(job))) {
    request.start.clearance = clearance * kDegree;
    request.wheel.nominal_radius = 50 * kMillimetre;
    request.wheel.width = width * kMillimetre;
    const double middle = job.cutter.flute_length / 2;
    request.edge = *cutter.section(middle).teeth[0].edge - LogCurve(cutter.cutter()).a(middle);
    request.near = job.process.setup_swivel;
    request.swivel = {-60 * kDegree, 60 * kDegree};
  }

  ReliefWheel wheelOf(const ReliefSetup& setup) const {
    ReliefWheel wheel = request.wheel;
    wheel.swivel = setup.swivel;
    wheel.height = setup.height;
    return wheel;
  }

  WheelSweep sweepOf(const ReliefSetup& setup) const {
    const ReliefWheel wheel = wheelOf(setup);
    return reliefSweep(cutter.cutter(), ReliefPath(cutter.cutter(), request.start, wheel), wheel, request.edge);
  }

  GroundCutter with(const Reliefs& reliefs) const {
    return {cutter.cutter(), cutter.flutes(), cutter.teeth(), std::vector<Reliefs>(cutter.flutes().size(), reliefs)};
  }
};

// Of every tooth, in more sections than the solver looks at.
TEST(ReliefSetup, ReachesEveryHeelAndNoNextEdge) {
  for (const auto& [file, clearance, width] :
       {std::tuple{"jobs/roughing_d10_t4.yaml", 10.0, 6.0}, std::tuple{"jobs/left_hand_d8_t3.yaml", 10.0, 6.0},
        std::tuple{"jobs/taper_d6_t6.yaml", 10.0, 3.0}, std::tuple{"jobs/finishing_d20_t8.yaml", 10.0, 3.0}}) {
    SCOPED_TRACE(file);
    const Tool tool(file, clearance, width);
    const ReliefSetup setup = findReliefSetup(tool.cutter, tool.request);
    ASSERT_EQ(setup.refused, "");
    const GroundCutter relieved = tool.with({{tool.sweepOf(setup)}});
    for (int i = 0; i <= 10; ++i) {
      const GroundSection section = relieved.section(tool.job.cutter.flute_length * i / 10);
      for (const ToothSection& tooth : section.teeth) {
        const ReliefSection& relief = tooth.relief.value();
        ASSERT_TRUE(relief.heel) << section.x;
        EXPECT_GT(relief.next_edge, setup.next_edge - 1e-6);
        EXPECT_GT(*relief.land_end_clearance, 0);
        EXPECT_NEAR(*relief.clearance / kDegree, clearance, 0.02);
      }
    }
  }
}

// The nearest one that can do it: a degree nearer to the flute's it cannot.
TEST(ReliefSetup, TakesTheSwivelNearestToTheFlutes) {
  const Tool easy("jobs/roughing_d10_t4.yaml", 10, 6);
  EXPECT_EQ(findReliefSetup(easy.cutter, easy.request).swivel, easy.job.process.setup_swivel);

  Tool far("jobs/taper_d6_t6.yaml", 10, 3);
  const ReliefSetup setup = findReliefSetup(far.cutter, far.request);
  ASSERT_EQ(setup.refused, "");
  EXPECT_LT(setup.swivel, far.request.near - 5 * kDegree);
  far.request.asked = setup.swivel + 1 * kDegree;
  const ReliefSetup nearer = findReliefSetup(far.cutter, far.request);
  EXPECT_NE(nearer.refused.find("next edge"), std::string::npos) << nearer.refused;
}

TEST(ReliefSetup, SaysWhatIsInTheWay) {
  const Tool narrow("jobs/unequal_d12_t4.yaml", 10, 3);
  EXPECT_NE(findReliefSetup(narrow.cutter, narrow.request).refused.find("mm wide, this one is 3 mm"),
            std::string::npos);
  const Tool long_land("jobs/paper.yaml", 10, 6);
  EXPECT_NE(findReliefSetup(long_land.cutter, long_land.request).refused.find("clearance is lost"), std::string::npos);
}

// A steep relief on the way to the heel. What it takes of the core depends on the swivel.
TEST(ReliefSetup, KeepsTheCore) {
  Tool tool("jobs/roughing_d10_t4.yaml", 28, 8);
  const double least = tool.job.cutter.core_diameter - tool.job.cutter.core_tolerance;
  const ReliefSetup setup = findReliefSetup(tool.cutter, tool.request);
  ASSERT_EQ(setup.refused, "");
  const auto core_with = [&](const ReliefSetup& with, double x) {
    return 2 * tool.with({{tool.sweepOf(with)}}).section(x).core_radius;
  };
  for (int i = 0; i <= 10; ++i) EXPECT_GT(core_with(setup, tool.job.cutter.flute_length * i / 10), least);
  tool.request.asked = tool.request.near;
  const ReliefSetup nearest = findReliefSetup(tool.cutter, tool.request);
  EXPECT_NE(nearest.refused.find("the wheel leaves a core of 6.2"), std::string::npos) << nearest.refused;
  EXPECT_NE(nearest.refused.find("allowed: from 6.79 mm"), std::string::npos) << nearest.refused;
  EXPECT_NEAR(core_with(nearest, 0), 6.2 * kMillimetre, 0.01 * kMillimetre);
}

// A second relief goes on where the first is as wide as asked.
TEST(ReliefSetup, OfTwoReliefsTheFirstIsAsWideAsAsked) {
  Tool tool("jobs/roughing_d10_t4.yaml", 10, 6);
  tool.request.land = 0.4 * kMillimetre;
  const ReliefSetup first = findReliefSetup(tool.cutter, tool.request);
  ASSERT_EQ(first.refused, "");
  Reliefs reliefs{{tool.sweepOf(first)}};
  const ConicalCutter& cone = tool.cutter.cutter();
  const ReliefPath::Place end =
      ReliefPath(cone, tool.request.start, tool.wheelOf(first)).surfaceAt(0, 0.4 * kMillimetre);
  tool.request.land = 0;
  tool.request.start = {20 * kDegree, end.radius / cone.radius(0), end.behind};
  const ReliefSetup second = findReliefSetup(tool.cutter, tool.request);
  ASSERT_EQ(second.refused, "");
  reliefs.push_back({tool.sweepOf(second)});
  for (const double x : {0.0, 10e-3, 22e-3}) {
    const ReliefSection relief = tool.with(reliefs).section(x).teeth[0].relief.value();
    EXPECT_NEAR(*relief.land, 0.4 * kMillimetre, 1e-6);
    EXPECT_NEAR(*relief.clearance / kDegree, 10, 0.02);
    ASSERT_TRUE(relief.heel);
    EXPECT_GT(*relief.heel, 0.5 * kMillimetre);
  }
}

}  // namespace test_relief_setup
}  // namespace grinder
