#include "flute_grinder/record/verdict.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/tool_figure.h"
#include "flute_grinder/tool/z_law.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

/// @file
/// The verdict on a run of a tool, all of whose figures are as asked, with one of them changed.

namespace grinder {
namespace test_verdict {

using namespace units;

const Tolerances kTolerances{0.5, 0.02, 64, 5, 1};
using Names = std::vector<std::string>;
const Names kFlutes{"rake", "chordal rake", "spiral angle", "core diameter", "land"};
const Names kRun{"path deviation", "following error in strokes", "feed constancy", "late cycles"};

Names operator+(Names names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

/// A run, and what is measured of its tool.
struct Ground {
  explicit Ground(const GrindJob& asked)
      : job(withLaws(ValidJob(asked))), tool(measure(job, "", groundCutterOf(job), evenSections(*job, 3))) {
    tool.of_run = true;
    for (int tooth = 0; tooth < job.teeth(); ++tooth) {
      tool.strokes.push_back({{tooth, 0}, MoveKind::kStroke, {0, 1}, {}});
      StrokeFigures& stroke = strokes.emplace_back();
      stroke.place = {tooth, 0};
      stroke.has_feed = true;
      stroke.min_feed = 0.99 * job->process().feed;
      stroke.max_feed = 1.01 * job->process().feed;
      stroke.min_feed_x = 7 * kMillimetre;
      stroke.deviation_x = 4.5 * kMillimetre;
    }
    for (MeasuredSection& section : tool.sections) makeAsAsked(section.ground);
  }

  void makeAsAsked(GroundSection& section) {
    section.core_radius = askedCore(job->cutter, section.x) / 2;
    for (std::size_t i = 0; i < section.teeth.size(); ++i) {
      ToothSection& tooth = section.teeth[i];
      tooth.complete = true;
      tooth.rake = tooth.chordal_rake = job->cutter.rake_angle;
      tooth.spiral = job.cutterOf(static_cast<int>(i)).spiral_angle;
      tooth.flute = 1;
      tooth.land = kMillimetre / section.radius;
      if (job.relief(0) == nullptr) continue;
      tooth.relief.emplace();
      tooth.relief->clearance = job->cutter.clearance;
      tooth.relief->second_clearance = job->cutter.second_clearance;
      tooth.relief->land = job->cutter.land;
      tooth.relief->edge_radius = section.radius;
    }
  }

  ToothSection& tooth(std::size_t section, std::size_t number) { return tool.sections[section].ground.teeth[number]; }

  std::vector<Criterion> criteria() const {
    std::vector<Criterion> all = criteriaOfTool(job, measured ? &tool : nullptr, kTolerances);
    for (const Criterion& criterion : criteriaOfRun({job, strokes, limits, 1000, late, 0.00125}, kTolerances)) {
      all.push_back(criterion);
    }
    return all;
  }
  Verdict verdict() const { return verdictOn(criteria(), outcome, lost); }

  ValidJob job;
  GroundTool tool;
  bool measured = true;
  std::vector<StrokeFigures> strokes;
  std::vector<FeedLimit> limits;
  std::uint64_t late = 0, lost = 0;
  std::string outcome = "done";
};

/// Two teeth of a cone whose largest radius is 7.62 mm.
GrindJob fluteJob() {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  job.tooth_angles = {0, kPi};
  return job;
}

Ground flutes() {
  static const Ground good(fluteJob());
  return good;
}
Ground reliefs(const char* operation) { return Ground(readJobFile("jobs/end_mill_d10_t4.yaml", operation)); }

Criterion criterion(const Ground& run, const std::string& name) {
  for (const Criterion& line : run.criteria()) {
    if (line.name == name) return line;
  }
  ADD_FAILURE() << name;
  return {};
}

Names namesOf(const Ground& run, const std::string& result) {
  Names names;
  for (const Criterion& line : run.criteria()) {
    if (line.result() == result) names.push_back(line.name);
  }
  return names;
}

void expectVerdict(const Ground& run, const std::string& verdict, const Names& because) {
  EXPECT_EQ(run.verdict().verdict, verdict);
  EXPECT_EQ(run.verdict().because, because);
}

/// A criterion's figure, within its tolerance and beyond it.
struct Edge {
  const char* name;
  std::function<void(Ground&, double value)> set;
  double within, beyond;
  const char* place;
};

void expectEdge(const Ground& good, const Edge& edge) {
  SCOPED_TRACE(edge.name);
  Ground run = good;
  edge.set(run, edge.within);
  expectVerdict(run, "passed", {});
  edge.set(run, edge.beyond);
  expectVerdict(run, "failed", {edge.name});
  EXPECT_EQ(criterion(run, edge.name).place, edge.place);
}

TEST(Verdict, PassedByAllCriteria) {
  const Ground run = flutes();
  EXPECT_EQ(namesOf(run, "passed"), kFlutes + Names{"gouge"} + kRun);
  expectVerdict(run, "passed", {});
  Ground off = run;
  off.strokes[0].deviation = 0.5 * kMicrometre;
  EXPECT_EQ(toJson(std::vector<Criterion>{criterion(off, "path deviation")})[0], Json::parse(R"({
    "name": "path deviation", "unit": "\u00b5m", "of_tool": false, "digits": null, "asked": 0.0, "measured": 0.5,
    "tolerance": 1.0, "missing": false, "place": "tooth 1, pass 1, X = 4.500 mm", "remark": "", "result": "passed"})"));
}

TEST(Verdict, EachCriterionPassesWithinItsToleranceAndFailsBeyond) {
  const Ground good = flutes();
  const double feed = good.job->process().feed;
  const Edge edges[]{
      {"path deviation", [](Ground& r, double v) { r.strokes[1].deviation = v * kMicrometre; }, 1, 1.001,
       "tooth 2, pass 1, X = 4.500 mm"},
      {"rake", [](Ground& r, double v) { r.tooth(1, 1).rake = v * kDegree; }, 8.499, 8.501, "tooth 2, X = 15.000 mm"},
      {"rake", [](Ground& r, double v) { r.tooth(1, 1).rake = v * kDegree; }, 7.501, 7.499, "tooth 2, X = 15.000 mm"},
      {"chordal rake", [](Ground& r, double v) { r.tooth(2, 0).chordal_rake = v * kDegree; }, 2.001, 1.999,
       "tooth 1, X = 30.000 mm"},
      {"spiral angle", [](Ground& r, double v) { r.tooth(0, 0).spiral = v * kDegree; }, 26.001, 25.999,
       "tooth 1, X = 0.000 mm"},
      {"core diameter", [](Ground& r, double v) { r.tool.sections[0].ground.core_radius = v * kMillimetre / 2; }, 7.199,
       7.201, "X = 0.000 mm"},
      {"land", [](Ground& r, double v) { r.tooth(0, 1).land = v / 5; }, 0.501, 0.499, "tooth 2, X = 0.000 mm"},
      {"following error in strokes", [](Ground& r, double v) { r.strokes[0].following_error[kZ] = v * kMicrometre; },
       64, 64.001, "axis Z, tooth 1, pass 1"},
      // 64 um at the maximum radius, 5 mm + 30 mm tan 5 deg
      {"following error in strokes", [](Ground& r, double v) { r.strokes[0].following_error[kA] = v; }, 64e-3 / 7.6247,
       64e-3 / 7.6245, "axis A, tooth 1, pass 1"},
      {"feed constancy", [&](Ground& r, double v) { r.strokes[1].min_feed = v * feed; }, 0.951, 0.949,
       "tooth 2, pass 1, X = 7.000 mm"},
      {"feed constancy", [&](Ground& r, double v) { r.strokes[1].max_feed = v * feed; }, 1.049, 1.051,
       "tooth 2, pass 1"},
      {"late cycles", [](Ground& r, double v) { r.late = static_cast<std::uint64_t>(v); }, 10, 11,
       "11 of 1000 cycles, the longest 1.250 ms"},
  };
  for (const Edge& edge : edges) expectEdge(good, edge);
  // That of the land is a minimum.
  EXPECT_EQ(criterion(good, "land").asked, 0.5);
  EXPECT_FALSE(criterion(good, "land").tolerance);
}

TEST(Verdict, GougesOfAllPassesBeyondTheToleranceAreNamed) {
  Ground run = flutes();
  const auto gouge = [&](int pass, MoveKind move, double depth) {
    run.tool.gouges.push_back({{1, pass}, move, 3 * kMillimetre, depth * kMillimetre});
  };
  gouge(0, MoveKind::kStroke, 0.0499);  // half of the core's tolerance is 0.05
  expectVerdict(run, "passed", {});
  gouge(1, MoveKind::kStroke, 0.2);
  gouge(2, MoveKind::kRetract, 0.3);
  gouge(3, MoveKind::kStroke, 0.0501);
  expectVerdict(run, "failed", {"gouge"});
  EXPECT_EQ(criterion(run, "gouge").place,
            "tooth 2, pass 3, retract, X = 3.000 mm; also tooth 2, pass 2, stroke; tooth 2, pass 4, stroke");
}

TEST(Verdict, AReliefIsJudgedByClearanceWidthOfThePrimaryAndEdge) {
  const Ground good = reliefs("secondary");
  const Names own{"clearance", "second clearance", "primary relief", "edge diameter", "gouge"};
  EXPECT_EQ(namesOf(good, "passed"), kFlutes + own + kRun);
  const Edge edges[]{
      {"clearance", [](Ground& r, double v) { r.tooth(2, 1).relief->clearance = v * kDegree; }, 10.499, 10.501,
       "tooth 2, X = 22.000 mm"},
      {"second clearance", [](Ground& r, double v) { r.tooth(1, 0).relief->second_clearance = v * kDegree; }, 19.501,
       19.499, "tooth 1, X = 11.000 mm"},
      {"primary relief", [](Ground& r, double v) { r.tooth(0, 1).relief->land = v * kMillimetre; }, 0.4199, 0.4201,
       "tooth 2, X = 0.000 mm"},
      {"edge diameter", [](Ground& r, double v) { r.tooth(0, 3).relief->edge_radius = v * kMillimetre / 2; }, 9.9801,
       9.9799, "tooth 4, X = 0.000 mm"}};
  for (const Edge& edge : edges) expectEdge(good, edge);
  Ground none = good;
  none.tooth(0, 0).relief->clearance.reset();
  expectVerdict(none, "failed", {"clearance"});
}

TEST(Verdict, APrimaryReliefIsAsWideAsAskedOnlyBehindASecondaryOneAndOnPlannedFlutesTheyAreNotMeasured) {
  Ground run = reliefs("primary");
  for (ToothSection& tooth : run.tool.sections[0].ground.teeth) tooth.relief->land = 1.5 * kMillimetre;
  expectVerdict(run, "passed", {});
  run.tool.on_planned = true;
  EXPECT_EQ(namesOf(run, "not measured"), kFlutes);
  EXPECT_EQ(run.verdict().verdict, "incomplete");
}

TEST(Verdict, WhatIsNotThereFails) {
  Ground run = flutes();
  run.tooth(2, 1).rake.reset();
  expectVerdict(run, "failed", {"rake"});
  EXPECT_EQ(criterion(run, "rake").remark, "there is none");
  EXPECT_FALSE(criterion(run, "rake").measured);
  Ground nan = flutes();
  nan.tool.sections[2].ground.core_radius = std::nan("");
  nan.strokes[0].following_error[kX] = std::nan("");
  expectVerdict(nan, "failed", {"core diameter", "following error in strokes"});
}

TEST(Verdict, IncompleteFluteHasNoRakeOnlyWhereTheJobAllowsIt) {
  Ground run = flutes();
  run.tooth(0, 0).complete = false;
  expectVerdict(run, "failed", {"rake", "chordal rake"});
  GrindJob allowed = fluteJob();
  allowed.process().incomplete_ok = true;
  Ground other(allowed);
  other.tooth(0, 0).complete = false;
  expectVerdict(other, "passed", {});
}

TEST(Verdict, FeedThatThePlanReducesIsNotJudged) {
  Ground run = flutes();
  const struct {
    double from, to;
    bool judged;
  } rows[]{{-0.5, 3.9, false}, {29.9, 31.0, false}, {3.9, -0.5, false}, {30.0, 36.0, true}, {-1.0, 0.0, true}};
  for (const auto& row : rows) {
    run.limits = {{"axis A jerk", row.from * kMillimetre, row.to * kMillimetre}};
    row.judged ? expectVerdict(run, "passed", {}) : expectVerdict(run, "incomplete", {"feed constancy: not measured"});
    const std::string remark = criterion(run, "feed constancy").remark;
    if (row.to == -0.5) {
      EXPECT_EQ(remark, "the plan slows down: axis A jerk, X 3.900 to -0.500 mm");
    }
  }
}

TEST(Verdict, JobsThatDidNotEndWell) {
  Ground run = flutes();
  run.outcome = "canceled";
  expectVerdict(run, "failed", {"the job ended as canceled"});
  run.outcome = "done";
  run.lost = 3;
  expectVerdict(run, "incomplete", {"3 setpoints are not in the file"});
  run.lost = 0;
  run.outcome = "";
  expectVerdict(run, "unfinished", {"the end of the job is not in the file"});
  run.strokes[0].deviation = 3 * kMicrometre;
  expectVerdict(run, "failed", {"path deviation"});
}

TEST(Verdict, WhatIsNotMeasuredIsNeverPassed) {
  Ground run = flutes();
  run.tool.strokes.pop_back();
  EXPECT_EQ(namesOf(run, "not measured"), kFlutes);
  EXPECT_EQ(criterion(run, "gouge").result(), std::string("passed"));
  EXPECT_EQ(run.verdict().verdict, "incomplete");
  run.measured = false;
  EXPECT_EQ(namesOf(run, "not measured"), kFlutes + Names{"gouge"});
  EXPECT_EQ(run.verdict().verdict, "incomplete");
}

TEST(Verdict, CriteriaAreReadAsTheyWereWritten) {
  Ground run = flutes();
  run.tooth(0, 0).rake.reset();
  run.limits = {{"axis A jerk", 0, 2 * kMillimetre}};
  const Json written = toJson(run.criteria());
  EXPECT_EQ(toJson(criteriaFrom(Json::parse(written.dump()))), written);
}

/// What is said of a file with this text, without its path.
std::string refusal(const std::string& text) {
  const test_support::TempFolder folder;
  const std::string path = folder.path() / "tolerances.yaml";
  std::ofstream(path) << text;
  const std::string said = test_support::refusalOf([&] { readTolerances(path); });
  EXPECT_EQ(said.substr(0, path.size()), path);
  return said.substr(path.size());
}

TEST(Tolerances, AreThoseOfTheFileAndBadOnesAreNamed) {
  const Tolerances read = readTolerances("config/tolerances.yaml");
  EXPECT_EQ(read.land_mm, 0.05);
  EXPECT_EQ(read.edge_diameter_mm, 0.02);
  EXPECT_EQ(read.following_error_um, 50);
  EXPECT_EQ(read.feed_percent, 5);
  EXPECT_EQ(read.late_cycles_percent, 1);
  const std::string whole = "edge_diameter_mm: 1\nfollowing_error_um: 1\nfeed_percent: 1\nlate_cycles_percent: 1\n";
  EXPECT_EQ(refusal(whole), ":1: land_mm is missing; allowed: a number from 0");
  EXPECT_NE(refusal(whole + "land_mm: 1\nland: 1").find("land"), std::string::npos);
  for (const std::string wrong : {"-1", ".nan", ".inf", "true", "wide", "[1]"}) {
    EXPECT_NE(refusal(whole + "land_mm: " + wrong).find("; allowed: a number from 0"), std::string::npos) << wrong;
  }
  EXPECT_THROW(readTolerances("config/none.yaml"), FileError);
}

}  // namespace test_verdict
}  // namespace grinder
