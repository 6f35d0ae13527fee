#include "flute_grinder/job/file_error.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/verdict.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <string>

/// @file
/// The summary of a record is judged as the record is.

namespace grinder {
namespace test_record_summary {

const Tolerances kTolerances{0.5, 0.02, 50, 5, 1};

/// Without strokes. The texts have what a scanner may stumble on.
Json document() {
  return Json::parse(R"({
    "record": 1, "machine": {"name": "}]\\", "software": "", "period_ms": 1, "max_velocity": {"x_mm_s": 1}},
    "job": {"name": "a \"job\" {[,", "digest": "", "file": {
      "cutter": {"end_diameter_mm": 10, "cone_angle_deg": 5, "flute_length_mm": 20, "rake_angle_deg": 8,
                 "rake_tolerance_deg": 0.5, "chordal_rake_tolerance_deg": 4, "core_tolerance_mm": 0.25,
                 "spiral_tolerance_deg": 0.25, "clearance_deg": 7, "clearance_tolerance_deg": 1, "second_clearance_deg": 20,
                 "land_mm": 1},
      "process": {"feed_mm_min": 100, "wheel": {"wear_mm": 0}}, "operation": "secondary", "operations": [{}, {}],
      "interpolation": {"tolerance_um": 2}}},
    "started": "2026-11-22T17:04:13.123Z", "ended": "2026-11-22T17:04:23.123Z", "outcome": "done", "reason": "",
    "wheel": {"name": "", "dressed": ""}, "passes": 4,
    "planned": {"feed_limits": []}, "setpoints": {"written": 1000, "lost": 0},
    "late_cycles": {"count": 0, "longest_ms": 1.25}, "strokes": [], "holds": [{"reason": "]"}, {}], "overrides": []})");
}

class RecordSummary : public ::testing::Test {
 protected:
  Json summaryOf(const std::string& text) {
    const std::string path = folder_.path() / "20261122T170413.123Z.json";
    std::ofstream(path) << text;
    return readRecordSummary(path);
  }

  test_support::TempFolder folder_;
};

/// Around what is allowed, so that about half of the records fail; or null.
Json figure(std::mt19937& engine, double asked, double tolerance) {
  if (std::uniform_int_distribution<>(0, 39)(engine) == 0) return nullptr;
  return asked + std::uniform_real_distribution<>(0, 1.02)(engine) * tolerance;
}

Json randomStroke(std::mt19937& engine) {
  return {{"tooth", 1},
          {"pass", 2},
          {"feed_min_mm_min", figure(engine, 100, -5)},
          {"feed_max_mm_min", figure(engine, 100, 5)},
          {"deviation_um", figure(engine, 0, 2)},
          {"following_error",
           {{"x_um", figure(engine, 0, 50)}, {"y_um", figure(engine, 0, 50)}, {"a_mdeg", figure(engine, 0, 400)}}},
          {"complete", std::uniform_int_distribution<>(0, 1)(engine) == 1}};
}

TEST_F(RecordSummary, HasTheVerdictOfTheRecord) {
  std::mt19937 engine(1);
  int failed = 0;
  for (int i = 0; i < 1000; ++i) {
    Json record = document();
    for (int n = i % 6; n > 0; --n) record["strokes"].push_back(randomStroke(engine));
    Json summary = summaryOf(record.dump(i % 2 == 0 ? -1 : 2));
    judgeRecord(record, kTolerances);
    const Verdict verdict = verdictOnRecord(summary, kTolerances);
    ASSERT_EQ(verdict.verdict, record["verdict"]) << record;
    ASSERT_EQ(Json(verdict.because), record["verdict_because"]) << record;
    failed += record["verdict"] == "failed" ? 1 : 0;
  }
  EXPECT_GT(failed, 200);
  EXPECT_LT(failed, 800);
}

TEST_F(RecordSummary, CountsStrokesAndHolds) {
  Json record = document();
  for (const bool complete : {true, false, true}) record["strokes"].push_back({{"complete", complete}});
  const Json summary = summaryOf(record.dump());
  EXPECT_EQ(summary["complete_strokes"], 2);
  EXPECT_EQ(summary["holds"], 2);
  EXPECT_EQ(summary["job"]["name"], record["job"]["name"]);
}

/// What is said of a record; empty if nothing is.
template <typename Read>
std::string refusal(const std::string& path, const Json& record, const Read& read) {
  std::ofstream(path) << record.dump();
  try {
    read(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RecordSummary, OfAValueOfAnotherTypeIsNone) {
  const std::string path = folder_.path() / "20261122T170413.123Z.json", begin = path + ": is no record of a job: ";
  Json good = document();
  good["holds"] = {{{"at_s", 1}, {"duration_s", 2}, {"reason", "by \x1b[2J"}}};
  good["reason"] = "\t";
  std::mt19937 engine(1);
  Json stroke = randomStroke(engine);
  stroke.update(Json{{"depth_mm", nullptr}, {"started_s", 0}, {"duration_s", 1}, {"feed_min_x_mm", 0}});
  stroke["following_error"]["z_um"] = 0;
  good["strokes"] = {stroke};
  EXPECT_EQ(refusal(path, good, readRecord), "");
  EXPECT_EQ(readRecord(path)["holds"][0]["reason"], "by \\x1b[2J");
  EXPECT_EQ(refusal(path, good, readRecordSummary), "");
  EXPECT_EQ(readRecordSummary(path)["reason"], "\\t");
  const struct {
    const char* key;
    Json value;
    const char* said;
  } rows[]{{"/passes", -1, "passes = -1; allowed: a whole number from 0"},
           {"/job", 7, "job = 7; allowed: an object"},
           {"/job/name", nullptr, "job.name = null; allowed: a text"},
           {"/job/file/cutter/rake_angle_deg", "8", "job.file.cutter.rake_angle_deg = \"8\"; allowed: a number"},
           {"/setpoints/written", "many", "setpoints.written = \"many\"; allowed: a whole number from 0"},
           {"/late_cycles/longest_ms", true, "late_cycles.longest_ms = true; allowed: a number, or null"},
           {"/started", "today", "started = \"today\"; allowed: a time, as 2026-11-22T17:04:13.123Z"},
           {"/outcome", Json::array(), "outcome = []; allowed: a text"}};
  for (const auto& row : rows) {
    Json record = good;
    record[Json::json_pointer(row.key)] = row.value;
    EXPECT_EQ(refusal(path, record, readRecord), begin + row.said);
    EXPECT_EQ(refusal(path, record, readRecordSummary), begin + row.said);
  }
  Json record = good;
  record["strokes"][0]["depth_mm"] = "1";
  EXPECT_EQ(refusal(path, record, readRecord), begin + "strokes[0].depth_mm = \"1\"; allowed: a number, or null");
  record = good;
  record["holds"][0].erase("at_s");
  EXPECT_EQ(refusal(path, record, readRecord), begin + "holds[0].at_s is missing");
}

TEST_F(RecordSummary, OfATextThatIsCutOffIsNone) {
  Json record = document();
  std::mt19937 engine(1);
  record["strokes"] = {randomStroke(engine)};
  const std::string whole = record.dump();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(summaryOf(whole.substr(0, size)), FileError) << whole.substr(0, size);
  }
  for (const char* const more : {"}", "1", ","}) EXPECT_THROW(summaryOf(whole + more), FileError) << more;
  for (const char* other : {"[]", "1", "{}", "{\"record\": 2}", "{1: 2}", "{\"a\" 1}", "]", "{\"record\": 1,}"}) {
    EXPECT_THROW(summaryOf(other), FileError) << other;
  }
}

}  // namespace test_record_summary
}  // namespace grinder
