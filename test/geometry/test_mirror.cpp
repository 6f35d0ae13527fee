// A left-hand job is a right-hand one in the mirror: the same tool, with Z and A of every setpoint negated.

#include "motion/generators.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/job_setup.h"
#include "flute_grinder/geometry/rake_touch.h"
#include "flute_grinder/geometry/z_law.h"
#include "jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace grinder {
namespace test_mirror {

using test_support::jobOf;
using test_support::paper;
using units::kDegree;
using units::kMillimetre;

constexpr double kRounding =
    1e-7;  ///< and the precision of a search, which sees a mirror image from its other end [m], [rad]

/// The job in the mirror that turns Z round. The first tooth stays the first, the others change their order.
GrindJob mirrored(GrindJob job) {
  const bool right = job.cutter.cut == CutDirection::kRightHand;
  job.cutter.cut = right ? CutDirection::kLeftHand : CutDirection::kRightHand;
  job.cutter.spiral_angle *= -1;
  for (double& spiral : job.spiral_angles) spiral *= -1;
  for (double& angle : job.tooth_angles) angle = angle == 0 ? 0 : units::kTurn - angle;
  std::reverse(job.tooth_angles.begin() + 1, job.tooth_angles.end());
  if (!job.spiral_angles.empty()) std::reverse(job.spiral_angles.begin() + 1, job.spiral_angles.end());
  GrindProcess& p = job.process;
  p.setup_swivel *= -1;
  p.setup_height *= -1;
  std::swap(p.wheel_corner_radius_lower, p.wheel_corner_radius_upper);
  if (isTapered(p.wheel_profile)) {
    p.wheel_side = p.wheel_side == WheelFace::kUpper ? WheelFace::kLower : WheelFace::kUpper;
  }
  std::reverse(job.wheel_points.begin(), job.wheel_points.end());
  for (ProfilePoint& point : job.wheel_points) point.w *= -1;
  return job;
}

/// Right-hand jobs of cones, cylinders and back tapers, with every kind of wheel.
class RandomJobs {
 public:
  GrindJob job() {
    GrindJob job = paper();
    CutterGeometry& c = job.cutter;
    c.end_diameter = between(2, 16) * kMillimetre;
    c.cone_angle = i_ % 4 == 0 ? 0 : between(-1.5, 12) * kDegree;
    c.spiral_angle = between(-20, 45) * kDegree;
    c.rake_angle = between(-5, 15) * kDegree;
    c.flute_length = between(0.5, 2) * c.end_diameter;
    c.rake_tolerance = 5 * kDegree;
    c.shank_diameter = 40 * kMillimetre;
    GrindProcess& p = job.process;
    p.depth = p.infeed = between(0.1, 0.25) * c.end_diameter;
    if (i_ % 3 == 0) p.depth_end = between(0.8, 1) * p.depth;
    p.finish_infeed = 0;
    p.spark_out = 0;
    p.overtravel_end = between(0.1, 0.4) * c.end_diameter;
    p.overtravel_shank = between(0, 10) * kMillimetre;
    p.direction = i_ % 2 == 0 ? StrokeDirection::kFromEnd : StrokeDirection::kToEnd;
    p.wheel_diameter = between(60, 125) * kMillimetre;
    p.wheel_width = between(0.1, 0.4) * c.end_diameter;
    p.wheel_wear = between(0, 0.05) * kMillimetre;
    p.wheel_wear_per_pass = between(0, 1e-3) * kMillimetre;
    shapeWheel(job);
    p.setup_swivel = c.spiral_angle + between(0, 9) * kDegree;
    const double face = c.end_diameter / 2 * std::sin(between(0, 25) * kDegree);
    p.setup_height = face - p.wheel_width / 2 / std::cos(p.setup_swivel);
    ++i_;
    return job;
  }

  double between(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

 private:
  void shapeWheel(GrindJob& job) {
    GrindProcess& p = job.process;
    p.wheel_profile = kWheelShapes[i_ % 5].value;
    const double radius = p.wheel_diameter / 2, half = p.wheel_width / 2;
    if (isTapered(p.wheel_profile)) p.wheel_angle = between(5, 30) * kDegree;
    if (p.wheel_profile == WheelShape::kPoints) {
      job.wheel_points = {{-half, 0.98 * radius}, {0.2 * half, 0.99 * radius}, {half, radius}};
    }
    if (p.wheel_profile != WheelShape::kFullRadius) {
      p.wheel_corner_radius_lower = between(0, 0.2) * p.wheel_width;
      p.wheel_corner_radius_upper = between(0, 0.2) * p.wheel_width;
    }
  }

  std::size_t i_ = 0;
  std::mt19937 random_{7};
};

void expectSame(const std::optional<double>& right, const std::optional<double>& left, int sign, const char* what) {
  ASSERT_EQ(right.has_value(), left.has_value()) << what;
  if (right) {
    EXPECT_NEAR(*left, sign * *right, kRounding) << what;
  }
}

/// The same tool in every section; with teeth of one kind, or a single one.
void expectMirrored(const GroundCutter& right, const GroundCutter& left) {
  const double length = right.cutter().geometry().flute_length;
  for (const double part : {0.0, 0.3, 1.0}) {
    const GroundSection one = right.section(part * length), other = left.section(part * length);
    EXPECT_NEAR(other.core_radius, one.core_radius, kRounding);
    const ToothSection &a = one.teeth[0], &b = other.teeth[0];
    expectSame(a.edge, b.edge, -1, "edge");
    expectSame(a.rake, b.rake, 1, "rake");
    expectSame(a.normal_rake, b.normal_rake, 1, "normal rake");
    expectSame(a.flute, b.flute, 1, "flute");
    expectSame(a.land, b.land, 1, "land");
    expectSame(a.spiral, b.spiral, -1, "spiral");
    EXPECT_NEAR(b.depth, a.depth, kRounding);
    EXPECT_EQ(b.complete, a.complete);
  }
}

std::vector<Setpoint> setpointsOf(const ValidJob& job, JobPlan& plan) {
  const Machine machine = test_support::plainMachine();
  std::vector<Setpoint> setpoints;
  plan = planJob(withLaws(job), machine, machine.park, [&](const Setpoint& s) { setpoints.push_back(s); });
  return setpoints;
}

/// The same path with Z and A negated, the same verdict.
void expectMirroredPlans(const ValidJob& right, const ValidJob& left) {
  JobPlan one, other;
  const std::vector<Setpoint> a = setpointsOf(right, one), b = setpointsOf(left, other);
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(b.size(), a.size());
  EXPECT_EQ(other.fault, one.fault);
  EXPECT_EQ(other.reasons.size(), one.reasons.size());
  const CutterCheck of_right = checkGroundCutter(one.program->job()), of_left = checkGroundCutter(other.program->job());
  EXPECT_EQ(of_left.reasons.size(), of_right.reasons.size());
  ASSERT_EQ(of_left.complete.has_value(), of_right.complete.has_value());
  if (of_right.complete) {
    EXPECT_NEAR(of_left.complete->from, of_right.complete->from, kRounding);
    EXPECT_NEAR(of_left.complete->to, of_right.complete->to, kRounding);
  }
  Axes mirror;
  mirror << 1, 1, -1, -1;
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, (b[i].position - mirror * a[i].position).abs().maxCoeff());
  }
  EXPECT_EQ(worst, 0);
}

TEST(Mirror, ALeftHandJobIsARightHandOneInTheMirror) {
  RandomJobs random;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const GrindJob right = random.job(), left = mirrored(right);
    ASSERT_TRUE(validate(right).empty()) << text(validate(right));
    ASSERT_TRUE(validate(left).empty());
    expectMirrored(groundCutterOf(ValidJob(right)), groundCutterOf(ValidJob(left)));
    expectMirroredPlans(ValidJob(right), ValidJob(left));
  }
}

TEST(Mirror, UnequalTeethHaveTheirLandsInTheMirror) {
  const GrindJob right = jobOf("unequal_d12_t4");
  GrindJob one = right;
  one.process.wheel_wear_per_pass = 0;  // teeth in another order are ground by another wheel
  expectMirrored(groundCutterOf(ValidJob(one)), groundCutterOf(ValidJob(mirrored(one))));
}

TEST(Mirror, TheLawOfConstantRakeIsMirrored) {
  GrindJob job = paper();
  job.process.z_law = ZLaw::kConstantRake;
  for (const double lead : {0.0, 0.5e-3, -2e-3}) {
    SCOPED_TRACE(lead);
    job.process.setup_lead = lead;
    const ValidJob right = withLaws(ValidJob(job)), left = withLaws(ValidJob(mirrored(job)));
    for (std::size_t i = 0; i < right.zCorrectionOf(0).coefficients.size(); ++i) {
      EXPECT_NEAR(left.zCorrectionOf(0).coefficients[i], -right.zCorrectionOf(0).coefficients[i], kRounding) << i;
    }
    expectMirrored(groundCutterOf(right), groundCutterOf(left));
    expectMirroredPlans(right, left);
  }
}

TEST(Mirror, TheSetUpIsMirrored) {
  GrindJob angled = jobOf("taper_d6_t6");
  angled.process.wheel_profile = WheelShape::kAngled;
  angled.process.wheel_angle = 5 * kDegree;
  angled.process.wheel_corner_radius_lower = 0.1 * kMillimetre;
  angled.process.wheel_corner_radius_upper = 0.2 * kMillimetre;
  for (const GrindJob& job : {jobOf("paper"), angled, jobOf("left_hand_d8_t3")}) {
    const Range swivel{-60 * kDegree, 60 * kDegree};
    const auto solved = [&](const GrindJob& j) {
      const auto result = solveJobSetup(j, swivel, std::nullopt);
      if (const auto* refusal = std::get_if<std::string>(&result)) ADD_FAILURE() << *refusal;
      return std::holds_alternative<JobSetup>(result) ? std::get<JobSetup>(result) : JobSetup{};
    };
    const JobSetup one = solved(job), other = solved(mirrored(job));
    EXPECT_NEAR(other.job.process.setup_swivel, -one.job.process.setup_swivel, kRounding);
    EXPECT_NEAR(other.job.process.setup_height, -one.job.process.setup_height, kRounding);
    EXPECT_NEAR(other.job.process.depth, one.job.process.depth, kRounding);
    EXPECT_NEAR(other.check.figures.rake.from, one.check.figures.rake.from, kRounding);
    EXPECT_NEAR(other.check.figures.rake.to, one.check.figures.rake.to, kRounding);
    EXPECT_NEAR(other.overtravel[0], one.overtravel[0], kRounding);
    EXPECT_NEAR(other.overtravel[1], one.overtravel[1], kRounding);
    EXPECT_EQ(other.check.reasons.size(), one.check.reasons.size());
  }
}

TEST(Mirror, AProbeTouchesTheMirroredFace) {
  const GrindJob right = paper();
  for (const double at : {5.0, 20.0}) {
    const double from_axis = right.cutter.end_diameter / 2 + at * kMillimetre * std::tan(right.cutter.cone_angle);
    const Eigen::Vector3d ball{at * kMillimetre, from_axis - 0.3 * kMillimetre, 0};
    EXPECT_NEAR(rakeTouchAngle(ValidJob(mirrored(right)), ball, 0.3 * kMillimetre),
                -rakeTouchAngle(ValidJob(right), ball, 0.3 * kMillimetre), 1e-6);
  }
}

}  // namespace test_mirror
}  // namespace grinder
