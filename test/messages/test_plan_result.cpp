#include "flute_grinder/messages/plan_result.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_plan_result {

TEST(PlanResult, HasWhatThePassesRemoveInSiUnitsAndInWords) {
  PlannedJob plan;
  EXPECT_TRUE(resultOf(plan).plan.passes.empty()) << "they were not measured";
  plan.passes = {{0.4e-3, 0, 0, 0}, {0.8e-3, 0.31254e-6, 2.1356e-9, 40e-9}, {0.8e-3, 0, 0, 0}};
  const flute_grinder::PlanReport report = resultOf(plan).plan;
  ASSERT_EQ(report.passes.size(), 3u);
  EXPECT_EQ(report.passes[1].depth, 0.8e-3);
  EXPECT_EQ(report.passes[1].area, 0.31254e-6);
  EXPECT_EQ(report.passes[1].rate, 2.1356e-9);
  EXPECT_EQ(report.passes[1].volume, 40e-9);
  EXPECT_EQ(passText(report, 0), "0.4000 mm, removes nothing");
  EXPECT_EQ(passText(report, 1), "0.8000 mm, 0.3125 mm^2, 2.14 mm^3/s");
  EXPECT_EQ(passText(report, 2), "0.8000 mm, spark-out");
}

}  // namespace test_plan_result
}  // namespace grinder
