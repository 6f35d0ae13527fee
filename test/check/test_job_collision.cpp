#include "flute_grinder/check/job_collision.h"

#include "curve/reference.h"
#include "flute_grinder/base/units.h"
#include "machine.h"
#include "motion/examples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace grinder {
namespace test_job_collision {

using test_support::plainMachine;
using units::kDegree;

/// The paper's cutter with a shank of 16 mm, ground with a wheel of 100 mm.
GrindJob paperJob() {
  GrindJob job = test_support::paperJob();
  job.cutter.shank_diameter = 0.016;
  job.process().setup_swivel = 31.769 * kDegree;
  return job;
}

/// A cylinder of 10 mm with flutes of 20 mm, 1.6 mm deep.
GrindJob cylinderJob(double shank_diameter) {
  GrindJob job = paperJob();
  job.cutter.cone_angle = 0;
  job.cutter.flute_length = 0.02;
  job.cutter.shank_diameter = shank_diameter;
  job.process().depth = job.process().infeed = 0.0016;
  return job;
}

GrindProgram programOf(const ValidJob& job, const Axes& offset = Axes::Zero()) {
  Machine machine = plainMachine();
  machine.collision_clearance = 1e-3;
  return {job, machine, {machine.park, {}, offset}};
}

CollisionResult checked(const GrindJob& job, const std::string& urdf = shippedUrdf(),
                        const Axes& offset = Axes::Zero()) {
  return checkCollision(programOf(ValidJob(job), offset), shapesOf(urdf));
}

/// The wheel's rim and the edge of the collet, in the plane Z = 0.
TEST(JobCollision, ATenthOfAMillimetreDecides) {
  for (const double wanted : {-0.1e-3, 0.9e-3, 1.1e-3}) {
    GrindJob job = cylinderJob(0.01);
    job.process().setup_swivel = 0;
    const double across = 0.055 - 0.0016 - 0.021;
    const double x = 0.062 - std::sqrt(std::pow(0.05 + wanted, 2) - across * across);
    job.cutter.flute_length = x - job.process().overtravel_shank;
    const CollisionResult result = checked(job, SmallMachine().urdf());
    EXPECT_EQ(!result.reason, wanted > 1e-3) << wanted;
    EXPECT_NEAR(result.closest->distance, std::max(0.0, wanted), 3e-6);
    if (!result.reason) continue;
    const Reason& reason = *result.reason;
    EXPECT_EQ(reason.kind, ReasonKind::kCollision);
    EXPECT_EQ(reason.detail, "wheel and collet");
    EXPECT_EQ(reason.limit, 1e-3);
    EXPECT_TRUE(reason.has_place);
    EXPECT_EQ(reason.value, result.closest->distance);
    EXPECT_EQ(reason.x, result.closest->axes[kX]);
  }
}

TEST(JobCollision, AShiftTurnsTheCutterAndMovesNothingElse) {
  GrindJob job = paperJob();
  const ClosestPlace without = *checked(job).closest;
  for (const double x_shift : {-15e-3, 11.847e-3}) {
    job.process().setup_x_shift = x_shift;
    const ClosestPlace with = *checked(job).closest;
    EXPECT_EQ(with.distance, without.distance) << x_shift;
    EXPECT_EQ(with.first + with.second, without.first + without.second) << x_shift;
  }
}

/// A job with a bow of Z of some tenths of a millimetre.
ValidJob bentJob() {
  GrindJob job = paperJob();
  job.process().infeed = job.process().depth / 2;
  job.process().z_law = ZLaw::kConstantRake;
  ZCorrection bow;
  bow.from = -job.process().overtravel_end;
  bow.pieces = 4;
  bow.piece = (job.cutter.flute_length + job.process().overtravel_end + job.process().overtravel_shank) / bow.pieces;
  for (int i = 0; i < bow.coefficientCount(); ++i) {
    bow.coefficients[static_cast<std::size_t>(i)] = 0.3e-3 * std::sin(1.1 * i);
  }
  return ValidJob(job).withZCorrections({bow});
}

TEST(JobCollision, ABentStrokeIsFollowedToAMicrometre) {
  const GrindProgram program = programOf(bentJob());
  const ProgramPath path = pathOf(program);
  ASSERT_EQ(path.moves.size() + 1, path.points.size());
  std::size_t legs_of_strokes = 0;
  for (std::size_t leg = 0; leg < path.moves.size(); ++leg) {
    const Axes &from = path.points[leg], &to = path.points[leg + 1];
    const Move& move = program.moves().at(path.moves[leg]);
    const bool last = leg + 1 == path.moves.size() || path.moves[leg + 1] != path.moves[leg];
    EXPECT_TRUE(!last || (to == move.to).all());
    if (move.kind != MoveKind::kStroke) continue;
    ++legs_of_strokes;
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Axes at = (1 - part) * from + part * to;
      const double z = at[kX] * std::tan(5 * units::kDegree) * std::sin(8 * units::kDegree) +
                       static_cast<double>(test_support::referenceCorrection(bentJob().zCorrectionOf(0), at[kX]));
      EXPECT_NEAR(at[kZ], z, 1.001e-6);
      EXPECT_NEAR(at[kY],
                  program.moves().at(path.moves[leg] - 1).to[kY] +
                      (at[kX] - program.strokeFrom()) * std::tan(5 * units::kDegree),
                  1e-12);
    }
  }
  EXPECT_GT(legs_of_strokes, 20u);
  EXPECT_EQ(pathOf(programOf(ValidJob(paperJob()))).moves.size(), programOf(ValidJob(paperJob())).moves().size());
}

TEST(JobCollision, OfABentStrokeTheMoveIsNamed) {
  GrindJob longer = *bentJob();
  longer.process().wheel_diameter = 0.5;
  longer.cutter.flute_length = 0.16;
  const ValidJob job = ValidJob(longer).withZCorrections({bentJob().zCorrectionOf(0)});
  const CollisionResult result = checkCollision(programOf(job), shippedShapes());
  ASSERT_TRUE(result.reason);
  EXPECT_EQ(result.reason->move, programOf(job).moves().at(result.closest->leg).kind);
  EXPECT_EQ(result.reason->x, result.closest->axes[kX]);
}

TEST(JobCollision, TheStrokesEndIsTheDeepestAtTheShank) {
  GrindJob job = paperJob();
  job.process().infeed = job.process().depth / 3;
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    job.process().direction = direction;
    const Axes end = collisionJobOf(programOf(ValidJob(job))).stroke_end;
    const double x = job.cutter.flute_length + job.process().overtravel_shank;
    EXPECT_DOUBLE_EQ(end[kX], x);
    EXPECT_NEAR(end[kY], x * std::tan(job.cutter.cone_angle) - job.process().depth, 1e-12);
  }
}

TEST(JobCollision, AShankMayStandOutByTheFlutesDepthAndNoMore) {
  for (const double shank_diameter : {0.008, 0.010, 0.0131}) {
    EXPECT_FALSE(checked(cylinderJob(shank_diameter)).reason) << shank_diameter;
  }
  for (const double shank_diameter : {0.0134, 0.02, 0.04}) {
    const CollisionResult result = checked(cylinderJob(shank_diameter));
    ASSERT_TRUE(result.reason) << shank_diameter;
    EXPECT_EQ(result.reason->detail, "wheel and shank");
  }
  GrindJob with_neck = cylinderJob(0.02);
  with_neck.cutter.neck_length = 0.038;
  EXPECT_FALSE(checked(with_neck).reason);
}

/// The shipped machine with a place for the origin of a joint.
std::string withOrigin(std::string urdf, const std::string& joint, const std::string& origin) {
  const std::size_t begin = urdf.find("<joint name=\"" + joint + "\"");
  return urdf.insert(urdf.find('>', begin) + 1, "<origin xyz=\"" + origin + "\"/>");
}

/// A shape of the chuck moved along X.
std::string withChuckMoved(const std::string& urdf, const std::string& name, double from, double by) {
  const std::string begin = "<collision name=\"" + name + "\">\n      <origin xyz=\"";
  std::ostringstream as_shipped;
  as_shipped << from;
  return replaced(urdf, begin + as_shipped.str(), begin + std::to_string(from + by));
}

/// Compared with a machine whose table and chuck stand elsewhere by as much.
TEST(JobCollision, TheWorkOffsetOfXSaysHowFarTheCutterStandsOut) {
  for (const double stands_in : {-0.02, -0.01, 0.005}) {
    const std::string in = std::to_string(stands_in), out = std::to_string(-stands_in);
    const std::string table = withOrigin(withOrigin(shippedUrdf(), "axis_x", out + " 0 0"), "axis_a", in + " 0 0");
    const std::string collet = withChuckMoved(table, "collet", 0.0885, -stands_in);
    const std::string moved = withChuckMoved(collet, "spindle_nose", 0.1225, -stands_in);
    ASSERT_FALSE(moved.empty());
    const CollisionResult expected = checked(paperJob(), moved);
    const CollisionResult result = checked(paperJob(), shippedUrdf(), {stands_in, 0.02, 0.01, 3});
    ASSERT_TRUE(result.closest && expected.closest);
    EXPECT_NEAR(result.closest->distance, expected.closest->distance, 4e-6) << stands_in;
    EXPECT_EQ(result.closest->first + result.closest->second, expected.closest->first + expected.closest->second);
    EXPECT_EQ(result.reason.has_value(), expected.reason.has_value());
  }
  // The collet's mouth is 62 mm from the end of a cutter without offset, and the wheel goes to 37 mm.
  EXPECT_EQ(checked(paperJob(), shippedUrdf(), {0.025, 0, 0, 0}).reason.value().detail, "wheel and collet");
}

}  // namespace test_job_collision
}  // namespace grinder
