// Numbers in files, in a process whose locale has a comma in them, as rviz' may have.

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/job_file.h"
#include "german.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_numbers {

TEST(Numbers, HaveAPointInALocaleWithAComma) {
  const test_support::German german;
  ASSERT_TRUE(test_support::hasComma());
  EXPECT_EQ(format("%.5f", 3.11483), "3.11483");
  EXPECT_EQ(text({0.0124, Unit::kMetre}, 6), "12.4 mm");
  EXPECT_EQ(shopNumber(0.00311483, Unit::kMetre), 3.11483);
  const char* row = "3.11483,2";
  char* end = nullptr;
  EXPECT_EQ(parseNumber(row, &end), 3.11483);
  EXPECT_STREQ(end, ",2");
  EXPECT_TRUE(test_support::hasComma()) << "the process keeps its locale";
}

TEST(Numbers, OfAJobFileAreReadAndWrittenInALocaleWithAComma) {
  const std::string path = "jobs/paper.yaml";
  const GrindJob job = readJobFile(path);
  const test_support::German german;
  ASSERT_TRUE(test_support::hasComma());
  const GrindJob again = readJobFile(path);
  EXPECT_EQ(again.cutter.end_diameter, job.cutter.end_diameter);
  EXPECT_EQ(again.process().depth, job.process().depth);
  EXPECT_EQ(withSetup("", "paper.setup.yaml", "paper.yaml", job), test_support::readFile("jobs/paper.setup.yaml"));
}

}  // namespace test_numbers
}  // namespace grinder
