// The ground cutter against closed forms, and membership by brute force.

#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_cutter.h"

#include "brute_force.h"
#include "random_cases.h"
#include "tool/solid_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace grinder {
namespace test_ground_cutter {

using test_support::Case;
using units::kDegree;
using units::kMillimetre;
constexpr double kMicrodegree = 1e-6 * kDegree;
constexpr double kSameEnd = 5e-9;  ///< of an arc, by two searches [rad]

TEST(GroundCutter, AStraightFluteIsAsTheWheelIs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> diameter(2, 30), part(0.05, 0.6), wheel(40, 200), width(1, 10);
  for (int i = 0; i < 200; ++i) {
    Case c;
    c.diameter = diameter(random);
    c.spiral = c.swivel = 0;
    c.depth = part(random) * c.diameter / 2;
    c.wheel = wheel(random);
    c.width = width(random);
    c.face = (part(random) - 0.3) * c.diameter / 2;
    const double r = c.diameter / 2;
    // Beyond this height the face does not reach the outer circle within the depth.
    if (std::abs(c.face) > 0.9 * std::sqrt(r * r - (r - c.depth) * (r - c.depth))) continue;
    if (std::abs(c.face - c.width) > 0.9 * r) continue;
    const GroundSection s = c.ground().section(0.02);
    ASSERT_TRUE(s.teeth[0].rake.has_value()) << i;
    EXPECT_NEAR(*s.teeth[0].edge, std::asin(c.face / r), 1e-12) << i;
    EXPECT_NEAR(*s.teeth[0].rake, std::asin(c.face / r), kMicrodegree) << i;
    EXPECT_NEAR(*s.teeth[0].chordal_rake, std::asin(c.face / r), kMicrodegree) << i;  // the rake face is plane
    EXPECT_NEAR(*s.teeth[0].spiral, 0, 1e-9) << i;
    // The floor lies at R - depth if the wheel stands over the axis, else at the nearer corner.
    const double z = c.face < 0 ? c.face : std::max(0.0, c.face - c.width);
    EXPECT_NEAR(s.core_radius, std::hypot(r - c.depth, z) * kMillimetre, 2e-9) << i;
  }
}

TEST(GroundCutter, AtTheStrokesEndTheFloorIsTheWheelsCircle) {
  Case c;
  c.spiral = c.swivel = 0;
  c.face = 1;
  c.to = 10;
  const double rw = c.wheel / 2, floor = c.diameter / 2 - c.depth;
  for (const double beyond : {0.0, 2.0, 5.0, 10.0}) {
    const double expected = floor + rw - std::sqrt(rw * rw - beyond * beyond);
    const GroundSection s = c.ground().section((c.to + beyond) * kMillimetre);
    EXPECT_NEAR(s.core_radius, expected * kMillimetre, 2e-9);
    EXPECT_EQ(s.teeth[0].complete, beyond == 0) << beyond;
  }
}

/// A random cutter, wheel, set-up and section.
struct RandomCase {
  Case c;
  WheelProfile wheel;
  double x, outer;

  brute::Bench bench(int poses, int places) const {
    return {{{c.cutter().cone()}, wheel, c.wheel / 2 * kMillimetre},
            c.setup().swivel,
            c.setup().height,
            c.depth * kMillimetre,
            poses,
            places};
  }
  brute::Bench::Way way() const {
    return {std::max(c.from * kMillimetre, x - 0.04), std::min(c.to * kMillimetre, x + 0.04)};
  }
};

/// @return nothing where the cone would close.
std::optional<RandomCase> randomCase(std::mt19937& random, int i) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Case c;
  c.diameter = uniform(3, 20);
  c.cone = uniform(-2, 25);
  c.spiral = uniform(-55, 55);
  c.rake = uniform(-5, 15);
  c.depth = uniform(0.08, 0.3) * c.diameter;
  c.wheel = uniform(40, 125);
  c.width = uniform(0.1, 0.6) * c.diameter;
  c.swivel = c.spiral + uniform(-6, 6);
  c.face = uniform(-0.1, 0.3) * c.diameter;
  c.from = uniform(-6, 0);
  c.to = uniform(20, 35);
  c.a = uniform(-3, 3);
  c.cut = i / 4 % 2 == 0 ? CutDirection::kRightHand : CutDirection::kLeftHand;
  const double x = uniform(3, 18) * kMillimetre;
  const double radius = c.cutter().radius(std::min(c.to, 40.0) * kMillimetre + 0.04);
  if (!(c.cutter().radius(-0.006) > 5e-4 && radius > 5e-4)) return std::nullopt;
  const std::array<double, 2> corners{uniform(0, 0.2) * c.width * kMillimetre, uniform(0, 0.2) * c.width * kMillimetre};
  const WheelProfile wheel =
      i % 4 == 0   ? WheelProfile::straight(c.wheel * kMillimetre, c.width * kMillimetre)
      : i % 4 == 1 ? WheelProfile::straight(c.wheel * kMillimetre, c.width * kMillimetre, corners)
      : i % 4 == 2
          ? WheelProfile::angled(c.wheel * kMillimetre, c.width * kMillimetre, uniform(-45, 45) * kDegree, corners)
          : WheelProfile::fullRadius(c.wheel * kMillimetre, c.width * kMillimetre);
  return RandomCase{c, wheel, x, c.cutter().radius(x)};
}

/// The end of a removed arc by brute force: the farthest over the poses of the stroke, ever closer to the best. It is
/// never beyond the true one.
double bruteEnd(const RandomCase& k, double r, bool high, int poses, int places) {
  constexpr int kCloser = 14;
  const brute::Bench bench = k.bench(poses, places);
  const auto [from, to] = k.way();
  double step = (to - from) / poses, best = -1e9, best_at = from;
  const auto tryAll = [&, from = from, to = to](double first, int count) {
    for (int i = 0; i <= count; ++i) {
      const double at = std::clamp(first + i * step, from, to);
      const double end = bench.endAt(k.x, r, at, high ? 1 : -1).angle;
      if (end > best) best = end, best_at = at;
    }
  };
  tryAll(from, poses);
  for (int i = 0; i < kCloser; ++i) {
    step /= 6;
    tryAll(best_at - 6 * step, 12);
  }
  return (high ? best : -best) + k.c.a;
}

/// The same, looked for more finely where the first looks have not come as far as `near`.
double bruteEnd(const RandomCase& k, double r, double near, bool high) {
  double end = 0;
  for (const int fineness : {1, 6, 36}) {
    end = bruteEnd(k, r, high, 250 * fineness, 33 * fineness);
    if (std::abs(end - near) < kSameEnd) break;
  }
  return end;
}

/// Compares rake, edge, flute and the arcs within it with those of brute force. @return false where no flute is ground.
/// @param rake_off allowed [rad].
bool compare(const RandomCase& k, double rake_off = 0.005 * kDegree) {
  const WheelSweep sweep = k.c.sweep(k.wheel);
  const GroundSection section = GroundCutter(k.c.cutter(), {{sweep}}, {{0, 0}}).section(k.x);
  const ToothSection tooth = section.teeth[0];
  if (!tooth.rake || !(*tooth.flute > 1e-3)) return false;
  // The rake face is the wall at the larger angles on the right hand, at the smaller ones on the left hand.
  const bool right = k.c.cut == CutDirection::kRightHand;
  const int hand = right ? 1 : -1;
  const double edge = bruteEnd(k, k.outer, *tooth.edge, right);
  const double back = bruteEnd(k, k.outer, *tooth.edge - hand * *tooth.flute, !right);
  const auto face = [&](double r) {
    const auto arc = sweep.arc(k.x, r);
    return bruteEnd(k, r, right ? arc->high : arc->low, right);
  };
  // Brute force is too coarse for a short step at a sharp corner, and a long one may run over a kink. On a kink the
  // rake is that of either side.
  double off = 1;
  const double h = 1e-4 * k.outer;
  for (const auto& [inward, outward] : {std::pair{h, h}, {10 * h, 10 * h}, {h, 0.0}, {0.0, h}}) {
    const double fall = hand * (face(k.outer - inward) - face(k.outer + outward));
    off = std::min(off, std::abs(*tooth.rake - std::atan(k.outer * fall / (inward + outward))));
    if (off < rake_off) break;
  }
  EXPECT_LT(off, rake_off);
  EXPECT_NEAR(*tooth.edge, edge, 0.001 * kDegree);
  EXPECT_NEAR(*tooth.flute, hand * (edge - back), 0.001 * kDegree);
  for (const double asked : {0.0, tooth.depth / 4}) {
    const GroundCutter ground(k.c.cutter(), {{sweep}}, {{0, 0}}, {}, asked);
    const double inner = k.outer - (asked > 0 ? asked : tooth.depth / 10), inward = hand * (face(inner) - edge);
    const double chord = std::atan(inner * std::sin(inward) / (k.outer - inner * std::cos(inward)));
    EXPECT_NEAR(*ground.section(k.x).teeth.at(0).chordal_rake, chord, 0.01 * kDegree);
  }
  for (const double part : {0.2, 0.5, 0.8}) {
    const double r = k.outer - part * (k.outer - section.core_radius);
    const auto arc = sweep.arc(k.x, r);
    EXPECT_TRUE(arc.has_value());
    if (!arc || arc->high - arc->low < 1e-3) continue;
    for (const auto& [end, high] : {std::pair{arc->high, true}, {arc->low, false}}) {
      const double within = (high ? 1 : -1) * (end - bruteEnd(k, r, end, high));
      EXPECT_GT(within, -kSameEnd);
      EXPECT_LT(within, 0.001 * kDegree);
    }
  }
  return true;
}

TEST(GroundCutter, RakeEdgeAndFluteAreThoseOfBruteForce) {
  std::mt19937 random(23);
  const int cases = test_support::randomCases(70);
  int checked = 0;
  for (int i = 0; checked < cases && i < 60 * cases; ++i) {
    SCOPED_TRACE(i);
    const auto k = randomCase(random, i);
    checked += k && compare(*k);
  }
  EXPECT_EQ(checked, cases);
}

/// A random tool that is much smaller than the wheel's reach along it.
RandomCase microCase(std::mt19937& random, int i) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Case c;
  c.diameter = uniform(0.1, 1);
  c.cone = i % 3 == 0 ? 0 : uniform(-2, 12);
  c.spiral = i % 5 == 0 ? 0 : uniform(-10, 55);
  c.rake = uniform(-5, 20);
  c.depth = uniform(0.06, 0.28) * c.diameter;
  c.wheel = uniform(40, 125);
  c.width = i % 2 == 0 ? uniform(0.2, 6) : uniform(0.3, 1) * c.diameter;
  c.swivel = std::clamp(i % 7 == 0 ? uniform(-60, 60) : c.spiral + uniform(-8, 12), -60.0, 60.0);
  c.face = c.diameter / 2 * std::sin(uniform(-10, 30) * kDegree);
  // On the way to the apex, half of it at most.
  const double open = c.cone == 0 ? 100 : 0.25 * c.diameter / std::abs(std::tan(c.cone * kDegree));
  const double length = std::min(uniform(0.5, 6) * c.diameter, c.cone < 0 ? open : 100);
  c.from = -std::min(uniform(0.1, 3), c.cone > 0 ? open : 100);
  c.to = length + std::min(uniform(0.1, 3), c.cone < 0 ? open / 2 : 100);
  const double w = c.width * kMillimetre, d = c.wheel * kMillimetre, x = 0.6 * length * kMillimetre;
  const WheelProfile wheel = i % 4 == 0   ? WheelProfile::straight(d, w)
                             : i % 4 == 1 ? WheelProfile::angled(d, w, uniform(5, 40) * kDegree)
                             : i % 4 == 2 ? WheelProfile::straight(d, w, {0.15 * w, 0.15 * w})
                                          : WheelProfile::fullRadius(d, w);
  return {c, wheel, x, c.cutter().radius(x)};
}

// With either of its walls as the rake face.
TEST(GroundCutter, OfMicroToolsTheyAreToo) {
  // The rake came out as 27.93, -21.09 or -61.6 deg, depending on X.
  const Case c{0.387, 0, 45.938, 16.809, 0.0604, 125, 0.281, 43.952, 0.07336, -0.82, 3.26};
  const WheelProfile angled = WheelProfile::angled(0.125, 0.281e-3, 24.131 * kDegree);
  std::vector<RandomCase> all;
  for (int i = 0; i < 9; ++i) all.push_back({c, angled, 0.15e-3 * i, c.cutter().radius(0.15e-3 * i)});
  std::mt19937 random(11);
  for (int i = 0; i < 20; ++i) all.push_back(microCase(random, i));
  int checked = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const CutDirection cut : {CutDirection::kRightHand, CutDirection::kLeftHand}) {
      SCOPED_TRACE(::testing::Message() << i << ' ' << toString(cut));
      all[i].c.cut = cut;
      checked += compare(all[i], 0.02 * kDegree);
    }
  }
  EXPECT_GT(checked, 48);
}

TEST(GroundCutter, TheCoreIsThatOfBruteForce) {
  std::mt19937 random(5);
  const int cases = test_support::randomCases(80);
  int checked = 0;
  for (int i = 0; checked < cases && i < 60 * cases; ++i) {
    const auto k = randomCase(random, i);
    if (!k) continue;
    const double core = k->c.sweep(k->wheel).minRadius(k->x, k->outer);
    if (!(core < k->outer - 1e-5)) continue;
    ++checked;
    EXPECT_NEAR(core, k->bench(400, 60).core(k->x, k->way()), 0.1e-6) << "case " << i;
  }
  EXPECT_EQ(checked, cases);
}

TEST(GroundCutter, NoLongerStrokeMovesTheEndsOfACompleteArc) {
  std::mt19937 random(31);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int complete = 0, incomplete = 0;
  for (int i = 0; i < 1000; ++i) {
    auto k = randomCase(random, i);
    if (!k) continue;
    k->c.from = k->x / kMillimetre - uniform(0, 25);
    k->c.to = k->x / kMillimetre + uniform(0, 25);
    Case longer = k->c;
    longer.from -= 100;
    longer.to += 100;
    // About its apex a cone turns without end.
    const double apex = -k->c.diameter / 2 / std::tan(k->c.cone * kDegree);
    if (apex < 0) longer.from = std::max(longer.from, 0.95 * apex);
    if (apex > 0) longer.to = std::min(longer.to, 0.95 * apex);
    const double r = k->outer - uniform(0, 0.8) * std::min(k->c.depth * kMillimetre, 0.9 * k->outer);
    // Nor may it go where it would spoil the flute.
    if (const auto spoils = longer.sweep(k->wheel).overcutStart(k->x, r)) {
      if (apex < 0) longer.from = std::max(longer.from, *spoils / kMillimetre);
      if (apex > 0) longer.to = std::min(longer.to, *spoils / kMillimetre);
    }
    if (!(longer.from < k->c.from && longer.to > k->c.to)) continue;
    const WheelSweep sweep = k->c.sweep(k->wheel);
    const auto arc = sweep.arc(k->x, r), most = longer.sweep(k->wheel).arc(k->x, r);
    if (!arc) continue;
    ASSERT_TRUE(most.has_value()) << "case " << i;
    const double moved = std::max(std::abs(most->high - arc->high), std::abs(most->low - arc->low));
    if (sweep.isComplete(k->x, r, arc->low, arc->low_x, false) &&
        sweep.isComplete(k->x, r, arc->high, arc->high_x, true)) {
      ++complete;
      EXPECT_LT(moved, 1e-7) << "case " << i;
    } else if (moved > 1e-7) {
      ++incomplete;
    }
  }
  EXPECT_GT(complete, 75);
  EXPECT_GT(incomplete, 75);
}

TEST(WheelSweep, DeeperByWhatIsAskedItReachesTheRadius) {
  for (const double cone : {-1.0, 0.0, 8.0}) {
    Case c;
    c.cone = cone;
    c.width = 3;
    const double deeper = c.sweep().deeperFor(0.01, 2.9 * kMillimetre);
    c.depth += deeper / kMillimetre;
    EXPECT_NEAR(c.sweep().minRadius(0.01, 0.02), 2.9 * kMillimetre, 1e-9) << cone;
  }
}

TEST(GroundCutter, ALandIsWhatTheFluteBehindItLeaves) {
  for (const test_support::SolidCase& c : test_support::solidCases()) {
    SCOPED_TRACE(c.name);
    const bool right = c.ground.direction() == CutDirection::kRightHand;
    const std::vector<ToothSection> teeth = c.ground.section(c.from + 0.2 * (c.to - c.from)).teeth;
    for (std::size_t i = 0; i < teeth.size(); ++i) {
      const ToothSection& behind = teeth[(i + (right ? 1 : teeth.size() - 1)) % teeth.size()];
      const double turn = (right ? 1 : -1) * (*behind.edge - *teeth[i].edge);
      const double left = turn - *behind.flute + (turn > 0 ? 0 : units::kTurn);
      ASSERT_EQ(teeth[i].land.has_value(), left > 0) << i;
      if (left > 0) {
        EXPECT_NEAR(*teeth[i].land, left, 1e-9) << i;
      }
    }
  }
}

}  // namespace test_ground_cutter
}  // namespace grinder
