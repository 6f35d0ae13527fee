#include "flute_grinder/record/tool_records.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/ground_tool.h"
#include "flute_grinder/tool/tool_figure.h"
#include "flute_grinder/tool/z_law.h"
#include "record/ground_strokes.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

/// @file
/// Which records of a folder are of one tool, and what they ground together.

namespace grinder {
namespace test_tool_records {

using Files = std::vector<std::string>;

class ToolRecordsTest : public ::testing::Test {
 protected:
  /// Keeps a record of an operation whose axes were on the path, with the strokes of some teeth. @return its path.
  std::string keep(int operation, bool continues = false, int first_tooth = 0, int end_tooth = 4) {
    const ValidJob& job = planned(operation);
    std::vector<RunStroke> ground;
    Json strokes = Json::array();
    for (int tooth = first_tooth; tooth < end_tooth; ++tooth) {
      const GrindStroke stroke = strokeOf(job, tooth, job.deepest(), 0);
      const int last = static_cast<int>(job.depths().size()) - 1;
      ground.push_back({{tooth, last}, MoveKind::kStroke, {stroke.from, stroke.to}, {{}, {}}});
      for (int pass = 0; pass <= last; ++pass) {
        strokes.push_back({{"tooth", tooth + 1}, {"pass", pass + 1}, {"complete", true}});
      }
    }
    // One more was begun.
    if (end_tooth < 4) strokes.push_back({{"tooth", end_tooth + 1}, {"pass", 1}, {"complete", false}});
    Record record;
    record.head.started = record.head.ended = "2026-11-22T17:04:13.123Z";
    record.head.digest = jobDigest(*job);
    record.head.continues = continues;
    record.head.outcome = "done";
    record.body = {{"job_file", toJson(*job)}, {"strokes", strokes}, {"ground", toJson(ground)}, {"not_ground", ""}};
    const std::string path = folder_.path() / (format("%010d", ++count_) + "_20261122T170413.123Z.json");
    std::ofstream(path) << text(record);
    return path;
  }

  /// The numbers of the records of each operation.
  static std::vector<Files> filesOf(const ToolRecords& tool) {
    std::vector<Files> files;
    for (const ToolRecords::Operation& operation : tool.operations()) {
      Files& numbers = files.emplace_back();
      for (const std::string& file : operation.files) numbers.push_back(file.substr(9, 1));
    }
    return files;
  }

  /// Flutes and reliefs.
  static GrindJob threeOperations() {
    GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "1");
    job.operations.resize(3);
    return job;
  }

  /// One of them, computed once.
  static const ValidJob& planned(int operation) {
    static std::map<int, ValidJob> jobs;
    if (jobs.count(operation) == 0)
      jobs.emplace(operation, withLaws(ValidJob(threeOperations().ofOperation(operation))));
    return jobs.at(operation);
  }

  const test_support::TempFolder folder_;
  int count_ = 0;
};

TEST_F(ToolRecordsTest, AreThoseOfAllOperationsWhicheverIsNamedAndNotOfAnotherToolOfTheJob) {
  keep(0);
  for (const std::string& path : Files{keep(1), keep(2)}) {
    const ToolRecords tool(path);
    EXPECT_EQ(filesOf(tool), (std::vector<Files>{{"1"}, {"2"}, {"3"}}));
    EXPECT_EQ(&tool.last(), &tool.operations()[2]);
    for (const ToolRecords::Operation& operation : tool.operations()) EXPECT_TRUE(operation.missing().empty());
  }
  const std::string relief = keep(1);  // of a tool whose flutes are not in the records
  EXPECT_EQ(filesOf(ToolRecords(relief)), (std::vector<Files>{{}, {"4"}, {}}));
  const std::string flute = keep(0);
  keep(0), keep(1);
  EXPECT_EQ(filesOf(ToolRecords(flute)), (std::vector<Files>{{"5"}, {}, {}}));
}

TEST_F(ToolRecordsTest, ThatContinueARunAreOneWithIt) {
  keep(0, false, 0, 2);
  const std::string rest = keep(0, true, 2, 3);
  const ToolRecords tool(rest);
  EXPECT_EQ(filesOf(tool), (std::vector<Files>{{"1", "2"}, {}, {}}));
  const std::vector<ToothPass> missing = tool.last().missing();
  EXPECT_EQ(missing.size(), planned(0).depths().size());
  for (const ToothPass& place : missing) EXPECT_EQ(place.tooth, 3);
}

TEST_F(ToolRecordsTest, WithoutTheNameOfARecordStandForThemselves) {
  const std::string path = keep(1), copy = folder_.path() / "copy.json";
  keep(2);
  std::filesystem::rename(path, copy);
  EXPECT_EQ(filesOf(ToolRecords(copy)).at(2), Files());
}

/// Axes on their path grind the tool that the job asks for, by all operations together.
TEST_F(ToolRecordsTest, AreMeasuredOnWhatWasGroundBefore) {
  keep(0), keep(1);
  const ToolRecords tool(keep(2));
  const RunStrokes strokes = tool.strokes(tool.last());
  EXPECT_FALSE(strokes.isOnPlanned());
  const ValidJob& asked = planned(2);
  const GroundTool ground = measure("", strokes, {0, 0.011}),
                   planned = measure(asked, "", groundCutterOf(asked), {0, 0.011});
  for (std::size_t i = 0; i < 2; ++i) {
    for (const ToolFigureRow& row : kToolFigures) {
      const FigureValue a = measured(row.value, {asked, ground.sections[i].ground, 2});
      const FigureValue b = measured(row.value, {asked, planned.sections[i].ground, 2});
      ASSERT_EQ(a.has_value(), b.has_value()) << row.name;
      EXPECT_NEAR(a.value_or(0), b.value_or(0), 1e-6) << row.name;
    }
  }
  keep(0);
  const ToolRecords other(keep(2));
  EXPECT_TRUE(other.strokes(other.own()).isOnPlanned());
  const ToolRecords flute(folder_.path() / "0000000001_20261122T170413.123Z.json");
  EXPECT_FALSE(flute.strokes(flute.own()).isOnPlanned());
  EXPECT_EQ(&flute.own(), &flute.operations()[0]);
}

}  // namespace test_tool_records
}  // namespace grinder
