// Touching off, against where a wheel's edges stand.

#include "flute_grinder/geometry/touch_off.h"

#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace flute_grinder {
namespace test_touch_off {

using units::kDegree;
using units::kMillimetre;

constexpr double kMicron = 1e-6;
const double kEdge = 1.5 * kMillimetre * std::cos(31.769 * kDegree);  ///< above the middle of the wheel

/// A wheel of 3 mm at a height of 2.788 mm, by its swivel of 31.769 deg.
GrindJob paper() { return readJobFile(SOURCE_DIR "/jobs/paper.yaml"); }

GrindJob worn() {
  GrindJob job = paper();
  job.process.wheel_wear = 0.25 * kMillimetre;
  return job;
}

/// Only the edge of the upper face is as large as the wheel.
GrindJob tapered() {
  GrindJob job = worn();
  job.process.wheel_profile = WheelShape::kAngled;
  job.process.wheel_angle = 20 * kDegree;
  return job;
}

TEST(TouchOff, TellsWhatTheAxesRead) {
  TouchReadings touch = touchReadings(paper());
  EXPECT_EQ(touch.y, 0);
  EXPECT_NEAR(touch.z_for_y / kMillimetre, -2.788, 1e-9);
  EXPECT_NEAR(touch.z / kMillimetre, 1.5 - 2.788, 1e-9);
  touch = touchReadings(tapered());
  EXPECT_NEAR(touch.y / kMillimetre, -0.25, 1e-9);
  EXPECT_NEAR(touch.z_for_y / kMillimetre, -(2.788 + kEdge / kMillimetre), 1e-6);
}

TEST(TouchOff, YIsThatOfTheBlankLessTheWear) {
  EXPECT_NEAR(touchY(paper(), 10 * kMillimetre), 0, 1e-15);
  EXPECT_NEAR(touchY(paper(), 12.02 * kMillimetre), 1.01 * kMillimetre, 1e-15);
  EXPECT_NEAR(touchY(worn(), 12.02 * kMillimetre), 0.76 * kMillimetre, 1e-15);
}

TEST(TouchOff, AStraightWheelTouchesOverItsWidth) {
  const double middle = -2.788 * kMillimetre;
  for (const double off : {-kEdge + kMicron, 0.0, kEdge - kMicron}) EXPECT_EQ(heightRefusal(paper(), middle + off), "");
  for (const double off : {-kEdge - 3 * kMicron, kEdge + 3 * kMicron}) {
    EXPECT_NE(heightRefusal(paper(), middle + off).find("move Z to -2.788 mm, and touch again"), std::string::npos);
  }
  EXPECT_EQ(heightRefusal(paper(), 0).find("the wheel's centre stands 2.788 mm above the cutter's axis: "), 0U);
  EXPECT_NE(heightRefusal(paper(), std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(TouchOff, ATaperedWheelTouchesAtItsLargerFace) {
  const double edge = -2.788 * kMillimetre - kEdge;
  EXPECT_EQ(heightRefusal(tapered(), edge), "");
  EXPECT_EQ(heightRefusal(tapered(), touchReadings(tapered()).z_for_y), "");
  EXPECT_NE(heightRefusal(tapered(), edge - 3 * kMicron), "");
  EXPECT_NE(heightRefusal(tapered(), -2.788 * kMillimetre).find("move Z to -4.0632"), std::string::npos)
      << heightRefusal(tapered(), -2.788 * kMillimetre);
}

}  // namespace test_touch_off
}  // namespace flute_grinder
