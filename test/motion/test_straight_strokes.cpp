// The strokes of an operation on the end of a tool: straight, in the plane of a face of the wheel. test/rides hold them
// at any moment, with a cup round the work, too.

#include "flute_grinder/motion/job_plan.h"

#include "examples.h"
#include "flute_grinder/base/units.h"
#include "stream_checks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grinder {
namespace test_straight_strokes {

using namespace test_support;
using units::kDegree;

constexpr OperationKind kKinds[] = {OperationKind::kGash, OperationKind::kPrimaryEnd, OperationKind::kSecondaryEnd,
                                    OperationKind::kChamfer};

/// A cylindrical end mill of four teeth, of which only the end is ground, with the swivels of the trade.
GrindJob endJob(OperationKind kind) {
  GrindJob job = paperJob();
  CutterGeometry& c = job.cutter;
  c.end_diameter = 10e-3;
  c.cone_angle = 0;
  c.spiral_angle = c.rake_angle = 0;
  c.end_clearance = 8 * kDegree;
  c.end_second_clearance = 18 * kDegree;
  c.end_land = 0.4e-3;
  c.end_dish = 2 * kDegree;
  c.end_rake = 3 * kDegree;
  c.end_clearance_tolerance = c.end_rake_tolerance = 0.5 * kDegree;
  c.chamfer_width = 0.2e-3;
  c.chamfer_angle = 45 * kDegree;
  c.chamfer_clearance = 10 * kDegree;
  job.tooth_angles = {0, 90 * kDegree, 180 * kDegree, 270 * kDegree};
  job.operations.push_back(job.process());
  job.operation = 1;
  GrindProcess& p = job.process();
  p.kind = kind;
  p.depth = p.overtravel_end = p.overtravel_shank = 0;
  p.infeed = 0.2e-3;
  p.finish_infeed = 0.03e-3;
  p.spark_out = 1;
  p.clearance = 1e-3;
  if (kind == OperationKind::kGash) p.gash_angle = 45 * kDegree, p.gash_past = -0.15e-3, p.infeed = 2e-3;
  const double swivels[] = {3.000, 81.76003, 71.90308, 44.13603};
  p.setup_swivel = swivels[static_cast<int>(kind) - static_cast<int>(OperationKind::kGash)] * kDegree;
  return job;
}

/// With edges at the teeth's angles.
ValidJob validEndJob(OperationKind kind, CutDirection cut = CutDirection::kRightHand, double wear_per_pass = 0) {
  GrindJob asked = endJob(kind);
  asked.cutter.cut = cut;
  asked.process().wheel_wear_per_pass = wear_per_pass;
  if (cut == CutDirection::kLeftHand) {
    GrindProcess& p = asked.process();
    p.wheel_profile = WheelShape::kCup;
    p.wheel_side = WheelFace::kLower;
    p.wheel_rim = 8e-3;
  }
  const ValidJob job(asked);
  return job.withEdges(ValidJob(job->ofOperation(0)), std::vector<EdgeHelix>(job->tooth_angles.size()));
}

TEST(StraightStrokes, RunInThePlaneOfTheFaceAtConstantA) {
  for (const OperationKind kind : kKinds) {
    SCOPED_TRACE(toString(kind));
    const ValidJob job = validEndJob(kind);
    ASSERT_GT(job.depths().size(), 2u);
    const double sin = std::sin(job->process().setup_swivel), cos = std::cos(job->process().setup_swivel);
    std::vector<Setpoint> setpoints;
    const JobPlan plan =
        planJob(job, plainMachine(), plainMachine().park, [&](const Setpoint& p) { setpoints.push_back(p); });
    ASSERT_TRUE(plan.good()) << text(plan.reasons);
    EXPECT_EQ(beyondLimits(setpoints, plainMachine()), "");
    Axes at = plainMachine().park;
    std::size_t begun = 0;
    for (const Move& move : plan.program->moves()) {
      const Axes way = move.to - at;
      at = move.to;
      const bool index = move.kind == MoveKind::kIndex, position = move.kind == MoveKind::kPosition;
      const bool approach = move.kind == MoveKind::kApproach;
      begun += index || position || approach ? 1 : 0;
      EXPECT_TRUE(way[kY] == 0 || !(index || position)) << "above the work";
      EXPECT_TRUE(way[kA] == 0 || index || move.kind == MoveKind::kReturn);
      EXPECT_TRUE((way[kX] == 0 && way[kZ] == 0) || !(index || approach));
    }
    EXPECT_EQ(begun, 3 * job.passes().size());
    std::vector<double> planes(job.depths().size(), 0);
    int at_feed = 0;
    for (std::size_t i = 1; i < setpoints.size(); ++i) {
      const Setpoint &p = setpoints[i], &before = setpoints[i - 1];
      if (p.move != MoveKind::kStroke) continue;
      EXPECT_LE(p.feed, job->process().feed * (1 + 1e-12));
      EXPECT_EQ(p.position[kA], before.position[kA]);
      if (p.at_feed) {
        ++at_feed;
        EXPECT_NEAR(p.velocity.head<3>().matrix().norm(), p.feed, 1e-9 * p.feed);
      }
      const auto plane = [&](const Setpoint& at) { return -sin * at.position[kX] + cos * at.position[kZ]; };
      EXPECT_NEAR(plane(p), plane(before), 1e-12);
      planes[p.pass] = plane(p);
    }
    EXPECT_GT(at_feed, 0);
    // Each pass takes its infeed: of a gash along Y, else across the plane, which the setup's rounded swivel blurs.
    for (std::size_t i = 1; i < planes.size(); ++i) {
      const double infeed = kind == OperationKind::kGash ? 0 : job.depths()[i] - job.depths()[i - 1];
      EXPECT_NEAR(planes[i - 1] - planes[i], infeed, 1e-8);
    }
  }
}

/// A face that has worn by w goes on by w along the spindle, which leans back by the swivel.
TEST(StraightStrokes, GoOnByTheWearOfTheFaceAlone) {
  constexpr double kWear = 2e-6, kRounded = 1e-6;  // the set-up's swivels are rounded
  for (const CutDirection cut : {CutDirection::kRightHand, CutDirection::kLeftHand}) {
    for (const OperationKind kind :
         {OperationKind::kPrimaryEnd, OperationKind::kSecondaryEnd, OperationKind::kChamfer}) {
      SCOPED_TRACE(std::string(toString(kind)) + " " + toString(cut));
      const auto strokesWith = [&](double wear) {
        std::vector<Axes> ends;
        const GrindProgram program(validEndJob(kind, cut, wear), plainMachine(), plainMachine().park);
        for (const Move& move : program.moves()) {
          if (move.kind == MoveKind::kApproach || move.kind == MoveKind::kStroke) ends.push_back(move.to);
        }
        return ends;
      };
      const std::vector<Axes> fresh = strokesWith(0), worn = strokesWith(kWear);
      ASSERT_EQ(fresh.size(), worn.size());
      const double swivel = endJob(kind).process().setup_swivel;
      for (std::size_t i = 0; i < fresh.size(); ++i) {
        const double wear = static_cast<double>(i / 2) * kWear;
        const Axes way = worn[i] - fresh[i];
        EXPECT_NEAR(way[kX], wear * std::sin(swivel), kRounded * wear + 1e-15);
        EXPECT_NEAR(way[kZ], -wear * std::cos(swivel), kRounded * wear + 1e-15);
        EXPECT_NEAR(way[kY], 0, 1e-15);
        EXPECT_EQ(way[kA], 0);
      }
    }
  }
}

TEST(StraightStrokes, ArePlannedByTheirShapesAsOneByOne) {
  for (const OperationKind kind : kKinds) {
    const ValidJob job = validEndJob(kind);
    const JobPlan whole = planJob(job, plainMachine(), plainMachine().park, [](const Setpoint&) {});
    const JobPlan by_shapes = planJob(job, plainMachine(), plainMachine().park);
    EXPECT_EQ(whole.statistics.setpoints, by_shapes.statistics.setpoints);
    EXPECT_EQ(whole.move_ends, by_shapes.move_ends);
  }
}

TEST(StraightStrokes, NeedTheSwivelOfTheirPlane) {
  GrindJob job = endJob(OperationKind::kPrimaryEnd);
  job.process().setup_swivel = 81.7 * kDegree;
  try {
    ValidJob{job};
    FAIL();
  } catch (const InvalidJob& error) {
    EXPECT_STREQ(error.what(),
                 "process.setup.swivel_deg = 81.7 deg; allowed: that of the plane that is ground, 81.76003283 deg");
  }
}

}  // namespace test_straight_strokes
}  // namespace grinder
