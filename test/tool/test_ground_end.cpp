#include "tool/ground_end.h"

#include "flute_grinder/base/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace grinder {
namespace test_ground_end {

using Eigen::Vector3d;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

constexpr CutDirection kHands[] = {CutDirection::kRightHand, CutDirection::kLeftHand};

class Random {
 public:
  double between(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }

 private:
  std::mt19937 engine_{11};
};

FaceWheel wheelOf(double diameter, double width) {
  FaceWheel wheel;
  wheel.nominal_radius = (diameter / 2 + 0.2) * kMillimetre;
  wheel.radius = diameter / 2 * kMillimetre;
  wheel.width = width * kMillimetre;
  wheel.height = -2 * kMillimetre;
  return wheel;
}

/// Whether a place is in the wheel in any of many poses along the stroke and on the way out of it.
bool isInWheel(const FaceStroke& stroke, const FaceWheel& wheel, const WheelProfile& profile, double radius,
               const Vector3d& place) {
  const double turn = std::atan2(place[2], place[1]) - stroke.to[kA], r = std::hypot(place[1], place[2]);
  const Vector3d at(place[0], r * std::cos(turn), r * std::sin(turn));
  const Vector3d spindle(-std::sin(stroke.swivel), 0, std::cos(stroke.swivel));
  const auto covers = [&](const Axes& axes) {
    const Vector3d from_centre =
        at - Vector3d(axes[kX], radius + wheel.nominal_radius + axes[kY], wheel.height + axes[kZ]);
    const double w = from_centre.dot(spindle), q = (from_centre - w * spindle).norm();
    return std::abs(w) <= wheel.width / 2 && q <= profile.radius(w) && q >= wheel.inner_radius;
  };
  for (int i = 0; i <= 250; ++i) {
    Axes on_stroke = stroke.from + i / 250.0 * (stroke.to - stroke.from), off = stroke.to;
    off[kY] += i / 250.0 * 4 * radius;
    if (covers(on_stroke)) return true;
    if (std::abs(stroke.per_stock[kX]) > 0 && stroke.from[kX] != stroke.to[kX]) continue;  // out along X
    if (covers(off)) return true;
  }
  return false;
}

TEST(FaceSweep, RemovesWhatTheWheelPassesThrough) {
  Random random;
  int removed_places = 0, left_places = 0;
  for (int i = 0; i < 12; ++i) {
    const CutDirection cut = kHands[i / 3 % 2];
    const EndTooth tooth{random.between(3, 8) * kMillimetre, kPi / 2, cut};
    FaceWheel wheel = wheelOf(random.between(50, 100), random.between(3, 8));
    const double corner = i % 3 == 0 ? 0 : random.between(0.1, 1) * kMillimetre;
    const bool gash = i % 3 < 2;
    if (!gash && cut == CutDirection::kLeftHand) wheel.inner_radius = wheel.radius - 1.2 * tooth.radius;
    const bool plunges = wheel.inner_radius > 0;
    const WheelProfile profile =
        i % 3 == 1 ? WheelProfile::angled(2 * wheel.radius, wheel.width, 20 * kDegree, {corner, 0})
                   : WheelProfile::straight(2 * wheel.radius, wheel.width, {plunges ? 0 : corner, corner / 2});
    const double dish = random.between(0, 3) * kDegree;
    const FaceStroke stroke =
        gash ? gashStroke(tooth, gashNormal(random.between(-8, 12) * kDegree, dish), random.between(25, 60) * kDegree,
                          -0.1 * kMillimetre, wheel, 1 * kMillimetre)
             : endStroke(tooth, endNormal(random.between(5, 20) * kDegree, dish), {0, tooth.radius, 0}, wheel,
                         0.2 * kMillimetre, 1 * kMillimetre);
    const FaceSweep sweep(stroke, wheel, profile, tooth.radius, 0);
    for (int k = 0; k < 300; ++k) {
      const double r = tooth.radius * random.between(0.01, 1), angle = random.between(0, 2 * kPi);
      const double x = tooth.radius * random.between(-0.2, 1);
      std::vector<Range> ranges;
      sweep.addRemoved(r, angle, ranges);
      bool removed = false, near = false;
      constexpr double kNear = 0.02 * kMillimetre;
      for (const Range& range : ranges) {
        removed = removed || (x >= range.from && x <= range.to);
        near = near || std::abs(x - range.from) < kNear || std::abs(x - range.to) < kNear;
      }
      if (near) continue;
      (removed ? removed_places : left_places)++;
      EXPECT_EQ(isInWheel(stroke, wheel, profile, tooth.radius, {x, r * std::cos(angle), r * std::sin(angle)}), removed)
          << i << ": " << x << ' ' << r << ' ' << angle;
    }
  }
  EXPECT_GT(removed_places, 200);
  EXPECT_GT(left_places, 200);
}

/// In front of its face, a gash ends at a straight bottom.
TEST(FaceSweep, HasAStraightBottomInAGash) {
  const EndTooth tooth{5 * kMillimetre, kPi / 2, CutDirection::kRightHand};
  const FaceWheel wheel = wheelOf(100, 3);
  const double angle = 40 * kDegree, past = -0.1 * kMillimetre;
  const FaceStroke stroke = gashStroke(tooth, gashNormal(0, 0), angle, past, wheel, 1 * kMillimetre);
  const FaceSweep sweep(stroke, wheel, WheelProfile::straight(2 * wheel.radius, wheel.width), tooth.radius, 0);
  for (double r = 0.2 * kMillimetre; r < tooth.radius; r += 0.1 * kMillimetre) {
    std::vector<Range> ranges;
    sweep.addRemoved(r, -1e-9, ranges);
    double bottom = 0;
    for (const Range& range : ranges) bottom = std::max(bottom, range.to);
    EXPECT_NEAR(bottom, (r + past) / std::tan(angle), 1e-9);
  }
}

TEST(GroundEnd, FindsTheFiguresOfAnyEnd) {
  Random random;
  for (int i = 0; i < 24; ++i) {
    const CutDirection cut = kHands[i % 2];
    const bool right = i % 2 == 0;
    const int teeth = 2 + i % 3;
    const EndTooth tooth{random.between(3, 8) * kMillimetre, 2 * kPi / teeth, cut};
    const double clearance = random.between(5, 10) * kDegree, second = random.between(14, 22) * kDegree;
    const double dish = random.between(0.5, 3) * kDegree, rake = random.between(0, 10) * kDegree;
    const double land = random.between(0.04, 0.1) * tooth.radius;
    const double past = -random.between(0.02, 0.05) * tooth.radius;
    const double turn = i % 4 < 2 ? 0 : 0.01;  // of the gashes, behind the radius
    SCOPED_TRACE(testing::Message() << teeth << " teeth, hand " << i % 2 << ", R " << tooth.radius << ", clearances "
                                    << clearance / kDegree << ' ' << second / kDegree << ", dish " << dish / kDegree
                                    << ", rake " << rake / kDegree);
    FaceWheel wheel = wheelOf(100, 10), thin = wheelOf(100, 0.3 * tooth.radius / kMillimetre);
    if (!right) wheel.inner_radius = wheel.radius - 1.2 * tooth.radius;
    const auto strokeOf = [&](const OnTooth& normal, const OnTooth& through) {
      return endStroke(tooth, normal, through, wheel, 0.05 * kMillimetre, 1 * kMillimetre);
    };
    const FaceStroke gash = gashStroke(tooth, gashNormal(rake, dish), 45 * kDegree, past, thin, 1 * kMillimetre);
    const FaceStroke primary = strokeOf(endNormal(clearance, dish), {0, tooth.radius, 0});
    const FaceStroke secondary = strokeOf(endNormal(second, dish), {land * std::tan(clearance), tooth.radius, land});
    const double width = random.between(0.02, 0.05) * tooth.radius, angle = random.between(30, 60) * kDegree;
    const double chamfer_clearance = random.between(6, 14) * kDegree;
    const double corner_x = width * (1 / std::tan(angle) + std::tan(dish));
    const FaceWheel plain = wheelOf(100, 10);
    const FaceStroke chamfer =
        chamferStroke(tooth, chamferNormal(angle, chamfer_clearance, dish, std::tan(rake)),
                      {corner_x, tooth.radius, corner_x * std::tan(rake)}, plain, 0.05 * kMillimetre, 1 * kMillimetre);
    if (!right) {
      // A left-hand tool's edge is the lowest place of the flank.
      const double at = -chamfer.to[kA], edge = tooth.radius * std::cos(at) + corner_x * std::tan(rake) * std::sin(at);
      const double rim = tooth.radius + plain.nominal_radius + chamfer.to[kY] - plain.radius;
      EXPECT_NEAR(rim, edge - 0.05 * kMillimetre, 1e-12);
    }
    const WheelProfile profile = WheelProfile::straight(2 * wheel.radius, wheel.width);
    const WheelProfile gasher = WheelProfile::straight(2 * thin.radius, thin.width);
    std::vector<double> angles;
    std::vector<EndCut> cuts;
    for (int k = 0; k < teeth; ++k) {
      const double tooth_angle = k * tooth.pitch;
      const auto number = static_cast<std::size_t>(k);
      angles.push_back(tooth_angle);
      cuts.push_back({number, EndFace::kPrimary, {primary, wheel, profile, tooth.radius, tooth_angle}});
      cuts.push_back({number, EndFace::kSecondary, {secondary, wheel, profile, tooth.radius, tooth_angle}});
      cuts.push_back({number, EndFace::kChamfer, {chamfer, plain, profile, tooth.radius, tooth_angle}});
      cuts.push_back(
          {number, EndFace::kGash, {gash, thin, gasher, tooth.radius, tooth_angle + (right ? turn : -turn)}});
    }
    const GroundEnd end(tooth.radius, cut, angles, cuts, 0);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const std::optional<double> whole_from = end.wholeFrom(k);
      ASSERT_TRUE(whole_from);
      EXPECT_LT(*whole_from, 0.35 * tooth.radius);
      // Whole is where the edge is at its place: all before it and above the flank is removed, and nothing under it.
      const auto is_removed = [&](double r, double behind, double below) {
        const double x = (tooth.radius - r) * std::tan(dish) + std::max(0.0, behind) * std::tan(clearance) + below;
        const double from_axis = std::hypot(r, behind), angle = angles[k] + (right ? 1 : -1) * std::atan2(behind, r);
        for (const double other : angles) {
          const Vector3d place(x, from_axis * std::cos(angle - other), from_axis * std::sin(angle - other));
          if (isInWheel(gash, thin, gasher, tooth.radius, place)) return true;
          if (isInWheel(primary, wheel, profile, tooth.radius, place)) return true;
          if (isInWheel(secondary, wheel, profile, tooth.radius, place)) return true;
          if (isInWheel(chamfer, plain, profile, tooth.radius, place)) return true;
        }
        return false;
      };
      const auto is_whole = [&](double r) {
        const double tip = 1e-4 * tooth.radius, little = 1e-6 * tooth.radius;
        return !is_removed(r, tip, little) && is_removed(r, tip, -little) && is_removed(r, -tip, little);
      };
      if (turn == 0) {
        EXPECT_TRUE(is_whole(*whole_from + 0.01 * tooth.radius));
        EXPECT_FALSE(is_whole(*whole_from - 0.01 * tooth.radius)) << *whole_from;
      }
      if (turn == 0) {
        const std::optional<ChamferFigures> found = end.chamfer(k);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->width, width, 1e-7);
        EXPECT_NEAR(found->angle, angle, 1e-4);
        EXPECT_NEAR(found->clearance, chamfer_clearance, 1e-4);
      }
      for (const double part : {0.4, 0.65, 0.85}) {
        const double r = part * tooth.radius;
        const EndSection section = end.section(k, r);
        ASSERT_TRUE(section.edge) << part;
        EXPECT_NEAR(section.behind, r * std::tan(turn), turn == 0 ? 1e-9 : 0.05 * r * turn);
        EXPECT_NEAR(*section.edge, (tooth.radius - r) * std::tan(dish) + section.behind * std::tan(clearance), 1e-9);
        EXPECT_NEAR(section.clearance.value_or(-1), clearance, 1e-6);
        EXPECT_NEAR(section.second_clearance.value_or(-1), second, 1e-6);
        EXPECT_NEAR(section.land.value_or(-1), land - section.behind, 1e-9);
        EXPECT_NEAR(section.rake.value_or(-1), rake, turn == 0 ? 1e-6 : 0.1 * turn);
      }
    }
  }
}

}  // namespace test_ground_end
}  // namespace grinder
