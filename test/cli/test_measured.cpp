// What `grind measured` and `grind correct` do with a folder of records.

#include "cli/correct.h"
#include "cli/measured.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/correction.h"
#include "flute_grinder/record/measured.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_cli_measured {

constexpr const char* kJob = "jobs/paper.yaml";

class MeasuredTools : public ::testing::Test {
 protected:
  std::string pathOf(int number) const {
    return folder_.path() / (format("%010d", number) + "_20261122T170413.123Z.json");
  }

  /// A record of a tool that was ground to its end, with a zero point of Y found in an hour of that day.
  void keep(int number, double y_mm = 1.5, int found_at = 7) {
    Record record;
    record.head.digest = digest_;
    record.head.outcome = "done";
    record.head.tool = "a cone";
    record.head.ended = "2026-11-22T17:05:13.123Z";
    record.body = {{"not_ground", "by \x1b"},
                   {"work_offsets", {{"y_mm", y_mm}, {"z_mm", -7.0}}},
                   {"zero_points",
                    {{"y", {{"found_at", format("2026-11-22T%02d:00:00.000Z", found_at)}}},
                     {"z", {{"found_at", "2026-11-21T18:00:00.000Z"}}}}}};
    std::ofstream(pathOf(number)) << text(record);
  }

  /// @return what is printed.
  std::string measure(const std::vector<std::string>& figures, std::uint64_t tool = 0) {
    ::testing::internal::CaptureStdout();
    const auto said = [] { return ::testing::internal::GetCapturedStdout(); };
    try {
      EXPECT_EQ(keepMeasured("grinder", {kJob, "", figures, tool, folder_.path()}), 0);
    } catch (const std::exception&) {
      EXPECT_EQ(said(), "");
      throw;
    }
    return said();
  }

  /// A tool that was ground with Y and Z off, and measured with a gauge of 0.01 deg and 0.1 um.
  void grind(int number, double y_um, double z_um, double y_mm = 1.5, int found_at = 7) {
    GrindJob job = readJobFile(kJob);
    job.process().depth -= y_um * units::kMicrometre;
    job.process().depth_end -= y_um * units::kMicrometre;
    job.process().setup_height += z_um * units::kMicrometre;
    const GroundCutter tool = groundCutterOf(withLaws(ValidJob(job)));
    std::vector<std::string> figures;
    for (const double x : {2.0, 15.0, 28.0}) {
      const GroundSection section = tool.section(x * units::kMillimetre);
      figures.push_back(format("rake@%g=%.2f", x, section.teeth[0].rake.value() / units::kDegree));
      figures.push_back(format("core@%g=%.4f", x, 2 * section.core_radius / units::kMillimetre));
    }
    keep(number, y_mm, found_at);
    measure(figures, static_cast<std::uint64_t>(number));
  }

  /// @return the JSON that is printed.
  Json correct(int status, std::uint64_t since = 0) {
    return Json::parse(printed(asking(kJob, "", since, true), status));
  }
  CorrectOptions asking(const char* job, const char* operation, std::uint64_t since, bool json) const {
    return {job, operation, since, folder_.path(), "config/grinder.yaml", "urdf/grinder.urdf", json, false, {}};
  }
  std::string printed(const CorrectOptions& options, int status) {
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(grinder::correct("grinder", options), status);
    err_ = ::testing::internal::GetCapturedStderr();
    return ::testing::internal::GetCapturedStdout();
  }

  std::string err_;
  const std::string digest_ = jobDigest(readJobFile(kJob));
  const test_support::TempFolder folder_;
};

TEST_F(MeasuredTools, KeepWhatIsEntered) {
  keep(3), keep(4);
  const std::string other = test_support::readFile(pathOf(4));
  EXPECT_EQ(measure({"core@15=9.43", "rake@15=8.25"}, 3),
            "tool 3, a cone, ground until 2026-11-22T17:05:13.123Z\n"
            "core diameter at X = 15 mm: 9.43 mm; asked 9.425 mm within 0.02 mm\n"
            "rake at X = 15 mm: 8.25 deg; asked 8 deg within 0.5 deg\n");
  EXPECT_EQ(test_support::readFile(pathOf(4)), other);
  measure({"core@15=9.44"}, 3);
  const Record record = readRecord(pathOf(3));
  EXPECT_EQ(record.body["measured"].size(), 3U);
  EXPECT_EQ(record.body["not_ground"], "by \\x1b");
  EXPECT_GT(timeOf(record.body["measured"][0]["when"]), timeOf("2026-01-01T00:00:00.000Z"));
  EXPECT_NE(record.body["measured"][0]["by"].get<std::string>().find('@'), std::string::npos);
  measure({"core@2=7.15"});  // of the last
  EXPECT_EQ(measuredOf(readRecord(pathOf(4))).size(), 1U);
}

TEST_F(MeasuredTools, KeepNothingIfOneOfTheEntriesIsRefused) {
  keep(3);
  const std::string before = test_support::readFile(pathOf(3));
  const auto refused = [&](const std::vector<std::string>& figures, std::uint64_t tool) {
    return test_support::refusalOf<std::invalid_argument>([&] { measure(figures, tool); });
  };
  EXPECT_EQ(refused({"core@15=9.43", "cor@15=9"}, 3).find("figure = cor; allowed: "), 0U);
  EXPECT_EQ(refused({"core@15=9.43"}, 4), "tool = 4; allowed: 3");
  EXPECT_EQ(test_support::readFile(pathOf(3)), before);
}

TEST_F(MeasuredTools, SayWhatToSet) {
  for (const int number : {1, 2, 3, 4}) grind(number, 15, -10);
  const Json said = correct(0);
  EXPECT_EQ(said["tools"], 4);
  EXPECT_EQ(said["measured"], 4);
  EXPECT_NEAR(said["turn"]["y_mm"], -0.015, 0.002);
  EXPECT_NEAR(said["turn"]["z_mm"], 0.010, 0.003);
  EXPECT_EQ(said["turn"]["swivel_deg"], 0.0);
  EXPECT_NEAR(said["offsets"]["y_mm"], 1.5 - 0.015, 0.002);
  EXPECT_NEAR(said["offsets"]["z_mm"], -7 + 0.010, 0.003);
  EXPECT_EQ(said["figures"].size(), 6U);
  for (const Json& figure : said["figures"]) {
    const bool is_core = figure["figure"] == "core_diameter";
    const std::string unit = is_core ? "_mm" : "_deg";
    EXPECT_NEAR(figure["after" + unit], figure["planned" + unit], is_core ? 0.002 : 0.05) << text(figure);
  }
  // By the edge circle: 1.865 of Y and 0.72 of Z.
  EXPECT_EQ(said["figures"][3]["x_mm"], 2.0);
  EXPECT_NEAR(said["figures"][3]["now_mm"].get<double>() - said["figures"][3]["planned_mm"].get<double>(),
              1.865 * 0.015 - 0.72 * 0.010, 0.001);
  const std::string table = printed(asking(kJob, "", 0, false), 0);
  EXPECT_NE(table.find("since tool 1: 4 ground, 4 measured; zero points of tool 4\n"), std::string::npos) << table;
  EXPECT_NE(table.find("work offset of Y: -0.01"), std::string::npos) << table;
  EXPECT_NE(table.find(" mm, to 1.48"), std::string::npos) << table;
  EXPECT_NE(table.find("nothing is set yet"), std::string::npos) << table;
}

TEST_F(MeasuredTools, KnowACorrectionAndForgetWhatATouchOffReplaces) {
  for (const int number : {1, 2, 3}) grind(number, 15, 0);
  grind(4, 0, 0, 1.485);
  const Json corrected = correct(0);
  EXPECT_EQ(corrected["tools"], 4);
  EXPECT_TRUE(corrected["left_out"].empty());
  EXPECT_TRUE(corrected["in_dead_band"]);
  EXPECT_EQ(corrected["offsets"]["y_mm"], 1.485);
  grind(5, 40, 0, 1.6, 8);
  const Json anew = correct(0);
  EXPECT_EQ(anew["since"], 5);
  EXPECT_EQ(anew["measured"], 1);
  EXPECT_LT(anew["turn"]["y_mm"], -0.02);
}

TEST_F(MeasuredTools, SetNothingByAWrongEntry) {
  for (const int number : {1, 2, 3}) grind(number, 2, 0);
  grind(7, 2, 0);
  measure({"core@2=7.252"}, 7);
  const Json wrong = correct(1);
  EXPECT_TRUE(wrong["alarm"]);
  EXPECT_EQ(wrong["measured"], 3);
  EXPECT_EQ(wrong["offsets"]["y_mm"], 1.5);
  EXPECT_EQ(err_.find("tool 7: core_diameter@2 = 7.252 mm; allowed: 7.1"), 0U) << err_;
  measure({"core@2=7.152"}, 7);
  EXPECT_FALSE(correct(0)["alarm"]);
  measure({"core@2=7.252"}, 2);  // an earlier one is left out
  const Json earlier = correct(0);
  EXPECT_EQ(earlier["measured"], 3);
  EXPECT_EQ(earlier["left_out"].size(), 1U);
  const Json later = correct(0, 7);
  EXPECT_EQ(later["since"], 7);
  EXPECT_EQ(later["measured"], 1);
}

TEST_F(MeasuredTools, NeedSomethingMeasuredOfTheFlutes) {
  const auto refused = [&](const char* job, const char* operation, std::uint64_t since = 0) {
    return test_support::refusalOf<std::invalid_argument>(
        [&] { grinder::correct("grinder", asking(job, operation, since, false)); });
  };
  EXPECT_EQ(refused(kJob, ""), "no tool of this job and set-up is in the records");
  keep(1);
  EXPECT_EQ(refused(kJob, "").find("no tool has been measured since its zero points were found"), 0U);
  EXPECT_EQ(refused(kJob, "", 2), "--since 2; allowed: up to 1, the last tool");
  EXPECT_EQ(refused("jobs/end_mill_d10_t4.yaml", "gash").find("operation = gash; allowed: flute, primary,"), 0U);
}

TEST_F(MeasuredTools, WearTheWheelThoughNobodyMeasuresThem) {
  for (const int number : {1, 2, 3, 4}) grind(number, 4 * number, 0);
  for (const int number : {5, 6, 7, 8}) keep(number);
  EXPECT_NEAR(correct(0)["turn"]["y_mm"], -9 * 0.004, 0.006);
}

TEST(SettingsText, HasTheTurnOfTheSwivelByHand) {
  SetupFindings found;
  found.measured = 1;
  found.last.offset = Turns::Zero();
  Correction turns;
  turns.by_swivel = true;
  for (const auto& [turn, by] :
       {std::pair(SetupTurn::kY, 12e-6), {SetupTurn::kZ, -4e-6}, {SetupTurn::kSwivel, -0.25 * units::kDegree}}) {
    turns.turn[indexOf(turn)] = by;
  }
  EXPECT_EQ(
      settingsText(found, turns),
      "work offset of Y: +0.0120 mm, to 0.0120 mm\nwork offset of Z: -0.0040 mm, to -0.0040 mm\n"
      "turn the swivel by -0.250 deg, at its scale or stop, and confirm the job's angle again; then use 'grind correct "
      "--since'");
  EXPECT_NEAR(mostTurns({1, 2, 3, 4})[indexOf(SetupTurn::kSwivel)], units::kDegree, 1e-12);
}

}  // namespace test_cli_measured
}  // namespace grinder
