// Touching off, against where a wheel's edges stand.

#include "flute_grinder/setup/touch_off.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/ground_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace grinder {
namespace test_touch_off {

using units::kDegree;
using units::kMillimetre;

constexpr double kMicron = 1e-6;
const double kEdge = 1.5 * kMillimetre * std::cos(31.769 * kDegree);  ///< above the middle of the wheel

/// A wheel of 3 mm at a height of 2.788 mm, by its swivel of 31.769 deg.
GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

GrindJob worn() {
  GrindJob job = paper();
  job.process().wheel_wear = 0.25 * kMillimetre;
  return job;
}

/// Only the edge of the upper face is as large as the wheel.
GrindJob tapered() {
  GrindJob job = worn();
  job.process().wheel_profile = WheelShape::kAngled;
  job.process().wheel_angle = 20 * kDegree;
  return job;
}

TEST(TouchOff, ReportsWhatTheAxesRead) {
  const TouchReadings touch = touchReadings(paper());
  EXPECT_EQ(touch.y, 0);
  EXPECT_NEAR(touch.z_for_y / kMillimetre, -2.788, 1e-9);
  EXPECT_NEAR(touch.z / kMillimetre, 1.5 - 2.788, 1e-9);
}

TEST(TouchOff, AStraightWheelTouchesOverItsWidth) {
  const double middle = -2.788 * kMillimetre;
  for (const double off : {-kEdge + kMicron, 0.0, kEdge - kMicron}) EXPECT_EQ(heightRefusal(paper(), middle + off), "");
  for (const double off : {-kEdge - 3 * kMicron, kEdge + 3 * kMicron}) {
    EXPECT_NE(heightRefusal(paper(), middle + off).find("move Z to -2.788 mm, and touch again"), std::string::npos);
  }
  EXPECT_EQ(heightRefusal(paper(), 0).find("the wheel's centre is 2.788 mm above the cutter's axis: "), 0U);
  EXPECT_NE(heightRefusal(paper(), std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(TouchOff, ATaperedWheelTouchesAtItsLargerFace) {
  const double edge = -2.788 * kMillimetre - kEdge;
  EXPECT_EQ(heightRefusal(tapered(), edge), "");
  EXPECT_NE(heightRefusal(tapered(), edge - 3 * kMicron), "");
  EXPECT_NE(heightRefusal(tapered(), -2.788 * kMillimetre).find("move Z to -4.0632"), std::string::npos)
      << heightRefusal(tapered(), -2.788 * kMillimetre);
}

/// The minimum gap between a blank and the wheel, over the wheel's whole surface: its meridian (w, radius) by
/// trigonometry alone, turned about the spindle, at the work positions Y and Z.
double gapToBlank(const GrindJob& job, double blank_diameter, double y, double z,
                  const std::function<double(double)>& radius) {
  const GrindProcess& p = job.process();
  const double centre_y = job.cutter.end_diameter / 2 + p.wheel_diameter / 2 + y, centre_z = p.setup_height + z;
  double gap = std::numeric_limits<double>::infinity();
  constexpr int kPlaces = 2000, kTurns = 2;
  for (int i = 0; i <= kPlaces; ++i) {
    const double w = p.wheel_width * (static_cast<double>(i) / kPlaces - 0.5);
    for (int k = -kTurns; k <= kTurns; ++k) {
      const double turn = 0.1 * k / kTurns;  // about the line toward the blank
      const double in_plane = radius(w) * std::sin(turn);
      const double at_y = centre_y - radius(w) * std::cos(turn);
      const double at_z = centre_z + w * std::cos(p.setup_swivel) + in_plane * std::sin(p.setup_swivel);
      gap = std::min(gap, std::hypot(at_y, at_z) - blank_diameter / 2);
    }
  }
  return gap;
}

/// The meridian of a bevelled wheel whose maximum diameter is given, its larger face up or down, and its corners
/// rounded: circles that touch the face and the line.
class Bevel {
 public:
  Bevel(double diameter, double width, double angle, bool upper, double lower_corner, double upper_corner)
      : width_(width),
        tan_(std::tan(angle)),
        upper_(upper),
        large_(upper ? upper_corner : lower_corner),
        small_(upper ? lower_corner : upper_corner) {
    // By rc (tan a + 1/cos a - 1) the line's end lies outside the circle's top.
    sharp_ = diameter / 2 + large_ * (tan_ + 1 / std::cos(angle) - 1);
  }

  double operator()(double w) const {
    const double in = width_ / 2 - (upper_ ? w : -w);  // from the larger face
    const double hypotenuse = std::hypot(1, tan_);
    const double line = sharp_ - in * tan_;
    const double large_centre = sharp_ - large_ * (tan_ + hypotenuse);
    if (in < large_ * (1 + tan_ / hypotenuse)) {
      return large_centre + std::sqrt(std::max(0.0, large_ * large_ - (large_ - in) * (large_ - in)));
    }
    const double out = width_ - in;  // from the smaller face
    if (out < small_ * (1 - tan_ / hypotenuse)) {
      const double centre = sharp_ - (width_ - small_) * tan_ - small_ * hypotenuse;
      return centre + std::sqrt(std::max(0.0, small_ * small_ - (small_ - out) * (small_ - out)));
    }
    return line;
  }

 private:
  double width_, tan_;
  bool upper_;
  double large_, small_, sharp_;
};

// What a micrometer measures, job and machine agree: the wheel touches where the sheet says.
TEST(TouchOff, AWheelWithRoundedCornersTouchesTheBlankAtItsReading) {
  struct Case {
    double angle, lower, upper;
  };
  for (const Case c : {Case{45, 0.5, 0.5}, Case{20, 0.1, 0.1}, Case{30, 0, 0.8}, Case{30, 0.8, 0}, Case{60, 0.3, 0.2},
                       Case{0, 0.5, 0.3}}) {
    for (const WheelFace side : {WheelFace::kUpper, WheelFace::kLower}) {
      for (const WheelShape shape : {WheelShape::kStraight, WheelShape::kAngled, WheelShape::kCup}) {
        if (shape == WheelShape::kStraight && c.angle != 0) continue;
        GrindJob job = worn();
        GrindProcess& p = job.process();
        p.wheel_profile = shape;
        p.wheel_side = side;
        p.wheel_width = 10 * kMillimetre;
        p.wheel_angle = c.angle * kDegree;
        p.wheel_corner_radius_lower = c.lower * kMillimetre;
        p.wheel_corner_radius_upper = c.upper * kMillimetre;
        const Bevel wheel(p.wheel_diameter - 2 * p.wheel_wear, p.wheel_width, p.wheel_angle, side == WheelFace::kUpper,
                          p.wheel_corner_radius_lower, p.wheel_corner_radius_upper);
        const double z = touchReadings(job).z_for_y;
        for (const double blank : {10.0, 12.02}) {
          const double y = touchY(job, blank * kMillimetre);
          EXPECT_NEAR(gapToBlank(job, blank * kMillimetre, y, z, wheel), 0, 2e-8) << c.angle << ' ' << blank;
        }
        EXPECT_EQ(heightRefusal(job, z), "") << c.angle;
        const WheelProfile profile = wheelOf(job).worn(p.wheel_wear);
        for (const double part : {0.0, 0.001, 0.02, 0.3, 0.5, 0.9, 0.98, 0.999, 1.0}) {
          const double w = p.wheel_width * (part - 0.5);
          EXPECT_NEAR(profile.radius(w), wheel(w), 1e-10) << c.angle << ' ' << part;
        }
      }
    }
  }
}

TEST(TouchOff, AFullRadiusAndPointsMeasureTheirDiameterToo) {
  GrindJob job = worn();
  GrindProcess& p = job.process();
  const double max = p.wheel_diameter / 2;
  p.wheel_profile = WheelShape::kFullRadius;
  EXPECT_DOUBLE_EQ(wheelOf(job).maxRadius(), max);
  EXPECT_NEAR(wheelOf(job).radius(0.0015 * std::sin(0.7)), max - 0.0015 + 0.0015 * std::cos(0.7), 1e-9);
  EXPECT_NEAR(touchReadings(job).z_for_y, -p.setup_height, 1e-12);
  // A line of 45 deg up to a corner of 0.5 mm: its profile is as high as if it were rounded from outside.
  p.wheel_profile = WheelShape::kPoints;
  p.wheel_corner_radius_upper = 0.5 * kMillimetre;
  job.process().wheel_points = {{-0.0015, max - 0.003}, {0.0015, max}};
  EXPECT_NEAR(wheelOf(job).maxRadius(), max, 1e-15);
  EXPECT_NEAR(wheelOf(job).radius(-0.0015), max - 0.003 + 0.0005 * std::sqrt(2), 1e-12);
  const double top = 0.0015 - 0.0005;
  EXPECT_NEAR(touchReadings(job).z_for_y, -(p.setup_height + top * std::cos(p.setup_swivel)), 1e-12);
  // Of two ribs, the upper one touches.
  p.wheel_corner_radius_upper = 0;
  job.process().wheel_points = {{-0.0015, max}, {-0.0010, max}, {0, max - 0.001}, {0.0005, max}, {0.0015, max}};
  EXPECT_NEAR(touchReadings(job).z_for_y, -(p.setup_height + 0.001 * std::cos(p.setup_swivel)), 1e-12);
  EXPECT_EQ(heightRefusal(job, touchReadings(job).z_for_y), "");
}

/// A machine whose flange is 23.5 mm above the swivel's centre.
MachineGeometry machine() {
  MachineGeometry m;
  m.work_axis_z = -0.02;
  m.swivel_centre = {0.001, 0.2, 0.3};
  m.flange = 0.0235;
  return m;
}

TEST(TouchOff, ZCountsWhatTheSwivelLowersTheWheel) {
  GrindJob job = readJobFile("jobs/unequal_d12_t4.yaml");
  const MachineGeometry m = machine();
  const auto above = wheelAboveSwivel(openJobFile("jobs/unequal_d12_t4.yaml").wheel, job, m);
  ASSERT_TRUE(above);
  EXPECT_NEAR(*above / kMillimetre, 23.5 - 2 - 1.5, 1e-9);
  for (const double swivel : {38.734, -55.0, 0.0}) {
    job.process().setup_swivel = swivel * kDegree;
    // With the swivel at 0 the wheel's middle is 20 mm above the swivel's centre, its lower face 1.5 mm below.
    const double blank = 12 * kMillimetre;
    const double at_touch = m.work_axis_z + blank / 2 + 1.5 * kMillimetre - (m.swivel_centre.z() + 20 * kMillimetre);
    const double reads = at_touch - workZero(m, job, {2 * kMillimetre, 0.06}).z();
    EXPECT_NEAR(blank / 2 + touchReadings(job, *above).z, reads, 1e-12) << swivel;
    EXPECT_NEAR(touchReadings(job).z - touchReadings(job, *above).z,
                20 * kMillimetre * (1 - std::cos(swivel * kDegree)), 1e-12);
  }
}

TEST(TouchOff, WithoutAWheelFileOrItsFlangeTheWheelsPlaceIsNotKnown) {
  EXPECT_FALSE(wheelAboveSwivel(WheelFile{}, paper(), machine()));
  EXPECT_FALSE(wheelAboveSwivel(std::nullopt, paper(), machine()));
}

}  // namespace test_touch_off
}  // namespace grinder
