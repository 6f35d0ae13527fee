#include "tool/ground_end.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

namespace grinder {
namespace test_ground_end {

using Eigen::Vector3d;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

constexpr CutDirection kHands[] = {CutDirection::kRightHand, CutDirection::kLeftHand};

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
    const bool is_cup = wheel.inner_radius > 0;  // it goes out as it came, along X
    if (!is_cup && covers(off)) return true;
  }
  return false;
}

bool isIn(const RemovedVolume& volume, const Vector3d& place) {
  const auto in_front = [&](const Plane& plane) { return plane.height(place) > 0; };
  const bool in_body = std::all_of(volume.body.begin(), volume.body.end(), in_front);
  return in_body && (volume.hollow.empty() || std::any_of(volume.hollow.begin(), volume.hollow.end(), in_front));
}

TEST(FaceSweep, RemovesWhatTheWheelPassesThrough) {
  auto between = test_support::numbers(11);
  int removed_places = 0, left_places = 0;
  for (int i = 0; i < 12; ++i) {
    const CutDirection cut = kHands[i / 3 % 2];
    const EndTooth tooth{between(3, 8) * kMillimetre, kPi / 2, cut};
    FaceWheel wheel = wheelOf(between(50, 100), between(3, 8));
    const double corner = i % 3 == 0 ? 0 : between(0.1, 1) * kMillimetre;
    const bool gash = i % 3 < 2;
    if (!gash && cut == CutDirection::kLeftHand) wheel.inner_radius = wheel.radius - 1.2 * tooth.radius;
    const bool plunges = wheel.inner_radius > 0;
    const WheelProfile profile =
        i % 3 == 1 ? WheelProfile::angled(2 * wheel.radius, wheel.width, 20 * kDegree, {corner, 0})
                   : WheelProfile::straight(2 * wheel.radius, wheel.width, {plunges ? 0 : corner, corner / 2});
    const double dish = between(0, 3) * kDegree;
    const FaceStroke stroke = gash ? gashStroke(tooth, gashNormal(between(-8, 12) * kDegree, dish),
                                                between(25, 60) * kDegree, -0.1 * kMillimetre, wheel, 1 * kMillimetre)
                                   : endStroke(tooth, endNormal(between(5, 20) * kDegree, dish), {0, tooth.radius, 0},
                                               wheel, 0.2 * kMillimetre, 1 * kMillimetre);
    const FaceSweep sweep(stroke, wheel, profile, tooth.radius, 0);
    const RemovedVolume volume = sweep.volume(1e-6);
    for (int k = 0; k < 300; ++k) {
      const double r = tooth.radius * between(0.01, 1), angle = between(0, 2 * kPi);
      const double x = tooth.radius * between(-0.2, 1);
      const Eigen::Vector2d ray(r * std::cos(angle), r * std::sin(angle));
      constexpr double kNear = 0.02 * kMillimetre;
      const bool removed = sweep.removes(ray, x);
      const std::optional<double> to = sweep.removedTo(ray, x);
      ASSERT_EQ(to.has_value(), removed);
      EXPECT_TRUE(!to || (*to >= x && sweep.removes(ray, *to - 1e-9) && !sweep.removes(ray, *to + 1e-9))) << i;
      const bool near = sweep.removes(ray, x - kNear) != removed || sweep.removes(ray, x + kNear) != removed;
      if (near) continue;
      (removed ? removed_places : left_places)++;
      EXPECT_EQ(isIn(volume, {x, ray[0], ray[1]}), removed);
      EXPECT_EQ(isInWheel(stroke, wheel, profile, tooth.radius, {x, ray[0], ray[1]}), removed)
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
    const double bottom = sweep.removedTo({r, -1e-9 * r}, 0).value_or(0);
    EXPECT_NEAR(bottom, (r + past) / std::tan(angle), 1e-9);
  }
}

/// A random end with all its strokes, the gashes turned behind the radius.
struct WholeEnd {
  template <typename Between>
  WholeEnd(int teeth, CutDirection cut, double turn, Between& between)
      : right(cut == CutDirection::kRightHand),
        tooth{between(3, 8) * kMillimetre, 2 * kPi / teeth, cut},
        clearance(between(5, 10) * kDegree),
        second(between(14, 22) * kDegree),
        dish(between(0.5, 3) * kDegree),
        rake(between(0, 10) * kDegree),
        land(between(0.04, 0.1) * tooth.radius),
        width(between(0.02, 0.05) * tooth.radius),
        angle(between(30, 60) * kDegree),
        chamfer_clearance(between(6, 14) * kDegree) {
    const FaceWheel thin = wheelOf(100, 0.3 * tooth.radius / kMillimetre);
    FaceWheel wheel = plain;
    if (!right) wheel.inner_radius = wheel.radius - 1.2 * tooth.radius;
    const double past = -between(0.02, 0.05) * tooth.radius;
    const auto flank = [&](const OnTooth& normal, const OnTooth& through) {
      return endStroke(tooth, normal, through, wheel, kGap, 1 * kMillimetre);
    };
    const OnTooth land_end(land * std::tan(clearance), tooth.radius, land);
    add(OperationKind::kPrimaryEnd, flank(endNormal(clearance, dish), {0, tooth.radius, 0}), wheel);
    add(OperationKind::kSecondaryEnd, flank(endNormal(second, dish), land_end), wheel);
    const OnTooth normal = chamferNormal(angle, chamfer_clearance, dish, std::tan(rake));
    add(OperationKind::kChamfer, chamferStroke(tooth, normal, corner(), plain, kGap, 1 * kMillimetre), plain);
    add(OperationKind::kGash, gashStroke(tooth, gashNormal(rake, dish), 45 * kDegree, past, thin, 1 * kMillimetre),
        thin);
    strokes.back().stroke.to[kA] += right ? turn : -turn;
    strokes.back().stroke.from[kA] = strokes.back().stroke.to[kA];
    for (int k = 0; k < teeth; ++k) angles.push_back(k * tooth.pitch);
  }

  /// Where the chamfer's edge ends on the periphery.
  OnTooth corner() const {
    const double x = width * (1 / std::tan(angle) + std::tan(dish));
    return {x, tooth.radius, x * std::tan(rake)};
  }

  GroundEnd ground() const {
    std::vector<EndCut> cuts;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      for (const Ground& one : strokes) {
        cuts.push_back({k, one.face, {one.stroke, one.wheel, one.profile, tooth.radius, angles[k]}});
      }
    }
    return {tooth.radius, tooth.cut, angles, std::move(cuts), 0};
  }

  /// Whether any stroke removes a place, a distance behind a tooth's radius, and below the flank that begins there.
  bool isRemoved(std::size_t k, double r, double behind, double below) const {
    const double x = (tooth.radius - r) * std::tan(dish) + std::max(0.0, behind) * std::tan(clearance) + below;
    const double from_axis = std::hypot(r, behind), at = angles[k] + (right ? 1 : -1) * std::atan2(behind, r);
    for (const double other : angles) {
      const Vector3d place(x, from_axis * std::cos(at - other), from_axis * std::sin(at - other));
      for (const Ground& one : strokes) {
        if (isInWheel(one.stroke, one.wheel, one.profile, tooth.radius, place)) return true;
      }
    }
    return false;
  }

  /// Whether an edge is at its place: all before it and above the flank is removed, and nothing under it.
  bool isWhole(std::size_t k, double r) const {
    const double tip = 1e-4 * tooth.radius, little = 1e-6 * tooth.radius;
    return !isRemoved(k, r, tip, little) && isRemoved(k, r, tip, -little) && isRemoved(k, r, -tip, little);
  }

  struct Ground {
    OperationKind face;
    FaceStroke stroke;
    FaceWheel wheel;
    WheelProfile profile;
  };
  void add(OperationKind face, const FaceStroke& stroke, const FaceWheel& wheel) {
    strokes.push_back({face, stroke, wheel, WheelProfile::straight(2 * wheel.radius, wheel.width)});
  }

  static constexpr double kGap = 0.05 * kMillimetre;
  bool right;
  FaceWheel plain = wheelOf(100, 10);
  EndTooth tooth;
  double clearance, second, dish, rake, land, width, angle, chamfer_clearance;
  std::vector<Ground> strokes;
  std::vector<double> angles;
};

std::ostream& operator<<(std::ostream& out, const WholeEnd& end) {
  return out << end.angles.size() << " teeth, " << (end.right ? "right" : "left") << ", R " << end.tooth.radius
             << ", clearances " << end.clearance / kDegree << ' ' << end.second / kDegree << ", dish "
             << end.dish / kDegree << ", rake " << end.rake / kDegree;
}

TEST(GroundEnd, FindsTheFlanksAndTheRakeOfAnyEnd) {
  auto between = test_support::numbers(11);
  for (int i = 0; i < 24; ++i) {
    const double turn = i % 4 < 2 ? 0 : 0.01;
    const WholeEnd end(2 + i % 3, kHands[i % 2], turn, between);
    SCOPED_TRACE(testing::Message() << end);
    const GroundEnd ground = end.ground();
    for (std::size_t k = 0; k < end.angles.size(); ++k) {
      for (const double part : {0.4, 0.65, 0.85}) {
        const double r = part * end.tooth.radius;
        const EndSection section = ground.section(k, r);
        ASSERT_TRUE(section.edge) << part;
        EXPECT_NEAR(section.behind, r * std::tan(turn), turn == 0 ? 1e-9 : 0.05 * r * turn);
        const double x = (end.tooth.radius - r) * std::tan(end.dish) + section.behind * std::tan(end.clearance);
        EXPECT_NEAR(*section.edge, x, 1e-9);
        EXPECT_NEAR(section.clearance.value_or(-1), end.clearance, 1e-6);
        EXPECT_NEAR(section.second_clearance.value_or(-1), end.second, 1e-6);
        EXPECT_NEAR(section.land.value_or(-1), end.land - section.behind, 1e-9);
        EXPECT_NEAR(section.rake.value_or(-1), end.rake, turn == 0 ? 1e-6 : 0.1 * turn);
      }
    }
  }
}

TEST(GroundEnd, FindsFromWhereEdgesAreWholeAndTheChamfer) {
  auto between = test_support::numbers(11);
  for (int i = 0; i < 12; ++i) {
    const WholeEnd end(2 + i % 3, kHands[i % 2], 0, between);
    SCOPED_TRACE(testing::Message() << end);
    const double radius = end.tooth.radius;
    const GroundEnd ground = end.ground();
    for (std::size_t k = 0; k < end.angles.size(); ++k) {
      const std::optional<double> whole_from = ground.wholeFrom(k);
      ASSERT_TRUE(whole_from);
      EXPECT_LT(*whole_from, 0.35 * radius);
      EXPECT_TRUE(end.isWhole(k, *whole_from + 0.01 * radius));
      EXPECT_FALSE(end.isWhole(k, *whole_from - 0.01 * radius)) << *whole_from;
      const std::optional<ChamferFigures> chamfer = ground.chamfer(k);
      ASSERT_TRUE(chamfer);
      EXPECT_NEAR(chamfer->width, end.width, 1e-7);
      EXPECT_NEAR(chamfer->angle, end.angle, 1e-4);
      EXPECT_NEAR(chamfer->clearance, end.chamfer_clearance, 1e-4);
    }
  }
}

/// An end of which a flute is ground, and perhaps a gash behind it.
TEST(GroundEnd, FindsWhatOfTheBlankIsLeftBehindAFlute) {
  const EndFlutes flutes(groundCutterOf(withLaws(ValidJob(readJobFile("jobs/end_mill_d10_t4.yaml", "flute")))));
  constexpr double kR = 4 * kMillimetre, kRadius = 5 * kMillimetre, kDeep = 0.1 * kMillimetre, kFine = 0.01 * kDegree;
  const auto is_flute = [&](double turn) {
    std::vector<Range> ranges;
    for (std::size_t i = 0; i < flutes.teeth(); ++i) flutes.addRemoved(i, kR, turn, ranges);
    return std::any_of(ranges.begin(), ranges.end(), [](const Range& x) { return x.from <= 0 && x.to > kDeep; });
  };
  double heel = 5 * kDegree;
  while (!is_flute(heel)) heel += kFine;
  double edge = heel + kDegree;
  while (is_flute(edge)) edge += kFine;

  const EndTooth tooth{kRadius, kPi / 2, CutDirection::kRightHand};
  const FaceWheel wheel = wheelOf(100, 1);
  const FaceStroke stroke = gashStroke(tooth, gashNormal(0, 0), 45 * kDegree, 0, wheel, 1 * kMillimetre);
  const auto gashAt = [&](double angle) {
    return FaceSweep(stroke, wheel, WheelProfile::straight(2 * wheel.radius, wheel.width), kRadius, angle);
  };
  double width = 0;
  while (gashAt(0).removes({kR * std::cos(width + kFine), -kR * std::sin(width + kFine)}, kDeep)) width += kFine;
  EXPECT_GT(width, 10 * kDegree);

  // By which the end stands in front of a place so deep, from within the flute.
  const auto drag = [&](double face, double to) {
    const GroundEnd end(kRadius, tooth.cut, {0, kPi / 2, kPi, 1.5 * kPi}, {{1, OperationKind::kGash, gashAt(face)}}, 0,
                        flutes);
    EndSection from;
    from.r = kR;
    from.edge = kDeep;
    from.behind = kR * std::tan(heel + 2 * kDegree);
    return end.heelDrag(0, from, to);
  };
  // A gash that begins in the flute, and one that leaves a fin beside it.
  EXPECT_EQ(drag(edge + width - kDegree, edge + 5 * kDegree), 0);
  for (const double fin : {0.2 * kDegree, 0.7 * kDegree}) {
    EXPECT_EQ(drag(edge + width + fin, edge + 5 * kDegree), kDeep);
  }
  // What is narrower than a step, just before where the heel ends.
  EXPECT_EQ(drag(edge + kPi, edge - 0.1 * kDegree), 0);
  EXPECT_EQ(drag(edge + kPi, edge + 0.2 * kDegree), kDeep);
}

/// A left-hand tool's edge is the lowest place of the chamfer's flank: one of its ends, by the helix.
TEST(FaceStroke, PassesTheEdgeOfALeftHandChamferByTheGap) {
  auto between = test_support::numbers(11);
  for (int i = 0; i < 20; ++i) {
    const WholeEnd end(4, CutDirection::kLeftHand, 0, between);
    const Axes& to = end.strokes[2].stroke.to;
    const double outer = end.tooth.radius * std::cos(-to[kA]) + end.corner()[2] * std::sin(-to[kA]);
    const double inner = (end.tooth.radius - end.width) * std::cos(-to[kA]);
    const double below =
        std::min(outer, inner) - (end.tooth.radius + end.plain.nominal_radius + to[kY] - end.plain.radius);
    EXPECT_GE(below, WholeEnd::kGap - 1e-12);
    EXPECT_LE(below, WholeEnd::kGap + end.width);
  }
}

}  // namespace test_ground_end
}  // namespace grinder
