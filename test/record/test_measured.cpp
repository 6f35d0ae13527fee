// What people write of measured tools: what is taken, refused and kept.

#include "flute_grinder/record/measured_tools.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace grinder {
namespace test_measured {

using units::kDegree;
using units::kMillimetre;

/// A cylinder of 10 mm and 22 mm of flute.
GrindJob endMill(const std::string& operation) { return readJobFile("jobs/end_mill_d10_t4.yaml", operation); }
/// A cone of 10 mm and 30 mm of flute.
GrindJob cone() { return readJobFile("jobs/paper.yaml"); }

std::string refusal(const std::string& text, const GrindJob& job) {
  return test_support::refusalOf<std::invalid_argument>([&] { measuredFrom(text, job); });
}

TEST(Measured, IsReadInShopUnits) {
  const MeasuredFigure core = measuredFrom("core=6.82", endMill("1"));
  EXPECT_EQ(core.figure, ToolFigure::kCoreDiameter);
  EXPECT_DOUBLE_EQ(core.x, 11 * kMillimetre);
  EXPECT_DOUBLE_EQ(core.value, 6.82 * kMillimetre);
  const MeasuredFigure rake = measuredFrom("rake@15=-8.3", cone());
  EXPECT_EQ(rake.figure, ToolFigure::kRake);
  EXPECT_DOUBLE_EQ(rake.x, 15 * kMillimetre);
  EXPECT_DOUBLE_EQ(rake.value, -8.3 * kDegree);
  EXPECT_EQ(measuredFrom("core_diameter@30=15", cone()).figure, ToolFigure::kCoreDiameter);
  EXPECT_EQ(measuredFrom("end_clearance=8.1", endMill("end_primary")).figure, ToolFigure::kEndClearance);
}

TEST(Measured, IsRefusedIfTheToolCannotHaveIt) {
  const std::string form = "; allowed: FIGURE=VALUE or FIGURE@X=VALUE, as core=6.62 or rake@15=8.3, in mm or deg";
  EXPECT_EQ(refusal("core", cone()), "core" + form);
  EXPECT_EQ(refusal("cor@2=7", cone()), "figure = cor; allowed: rake, chordal_rake, spiral, core, land");
  EXPECT_EQ(refusal("clearance@2=7", cone()).find("figure = clearance; allowed: rake,"), 0U);
  EXPECT_EQ(refusal("rake=8", endMill("primary")),
            "figure = rake; allowed: clearance, second_clearance, primary, edge_diameter");
  EXPECT_EQ(refusal("core=7.1", cone()),
            "core; allowed: core@X, with X in mm from the small end, since the flute is not the same "
            "everywhere");
  EXPECT_EQ(refusal("end_clearance@2=8", endMill("end_primary")),
            "end_clearance@2; allowed: no X, since it is a figure of the end");
  for (const char* x : {"30.1", "-1", "nan", "", "2mm"}) {
    EXPECT_EQ(refusal(std::string("rake@") + x + "=8", cone()),
              std::string("rake@") + x + ": X = " + x + "; allowed: 0 to 30 mm, the flute's length");
  }
  for (const char* value : {"6820", "10.1", "0", "-6.8", "nan", "inf", "", "6,82"}) {
    EXPECT_EQ(refusal(std::string("core=") + value, endMill("1")),
              std::string("core = ") + value + "; allowed: more than 0, up to the diameter there, 10 mm");
  }
  for (const char* value : {"90", "-90", "nan", "8deg", ""}) {
    EXPECT_EQ(refusal(std::string("rake=") + value, endMill("1")),
              std::string("rake = ") + value + "; allowed: an angle in deg, within 90 deg");
  }
}

TEST(Measured, IsKeptWithAllEntriesAndTheLastOfAPlaceCounts) {
  Record record;
  record.body = Json::object();
  EXPECT_TRUE(measuredOf(record).empty());
  for (const char* entry : {"core@2=7.1", "rake@2=8.1", "core@3=7.2", "core@2=7.15"}) {
    MeasuredFigure measured = measuredFrom(entry, cone());
    measured.when = "2026-11-22T17:04:13.123Z";
    measured.by = "anna@grinder";
    addMeasured(record, measured);
  }
  const Json& first = record.body["measured"][0];
  EXPECT_EQ(text(first, -1), R"({"figure":"core_diameter","x_mm":2.0,"value_mm":7.1,)"
                             R"("when":"2026-11-22T17:04:13.123Z","by":"anna@grinder"})");
  EXPECT_EQ(record.body["measured"][1]["value_deg"], 8.1);
  EXPECT_EQ(record.body["measured"].size(), 4U);
  const std::vector<MeasuredFigure> all = measuredOf(record);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_DOUBLE_EQ(all[0].value, 8.1 * kDegree);
  EXPECT_DOUBLE_EQ(all[2].value, 7.15 * kMillimetre);
  EXPECT_EQ(all[2].by, "anna@grinder");
  record.body["measured"][0]["figure"] = "size";
  EXPECT_THROW(measuredOf(record), std::invalid_argument);
}

TEST(Measured, IsKeptOfAllWhoEnterItAtOnce) {
  const test_support::TempFolder folder;
  const ToolNumber tool{3, folder.path() / "0000000003_20261122T170413.123Z.json"};
  Record record;
  record.body = Json::object();
  std::ofstream(tool.path) << text(record);
  constexpr int writers = 8, entries = 10;
  std::vector<std::thread> threads;
  for (int writer = 0; writer < writers; ++writer) {
    threads.emplace_back([&, writer] {
      for (int i = 0; i < entries; ++i) {
        const MeasuredFigure one{ToolFigure::kRake, (writer + i / 100.0) * kMillimetre, kDegree, "", ""};
        keepMeasured(tool, {one}, "anna@grinder");
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(measuredOf(readRecord(tool.path)).size(), std::size_t{writers * entries});
}

TEST(Measured, IsShownBesideWhatIsAsked) {
  const GrindJob job = cone();
  // The core is asked from 6.8 mm at the small end to 12.05 mm at 30 mm.
  EXPECT_EQ(text(measuredFrom("core@15=9.43", job), ValidJob(job)),
            "core diameter at X = 15 mm: 9.43 mm; asked 9.425 mm within 0.02 mm");
  EXPECT_EQ(text(measuredFrom("land@15=3", job), ValidJob(job)), "land at X = 15 mm: 3 mm");
  const GrindJob end = endMill("end_primary");
  EXPECT_EQ(text(measuredFrom("end_clearance=8.1", end), ValidJob(end)), "end clearance: 8.1 deg");
}

TEST(Measured, IsOfAToolThatWasGroundToItsEnd) {
  const test_support::TempFolder folder;
  const auto keep = [&](int number, const char* digest, const char* outcome) {
    Record record;
    record.head.digest = digest;
    record.head.outcome = outcome;
    record.body = Json::object();
    std::ofstream(folder.path() / (format("%010d", number) + "_20261122T170413.123Z.json")) << text(record);
  };
  EXPECT_THROW(toolOf(toolsIn(folder.path(), "mine"), 0), std::invalid_argument);
  keep(3, "mine", "done"), keep(4, "other", "done"), keep(5, "mine", "canceled"), keep(7, "mine", "done");
  std::ofstream(folder.path() / "0000000008_20261122T170413.123Z.json") << "{";
  const std::vector<ToolNumber> tools = toolsIn(folder.path(), "mine");
  ASSERT_EQ(tools.size(), 2U);
  EXPECT_EQ(toolOf(tools, 0).number, 7U);
  EXPECT_EQ(toolOf(tools, 3).number, 3U);
  for (const std::uint64_t number : {1, 4, 5, 8}) {
    EXPECT_EQ(test_support::refusalOf<std::invalid_argument>([&] { toolOf(tools, number); }),
              "tool = " + std::to_string(number) + "; allowed: 3, 7");
  }
}

TEST(Measured, GoesFromToolToToolWithTheZeroPoints) {
  const auto tool = [](std::uint64_t number, double y, double found_at, const char* core) {
    MeasuredTool made;
    made.number = number;
    made.ended = "2026-11-22T17:05:13.123Z";
    made.offset[indexOf(SetupTurn::kY)] = y;
    made.found_at = {found_at, 1.7e9};
    if (*core != '\0') made.figures = {measuredFrom(std::string("core@15=") + core, cone())};
    return made;
  };
  const Json history = figureHistory(ValidJob(cone()),
                                     {tool(3, 0.0015, 1.7e9, "9.43"), tool(4, 0.0015, 1.7e9 + 0.001, ""),
                                      tool(6, 0.0014, 1.7e9, "9.42"), tool(7, 0.0014, 1.8e9, "9.5")},
                                     figureFrom("core@15", cone()));
  EXPECT_EQ(history["asked"], 9.425);
  EXPECT_EQ(history["tolerance"], 0.02);
  EXPECT_EQ(history["unit"], "mm");
  std::string zeros;
  for (const Json& one : history["tools"]) zeros += one["zero_points"].get<std::string>() + " ";
  EXPECT_EQ(zeros, "found same corrected found ");
  EXPECT_EQ(history["tools"][0]["measured"], 9.43);
  EXPECT_TRUE(history["tools"][1]["measured"].is_null());
  EXPECT_EQ(history["tools"][2]["y_mm"], 1.4);
  EXPECT_EQ(history["tools"][3]["tool"], 7);
}

}  // namespace test_measured
}  // namespace grinder
