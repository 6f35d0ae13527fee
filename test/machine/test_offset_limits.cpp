#include "flute_grinder/machine/offset_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grinder {
namespace test_offset_limits {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();
const double kTurn = 2 * std::acos(-1.0);

OffsetLimits limitsOf(double a) {
  AxisLimits travel;
  travel.min_position << -0.1, -0.02, -0.05, -a;
  travel.max_position << 0.3, 0.15, 0.1, a;
  return offsetLimits(travel, {0.005, 0.005, 0.005, kTurn});
}

TEST(OffsetLimits, AreTheTravelAndOfAOneTurnMore) {
  const OffsetLimits limits = limitsOf(1);
  for (const double good : {-0.02, 0.0, 0.15}) EXPECT_EQ(travelRefusal(limits, kY, good), "");
  EXPECT_EQ(travelRefusal(limits, kY, 0.1501),
            "work offset of axis Y = 150.1 mm; allowed: -20 to 150 mm, the travel of the axis");
  for (const double wrong : {-0.0201, 6.203, 1000.0, kNan, kInf, -kInf})
    EXPECT_NE(travelRefusal(limits, kY, wrong), "");
  EXPECT_EQ(travelRefusal(limits, kA, 1 + kTurn), "");
  EXPECT_NE(travelRefusal(limits, kA, 1.001 + kTurn), "");
}

TEST(OffsetLimits, OfAnAxisThatTurnsForEverAreThoseOfAnyOffset) {
  const OffsetLimits limits = limitsOf(kInf);
  EXPECT_EQ(travelRefusal(limits, kA, kMaxOffset), "");
  EXPECT_NE(travelRefusal(limits, kA, kMaxOffset * 1.001), "");
  EXPECT_NE(travelRefusal(limits, kA, kNan), "");
}

TEST(OffsetLimits, ALargeChangeOfOneThatWasSetWantsAConfirmation) {
  const OffsetLimits limits = limitsOf(100);
  const WorkOffset was{0.0015, "anna@grinder", 1.7e9};
  EXPECT_EQ(changeRefusal(limits, kY, was, 0.006), "");
  EXPECT_EQ(
      changeRefusal(limits, kY, was, -0.0105),
      "work offset of axis Y would change by 12 mm, from 1.5 mm to -10.5 mm; allowed without a confirmation: 5 mm");
  EXPECT_NE(changeRefusal(limits, kY, was, kNan), "");
  EXPECT_EQ(changeRefusal(limits, kA, was, 6), "");
  EXPECT_NE(changeRefusal(limits, kA, was, 7), "");
  EXPECT_EQ(changeRefusal(limits, kY, WorkOffset{}, 0.1), "") << "never set";
  EXPECT_EQ(changeRefusal(limits, kY, {kNan, "anna@grinder", 1.7e9}, 0.1), "") << "unknown";
}

}  // namespace test_offset_limits
}  // namespace grinder
