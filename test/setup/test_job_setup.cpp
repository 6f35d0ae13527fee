// The set-up of a job, rounded as in a file, against the ground cutter.

#include "any_tool.h"
#include "flute_grinder/setup/job_setup.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/setup/setup_sheet.h"
#include "flute_grinder/tool/z_law.h"

#include "jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace grinder {
namespace test_job_setup {

using units::kDegree;
using units::kMillimetre;

constexpr Range kMachine{-60 * kDegree, 60 * kDegree};

GrindJob shipped(const std::string& name) { return readJobFile("jobs/" + name + ".yaml"); }

/// The paper's cutter by its published motion.
GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

JobSetup solved(const GrindJob& job, std::optional<SetupFigure> keep = std::nullopt) {
  const auto result = solveJobSetup(job, kMachine, keep);
  if (const auto* refusal = std::get_if<std::string>(&result)) {
    ADD_FAILURE() << *refusal;
    return {};
  }
  return std::get<JobSetup>(result);
}

std::string refused(const GrindJob& job, const Range& machine = kMachine,
                    std::optional<SetupFigure> keep = std::nullopt) {
  const auto result = solveJobSetup(job, machine, keep);
  const auto* refusal = std::get_if<std::string>(&result);
  EXPECT_NE(refusal, nullptr);
  return refusal ? *refusal : "";
}

/// The set-up nearest to a tool that cannot be had.
JobSetup unsolved(const GrindJob& job) {
  const auto result = solveJobSetup(job, kMachine, std::nullopt);
  const auto* setup = std::get_if<JobSetup>(&result);
  EXPECT_TRUE(setup && !setup->check.reasons.empty());
  return setup ? *setup : JobSetup{};
}

void expectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

double rakeAt(const GrindJob& job, double x, std::size_t tooth = 0) {
  return groundCutterOf(ValidJob(job)).section(x).teeth.at(tooth).rake.value() / kDegree;
}

/// The maximum error of the rake over the flute.
double rakeError(const CutterCheck& check) {
  const GroundFigure* rake = find(check.figures, ToolFigure::kRake);
  return rake ? std::max(rake->asked->from - rake->least.value, rake->largest.value - rake->asked->to) : units::kPi;
}

// Their files' set-ups were found by exact fits at the flutes' ends, with the rake's error shared out between ends and
// middle.
TEST(JobSetup, AShippedJobIsSetUpAsWellAsInItsFile) {
  for (const char* entry : {"left_hand_d8_t3", "micro_d05_t2", "mould_cone_d2_t2"}) {
    const GrindJob job = shipped(entry);
    const JobSetup setup = solved(job);
    EXPECT_TRUE(setup.check.reasons.empty()) << text(setup.check.reasons);
    EXPECT_LT(rakeError(setup.check), rakeError(checkGroundCutter(withLaws(ValidJob(job)))) + 0.02 * kDegree) << entry;
    EXPECT_GE(setup.job.process().overtravel_end, setup.overtravel[0]) << entry;
    EXPECT_GE(setup.job.process().overtravel_shank, setup.overtravel[1]) << entry;
    EXPECT_LE(setup.job.process().overtravel_end, std::max(job.process().overtravel_end, setup.overtravel[0] + 1e-5));
    EXPECT_LE(setup.job.process().overtravel_shank,
              std::max(job.process().overtravel_shank, setup.overtravel[1] + 1e-5));
  }
}

/// The job of a steep cone with four teeth, in mm and deg: found at random, with much rake to correct.
GrindJob steep(double diameter, double cone, double spiral, double rake, double length, double core, double wheel,
               double width) {
  GrindJob job = paper();
  job.cutter.end_diameter = diameter * kMillimetre;
  job.cutter.cone_angle = cone * kDegree;
  job.cutter.spiral_angle = spiral * kDegree;
  job.cutter.rake_angle = rake * kDegree;
  job.cutter.flute_length = length * kMillimetre;
  test_support::askForRakeAlone(job.cutter);
  job.cutter.core_diameter = core * kMillimetre;
  job.cutter.core_diameter_end = (core + 2 * length * std::tan(cone * kDegree)) * kMillimetre;
  job.cutter.core_tolerance = 0.3 * kMillimetre;
  job.process().wheel_diameter = wheel * kMillimetre;
  job.process().wheel_width = width * kMillimetre;
  job.process().overtravel_end = job.process().overtravel_shank = 0;
  job.process().infeed = 3 * kMillimetre;
  job.tooth_angles = {0, 90 * kDegree, 180 * kDegree, 270 * kDegree};
  return job;
}

TEST(JobSetup, TheOvertravelIsThatOfTheJobsLawOfZ) {
  GrindJob job = steep(10.11, 10.75, -25.61, 7.54, 25.15, 6.591, 95, 1.86);
  job.cutter.cut = CutDirection::kLeftHand;
  job.process().z_law = ZLaw::kConstantRake;
  const JobSetup setup = solved(job);
  EXPECT_TRUE(setup.check.reasons.empty()) << text(setup.check.reasons);
  const GroundCutter cutter = groundCutterOf(withLaws(ValidJob(setup.job)));
  for (int i = 0; i <= 20; ++i) {
    const double x = job.cutter.flute_length * i / 20;
    EXPECT_TRUE(cutter.section(x).teeth[0].complete) << x;
    EXPECT_NEAR(cutter.section(x).teeth[0].rake.value(), job.cutter.rake_angle, 0.006 * kDegree) << x;
  }
  const GrindProcess& p = setup.job.process();
  EXPECT_GE(p.overtravel_end, setup.overtravel[0]);
  EXPECT_LT(p.overtravel_end, setup.overtravel[0] + 1.1e-5);
  EXPECT_GE(p.overtravel_shank, setup.overtravel[1]);
  EXPECT_LT(p.overtravel_shank, setup.overtravel[1] + 1.1e-5);
  GrindJob less = setup.job;
  less.process().overtravel_end -= 0.1 * kMillimetre;
  less.process().overtravel_shank -= 0.1 * kMillimetre;
  const auto complete = checkGroundCutter(withLaws(ValidJob(less))).complete;
  EXPECT_TRUE(complete && complete->from > 0 && complete->to < less.cutter.flute_length);
  const JobSetup again = solved(setup.job);
  EXPECT_EQ(again.job.process().overtravel_end, p.overtravel_end);
  EXPECT_EQ(again.job.process().overtravel_shank, p.overtravel_shank);
}

TEST(JobSetup, WhatAPlanRefusesSaysSo) {
  JobSetup setup;
  setup.job = paper();
  setup.check = checkGroundCutter(ValidJob(setup.job), groundCutterOf(ValidJob(setup.job)));
  EXPECT_EQ(planRefusal(setup), "");
  setup.job.cutter.rake_angle = 9 * kDegree;
  setup.check = checkGroundCutter(ValidJob(setup.job), groundCutterOf(ValidJob(setup.job)));
  const std::string text = planRefusal(setup);
  expectContains(text, "a plan would refuse this tool: cutter.rake_angle_deg = 9 deg");
  expectContains(text, ", or set process.z_law: constant_rake\n");
  setup.job.process().z_law = ZLaw::kConstantRake;
  EXPECT_EQ(planRefusal(setup).find("or set"), std::string::npos);
}

TEST(JobSetup, UnequalSpiralsAreSetForTheirMiddle) {
  GrindJob job = shipped("roughing_d10_t4");
  const double end = solved(job).job.process().setup_swivel + 1 * kDegree;
  const JobSetup equal = std::get<JobSetup>(solveJobSetup(job, {-60 * kDegree, end}, std::nullopt));
  EXPECT_EQ(equal.limit, SetupLimit::kSwivel);
  EXPECT_NEAR(equal.margin, 1 * kDegree / (end + 60 * kDegree), 1e-12);
  job.spiral_angles = {34.9 * kDegree, 35.1 * kDegree, 34.9 * kDegree, 35.1 * kDegree};
  job.cutter.spiral_angle = job.spiral_angles[0];
  const JobSetup setup = solved(job);
  EXPECT_NEAR(setup.job.process().setup_swivel, equal.job.process().setup_swivel, 1e-4 * kDegree);
  const double low = rakeAt(setup.job, 0.011, 0), high = rakeAt(setup.job, 0.011, 1);
  EXPECT_NEAR((low + high) / 2, 8, 0.02);
  const GroundFigure rake = *find(setup.check.figures, ToolFigure::kRake);
  EXPECT_NEAR(rake.least.value / kDegree, std::min(low, high), 0.01);
  EXPECT_NEAR(rake.largest.value / kDegree, std::max(low, high), 0.01);
}

TEST(JobSetup, ARefusalSaysWhatIsReachableAndWhichKeyToChange) {
  GrindJob job = shipped("roughing_d10_t4");
  std::string text = refused(job, {-20 * kDegree, 30 * kDegree});
  expectContains(text, "takes a swivel of 4");
  expectContains(text, "-20 to 30 deg; change cutter.spiral_angle_deg");
  GrindJob left = job;
  left.cutter.cut = CutDirection::kLeftHand;
  left.cutter.spiral_angle *= -1;
  text = refused(left, {-30 * kDegree, 20 * kDegree});
  expectContains(text, "takes a swivel of -4");
  expectContains(text, "-30 to 20 deg; change cutter.spiral_angle_deg");
  job.process().setup_swivel = 70 * kDegree;
  expectContains(refused(job, kMachine, SetupFigure::kSwivel), "process.setup.swivel_deg = 70 deg");
  job = shipped("roughing_d10_t4");
  job.process().finish_infeed = 6 * kMillimetre;  // more than the radius
  expectContains(refused(job), "process.finish_infeed_mm = 6 mm");
}

/// The number behind a text.
double numberBehind(const std::string& text, const std::string& name) {
  const std::size_t at = text.rfind(name + " = ");
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0 : std::stod(text.substr(at + name.size() + 3));
}

TEST(JobSetup, TheWidthThatARefusalNamesLeavesALand) {
  GrindJob job = steep(6.46, 0, 41.7, 1.2, 12.53, 4.421, 50, 2.4);
  job.tooth_angles.clear();
  for (int i = 0; i < 6; ++i) job.tooth_angles.push_back(i * units::kTurn / 6);
  job.cutter.core_tolerance = 0.05 * kMillimetre;
  job.cutter.rake_tolerance = job.cutter.spiral_tolerance = 0.5 * kDegree;
  const JobSetup none = unsolved(job);
  expectContains(planRefusal(none), "no land is left");
  expectContains(planRefusal(none), "It would be set up with " + none.remedy);
  const double width = numberBehind(none.remedy, "process.wheel.width_mm") * kMillimetre;
  ASSERT_GT(width, 0.5e-3) << none.remedy;
  job.process().wheel_width = width;
  EXPECT_TRUE(solved(job).check.reasons.empty());
}

// A search of many starts found a set-up for the first. The second has one only with a rake that Z corrects by more
// than its tolerance.
TEST(JobSetup, IsFoundOnAnotherBranch) {
  GrindJob far = steep(22.38, 5.6, -28.6, 5.3, 30, 15.683, 125, 8);
  far.cutter.cut = CutDirection::kLeftHand;
  far.cutter.core_diameter_end = 19.498 * kMillimetre;
  far.cutter.core_tolerance = 0.05 * kMillimetre;
  far.process().infeed = 20 * kMillimetre;
  far.tooth_angles = {0, 180 * kDegree};
  GrindJob corrected = steep(4.90283, 5.3549, 23.8265, 1.67397, 6.70135, 3.37216, 100, 0.596759);
  corrected.cutter.core_diameter_end = 4.47506 * kMillimetre;
  corrected.cutter.core_tolerance = 0.05 * kMillimetre;
  corrected.process().wheel_profile = WheelShape::kAngled;
  corrected.process().wheel_angle = 24.9368 * kDegree;
  corrected.tooth_angles = {0, 180 * kDegree};
  corrected.process().z_law = ZLaw::kConstantRake;
  for (GrindJob job : {far, corrected}) {
    job.cutter.rake_tolerance = job.cutter.spiral_tolerance = 0.5 * kDegree;
    const JobSetup setup = solved(job);
    EXPECT_TRUE(setup.check.reasons.empty()) << text(setup.check.reasons);
  }
}

// Of a valley of set-ups that grind the same, all but, each conversion of a number led to another one, of the last tool
// with another swivel by 4.4 deg.
TEST(JobSetup, TheLastBitOfANumberChoosesNoOtherSetup) {
  GrindJob slender = steep(9.33, 2, 23.2, 6.5, 18.32, 6.11, 125, 2.02);
  slender.cutter.core_diameter_end = 7.455 * kMillimetre;
  GrindJob small = steep(2.12, 3.4, 17, 6.4, 3.96, 1.379, 50, 1.12);
  small.cutter.core_diameter_end = 1.797 * kMillimetre;
  small.process().z_law = ZLaw::kConstantRake;
  for (GrindJob job : {slender, small}) {
    job.cutter.rake_tolerance = 0.5 * kDegree;
    job.cutter.spiral_tolerance = 0.3 * kDegree;
    job.cutter.chordal_rake_tolerance = 8 * kDegree;
    job.cutter.core_tolerance = 0.02 * kMillimetre;
    const JobSetup setup = solved(job);
    int nth = 0;
    visitJobFields([&](const JobField&, auto of) { of(job) *= 1 + 1e-12 * (++nth % 3 - 1); });
    const JobSetup shaken = solved(job);
    visitJobFields([&](const JobField& field, auto of) {
      EXPECT_EQ(of(shaken.job), isOfSetup(field) ? of(setup.job) : of(job)) << field.path;
    });
    ASSERT_EQ(shaken.check.figures.size(), setup.check.figures.size());
    for (std::size_t k = 0; k < setup.check.figures.size(); ++k) {
      const GroundFigure &now = shaken.check.figures[k], &was = setup.check.figures[k];
      if (!was.asked) continue;
      EXPECT_NEAR(now.least.value, was.least.value, 1e-3 * was.tolerance) << toString(was.figure);
      EXPECT_NEAR(now.largest.value, was.largest.value, 1e-3 * was.tolerance) << toString(was.figure);
    }
  }
}

TEST(SetupSheet, SaysWhatTheWheelIsAndReads) {
  JobSetup setup;
  setup.job = paper();
  setup.margin = 0.25;  // of 120 deg
  std::string text = setupSheet(setup, kMachine, std::nullopt);
  for (const char* part : {"straight, D 100 mm, 3 mm wide\n", "reads D/2 - 1.288 mm: 3.712 mm for D = 10 mm",
                           "reads (D - 10)/2 mm: 0.000 mm", "30.000 deg from the end of the machine's range"}) {
    expectContains(text, part);
  }
  setup.job.process().wheel_wear = 0.25 * kMillimetre;
  setup.job.process().wheel_profile = WheelShape::kAngled;
  setup.job.process().wheel_angle = 20 * kDegree;
  text = setupSheet(setup, kMachine, std::nullopt);
  expectContains(text, ", 20 deg, larger face upper, worn by 0.25 mm\n");
  expectContains(text, "reads (D - 10)/2 - 0.250 mm: -0.250 mm");
}

TEST(SetupSheet, ReportsHowHighTheWheelStands) {
  const GrindJob job = paper();
  EXPECT_NEAR(upperFaceHeight(job) / kMillimetre, 4.552, 1e-3);
  EXPECT_NEAR(lowerFaceHeight(job) / kMillimetre, 2 * 2.788 - 4.552, 1e-3);
}

// Of the shipped reamer: what the file has is what is found, and its plan takes it.
TEST(JobSetup, OfAReliefTakesTheFlutesSwivelAndReachesOverTheLand) {
  double height = 0;  // of the last
  for (const char* name : {"secondary", "primary"}) {
    const GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", name);
    const JobSetup setup = solved(job);
    EXPECT_TRUE(setup.check.reasons.empty()) << text(setup.check.reasons);
    EXPECT_NEAR(setup.job.process().setup_swivel, job.operations[0].setup_swivel, 1e-4 * kDegree);
    EXPECT_NEAR(setup.job.process().setup_height, job.process().setup_height, 1e-6);
    EXPECT_NEAR(std::remainder(setup.job.process().setup_height, 1e-5 * kMillimetre), 0, 1e-15);  // as in a file
    ASSERT_TRUE(setup.relief);
    EXPECT_GT(setup.relief->next_edge, 1 * kDegree);
    EXPECT_GT(setup.relief->land_end_clearance.value().from, 0);
    height = setup.job.process().setup_height;
  }
  const GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", "primary");
  EXPECT_EQ(refused(job, kMachine, SetupFigure::kHeight), "the height of a relief is not kept; allowed: swivel");
  GrindJob kept = job;
  kept.process().setup_swivel = 13.6 * kDegree;
  const GrindProcess with_kept = solved(kept, SetupFigure::kSwivel).job.process();
  EXPECT_EQ(with_kept.setup_swivel, kept.process().setup_swivel);
  EXPECT_NE(with_kept.setup_height, height);
  // A wheel too narrow for the land of the last relief, and too small for its face to take the rest.
  GrindJob narrow = readJobFile("jobs/taper_reamer_d6_t6.yaml", "secondary");
  for (GrindProcess* p : {&narrow.process(), &narrow.operations[2]}) p->wheel_width = 0.3e-3, p->wheel_diameter = 20e-3;
  expectContains(refused(narrow, {12 * kDegree, 15 * kDegree}), "wide, that of this wheel is 0.3 mm");
}

}  // namespace test_job_setup
}  // namespace grinder
