#include "flute_grinder/curve/relief_path.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/log_curve.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace grinder {
namespace test_relief_path {

using units::kDegree;
using units::kMillimetre;

Cone cutterOf(double diameter, double cone, double spiral, CutDirection cut = CutDirection::kRightHand) {
  Cone g;
  g.end_diameter = diameter * kMillimetre;
  g.cone_angle = cone * kDegree;
  g.spiral_angle = spiral * kDegree;
  g.flute_length = 25 * kMillimetre;
  g.cut = cut;
  return g;
}

/// With the relief's start at a place of the rim.
ReliefWheel wheelOf(const ConicalCutter& cutter, const ReliefStart& start, double diameter, double width, double swivel,
                    double contact) {
  ReliefWheel wheel{diameter / 2 * kMillimetre, 0, width * kMillimetre, swivel * kDegree, 0};
  wheel.height = ReliefPath::heightFor(cutter, start, wheel, contact * kMillimetre);
  return wheel;
}

/// The radius that is left at an angle behind the edge: the least at which a ray from the axis meets the wheel, over
/// all poses of the axes. Of the figures of a stroke and of the wheel's, nothing else.
struct BruteForce {
  const ConicalCutter& cutter;
  const ReliefPath& path;
  const ReliefWheel& wheel;
  double lowered = 0;  ///< Y against the path's

  double hand() const { return cutter.cone().cut == CutDirection::kLeftHand ? -1 : 1; }
  double edge(double x) const { return LogCurve(cutter).a(x); }

  double ray(double x, double behind, double axis_x) const {
    const double w_x = -std::sin(wheel.swivel), w_z = std::cos(wheel.swivel),
                 radius = wheel.nominal_radius - wheel.wear;
    const double c_y = cutter.cone().end_diameter / 2 + wheel.nominal_radius + path.y() + lowered +
                       axis_x * (cutter.tanCone() + path.taper());
    const double c_z = wheel.height + axis_x * cutter.tanCone() * path.cutter().zPerY();
    const double a = LogCurve(cutter, path.xShift()).a(axis_x) + path.a();
    const double psi = edge(x) + hand() * behind - a;
    // |p - c|^2 - (w (p - c))^2 = radius^2, with p = (x, r cos psi, r sin psi).
    const double d_x = x - axis_x, e_y = std::cos(psi), e_z = std::sin(psi);
    const double along0 = w_x * d_x - w_z * c_z, along1 = w_z * e_z;
    const double a2 = 1 - along1 * along1, a1 = -c_y * e_y - c_z * e_z - along0 * along1;
    const double a0 = d_x * d_x + c_y * c_y + c_z * c_z - along0 * along0 - radius * radius;
    const double root = a1 * a1 - a2 * a0;
    if (root < 0) return std::numeric_limits<double>::infinity();
    const double r = (-a1 - std::sqrt(root)) / a2;
    const bool on_rim = std::abs(along0 + r * along1) <= wheel.width / 2;
    return on_rim && r > 0 ? r : std::numeric_limits<double>::infinity();
  }

  double radius(double x, double behind) const { return ray(x, behind, poseOf(x, behind)); }

  /// The place of the axis X that leaves that radius.
  double poseOf(double x, double behind) const {
    constexpr int kPoses = 2000;
    const double middle = x + path.xShift(), reach = 2 * wheel.width, step = 2 * reach / kPoses;
    int best = 0;
    const auto at = [&](double i) { return ray(x, behind, middle - reach + i * step); };
    for (int i = 1; i <= kPoses; ++i) {
      if (at(i) < at(best)) best = i;
    }
    double from = best - 1, to = best + 1;
    for (int i = 0; i < 80; ++i) {
      const double third = (to - from) / 3;
      (at(from + third) < at(to - third) ? to : from) += at(from + third) < at(to - third) ? -third : third;
    }
    return middle - reach + (at(best) < at((from + to) / 2) ? best : (from + to) / 2) * step;
  }

  /// By how much the radius falls between two angles behind the edge.
  double clearance(double x, double from, double to) const {
    const double r1 = radius(x, from), r2 = radius(x, to);
    return std::atan((r1 - r2) / (r1 * (to - from)));
  }
};

/// Cutter, relief and wheel within what a machine has; the swivel is near the spiral angle.
struct Case {
  ConicalCutter cutter;
  ReliefStart start;
  ReliefWheel wheel;
};

Case drawn() {
  const auto within = [](double from, double to) { return from + (to - from) * *rc::gen::inRange(0, 10001) / 1e4; };
  const bool left = *rc::gen::arbitrary<bool>();
  const double hand = left ? -1 : 1, spiral = within(0, 45);
  Cone g =
      cutterOf(within(3, 20), within(-1, 10), hand * spiral, left ? CutDirection::kLeftHand : CutDirection::kRightHand);
  g.flute_length = within(0.5, 1.5) * g.end_diameter;
  const ConicalCutter cutter(g);
  const ReliefStart start{within(5, 20) * kDegree, within(0.9, 1), within(0, 20) * kDegree};
  const double width = within(3, 10), swivel = hand * std::max(0.0, spiral + within(-15, 10));
  return {cutter, start, wheelOf(cutter, start, within(60, 150), width, swivel, within(-0.45, 0.1) * width)};
}

RC_GTEST_PROP(ReliefPath, TheSurfaceIsWhatTheWheelLeaves, ()) {
  const Case c = drawn();
  const ReliefPath path(c.cutter, c.start, c.wheel);
  const BruteForce left{c.cutter, path, c.wheel};
  const double rim_end = c.wheel.width / 2 - path.contact();
  const auto start_off = [&](double x) {
    return left.radius(x, c.start.behind) - c.start.radius_part * c.cutter.radius(x);
  };
  // Far from the spiral angle, a large wheel takes the start of the relief with another place of its rim.
  RC_PRE(start_off(0) > -1e-9 && start_off(c.cutter.cone().flute_length) > -1e-9);
  for (const double x : {0.0, c.cutter.cone().flute_length}) {
    RC_ASSERT(start_off(x) < 1e-9);
    RC_ASSERT(std::abs(path.surface(x, 0).clearance - c.start.clearance) < 1e-9);
    for (const double part : {0.0, 0.3, 0.8}) {
      const ReliefPath::Place at = path.surface(x, part * rim_end);
      if (!(at.behind - c.start.behind < 0.7)) break;
      RC_ASSERT(std::abs(left.radius(x, at.behind) - at.radius) < 2e-9);
      constexpr double aside = 1e-5;  // the mean of both sides: the change of the clearance does not count
      const double measured = left.clearance(x, at.behind + 1e-9, at.behind + aside);
      RC_ASSERT(std::abs(measured - at.clearance) < 0.002 * kDegree);
    }
  }
}

/// The edge lies on the cylinder of the rim, not on a corner, whichever hand.
TEST(ReliefPath, EndsWhereTheWheelsCornersBegin) {
  // With the spiral the relief lies on one half of the rim, against it on the other.
  for (const auto& [cut, swivel, contact] : {std::tuple(CutDirection::kRightHand, 30, -2.5),
                                             {CutDirection::kLeftHand, -30, -2.5},
                                             {CutDirection::kRightHand, -20, 2.5},
                                             {CutDirection::kLeftHand, 20, 2.5}}) {
    SCOPED_TRACE(swivel);
    const double hand = cut == CutDirection::kLeftHand ? -1 : 1;
    const ConicalCutter cutter(cutterOf(10, 5, hand * 30, cut));
    const ReliefStart start{10 * kDegree};
    ReliefWheel wheel = wheelOf(cutter, start, 100, 6, swivel, contact);
    wheel.corner_radius = {0.4 * kMillimetre, 0.45 * kMillimetre};
    // The half on which it lies ends at the corner of the upper or of the lower face.
    const double corner = swivel > 0 ? 0.45 : 0.4;
    EXPECT_NEAR(ReliefPath(cutter, start, wheel).reach(), (3 - corner + 2.5) * kMillimetre, 1e-9);
    wheel.height = ReliefPath::heightForReach(cutter, start, wheel, 1.2 * kMillimetre);
    EXPECT_NEAR(ReliefPath(cutter, start, wheel).reach(), 1.2 * kMillimetre, 1e-9);
  }
}

/// The stroke goes on beyond the flute until the rim's end has formed the surface at the flute's ends.
TEST(ReliefPath, GoesBeyondTheFluteAsFarAsTheRimsEndNeeds) {
  const struct {
    ConicalCutter cutter;
    double wheel, width, swivel, contact;
  } rows[]{{ConicalCutter(cutterOf(10, 5, 30)), 100, 6, 30, -2.5},
           {ConicalCutter(cutterOf(10, 5, -30, CutDirection::kLeftHand)), 100, 6, -30, -2.5},
           {ConicalCutter(cutterOf(10, 0, 0)), 100, 6, -20, -2.5},
           {ConicalCutter(cutterOf(10, 0, 30)), 100, 6, -20, -2.5},  // on the rim's other half
           {ConicalCutter(cutterOf(4.92, -1.9, 6.1)), 75, 3.9, 20, 0.5}};
  const ReliefStart start{10 * kDegree, 1, 3 * kDegree};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.swivel);
    const ReliefWheel wheel = wheelOf(row.cutter, start, row.wheel, row.width, row.swivel, row.contact);
    const ReliefPath path(row.cutter, start, wheel);
    const BruteForce left{row.cutter, path, wheel};
    const double length = row.cutter.cone().flute_length;
    const auto formedAt = [&](double x) {
      return left.poseOf(x, path.surface(x, 0.999 * path.reach()).behind) - path.xShift();
    };
    EXPECT_NEAR(path.beyondEnd(), std::max(0.0, -formedAt(0)), 10e-6);
    EXPECT_NEAR(path.beyondShank(), std::max(0.0, formedAt(length) - length), 10e-6);
    EXPECT_GT(path.beyondEnd() + path.beyondShank(), 100e-6);
  }
  // Swivelled against the helix, the rim's end forms nothing: it needs no way.
  const ConicalCutter cutter(cutterOf(4.92, -1.9, 6.1));
  const ReliefPath against(cutter, start, wheelOf(cutter, start, 75, 3.9, -29, 0.5));
  ASSERT_TRUE(std::isnan(against.surface(0, against.reach()).behind));
  EXPECT_EQ(against.beyondEnd(), 0);
  EXPECT_EQ(against.beyondShank(), 0);
}

/// A second relief begins on the first where that is as wide as asked, and nowhere else.
TEST(ReliefPath, BeginsOnAnotherAsFarFromTheEdgeAsAsked) {
  const ConicalCutter cutter(cutterOf(10, 5, 30));
  const ReliefStart first{10 * kDegree, 1, 4 * kDegree};
  const ReliefWheel wheel = wheelOf(cutter, first, 100, 6, 30, -2.5);
  const ReliefPath primary(cutter, first, wheel);
  const ReliefPath::Place end = primary.surfaceAt(0, 0.8 * kMillimetre);
  const double radius = BruteForce{cutter, primary, wheel}.radius(0, end.behind), angle = end.behind - first.behind;
  EXPECT_NEAR(std::hypot(radius * std::cos(angle) - 5 * kMillimetre, radius * std::sin(angle)), 0.8 * kMillimetre,
              1e-8);
  EXPECT_TRUE(std::isnan(primary.surfaceAt(0, 8 * kMillimetre).radius));
}

/// The most by which the wheel is in the blank at an end of the stroke.
double deepest(const Case& c, const ReliefPath& path) {
  const double w_x = -std::sin(c.wheel.swivel), w_z = std::cos(c.wheel.swivel), radius = c.wheel.nominal_radius;
  double highest = -1;
  for (const double s : {-path.beyondEnd(), c.cutter.cone().flute_length + path.beyondShank()}) {
    const double axis_x = s + path.xShift();
    const double c_y =
        c.cutter.cone().end_diameter / 2 + radius + path.y() + axis_x * (c.cutter.tanCone() + path.taper());
    const double c_z = c.wheel.height + axis_x * c.cutter.tanCone() * path.cutter().zPerY();
    for (int i = 0; i <= 100; ++i) {
      const double w = (i / 100.0 - 0.5) * c.wheel.width;
      for (int k = -1000; k <= 1000; ++k) {
        const double sine = k / 1250.0;
        const double x = axis_x + w * w_x + radius * sine * w_z, z = c_z + w * w_z - radius * sine * w_x;
        const double blank = c.cutter.radius(x);
        if (!(std::abs(z) < blank)) continue;
        const double rim = c_y - radius * std::sqrt(1 - sine * sine);
        highest = std::max(highest, std::sqrt(blank * blank - z * z) - rim);
      }
    }
  }
  return highest;
}

// A pass as much higher than the last as the depth touches the blank at one place and no more.
RC_GTEST_PROP(ReliefPath, TheDepthReachesToTheBlank, ()) {
  const Case c = drawn();
  const ReliefPath path(c.cutter, c.start, c.wheel);
  const double highest = deepest(c, path);
  RC_ASSERT(highest <= path.depth() + 1e-9);
  RC_ASSERT(highest > path.depth() - 50e-6);
}

/// The wheel is deepest where it begins on a back taper, or on a cone with the end of its rim.
TEST(ReliefPath, TheDepthIsThatOfTheDeepestPlace) {
  const ConicalCutter taper(cutterOf(10, -2, 0)), cone(cutterOf(10, 20, 0));
  const ReliefStart first{10 * kDegree}, second{5 * kDegree, 0.8};
  for (const Case& c : {Case{taper, first, wheelOf(taper, first, 100, 6, -35, -2.5)},
                        Case{cone, second, wheelOf(cone, second, 100, 16, 30, -7.999)}}) {
    const ReliefPath path(c.cutter, c.start, c.wheel);
    EXPECT_NEAR(path.depth(), deepest(c, path), 0.5e-6);
  }
}

// Wear is taken up where the relief begins: it keeps its clearance and its radius, in the closed form and by Y alone.
TEST(ReliefPath, FollowsTheWheelsWear) {
  const ConicalCutter cutter(cutterOf(10, 5, 30));
  const ReliefStart start{10 * kDegree};
  ReliefWheel wheel = wheelOf(cutter, start, 100, 6, 30, -2.5);
  const ReliefPath fresh(cutter, start, wheel);
  wheel.wear = 1 * kMillimetre;
  const ReliefPath worn(cutter, start, wheel);
  const BruteForce left{cutter, worn, wheel};
  EXPECT_NEAR(left.radius(12 * kMillimetre, 0), cutter.radius(12 * kMillimetre), 1e-12);
  EXPECT_NEAR(left.clearance(12 * kMillimetre, 1e-9, 1e-5) / kDegree, 10, 0.001);
  // By Y alone, as between passes.
  wheel.wear = 0.1 * kMillimetre;
  const BruteForce lowered{cutter, fresh, wheel, -wheel.wear * fresh.yPerWear()};
  EXPECT_NEAR(lowered.radius(12 * kMillimetre, 0), cutter.radius(12 * kMillimetre), 1e-7);
}

TEST(ReliefPath, RefusesWhatItCannotGrind) {
  const ConicalCutter cutter(cutterOf(10, 5, 30));
  const ReliefStart start{20 * kDegree};
  const ReliefWheel steep{50 * kMillimetre, 0, 6 * kMillimetre, 78 * kDegree, 0};
  EXPECT_EQ(test_support::refusalOf<std::invalid_argument>([&] { ReliefPath(cutter, start, steep); }),
            "setup.swivel = 78 deg; allowed: less, for the clearance and the spiral angle");
  // 10 um beyond either end of the rim, and the heights of these ends in ascending order.
  for (const CutDirection cut : {CutDirection::kRightHand, CutDirection::kLeftHand}) {
    const double hand = cut == CutDirection::kLeftHand ? -1 : 1;
    const ConicalCutter handed(cutterOf(10, 5, hand * 30, cut));
    const auto wheelAt = [&](double contact) { return wheelOf(handed, start, 100, 6, hand * 30, contact); };
    // The corners of the lower and the upper face, which change sides with the hand.
    const double from = hand > 0 ? 0.2 - 3 : 0.5 - 3, to = hand > 0 ? 3 - 0.5 : 3 - 0.2;
    const double end = wheelAt(from).height, other = wheelAt(to).height;
    for (const double contact : {from - 0.01, to + 0.01}) {
      ReliefWheel beside = wheelAt(contact);
      beside.corner_radius = {0.2 * kMillimetre, 0.5 * kMillimetre};
      EXPECT_EQ(
          test_support::refusalOf<std::invalid_argument>([&] { ReliefPath(handed, start, beside); }),
          format("setup.height = %g mm; allowed: %g to %g mm, with the edge on the wheel's rim",
                 beside.height / kMillimetre, std::min(end, other) / kMillimetre, std::max(end, other) / kMillimetre));
    }
    EXPECT_NO_THROW(ReliefPath(handed, start, wheelAt(2.99)));
  }
}

}  // namespace test_relief_path
}  // namespace grinder
