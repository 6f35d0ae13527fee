#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/curve/relief_path.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/z_law.h"
#include "jobs.h"
#include "motion/examples.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

namespace grinder {
namespace test_operations {

using test_support::refusalOf;
using units::kDegree;
using units::kMillimetre;

constexpr const char* kReamer = "jobs/taper_reamer_d6_t6.yaml";

GrindJob reamer(const std::string& operation) { return readJobFile(kReamer, operation); }

CutterCheck checkOf(const GrindJob& job) { return checkGroundCutter(withLaws(ValidJob(job))); }

std::set<ReasonKind> kindsOf(const CutterCheck& check) {
  std::set<ReasonKind> kinds;
  for (const Reason& reason : check.reasons) kinds.insert(reason.kind);
  return kinds;
}

/// With another height of the set-up, in the operation and in the list.
GrindJob withHeight(GrindJob job, double height) {
  job.process().setup_height = height;
  job.operations[static_cast<std::size_t>(job.operation)].setup_height = height;
  return job;
}

TEST(Operations, AreNamedByNumberOrKindAndNeverGuessed) {
  for (const auto& [name, kind] :
       {std::pair{"1", OperationKind::kFlute}, std::pair{"flute", OperationKind::kFlute},
        std::pair{"2", OperationKind::kPrimaryRelief}, std::pair{"secondary", OperationKind::kSecondaryRelief}}) {
    EXPECT_EQ(reamer(name).process().kind, kind) << name;
  }
  const std::string allowed = "; allowed: 1 or flute, 2 or primary, 3 or secondary";
  EXPECT_EQ(refusalOf([] { reamer(""); }), std::string(kReamer) + ": operation is missing" + allowed);
  EXPECT_EQ(refusalOf([] { reamer("4"); }), std::string(kReamer) + ": operation = 4" + allowed);
  EXPECT_EQ(readJobFile("test/jobs/paper.yaml", "flute").operations.size(), 1u);
  EXPECT_THROW(readJobFile("test/jobs/paper.yaml", "primary"), FileError);
}

TEST(Operations, MayHaveAWheelOfPoints) {
  std::string text = readTextFile("jobs/end_mill_d10_t4.yaml");
  const std::string straight = "      width_mm: 3\n      profile: straight\n";
  ASSERT_NE(text.find(straight), std::string::npos);
  text.replace(text.find(straight), straight.size(),
               "      width_mm: 3\n      profile: points\n      points_mm: [[-1.5, 50], [1.5, 49]]\n");
  const std::string solved = "    setup: {file: end_mill_d10_t4.setup.yaml}\n";
  text.replace(text.find(solved), solved.size(),
               "    depth_mm: 1.6\n    overtravel_mm: [3.5, 1]\n    setup: {swivel_deg: 43.32, height_mm: -1.366}\n");
  const GrindJob job = parseJob(text, std::filesystem::absolute("jobs/mill.yaml"), "flute");
  ASSERT_EQ(job.process().wheel_points.size(), 2u);
  EXPECT_DOUBLE_EQ(job.process().wheel_points[1].radius, 49 * kMillimetre);
}

// What a relief leaves out and may take from the flutes, and what it may not.
TEST(Operations, TakeWhatTheReferenceSaysFromTheOneAhead) {
  const GrindJob flute = reamer("flute"), primary = reamer("primary");
  EXPECT_EQ(primary.process().clearance, flute.process().clearance);
  EXPECT_EQ(primary.process().direction, flute.process().direction);
  EXPECT_EQ(primary.process().order, flute.process().order);
  EXPECT_EQ(primary.process().spark_out, flute.process().spark_out);
  EXPECT_NE(primary.process().feed, flute.process().feed);
  EXPECT_EQ(primary.process().depth, 0);
  EXPECT_EQ(primary.process().setup_x_shift, 0);
}

TEST(Operations, EachHasItsDigestAndKnowsWhatWasGroundBefore) {
  std::set<std::string> digests;
  for (const char* name : {"flute", "primary", "secondary"}) digests.insert(jobDigest(reamer(name)));
  EXPECT_EQ(digests.size(), 3u);
  GrindJob other = reamer("secondary");
  other.operations[1].setup_swivel += 1e-3;  // of the primary relief
  EXPECT_NE(jobDigest(other), jobDigest(reamer("secondary")));
  other = reamer("primary");
  other.operations[2].setup_swivel += 1e-3;  // of what comes after
  EXPECT_EQ(jobDigest(other), jobDigest(reamer("primary")));
}

TEST(Operations, AreRefusedWhereTheyDoNotFollowOneAnother) {
  const struct {
    const char* operation;
    std::function<void(GrindJob&)> change;
    const char* reason;  ///< the only one
  } rows[]{
      {"primary", [](GrindJob& j) { std::swap(j.operations[1], j.operations[2]); },
       "process.kind = 2; allowed: 1 to 1"},
      {"primary", [](GrindJob& j) { j.operation = 3; }, "operation = 3; allowed: 0 to 2"},
      {"primary", [](GrindJob& j) { j.operations.clear(); }, "operations = 0; allowed: 1 to 7"},
      {"primary", [](GrindJob& j) { j.operations[0].kind = OperationKind::kGash; },
       "process.kind = 3; allowed: 0 to 0"},
      {"primary", [](GrindJob& j) { j.cutter.clearance = 0; },
       "cutter.clearance_deg = 0 deg; allowed: more than 0 with a relief"},
      {"secondary", [](GrindJob& j) { j.cutter.land = 0; },
       "cutter.land_mm = 0 mm; allowed: more than 0 with a secondary relief"},
      {"flute", [](GrindJob& j) { j.process().behind = 1e-4; },
       "process.behind_mm = 0.1 mm; allowed: 0 for this operation"},
      {"primary", [](GrindJob& j) { j.process().wheel_profile = WheelShape::kFullRadius; },
       "process.wheel.profile = 2; allowed: 0, straight, for a relief: its cylinder is what grinds it"},
  };
  for (const auto& row : rows) {
    GrindJob job = reamer(row.operation);
    row.change(job);
    EXPECT_EQ(text(validate(job)), row.reason);
  }
}

// Every setpoint of a relief's stroke is on the closed form: P(s) + R N - q w, with the edge of the flutes.
TEST(Operations, AReliefsStrokesAreTheClosedForm) {
  for (const char* name : {"primary", "secondary"}) {
    GrindJob asked = reamer(name);
    asked.process().roughing_passes = 0;
    asked.process().infeed = 0.05e-3;
    const ValidJob job = withLaws(ValidJob(asked));
    const ConicalCutter cutter(job->cutter);
    CutterGeometry as_ground = job->cutter;
    as_ground.spiral_angle = job.edges()[0].spiral_angle;
    const LogCurve edge{ConicalCutter(as_ground)};
    const ReliefPath& path = *job.relief(0);
    const double last = job.deepest();
    Machine machine = test_support::roomyMachine();
    std::map<std::uint16_t, int> strokes;
    const JobPlan plan = planJob(job, machine, machine.park, [&](const Setpoint& p) {
      if (p.move != MoveKind::kStroke) return;
      const auto tooth = static_cast<std::size_t>(p.tooth);
      const double s = p.position[kX] - path.xShift(), depth = job.depths()[p.pass];
      ++strokes[p.tooth];
      ASSERT_NEAR(p.position[kA] + p.path_error,
                  job->tooth_angles[tooth] + job.edges()[tooth].ahead + edge.a(s) + path.a(), 1e-9);
      ASSERT_NEAR(p.position[kY], path.y() + p.position[kX] * (cutter.tanCone() + path.taper()) + last - depth, 1e-12);
      ASSERT_NEAR(p.position[kZ], p.position[kX] * cutter.tanCone() * path.cutter().zPerY(), 1e-12);
    });
    ASSERT_TRUE(plan.good()) << text(plan.reasons);
    EXPECT_EQ(strokes.size(), job->tooth_angles.size());
    EXPECT_LT(plan.statistics.max_even_error, 1e-9);
    // From where the wheel first touches to the full depth, in infeeds.
    for (std::size_t i = 1; i < job.depths().size(); ++i) {
      EXPECT_LE(job.depths()[i] - job.depths()[i - 1], job->process().infeed * (1 + 1e-9));
    }
    EXPECT_LE(job.depths().front(), job->process().infeed * (1 + 1e-9));
    EXPECT_EQ(job.depths().back(), path.depth());
  }
}

TEST(Operations, AReliefThatWouldSpoilTheToolIsRefused) {
  // Of the primary, 0.15 mm of the rim are behind the edge, where the secondary is to begin at 0.3 mm.
  EXPECT_EQ(kindsOf(checkOf(withHeight(reamer("primary"), -4.19e-3))), std::set<ReasonKind>{ReasonKind::kHeel});
  // A secondary with less clearance than the primary in front of it goes below that before the land's end.
  GrindJob flat = reamer("secondary");
  flat.cutter.second_clearance = 6 * kDegree;
  const std::set<ReasonKind> spoils = kindsOf(checkOf(withHeight(flat, -3.4e-3)));
  for (const ReasonKind kind : {ReasonKind::kClearance, ReasonKind::kPrimaryLand, ReasonKind::kUndercut}) {
    EXPECT_EQ(spoils.count(kind), 1u) << toString(kind);
  }
  // A corner is none of the rim: neither where the relief ends, nor where it begins.
  GrindJob round = reamer("secondary");
  GrindProcess& own = round.operations[2];
  round.process().wheel_corner_radius_upper = own.wheel_corner_radius_upper = 0.5e-3;
  EXPECT_EQ(kindsOf(checkOf(round)), std::set<ReasonKind>{ReasonKind::kHeel});
  round.process().wheel_corner_radius_lower = own.wheel_corner_radius_lower = 5e-3;
  EXPECT_THROW(checkOf(round), InvalidJob);
}

// With another shift the flutes leave an edge that is up to 1 deg off the asked helix, along which a relief would take
// more off it than is allowed.
TEST(Operations, AReliefFollowsTheEdgeAsItIsGround) {
  GrindJob job = reamer("secondary");
  job.cutter.spiral_tolerance = 1 * kDegree;
  job.operations[0].setup_x_shift += 3e-3;
  const CutterCheck check = checkOf(job);
  EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
  EXPECT_GT(find(check.figures, ToolFigure::kOffHelix)->largest.value, 0.9 * kDegree);
  const GroundFigure clearance = *find(check.figures, ToolFigure::kClearance);
  EXPECT_NEAR(clearance.least.value, clearance.largest.value, 0.02 * kDegree);
}

TEST(Operations, ALandIsNotWiderThanTheRimOfThePrimaryReachesBehindTheEdge) {
  GrindJob job = reamer("secondary");
  const double reach = ValidJob(job.ofOperation(1)).relief(0)->reach();
  job.cutter.land = reach * 1.5;
  const std::string said = refusalOf<InvalidJob>([&] { ValidJob{job}; });
  EXPECT_NE(said.find("cutter.land_mm = " + text(Quantity{job.cutter.land, Unit::kMetre})), std::string::npos) << said;
  EXPECT_NE(said.find("reaches only " + text(Quantity{reach, Unit::kMetre}, 3)), std::string::npos) << said;
}

/// What is ground of the shipped roughing cutter with a primary relief whose wheel, of 100 mm, has the edge at a place
/// of its rim. @param width,contact [m]
CutterCheck checkOfRoughing(double clearance, double width, double swivel, double contact, double core_tolerance) {
  GrindJob job = test_support::jobOf("roughing_d10_t4");
  job.cutter.core_tolerance = core_tolerance;
  job.cutter.clearance = clearance;
  job.cutter.clearance_tolerance = 0.5 * kDegree;
  GrindProcess relief;
  relief.kind = OperationKind::kPrimaryRelief;
  relief.feed = 5e-3, relief.infeed = 0.1e-3, relief.clearance = 3e-3;
  relief.wheel_diameter = 100e-3, relief.wheel_width = width;
  relief.setup_swivel = swivel;
  relief.setup_height =
      ReliefPath::heightFor(ConicalCutter(job.cutter), {clearance}, {50e-3, 0, width, swivel, 0}, contact);
  job.operations.push_back(relief);
  return checkOf(job.ofOperation(1));
}

// A steep and wide one goes over the next flute's floor. How deep it may go there is for the core's tolerance to say.
TEST(Operations, AReliefThatTakesTheCoreIsRefused) {
  const CutterGeometry cutter = test_support::jobOf("roughing_d10_t4").cutter;
  const auto with_contact = [](double contact, double core_tolerance) {
    return checkOfRoughing(24 * kDegree, 4e-3, 25 * kDegree, contact, core_tolerance);
  };
  EXPECT_TRUE(with_contact(-1e-3, cutter.core_tolerance).reasons.empty());
  const CutterCheck deep = with_contact(-2e-3, cutter.core_tolerance);
  ASSERT_EQ(kindsOf(deep), std::set<ReasonKind>{ReasonKind::kCoreSize}) << text(deep.reasons);
  EXPECT_LE(find(deep.figures, ToolFigure::kCoreDiameter)->least.value, deep.reasons.front().value);
  EXPECT_LT(deep.reasons.front().value, cutter.core_diameter - 0.5e-3);
  EXPECT_NE(text(deep.reasons).find("change the height or the swivel of the relief's set-up"), std::string::npos);
  EXPECT_TRUE(with_contact(-2e-3, 0.6e-3).reasons.empty());
}

// A wheel 100 x 8 whose rim has the edge 1 mm from its lower face takes 93 of the 90 deg to the next one.
TEST(Operations, AReliefAsWideAsThePitchIsRefused) {
  const auto with_contact = [](double contact) {
    return checkOfRoughing(9 * kDegree, 8e-3, 43 * kDegree, contact, 0.02e-3);
  };
  const CutterCheck check = with_contact(-3e-3);
  ASSERT_EQ(kindsOf(check), std::set<ReasonKind>{ReasonKind::kNextEdge}) << text(check.reasons);
  EXPECT_NEAR(check.reasons.front().value / kDegree, 93 - 90, 0.5) << text(check.reasons);
  // With less of the rim behind the edge, the same wheel leaves the next tooth alone.
  EXPECT_EQ(kindsOf(with_contact(0)).count(ReasonKind::kNextEdge), 0u);
}

}  // namespace test_operations
}  // namespace grinder
