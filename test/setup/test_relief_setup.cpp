#include "setup/relief_setup.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/setup/job_setup.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_relief_setup {

using units::kDegree;
using units::kMillimetre;

constexpr Range kSwivel{-60 * kDegree, 60 * kDegree};
constexpr double kNarrow = 2;  ///< rim that reaches no heel: the wheel's face takes the rest [mm]

/// The flutes of a job with a primary relief.
struct Tool {
  GrindJob job;

  /// @param clearance [deg]. @param width of the reliefs' wheel [mm].
  Tool(const std::string& file, double clearance, double width) : job(readJobFile(file)) {
    job.cutter.clearance = clearance * kDegree;
    job.cutter.clearance_tolerance = 0.5 * kDegree;
    GrindProcess relief;
    relief.kind = OperationKind::kPrimaryRelief;
    relief.feed = 5e-3, relief.infeed = 0.1e-3, relief.clearance = 4e-3;
    relief.wheel_diameter = 100 * kMillimetre, relief.wheel_width = width * kMillimetre;
    job.operations.push_back(relief);
    job = job.ofOperation(1);
  }

  ValidJob flutes() const { return withLaws(ValidJob(job.ofOperation(0))); }

  ReliefSetup find(std::optional<double> asked = {}) const { return findReliefSetup(job, flutes(), kSwivel, asked); }

  /// With a swivel not far from the flutes': to look at all others takes long.
  ReliefSetup findNear() const {
    const double near = flutes()->process().setup_swivel;
    return findReliefSetup(job, flutes(), {near - 8 * kDegree, near + 4 * kDegree}, {});
  }

  void take(const ReliefSetup& setup) {
    job.process().setup_swivel = setup.swivel;
    job.process().setup_height = setup.height;
    job.operations[static_cast<std::size_t>(job.operation)] = job.process();
  }

  GroundCutter relieved() const { return groundCutterOf(withLaws(ValidJob(job))); }
};

// Of every tooth, in more sections than the solver looks at.
TEST(ReliefSetup, ReachesEveryHeelAndNoNextEdge) {
  for (const auto& [file, clearance, width] :
       {std::tuple{"jobs/left_hand_d8_t3.yaml", 10.0, 6.0}, std::tuple{"jobs/taper_d6_t6.yaml", 10.0, 3.0},
        std::tuple{"jobs/finishing_d20_t8.yaml", 8.0, kNarrow}}) {
    SCOPED_TRACE(file);
    Tool tool(file, clearance, width);
    const ReliefSetup setup = tool.find();
    ASSERT_EQ(setup.refused, "");
    EXPECT_EQ(setup.land_end_clearance.has_value(), width > kNarrow);
    tool.take(setup);
    const GroundCutter relieved = tool.relieved();
    for (int i = 0; i <= 4; ++i) {
      const GroundSection section = relieved.section(tool.job.cutter.flute_length * i / 4);
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

// The nearest one with a margin: some degrees nearer to the flutes' it has none.
TEST(ReliefSetup, TakesTheSwivelNearestToTheFlutes) {
  const Tool easy("jobs/roughing_d10_t4.yaml", 10, 6);
  const double near = easy.flutes()->process().setup_swivel;
  EXPECT_EQ(easy.find().swivel, near);
  EXPECT_LE(findReliefSetup(easy.job, easy.flutes(), {10 * kDegree, 20 * kDegree}, {}).swivel, 20 * kDegree);

  const Tool far("jobs/taper_d6_t6.yaml", 10, 3);
  const double near_far = far.flutes()->process().setup_swivel;
  const ReliefSetup setup = far.find();
  ASSERT_EQ(setup.refused, "");
  EXPECT_LT(setup.swivel, near_far - 2 * kDegree);
  EXPECT_NE(far.find(near_far).refused, "");
  const std::string refused = Tool("jobs/taper_d6_t6.yaml", 10, 5).find(near_far).refused;
  EXPECT_NE(refused.find("beyond the next edge"), std::string::npos) << refused;
  EXPECT_EQ(refused.find('-'), std::string::npos) << refused;

  GrindJob mirrored = far.job;
  mirrored.cutter.cut = CutDirection::kLeftHand;
  mirrored.cutter.spiral_angle *= -1;
  for (GrindProcess& p : mirrored.operations) p.setup_swivel *= -1, p.setup_height *= -1;
  mirrored = mirrored.ofOperation(1);
  const ValidJob left = withLaws(ValidJob(mirrored.ofOperation(0)));
  const ReliefSetup other = findReliefSetup(mirrored, left, kSwivel, {});
  EXPECT_NEAR(other.swivel, -setup.swivel, 1e-9);
  EXPECT_NEAR(other.height, -setup.height, 1e-9);
}

TEST(ReliefSetup, SaysWhatIsInTheWay) {
  EXPECT_NE(Tool("jobs/paper.yaml", 10, 6).findNear().refused.find("clearance is lost"), std::string::npos);
}

// A steep relief on the way to the heel. What it takes of the core depends on the swivel.
TEST(ReliefSetup, KeepsTheCore) {
  Tool tool("jobs/roughing_d10_t4.yaml", 34, 8);
  const double least = tool.job.cutter.core_diameter - tool.job.cutter.core_tolerance;
  const ReliefSetup setup = tool.findNear();
  ASSERT_EQ(setup.refused, "");
  Tool good = tool;
  good.take(setup);
  const GroundCutter relieved = good.relieved();
  for (int i = 0; i <= 4; ++i) {
    EXPECT_GT(2 * relieved.section(tool.job.cutter.flute_length * i / 4).core_radius, least);
  }
  const ReliefSetup other = tool.find(tool.flutes()->process().setup_swivel - 4 * kDegree);
  EXPECT_NE(other.refused.find("the wheel leaves a core of 4."), std::string::npos) << other.refused;
  EXPECT_NE(other.refused.find("allowed: from 6.79 mm"), std::string::npos) << other.refused;
}

// A second relief goes on where the first is as wide as asked, up to the heel, whatever follows.
TEST(ReliefSetup, OfTwoReliefsTheFirstIsAsWideAsAsked) {
  Tool tool("jobs/roughing_d10_t4.yaml", 10, 6);
  tool.job = readJobFile("jobs/end_mill_d10_t4.yaml", "primary");
  const ReliefSetup first = tool.find();
  ASSERT_EQ(first.refused, "");
  tool.take(first);
  tool.job = tool.job.ofOperation(2);
  const ReliefSetup second = tool.find();
  ASSERT_EQ(second.refused, "");
  tool.take(second);
  const GroundCutter relieved = tool.relieved();
  for (const double x : {0.0, 10e-3, tool.job.cutter.flute_length}) {
    const ReliefSection relief = relieved.section(x).teeth[0].relief.value();
    EXPECT_NEAR(*relief.land, 0.4 * kMillimetre, 1e-6);
    EXPECT_NEAR(*relief.clearance / kDegree, 10, 0.02);
    EXPECT_NEAR(*relief.second_clearance / kDegree, 20, 0.02);
    ASSERT_TRUE(relief.heel);
    EXPECT_GT(*relief.heel, 0.5 * kMillimetre);
  }
}

// The margins are the tool's, not a machine's: a small mill has a small wheel.
TEST(ReliefSetup, OfASmallToolHasSmallMargins) {
  Tool tool("jobs/roughing_d10_t4.yaml", 10, 6);
  const double part = 0.2;
  const auto shrink = [&](GrindProcess& p) {
    for (double* figure : {&p.depth, &p.depth_end, &p.infeed, &p.finish_infeed, &p.overtravel_end, &p.overtravel_shank,
                           &p.wheel_diameter, &p.wheel_width, &p.setup_height, &p.setup_x_shift}) {
      *figure *= part;
    }
  };
  CutterGeometry& c = tool.job.cutter;
  for (double* figure : {&c.end_diameter, &c.flute_length, &c.shank_diameter, &c.neck_length, &c.core_diameter,
                         &c.core_diameter_end, &c.core_tolerance}) {
    *figure *= part;
  }
  const ReliefSetup large = Tool("jobs/roughing_d10_t4.yaml", 10, 6).find();
  for (GrindProcess& operation : tool.job.operations) shrink(operation);
  tool.job = tool.job.ofOperation(1);
  const ReliefSetup small = tool.find();
  ASSERT_EQ(small.refused, "");
  EXPECT_NEAR(small.swivel, large.swivel, 1e-6);
  EXPECT_NEAR(small.width, part * large.width, 1e-4 * small.width);
}

}  // namespace test_relief_setup
}  // namespace grinder
