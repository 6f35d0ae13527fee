// Jobs with z_law constant_rake: the rake that is ground, by sections and by brute force, and what is refused.

#include "brute_force.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/setup/job_setup.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"
#include "motion/examples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace grinder {
namespace test_constant_rake {

using units::kDegree;
using units::kMillimetre;

constexpr int kParts = 25;  ///< of the flute, between the sections measured; the correction is made for others

using brute::Shop;
const Shop kSteep{5, 10, 20, 14, 15, 0.7, 75, 1.5};

/// The job with a set-up that gives the rake within two degrees by the published law, and nothing where there is none.
std::optional<GrindJob> jobFor(const Shop& s) {
  GrindJob job = test_support::paperJob();
  CutterGeometry& c = job.cutter;
  c = test_support::anyToolOf(s.tool().cutter, 10 * kMillimetre);
  c.rake_tolerance = 2 * kDegree;
  c.core_diameter = c.end_diameter - 2 * s.depth * kMillimetre;
  c.core_diameter_end = c.core_diameter + 2 * c.flute_length * std::tan(c.cone_angle);
  c.core_tolerance = 0.2 * kMillimetre;
  job.process().wheel_diameter = s.wheel * kMillimetre;
  job.process().wheel_width = s.width * kMillimetre;
  job.process().overtravel_end = job.process().overtravel_shank = 0;
  const auto result = solveJobSetup(job, {-60 * kDegree, 60 * kDegree}, std::nullopt);
  const auto* setup = std::get_if<JobSetup>(&result);
  if (!setup || !setup->check.reasons.empty()) return std::nullopt;
  job = setup->job;
  // The correction moves where the ends of the flute are formed by a little.
  job.process().overtravel_end += 0.2 * kMillimetre;
  job.process().overtravel_shank += 0.2 * kMillimetre;
  job.process().infeed = job.process().depth;
  job.process().z_law = ZLaw::kConstantRake;
  return job;
}

GrindJob steepJob() {
  static const GrindJob job = jobFor(kSteep).value();
  return job;
}

/// The maximum error of the rake over the flute [deg]; infinite where there is none.
double rakeError(const GroundCutter& cutter, const GrindJob& job) {
  double max = 0;
  for (int i = 0; i <= kParts; ++i) {
    for (const ToothSection& tooth : cutter.section(job.cutter.flute_length * i / kParts).teeth) {
      const double error = tooth.rake && tooth.complete ? std::abs(*tooth.rake - job.cutter.rake_angle) : 10;
      max = std::max(max, error / kDegree);
    }
  }
  return max;
}

double publishedRakeError(GrindJob job) {
  job.process().z_law = ZLaw::kPublished;
  return rakeError(groundCutterOf(ValidJob(job)), job);
}

Reason refusalOf(const GrindJob& job) {
  try {
    withLaws(ValidJob(job));
  } catch (const ReasonError& error) {
    return error.reason();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

// Of both hands, with wheels whose other corner is rounded.
TEST(ConstantRake, OnRandomConesTheRakeIsTheSameOverTheWholeFlute) {
  std::mt19937 dice(7);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); };
  int solved = 0, bent = 0, shifted = 0;
  for (int i = 0; i < 40 && solved < 4; ++i) {
    const bool left = i % 2 == 1;
    Shop s{draw(4, 14), draw(-1, 11), draw(12, 35), draw(4, 15), draw(10, 30), 0, draw(60, 125), draw(1, 3)};
    s.depth = s.diameter * draw(0.08, 0.17);
    if (left) s.spiral = -s.spiral, s.cut = CutDirection::kLeftHand;
    auto job = jobFor(s);
    if (!job) continue;
    // That away from the rake face.
    GrindProcess& p = job->process();
    (left ? p.wheel_corner_radius_upper : p.wheel_corner_radius_lower) = 0.2 * p.wheel_width;
    SCOPED_TRACE(testing::Message() << i << ": " << toolText(job->cutter, 1) << ", depth " << s.depth << ", wheel "
                                    << s.wheel << " x " << s.width);
    std::optional<ValidJob> with_law;
    try {
      with_law = withLaws(ValidJob(*job));
    } catch (const ReasonError& error) {
      ADD_FAILURE() << text(error.reason());
      continue;
    }
    ++solved;
    if (publishedRakeError(*job) > 0.005) ++bent;
    if (p.setup_x_shift != 0) ++shifted;
    EXPECT_LE(rakeError(groundCutterOf(*with_law), *job), 0.005);
    const brute::Bench bench = brute::benchOf(*job, 200, 40, with_law->zCorrectionOf(0));
    for (const double part : {0.13, 0.5, 0.83}) {
      EXPECT_NEAR(bench.rake(part * job->cutter.flute_length) / kDegree, s.rake, 0.005) << part;
    }
  }
  EXPECT_EQ(solved, 4);
  EXPECT_GE(bent, 2);
  EXPECT_GE(shifted, 2);
}

TEST(ConstantRake, OfAWornWheelTeethShareACorrectionWithTheirSpiralAngle) {
  GrindJob job = steepJob();
  job.tooth_angles = {0, 1.5, 3.1, 4.6};
  job.spiral_angles = {20 * kDegree, 20.2 * kDegree, 20 * kDegree, 20.2 * kDegree};
  job.process().wheel_wear = 5 * kMillimetre;
  const ValidJob with_law = withLaws(ValidJob(job));
  const auto same = [&](int i, int k) {
    return with_law.zCorrectionOf(i).coefficients == with_law.zCorrectionOf(k).coefficients;
  };
  EXPECT_TRUE(same(0, 2) && same(1, 3));
  EXPECT_FALSE(same(0, 1));
  EXPECT_LT(rakeError(groundCutterOf(with_law), job), 0.005);
}

TEST(ConstantRake, TheSameJobGivesTheSameBitsEitherWayOfTheStroke) {
  GrindJob job = steepJob();
  const ValidJob once = withLaws(ValidJob(job));
  // Of a job that was computed before nothing is taken.
  ZCorrection other = once.zCorrectionOf(0);
  other.coefficients[2] += 1e-6;
  const ValidJob again = withLaws(once.withZCorrections({other}));
  EXPECT_EQ(std::memcmp(&again.zCorrectionOf(0), &once.zCorrectionOf(0), sizeof(ZCorrection)), 0);
  job.process().direction = StrokeDirection::kToEnd;
  EXPECT_EQ(withLaws(ValidJob(job)).zCorrectionOf(0).coefficients, once.zCorrectionOf(0).coefficients);
  job.process().z_law = ZLaw::kPublished;
  EXPECT_EQ(withLaws(ValidJob(job)).zCorrectionOf(0).pieces, 0);
}

TEST(ConstantRake, ACylinderNeedsNoCorrection) {
  GrindJob job = jobFor({10, 0, 30, 8, 30, 1.6, 100, 3}).value();
  job.tooth_angles = {0, 3};
  const ValidJob with_law = withLaws(ValidJob(job));
  for (const int tooth : {0, 1}) {
    const ZCorrection& c = with_law.zCorrectionOf(tooth);
    for (double x = -0.01; x < 0.04; x += 0.001) EXPECT_LT(std::abs(c.at(x).z), 1e-9);
  }
}

TEST(ConstantRake, ASetUpThatIsFarOffIsRefusedWithWhatIsGround) {
  GrindJob job = steepJob();
  job.process().setup_swivel += 25 * kDegree;
  Reason reason = refusalOf(job);
  EXPECT_EQ(reason.kind, ReasonKind::kUnevenRake);
  EXPECT_DOUBLE_EQ(reason.limit, 14 * kDegree);
  EXPECT_GT(std::max(reason.value - reason.limit, reason.limit - reason.low), 0.005 * kDegree);
  // A wheel that does not reach the flute.
  job = steepJob();
  job.process().setup_height = 90 * kMillimetre;
  reason = refusalOf(job);
  EXPECT_EQ(reason.kind, ReasonKind::kUnevenRake);
  EXPECT_GT(reason.low, reason.value);
}

TEST(ConstantRake, ItGivesUpWhenToldToAndWithoutCorrectionsNoCutterIsComputed) {
  const GrindJob job = steepJob();
  int looks = 0;
  const PlanWatch never_again = [&](double) { return ++looks < 5; };
  try {
    withLaws(ValidJob(job), never_again);
    FAIL();
  } catch (const ReasonError& error) {
    EXPECT_EQ(error.reason().kind, ReasonKind::kGivenUp);
  }
  EXPECT_EQ(looks, 5);
  EXPECT_THROW(groundCutterOf(ValidJob(job)), std::invalid_argument);
}

}  // namespace test_constant_rake
}  // namespace grinder
