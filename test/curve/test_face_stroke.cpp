#include "flute_grinder/curve/face_stroke.h"

#include "flute_grinder/base/units.h"
#include "random_cases.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_face_stroke {

using Eigen::Vector3d;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

constexpr double kGap = 0.05 * kMillimetre;  ///< of the rim from the next tooth's edge
constexpr CutDirection kHands[] = {CutDirection::kRightHand, CutDirection::kLeftHand};

/// A tooth's direction in the machine, by a rotation about X; behind a left-hand edge is against it.
Vector3d turned(OnTooth direction, double tooth, CutDirection cut) {
  if (cut == CutDirection::kLeftHand) direction[2] *= -1;
  return Eigen::AngleAxisd(tooth, Vector3d::UnitX()) * direction;
}

Vector3d upperFaceNormal(double swivel) { return {-std::sin(swivel), 0, std::cos(swivel)}; }

TEST(FaceStroke, LaysAnyFlankOnTheLowerFace) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 10000; ++i) {
    const double colatitude = between(-10, 90) * kDegree, clearance = between(0.1, 45) * kDegree;
    const double spiral = between(-60, 60) * kDegree;
    const OnTooth normal = flankNormal(colatitude, clearance, spiral);
    // The edge lies in the flank, which falls by the clearance at right angles to it.
    const OnTooth surface(-std::cos(colatitude), std::sin(colatitude), 0);
    const OnTooth edge(std::sin(colatitude) * std::cos(spiral), std::cos(colatitude) * std::cos(spiral),
                       std::sin(spiral));
    EXPECT_NEAR(normal.norm(), 1, 1e-12);
    EXPECT_NEAR(normal.dot(edge), 0, 1e-12);
    EXPECT_NEAR(normal.dot(surface), std::cos(clearance), 1e-12);
    EXPECT_GT(normal[2], 0);
    for (const CutDirection cut : kHands) {
      const FacePose pose = flankPose(normal, cut);
      EXPECT_NEAR((turned(normal, pose.tooth, cut) - upperFaceNormal(pose.swivel)).norm(), 0, 1e-12);
    }
  }
}

/// A tool of which strokes take away what the wheel covers anywhere on their way: nothing but the axes' figures and the
/// wheel's.
class BruteForce {
 public:
  BruteForce(const FaceWheel& wheel, double end_radius, bool lower_face_grinds)
      : wheel_(wheel),
        end_radius_(end_radius),
        lower_(-wheel.width / 2 + (lower_face_grinds ? wheel.face_wear : 0)),
        upper_(wheel.width / 2 - (lower_face_grinds ? 0 : wheel.face_wear)) {}

  void grind(const FaceStroke& stroke, double tooth_angle, int poses) {
    for (int i = 0; i <= poses; ++i) {
      const Axes at = stroke.from + (stroke.to - stroke.from) * (static_cast<double>(i) / poses);
      const Vector3d centre(at[kX], end_radius_ + wheel_.nominal_radius + at[kY], wheel_.height + at[kZ]);
      poses_.push_back({centre, upperFaceNormal(stroke.swivel), at[kA] + tooth_angle});
    }
  }

  bool isGround(double x, double r, double angle) const {
    for (const Pose& pose : poses_) {
      const double turn = angle - pose.a;
      const Vector3d from_centre = Vector3d(x, r * std::cos(turn), r * std::sin(turn)) - pose.centre;
      const double w = from_centre.dot(pose.spindle), q = (from_centre - w * pose.spindle).norm();
      if (w >= lower_ && w <= upper_ && q <= wheel_.radius && q >= wheel_.inner_radius) return true;
    }
    return false;
  }

  /// X of the surface that is left on a ray along the axis; the largest of those that lower faces leave.
  double top(double r, double angle) const {
    double top = -std::numeric_limits<double>::infinity();
    for (const Pose& pose : poses_) {
      const double turn = angle - pose.a, y = r * std::cos(turn), z = r * std::sin(turn);
      const Vector3d face = pose.centre + lower_ * pose.spindle;
      const double x = face[0] - (z - face[2]) * pose.spindle[2] / pose.spindle[0];
      const double q = (Vector3d(x, y, z) - face).norm();
      if (q <= wheel_.radius && q >= wheel_.inner_radius) top = std::max(top, x);
    }
    return top;
  }

 private:
  struct Pose {
    Vector3d centre, spindle;
    double a;
  };
  FaceWheel wheel_;
  double end_radius_, lower_, upper_;
  std::vector<Pose> poses_;
};

struct End {
  int teeth;
  double clearance, dish;  // [deg]
  CutDirection cut = CutDirection::kRightHand;
  double diameter = 10, wheel = 100;  // [mm]
};

/// What brute force finds of an end.
struct MeasuredEnd {
  double dish = 0, clearance = 0;  ///< of the first tooth [deg]
  double whole_from = 0;           ///< radius outside which no other tooth has touched it [mm]
  double lowest_y = 0;             ///< [mm]
};

MeasuredEnd measured(const End& end) {
  const bool right = end.cut == CutDirection::kRightHand;
  FaceWheel wheel;
  wheel.nominal_radius = (end.wheel / 2 + 0.3) * kMillimetre;
  wheel.radius = end.wheel / 2 * kMillimetre;
  wheel.width = 10 * kMillimetre;
  wheel.height = 3 * kMillimetre;
  wheel.face_wear = 0.4 * kMillimetre;
  if (!right) wheel.inner_radius = wheel.radius - (end.diameter / 2 + 1) * kMillimetre;
  const double radius = end.diameter / 2 * kMillimetre;
  const EndTooth tooth{radius, 2 * kPi / end.teeth, end.cut};
  const OnTooth normal = endNormal(end.clearance * kDegree, end.dish * kDegree);
  // Any place of the plane gives the same stroke.
  const OnTooth through = OnTooth(0, radius, 0) + normal.cross(OnTooth(0.1, 0.7, -0.4)) * radius;
  const double clear = 1 * kMillimetre;
  const FaceStroke stroke = endStroke(tooth, normal, through, wheel, kGap, clear);
  BruteForce tool(wheel, radius, true);
  for (int i = 0; i < end.teeth; ++i) tool.grind(stroke, i * tooth.pitch, right ? 60 : 1);

  const double hand = right ? 1 : -1, tip = 1e-6;
  const auto edge = [&](double r) { return tool.top(r, hand * tip); };
  MeasuredEnd found;
  const double outer = 0.95 * radius, inner = 0.6 * radius;
  found.dish = std::atan((edge(inner) - edge(outer)) / (outer - inner)) / kDegree;
  const double step = 1e-3;
  found.clearance =
      std::atan((tool.top(outer, hand * step) - tool.top(outer, hand * tip)) / (outer * (step - tip))) / kDegree;
  const double slope = std::tan(end.dish * kDegree);
  for (double r = 0.02 * kMillimetre; r < radius; r += 0.02 * kMillimetre) {
    if (!(std::abs(edge(r) - (radius - r) * slope) < 1e-7)) found.whole_from = r / kMillimetre + 0.02;
  }
  found.lowest_y = stroke.to[kY] / kMillimetre + 0.3;  // of a wheel of the nominal radius
  // It begins clear of the blank, and the stock that is left is normal to the flank.
  BruteForce begin(wheel, radius, true);
  begin.grind({stroke.swivel, stroke.from, stroke.from, stroke.per_stock}, 0, 1);
  double highest = -1;
  for (double angle = 0; angle < 6.28; angle += 0.1) highest = std::max(highest, begin.top(radius, angle));
  EXPECT_LE(highest, -clear);
  if (!right) {
    // Of the end, nothing is farther than its diameter along Z from the edge, which lies on the plane at last.
    EXPECT_NEAR((stroke.to - stroke.from)[kX] * std::sin(stroke.swivel), clear + 2 * radius * std::cos(stroke.swivel),
                1e-12);
  }
  EXPECT_NEAR(stroke.per_stock[kX] * std::sin(stroke.swivel), -1, 1e-12);
  return found;
}

TEST(FaceStroke, GrindsEndsAsBruteForceFindsThem) {
  struct Row {
    End end;
    double y;
  };
  constexpr CutDirection kLeft = CutDirection::kLeftHand;
  for (const auto& [end, y] :
       {Row{{2, 8, 2}, -14.5}, Row{{3, 8, 2}, -6.9}, Row{{4, 8, 2}, -6.4}, Row{{4, 18, 2}, -5.2}, Row{{6, 8, 1}, -15},
        Row{{2, 8, 2, kLeft}, -18}, Row{{3, 8, 2, kLeft}, -12}, Row{{4, 8, 2, kLeft}, -13}}) {
    const MeasuredEnd found = measured(end);
    EXPECT_LE(found.whole_from, 0.1) << end.teeth << " teeth, clearance " << end.clearance;
    EXPECT_NEAR(found.lowest_y, y, 0.2) << end.teeth << " teeth, clearance " << end.clearance;
  }
}

TEST(FaceStroke, LeavesTheOtherEdgesOfAnyEnd) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 200; ++i) {
    End end{2 + i % 5, between(5, 20), between(0.5, 3), kHands[i / 5 % 2]};
    end.diameter = between(6, 16);
    SCOPED_TRACE(testing::Message() << end.teeth << " teeth, D " << end.diameter << ", clearance " << end.clearance
                                    << ", dish " << end.dish << ", hand " << i / 5 % 2);
    const MeasuredEnd found = measured(end);
    EXPECT_NEAR(found.dish, end.dish, 0.01);
    EXPECT_NEAR(found.clearance, end.clearance, 0.01);
    EXPECT_LE(found.whole_from, 0.05 * end.diameter);
  }
}

/// The rim passes the axis if asked, and the next tooth's edge, or a line before a far one, and what is under it on the
/// plane, are outside a rim or within a cup's, by the gap. Also of secondary flanks far behind the edge, whose
/// planes are in front of it near the axis.
TEST(FaceStroke, KeepsClearOfTheNextToothAtAnyPitch) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 4000; ++i) {
    const CutDirection cut = kHands[i % 2];
    const bool right = cut == CutDirection::kRightHand;
    const bool passes = i % 6 < 4;
    const double radius = between(2, 10) * kMillimetre, from = passes ? between(0.05, 0.9) * radius : 0;
    const double clearance = between(1, 20) * kDegree, dish = between(0, 10) * kDegree;
    const double second = clearance + between(0.5, passes ? 25 : 40) * kDegree;
    const double land = i % 3 > 0 ? between(0.02, 0.7) * radius : 0;
    const double past = i % 6 < 2 ? kGap : from / 4;
    FaceWheel wheel;
    // A rim that is hardly larger than the tool is found in many steps.
    wheel.nominal_radius = wheel.radius = passes ? between(25, 75) * kMillimetre : between(1.01, 1.3) * radius;
    wheel.width = 10 * kMillimetre;
    if (!right) wheel.inner_radius = wheel.radius - (passes ? radius + 1 * kMillimetre : 0);
    const EndTooth tooth{radius, between(40, 320) * kDegree, cut, from, past};
    const OnTooth normal = endNormal(land > 0 ? second : clearance, dish);
    const OnTooth through = OnTooth(0, radius, 0) + land * OnTooth(std::tan(clearance), 0, 1);
    const FaceStroke stroke = endStroke(tooth, normal, through, wheel, kGap, 1 * kMillimetre);
    const Vector3d centre(stroke.to[kX], radius + wheel.nominal_radius + stroke.to[kY], stroke.to[kZ]);
    const Vector3d spindle = upperFaceNormal(stroke.swivel), face = centre - wheel.width / 2 * spindle;
    const double off = (Vector3d(normal.dot(through) / normal[0], 0, 0) - face).norm();
    const double turn = passes ? std::clamp(tooth.pitch - 10 * kDegree, kPi, kPi + std::asin(past / from) / 2)
                               : std::clamp(tooth.pitch - 40 * kDegree, 140 * kDegree, 160 * kDegree);
    if (passes) {
      EXPECT_NEAR(right ? wheel.radius - off : off - wheel.inner_radius, past, 1e-9) << i;
    }
    const double behind = flankPose(normal, cut).tooth + (right ? 1 : -1) * std::min(tooth.pitch, turn);
    double nearest = right ? 1 : 0;
    for (int k = 0; k <= 200; ++k) {
      const double r = from + (radius - from) * k / 200;
      Vector3d place = turned({(radius - r) * std::tan(dish), r, 0}, behind, cut);
      for (int under = 0; under < 2; ++under) {
        const double beside = (place - face).cross(spindle).norm();
        nearest = right ? std::min(nearest, beside) : std::max(nearest, beside);
        place[0] -= (place - face).dot(spindle) / spindle[0];
      }
    }
    EXPECT_NEAR(nearest, right ? wheel.radius + kGap : wheel.inner_radius - kGap, 1e-7) << i;
  }
}

/// A cup that passes the axis by 0.05 mm has within its rim, by the gap, only what is 0.1 mm off the axis. Seen along
/// the spindle, the next tooth's edge begins at 0.1084 or 0.0788 mm. A small cup has within its rim what is 1.95 mm off
/// the middle of the next tooth, whose ends are 5 mm / cos(8 deg) apart on the plane of a flat end. By a plane of
/// 60 deg, an edge that begins at 0.2 mm is seen to begin at 0.1 mm, and the rim to be as far past the axis.
TEST(FaceStroke, RefusesARimThatCannotEndClearOfTheNextTooth) {
  FaceWheel wheel{50 * kMillimetre, 50 * kMillimetre, 10 * kMillimetre, 0, 0, 40 * kMillimetre};
  EndTooth tooth{5 * kMillimetre, kPi / 2, CutDirection::kLeftHand, 0.11 * kMillimetre, kGap};
  const auto refusal = [&](double clearance, double dish) {
    return test_support::refusalOf<std::invalid_argument>([&] {
      endStroke(tooth, endNormal(clearance * kDegree, dish * kDegree), {0, tooth.radius, 0}, wheel, kGap,
                1 * kMillimetre);
    });
  };
  const std::string begin = "the wheel's rim cannot end clear of the next tooth, by ";
  const std::string end = " mm; allowed: a flank and a wheel with which it can";
  EXPECT_EQ(refusal(8, 2), "");
  tooth.next_from = 0.08 * kMillimetre;
  EXPECT_EQ(refusal(8, 2), begin + "0.0212" + end);
  tooth.next_from = tooth.past_axis = 0;
  wheel.inner_radius = 2 * kMillimetre;
  EXPECT_EQ(refusal(8, 0), begin + "0.575" + end);
  tooth = {5 * kMillimetre, kPi / 2, CutDirection::kRightHand, 0.2 * kMillimetre, 0.1 * kMillimetre};
  EXPECT_EQ(refusal(60, 0), begin + "0.05" + end);
}

/// Two of an even number of teeth go to the axis, or one of any, at any pitch: where the next tooth is short, the rim
/// passes the axis.
TEST(FaceStroke, GrindsTeethToTheCentreBesideShortOnes) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 60; ++i) {
    const int teeth = 2 + i % 5, center = teeth % 2 == 0 && teeth > 2 && i % 3 > 0 ? 2 : 1;
    const CutDirection cut = kHands[i / 12 % 2];
    const bool right = cut == CutDirection::kRightHand;
    const double hand = right ? 1 : -1;
    std::vector<double> angles;
    for (int tooth = 0; tooth < teeth; ++tooth) angles.push_back((tooth + between(-0.08, 0.08)) * 2 * kPi / teeth);
    const double radius = between(3, 8) * kMillimetre, from = between(0.15, 0.4) * radius;
    const double clearance = between(5, 20) * kDegree, dish = between(0, 3) * kDegree;
    SCOPED_TRACE(testing::Message() << center << " of " << teeth << " teeth, hand " << hand << ", R " << radius
                                    << ", from " << from << ", clearance " << clearance << ", dish " << dish);
    FaceWheel wheel;
    wheel.nominal_radius = wheel.radius = between(25, 60) * kMillimetre;
    wheel.width = 10 * kMillimetre;
    if (!right) wheel.inner_radius = wheel.radius - radius - 1 * kMillimetre;
    const OnTooth normal = endNormal(clearance, dish), through(0, radius, 0);
    const OnTooth behind = through + 0.08 * radius * OnTooth(std::tan(clearance), 0, 1);
    const bool secondary = i % 2 == 0;
    const auto is_short = [&](int tooth) { return tooth % (teeth / center) != 0; };
    const auto angle = [&](int tooth) { return angles[static_cast<std::size_t>(tooth)]; };
    BruteForce tool(wheel, radius, true);
    for (int tooth = 0; tooth < teeth; ++tooth) {
      // Behind a left-hand tooth is the one before it.
      const int next = right ? (tooth + 1) % teeth : (tooth + teeth - 1) % teeth;
      const double way = hand * (angle(next) - angle(tooth)), pitch = way > 0 ? way : way + 2 * kPi;
      const bool passes = is_short(next);
      const double past = center > 1 || is_short(tooth) ? kGap : from / (teeth > 2 ? 4 : 2);
      const EndTooth end{radius, pitch, cut, passes ? from : 0, passes ? past : 0};
      const FaceStroke stroke = endStroke(end, normal, through, wheel, kGap, 1 * kMillimetre);
      tool.grind(stroke, angle(tooth), right ? 60 : 1);
      if (secondary) {
        tool.grind(endStroke(end, endNormal(clearance + 10 * kDegree, dish), behind, wheel, kGap, 1 * kMillimetre),
                   angle(tooth), right ? 60 : 1);
      }
    }
    const double slope = std::tan(dish);
    for (int tooth = 0; tooth < teeth; ++tooth) {
      for (double r = is_short(tooth) ? from : 3 * kGap; r < radius; r += 0.05 * kMillimetre) {
        EXPECT_NEAR(tool.top(r, angle(tooth) + hand * 1e-6), (radius - r) * slope, 1e-7) << tooth << ' ' << r;
      }
    }
    EXPECT_GE(tool.top(1e-9, angle(0)), radius * slope - 1e-9);  // without a nib
  }
}

/// The face lies in the chamfer's plane, its rim a gap below all that a blank has of it, and no lower.
TEST(FaceStroke, ChamfersAnyCornerAsDeepAsItNeeds) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 50; ++i) {
    const CutDirection cut = kHands[i % 2];
    const double hand = i % 2 == 0 ? 1 : -1, radius = between(3, 8) * kMillimetre;
    const double angle = between(30, 60) * kDegree, dish = between(0, 3) * kDegree;
    const double tan_rake = std::tan(between(10, 40) * kDegree), tan_hook = std::tan(between(0, 15) * kDegree);
    const OnTooth normal = chamferNormal(angle, between(5, 20) * kDegree, dish, hand * tan_rake, tan_hook);
    // The edge, from that of the hollow end to the periphery: back along the axis from X = 0, and forward by the hook.
    const double width = between(0.1, 0.4) * kMillimetre, length = width / std::tan(angle) + width * std::tan(dish);
    const OnTooth edge(width / std::tan(angle), width, length * hand * tan_rake - width * tan_hook);
    EXPECT_NEAR(normal.dot(edge.normalized()), 0, 1e-12);
    const double behind = length * hand * tan_rake / radius;
    const OnTooth through(length, radius * std::cos(behind), radius * std::sin(behind));
    FaceWheel wheel;
    wheel.nominal_radius = 50 * kMillimetre;
    wheel.radius = 49.8 * kMillimetre;
    wheel.width = 6 * kMillimetre;
    wheel.height = 2 * kMillimetre;
    wheel.face_wear = 0.1 * kMillimetre;
    const EndTooth tooth{radius, kPi / 2, cut};
    const FaceStroke stroke = chamferStroke(tooth, normal, through, wheel, kGap, 1 * kMillimetre);
    const double turn = flankPose(normal, cut).tooth;
    const Vector3d centre(stroke.to[kX], radius + wheel.nominal_radius + stroke.to[kY], wheel.height + stroke.to[kZ]);
    const Vector3d spindle = upperFaceNormal(stroke.swivel), place = turned(through, turn, cut);
    EXPECT_NEAR((place - centre).dot(spindle), wheel.face_wear - wheel.width / 2, 1e-12);
    EXPECT_NEAR((place - centre).cross(spindle)[1], 0, 1e-12) << "across from the corner";
    EXPECT_NEAR(radius + stroke.from[kY] + wheel.nominal_radius - wheel.radius, radius + 1 * kMillimetre, 1e-12);
    // Around the end, from the corner on, as far as the plane is within the blank.
    double lowest = place[1];
    for (double at = 0; at < kPi; at += 1e-4) {
      const OnTooth on_rim(0, radius * std::cos(at), radius * std::sin(at));
      if (normal.dot(on_rim - through) < 0) break;
      lowest = std::min(lowest, turned(on_rim, turn, cut)[1]);
    }
    EXPECT_NEAR(lowest - (centre[1] - wheel.radius), kGap, 2e-4 * radius);
  }
}

/// At a stroke's beginning, a wheel larger by less than `clear` touches nothing of the blank, and one by more does.
void expectClear(const FaceStroke& stroke, const FaceWheel& wheel, const EndTooth& tooth, double clear) {
  for (const double part : {0.97, 1.1}) {
    FaceWheel larger = wheel;
    larger.radius += part * clear;
    FaceStroke still = stroke;
    still.to = still.from;
    BruteForce blank(larger, tooth.radius, tooth.cut == CutDirection::kLeftHand);
    blank.grind(still, 0, 1);
    bool touched = false;
    for (int i = 0; i < 200 * 100; ++i) {
      const double x = i / 100 * 0.1 * kMillimetre, angle = (i % 100 - 50) * 0.01;
      touched = touched || blank.isGround(x, tooth.radius, angle);
    }
    EXPECT_EQ(touched, part > 1) << part;
  }
}

/// In the plane of the rake face, all beyond the bottom is removed in front of the face, and nothing behind it.
TEST(FaceStroke, GashesAnyEndToothInFrontOfItsFace) {
  auto between = test_support::numbers(7);
  for (int i = 0; i < 20; ++i) {
    const CutDirection cut = kHands[i % 2];
    const double hand = i % 2 ? -1 : 1;
    const double rake = between(-8, 12) * kDegree, dish = between(0, 3) * kDegree;
    const double angle = between(25, 60) * kDegree, past = between(-0.3, 0.1) * kMillimetre;
    FaceWheel wheel;
    wheel.nominal_radius = 40 * kMillimetre;
    wheel.radius = 39.8 * kMillimetre;
    wheel.width = 2 * kMillimetre;
    wheel.height = -4 * kMillimetre;
    wheel.face_wear = 0.3 * kMillimetre;
    const EndTooth tooth{between(3, 8) * kMillimetre, kPi / 2, cut};
    const FaceStroke stroke = gashStroke(tooth, gashNormal(rake, dish), angle, past, wheel, 1 * kMillimetre);
    SCOPED_TRACE(testing::Message() << "rake " << rake / kDegree << ", dish " << dish / kDegree << ", hand " << hand);
    // The bottom, less its sagitta.
    EXPECT_NEAR(stroke.to[kY] + wheel.nominal_radius, -past - tooth.radius + wheel.radius * std::cos(angle), 1e-12);
    EXPECT_TRUE(stroke.per_stock.isApprox(Axes(0, 1, 0, 0)));  // its passes step along the radius
    expectClear(stroke, wheel, tooth, 1 * kMillimetre);
    BruteForce tool(wheel, tooth.radius, cut == CutDirection::kLeftHand);
    tool.grind(stroke, 0, 500);
    for (int k = 0; k < 200; ++k) {
      const double x = between(0.02, 3) * kMillimetre, r = between(0.05, 1) * tooth.radius;
      double face = 0;
      for (int step = 0; step < 20; ++step) {
        const double from_edge = x - (tooth.radius - r * std::cos(face)) * std::tan(dish);
        face = std::asin(std::clamp(from_edge * std::tan(rake) / r, -0.5, 0.5));
      }
      // Along the face's plane from the end, and across it from the axis.
      const FacePose pose = gashPose(gashNormal(rake, dish), cut);
      const double above =
          r * std::cos(face + pose.tooth * hand) - (-past + x / std::cos(pose.swivel) * std::tan(angle));
      if (std::abs(above) < 0.03 * kMillimetre || std::abs(face) > 0.4) continue;
      const double tip = 2e-6 * kMillimetre / r;
      EXPECT_EQ(tool.isGround(x, r, hand * (face - tip)), above > 0) << x << ' ' << r << ' ' << above;
      EXPECT_FALSE(tool.isGround(x, r, hand * (face + tip))) << x << ' ' << r;
    }
  }
}

TEST(FaceStroke, HasTheSetUpsOfTheTrade) {
  struct Row {
    OnTooth normal;
    double swivel, tooth;
  };
  const auto end = [](double clearance, double dish) { return endNormal(clearance * kDegree, dish * kDegree); };
  for (const auto& [normal, swivel, tooth] :
       {Row{end(8, 2), 81.76, -13.95}, Row{end(18, 2), 71.90, -6.13}, Row{end(6, 0), 84.00, 0},
        Row{flankNormal(45 * kDegree, 10 * kDegree), 44.14, 76.00},
        Row{flankNormal(59 * kDegree, 12 * kDegree), 30.25, 76.07}}) {
    const FacePose right = flankPose(normal, CutDirection::kRightHand);
    const FacePose left = flankPose(normal, CutDirection::kLeftHand);
    EXPECT_NEAR(right.swivel / kDegree, swivel, 0.005);
    EXPECT_NEAR(right.tooth / kDegree, tooth, 0.005);
    EXPECT_EQ(left.swivel, right.swivel);
    EXPECT_NEAR(left.tooth / kDegree, 180 - tooth, 0.005);
  }
  // By rounding, a normal may be longer than 1.
  const double longer = 1 + std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(flankPose({-longer, 0, 0}, CutDirection::kRightHand).swivel, kPi / 2, 1e-12);
  EXPECT_NEAR(gashPose({longer, 0, 0}, CutDirection::kRightHand).swivel, kPi / 2, 1e-12);
}

}  // namespace test_face_stroke
}  // namespace grinder
