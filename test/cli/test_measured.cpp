// What `grind measured` and `grind correct` do with a folder of records.

#include "cli/measured.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/measured.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_cli_measured {

constexpr const char* kJob = "jobs/paper.yaml";

class MeasuredTools : public ::testing::Test {
 protected:
  std::string pathOf(int number) const {
    return folder_.path() / (format("%010d", number) + "_20261122T170413.123Z.json");
  }

  /// A record of a tool that was ground to its end.
  void keep(int number) {
    Record record;
    record.head.digest = digest_;
    record.head.outcome = "done";
    record.head.tool = "a cone";
    record.head.ended = "2026-11-22T17:05:13.123Z";
    record.body = {{"not_ground", "by \x1b"}};
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

}  // namespace test_cli_measured
}  // namespace grinder
