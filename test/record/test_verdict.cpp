#include "flute_grinder/record/verdict.h"

#include "flute_grinder/job/yaml_text.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// @file
/// The verdict on a bag's job of two teeth, all of whose figures are as asked, with one of them changed.

namespace grinder {
namespace test_verdict {

const Tolerances kTolerances{0.5, 0.02, 64, 5, 1};
const std::vector<std::string> kNames{"path deviation", "rake",         "chordal rake", "core diameter",
                                      "land",           "spiral angle", "gouge",        "following error in strokes",
                                      "feed constancy", "late cycles"};

/// A bag's job. The cutter's maximum radius is 25 mm.
Json document() {
  Json data = Json::parse(R"({
    "kind": "bag", "outcome": "done", "setpoints": {"written": 1000, "lost": 0},
    "late_cycles": {"count": 0, "longest_ms": 1.25},
    "job": {"file": {
      "cutter": {"end_diameter_mm": 10, "cone_angle_deg": 45, "flute_length_mm": 20, "rake_angle_deg": 8,
                 "rake_tolerance_deg": 0.5, "chordal_rake_tolerance_deg": 4, "core_tolerance_mm": 0.25,
                 "spiral_tolerance_deg": 0.25},
      "process": {"feed_mm_min": 100}, "interpolation": {"tolerance_um": 2}}},
    "strokes": [],
    "tool": {"teeth": 2, "strokes": [{"tooth": 0}, {"tooth": 1}], "gouges": [], "sections": []}})");
  for (const int tooth : {1, 2}) {
    data["strokes"].push_back({{"tooth", tooth},
                               {"pass", 1},
                               {"deviation_um", 1},
                               {"deviation_x_mm", 4.5},
                               {"following_error", {{"x_um", 1}, {"y_um", 1}, {"z_um", 1}, {"a_mdeg", 1}}},
                               {"feed_min_mm_min", 99},
                               {"feed_min_x_mm", 7},
                               {"feed_max_mm_min", 101}});
  }
  const Json tooth{{"complete", true}, {"rake_deg", 8},    {"chordal_rake_deg", 6},
                   {"land_mm", 1},     {"spiral_deg", 30}, {"asked_spiral_deg", 30}};
  for (const int x : {0, 10, 20}) {
    data["tool"]["sections"].push_back(
        {{"x_mm", x}, {"core_diameter_mm", 6 + x}, {"asked_core_diameter_mm", 6 + x}, {"teeth", {tooth, tooth}}});
  }
  return data;
}

Json& at(Json& data, const std::string& path) { return data[Json::json_pointer(path)]; }

Json judged(Json data) {
  addVerdict(data, kTolerances);
  return data;
}

/// Of a document with one value changed.
Json judgedWith(const std::string& path, const Json& value) {
  Json data = document();
  at(data, path) = value;
  return judged(data);
}

Json criterion(const Json& judged, const std::string& name) {
  for (const Json& line : judged["criteria"]) {
    if (line["name"] == name) return line;
  }
  ADD_FAILURE() << name;
  return {};
}

std::vector<std::string> namesOf(const Json& judged, const std::string& result) {
  std::vector<std::string> names;
  for (const Json& line : judged["criteria"]) {
    if (line["result"] == result) names.push_back(line["name"]);
  }
  return names;
}

/// A criterion's figure, at its tolerance and beyond it.
struct Edge {
  const char* name;
  const char* path;
  double at, beyond;
  const char* place;
};

void expectVerdict(const Json& judged, const std::string& verdict, const std::vector<std::string>& because) {
  EXPECT_EQ(judged["verdict"], verdict);
  EXPECT_EQ(judged["verdict_because"], Json(because));
}

void expectEdge(Json data, const Edge& edge) {
  SCOPED_TRACE(edge.path);
  at(data, edge.path) = edge.at;
  expectVerdict(judged(data), "passed", {});
  at(data, edge.path) = edge.beyond;
  const Json beyond = judged(data);
  expectVerdict(beyond, "failed", {edge.name});
  EXPECT_EQ(criterion(beyond, edge.name)["place"], edge.place);
}

TEST(Verdict, PassedByAllCriteria) {
  const Json data = judged(document());
  EXPECT_EQ(namesOf(data, "passed"), kNames);
  expectVerdict(data, "passed", {});
  EXPECT_EQ(data["criteria"][0], Json::parse(R"({
    "name": "path deviation", "unit": "\u00b5m", "digits": null, "asked": 0, "measured": 1, "tolerance": 2,
    "place": "tooth 1, pass 1, X = 4.500 mm", "result": "passed", "remark": ""})"));
}

TEST(Verdict, EachCriterionPassesAtItsToleranceAndFailsBeyond) {
  const Edge edges[]{
      {"path deviation", "/strokes/1/deviation_um", 2, 2.001, "tooth 2, pass 1, X = 4.500 mm"},
      {"rake", "/tool/sections/1/teeth/1/rake_deg", 8.5, 8.501, "tooth 2, X = 10.000 mm"},
      {"rake", "/tool/sections/1/teeth/1/rake_deg", 7.5, 7.499, "tooth 2, X = 10.000 mm"},
      {"chordal rake", "/tool/sections/2/teeth/0/chordal_rake_deg", 4, 3.999, "tooth 1, X = 20.000 mm"},
      {"core diameter", "/tool/sections/1/core_diameter_mm", 16.25, 16.251, "X = 10.000 mm"},
      {"core diameter", "/tool/sections/1/core_diameter_mm", 15.75, 15.749, "X = 10.000 mm"},
      {"land", "/tool/sections/0/teeth/1/land_mm", 0.5, 0.499, "tooth 2, X = 0.000 mm"},
      {"spiral angle", "/tool/sections/0/teeth/0/spiral_deg", 29.75, 29.749, "tooth 1, X = 0.000 mm"},
      {"following error in strokes", "/strokes/0/following_error/z_um", 64, 64.001, "Z, tooth 1, pass 1"},
      // 64 um at the maximum radius
      {"following error in strokes", "/strokes/0/following_error/a_mdeg", 146.67, 146.68, "A, tooth 1, pass 1"},
      {"feed constancy", "/strokes/1/feed_min_mm_min", 95, 94.999, "tooth 2, pass 1, X = 7.000 mm"},
      {"feed constancy", "/strokes/1/feed_max_mm_min", 105, 105.001, "tooth 2, pass 1"},
      {"late cycles", "/late_cycles/count", 10, 11, "11 of 1000 cycles, the longest 1.250 ms"},
  };
  for (const Edge& edge : edges) expectEdge(document(), edge);
  // That of the land is a minimum.
  const Json land = criterion(judged(document()), "land");
  EXPECT_EQ(land["asked"], 0.5);
  EXPECT_TRUE(land["tolerance"].is_null());
}

TEST(Verdict, AToolIsJudgedByTheTolerancesOfItsJob) {
  const struct {
    const char* key;
    double value;
    const char* failed;
  } cases[]{{"rake_angle_deg", 7.25, "rake"},
            {"chordal_rake_tolerance_deg", 1.9, "chordal rake"},
            {"core_tolerance_mm", 0.02, "core diameter"},
            {"spiral_tolerance_deg", 0.1, "spiral angle"}};
  Json data = document();
  // The worst is not the last.
  at(data, "/tool/sections/1/core_diameter_mm") = 16.03;
  for (const int i : {0, 1, 2}) data["tool"]["sections"][i]["teeth"][1]["spiral_deg"] = 30.2;
  expectVerdict(judged(data), "passed", {});
  for (const auto& c : cases) {
    Json narrow = data;
    narrow["job"]["file"]["cutter"][c.key] = c.value;
    expectVerdict(judged(narrow), "failed", {c.failed});
  }
}

TEST(Verdict, GougesOfAllPassesBeyondTheToleranceAreNamed) {
  Json data = document();
  const auto gouge = [&](int pass, const char* move, double depth) {
    data["tool"]["gouges"].push_back({{"tooth", 1}, {"pass", pass}, {"move", move}, {"depth_mm", depth}, {"x_mm", 3}});
  };
  gouge(0, "stroke", 0.125);  // half of the core's tolerance
  expectVerdict(judged(data), "passed", {});
  gouge(1, "stroke", 0.2);
  gouge(2, "retract", 0.3);
  gouge(3, "stroke", 0.126);
  const Json found = judged(data);
  expectVerdict(found, "failed", {"gouge"});
  EXPECT_EQ(criterion(found, "gouge")["place"],
            "tooth 2, pass 3, retract, X = 3.000 mm; also tooth 2, pass 2, stroke; tooth 2, pass 4, stroke");
}

/// Of the secondary relief of the same tool, of which all that was ground before is in the bag as well.
Json reliefsDocument() {
  Json data = document();
  Json& file = data["job"]["file"];
  file["operation"] = "secondary";
  file["cutter"].update(
      {{"clearance_deg", 10}, {"clearance_tolerance_deg", 0.5}, {"second_clearance_deg", 22}, {"land_mm", 0.4}});
  for (Json& section : data["tool"]["sections"]) {
    const double wider = section["x_mm"].get<double>() / 10;
    for (Json& tooth : section["teeth"]) {
      tooth.update({{"clearance_deg", 10}, {"second_clearance_deg", 22}, {"primary_mm", 0.4 + wider}});
    }
  }
  data["tool"]["on_planned"] = false;
  return data;
}

TEST(Verdict, AReliefIsJudgedByClearanceAndTheWidthOfThePrimary) {
  std::vector<std::string> names = kNames;
  names.insert(names.begin() + 6, {"clearance", "second clearance", "primary relief"});
  EXPECT_EQ(namesOf(judged(reliefsDocument()), "passed"), names);
  const Edge edges[]{
      {"clearance", "/tool/sections/2/teeth/1/clearance_deg", 10.5, 10.501, "tooth 2, X = 20.000 mm"},
      {"clearance", "/tool/sections/1/teeth/0/clearance_deg", 9.5, 9.499, "tooth 1, X = 10.000 mm"},
      {"second clearance", "/tool/sections/2/teeth/0/second_clearance_deg", 21.5, 21.499, "tooth 1, X = 20.000 mm"},
      {"primary relief", "/tool/sections/0/teeth/1/primary_mm", 0.42, 0.421, "tooth 2, X = 0.000 mm"},
      {"primary relief", "/tool/sections/0/teeth/0/primary_mm", 0.385, 0.379, "tooth 1, X = 0.000 mm"}};
  for (const Edge& edge : edges) {
    expectEdge(reliefsDocument(), edge);
    Json data = reliefsDocument();
    at(data, edge.path) = nullptr;
    expectVerdict(judged(data), "failed", {edge.name});
  }
}

TEST(Verdict, APrimaryReliefIsAsWideAsAskedOnlyBehindASecondaryOne) {
  Json data = reliefsDocument();
  data["job"]["file"]["operation"] = "primary";
  for (Json& tooth : data["tool"]["sections"][0]["teeth"]) tooth["primary_mm"] = 1.5;
  expectVerdict(judged(data), "passed", {});
}

TEST(Verdict, OfAReliefOnPlannedFlutesTheFlutesAreNotMeasured) {
  Json data = reliefsDocument();
  data["tool"]["on_planned"] = true;
  const std::vector<std::string> flutes(kNames.begin() + 1, kNames.begin() + 6);
  EXPECT_EQ(namesOf(judged(data), "not measured"), flutes);
  EXPECT_EQ(judged(data)["verdict"], "incomplete");
}

TEST(Verdict, WhatIsNotThereFails) {
  const Json found = judgedWith("/tool/sections/2/teeth/1/land_mm", nullptr);
  expectVerdict(found, "failed", {"land"});
  EXPECT_EQ(criterion(found, "land")["remark"], "there is none");
  EXPECT_TRUE(criterion(found, "land")["measured"].is_null());
  const double nan = std::nan("");
  EXPECT_EQ(judgedWith("/tool/sections/2/core_diameter_mm", nan)["verdict_because"][0], "core diameter");
  EXPECT_EQ(judgedWith("/tool/sections/0/asked_core_diameter_mm", nan)["verdict_because"][0], "core diameter");
}

TEST(Verdict, IncompleteFluteHasNoRakeOnlyWhereTheJobAllowsIt) {
  Json data = document();
  Json& tooth = data["tool"]["sections"][0]["teeth"][0];
  tooth["complete"] = false;
  tooth["rake_deg"] = tooth["chordal_rake_deg"] = nullptr;
  expectVerdict(judged(data), "failed", {"rake", "chordal rake"});
  data["job"]["file"]["process"]["incomplete_ok"] = true;
  expectVerdict(judged(data), "passed", {});
}

TEST(Verdict, FollowingErrorThatCouldNotBeReadIsNotMeasured) {
  for (const Json& unread : {Json(nullptr), Json(std::nan(""))}) {
    Json data = document();
    for (Json& stroke : data["strokes"]) {
      for (auto& error : stroke["following_error"]) error = unread;
    }
    expectVerdict(judged(data), "incomplete", {"following error in strokes: not measured"});
  }
  expectVerdict(judgedWith("/strokes/0/following_error/x_um", std::numeric_limits<double>::infinity()), "failed",
                {"following error in strokes"});
}

TEST(Verdict, FeedThatThePlanReducesIsNotJudged) {
  const std::vector<std::string> unknown{"feed constancy: not measured"};
  for (const auto& [from, to] : {std::pair{-0.5, 3.9}, {19.9, 31.0}, {3.9, -0.5}}) {
    const Json limits{{{"cause", "axis A jerk"}, {"from_x_mm", from}, {"to_x_mm", to}}};
    expectVerdict(judgedWith("/planned/feed_limits", limits), "incomplete", unknown);
  }
  const Json limits{{{"cause", "axis A jerk"}, {"from_x_mm", 0}, {"to_x_mm", 2}}};
  EXPECT_EQ(criterion(judgedWith("/planned/feed_limits", limits), "feed constancy")["remark"],
            "the plan slows down: axis A jerk, X 0.000 to 2.000 mm");
  for (const auto& [from, to] : {std::pair{20.0, 36.0}, {-1.0, 0.0}}) {
    const Json outside{{{"cause", "axis A jerk"}, {"from_x_mm", from}, {"to_x_mm", to}}};
    expectVerdict(judgedWith("/planned/feed_limits", outside), "passed", {});
  }
}

TEST(Verdict, JobsThatDidNotEndWell) {
  expectVerdict(judgedWith("/outcome", "canceled"), "failed", {"the job ended as canceled"});
  expectVerdict(judgedWith("/setpoints/lost", 3), "incomplete", {"3 setpoints are not in the file"});
  Json data = document();
  data.erase("outcome");
  expectVerdict(judged(data), "unfinished", {"the end of the job is not in the file"});
  at(data, "/strokes/0/deviation_um") = 3;
  expectVerdict(judged(data), "failed", {"path deviation"});
}

TEST(Verdict, ToolOfWhichAToothIsMissingIsNotMeasured) {
  Json data = document();
  data["tool"]["strokes"].erase(1);
  const Json found = judged(data);
  EXPECT_EQ(namesOf(found, "not measured"),
            (std::vector<std::string>{"rake", "chordal rake", "core diameter", "land", "spiral angle"}));
  EXPECT_EQ(criterion(found, "gouge")["result"], "passed");
  EXPECT_EQ(found["verdict"], "incomplete");
}

TEST(Verdict, RecordOfTheGrinderHasNoToolAndAllCycles) {
  Json data = document();
  data["kind"] = "record";
  data["duration_s"] = 3.2;
  data["machine"]["period_ms"] = 2;
  data["late_cycles"] = {{"count", 4}, {"longest_ms", nullptr}};
  const Json found = judged(data);
  EXPECT_EQ(namesOf(found, "not measured").size(), 6U);
  EXPECT_EQ(found["verdict"], "incomplete");
  EXPECT_EQ(criterion(found, "late cycles")["measured"], 0.25);
  EXPECT_EQ(criterion(found, "late cycles")["place"], "4 of 1600 cycles");
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

TEST(Tolerances, AreThoseOfTheFile) {
  const Tolerances read = readTolerances("config/tolerances.yaml");
  EXPECT_EQ(read.land_mm, 0.05);
  EXPECT_EQ(read.following_error_um, 50);
  EXPECT_EQ(read.feed_percent, 5);
  EXPECT_EQ(read.late_cycles_percent, 1);
}

TEST(Tolerances, BadOnesAreNamed) {
  const std::string allowed = "allowed: land_mm, primary_mm, following_error_um, feed_percent, late_cycles_percent";
  EXPECT_EQ(refusal("feed_percent: 5"), ": land_mm is missing");
  EXPECT_EQ(refusal("land: 1"), ": land: not known; " + allowed);
  EXPECT_EQ(refusal("# none"), ": has no keys; " + allowed);
  for (const std::string wrong : {"-1", ".nan", ".inf", "true", "wide"}) {
    EXPECT_EQ(refusal("land_mm: " + wrong), ": land_mm = " + wrong + "; allowed: a number from 0");
  }
  EXPECT_EQ(refusal("land_mm: [1]"), ": land_mm = (not a value); allowed: a number from 0");
  EXPECT_EQ(refusal("a: [").substr(0, 3), ":1:");
  EXPECT_THROW(readTolerances("config/none.yaml"), JobFileError);
}

}  // namespace test_verdict
}  // namespace grinder
