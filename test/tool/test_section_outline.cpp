// Outlines against areas, edges and walls that are measured in another way.

#include "flute_grinder/tool/section_outline.h"

#include "refusal.h"
#include "tool/solid_cases.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_section_outline {

using test_support::Case;
using test_support::cylinder;
using test_support::SolidCase;
using units::kDegree;
using units::kMillimetre;
constexpr double kTurn = 2 * units::kPi;

std::vector<PolarPoint> outlineOf(const GroundCutter& ground, double x, const OutlineGrid& grid) {
  return sectionOutline(ground, x, ground.cutter().radius(x), grid);
}

/// Of the polygon through the points [m^2].
double area(const std::vector<PolarPoint>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const PolarPoint& a = outline[i];
    const PolarPoint& b = outline[(i + 1) % outline.size()];
    twice += a.radius * b.radius * std::sin(b.angle() - a.angle());
  }
  return twice / 2;
}

TEST(SectionOutline, EnclosesWhatIsLeftOfTheBlank) {
  for (const SolidCase& c : test_support::solidCases()) {
    const OutlineGrid grid{c.ground.teeth().size(), 64, 200};
    for (const double part : {0.03, 0.4, 0.97}) {
      SCOPED_TRACE(::testing::Message() << c.name << " at " << part);
      const double x = c.from + part * (c.to - c.from);
      const GroundSection section = c.ground.section(x);
      const double blank = units::kPi * section.radius * section.radius;
      EXPECT_NEAR(area(outlineOf(c.ground, x, grid)), blank - c.ground.areaRemoved(section), 3e-4 * blank);
    }
  }
}

TEST(SectionOutline, HasItsEdgesWhereTheyAreMeasured) {
  for (const SolidCase& c : test_support::solidCases()) {
    const OutlineGrid grid{c.ground.teeth().size(), 400, 3};
    const double x = c.from + 0.2 * (c.to - c.from);
    const GroundSection section = c.ground.section(x);
    const std::vector<PolarPoint> outline = outlineOf(c.ground, x, grid);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const PolarPoint& a = outline[i];
      const PolarPoint& b = outline[(i + 1) % outline.size()];
      if (grid.kind(i, c.ground.direction()) != SurfaceKind::kRakeFace) continue;
      const PolarPoint& out = a.radius > b.radius ? a : b;
      const PolarPoint& in = a.radius > b.radius ? b : a;
      if (out.radius < section.radius) continue;
      const ToothSection& tooth = section.teeth[grid.tooth(i, c.ground.direction())];
      SCOPED_TRACE(::testing::Message() << c.name << " point " << i);
      EXPECT_NEAR(std::remainder(out.angle() - *tooth.edge, kTurn), 0, 1e-9);
      const double fall = std::remainder(in.angle() - out.angle(), kTurn);
      const double sign = c.ground.direction() == CutDirection::kRightHand ? 1 : -1;
      EXPECT_NEAR(std::atan(sign * out.radius * fall / (out.radius - in.radius)), *tooth.rake, 0.2 * kDegree);
    }
  }
}

TEST(SectionOutline, WithoutALandAToothEndsWhereItsWallsMeet) {
  Case c = cylinder();
  c.width = 6;
  const GroundCutter ground = c.ground(4);
  const OutlineGrid grid{4, 32, 5};
  const std::vector<PolarPoint> outline = outlineOf(ground, 0.01, grid);
  for (std::size_t tooth = 0; tooth < 4; ++tooth) {
    const PolarPoint tip = outline[grid.land(tooth, 0)];
    EXPECT_LT(tip.radius, 4.99 * kMillimetre);
    for (std::size_t k = 0; k <= grid.columns; ++k) {
      EXPECT_EQ(outline[grid.land(tooth, k)].radius, tip.radius);
      EXPECT_EQ(outline[grid.land(tooth, k)].turns, tip.turns);
    }
    const auto own = c.sweep().arc(0.01, tip.radius);
    EXPECT_NEAR(own->high + static_cast<double>(tooth) * kTurn / 4, tip.angle(), 1e-9);
    EXPECT_NEAR(own->high, own->low + kTurn / 4, 1e-9);
  }
}

TEST(SectionOutline, OfAFluteThatRemovesNothingShrinksToAPointOfTheLand) {
  Case c = cylinder();
  Case none = c;
  none.depth = -0.5;
  const GroundCutter ground(c.cutter(), {{c.sweep()}, {none.sweep()}},
                            {{0, 1}, {90 * kDegree, 0}, {180 * kDegree, 1}, {270 * kDegree, 1}});
  const OutlineGrid grid{4, 16, 4};
  const std::vector<PolarPoint> outline = outlineOf(ground, 0.01, grid);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t body = i / grid.perTooth(), within = i % grid.perTooth();
    const bool of_flute = (body == 1 && within < grid.rings) || (body == 0 && within > grid.rings + grid.columns);
    EXPECT_EQ(outline[i].radius < 5 * kMillimetre, of_flute) << i;
  }
  for (const std::size_t empty : {0, 2, 3}) {
    for (std::size_t ring = 0; ring <= grid.rings; ++ring) {
      const double place = outline[grid.high(empty, 0)].turns;
      EXPECT_EQ(outline[grid.high(empty, ring % grid.rings)].turns, place);
      EXPECT_EQ(outline[grid.lowOfNext(empty + 3, ring)].turns, place + (empty == 0 && ring > 0));
    }
  }
  for (std::size_t i = 1; i < outline.size(); ++i) {
    if (outline[i - 1].radius < 5 * kMillimetre || outline[i].radius < 5 * kMillimetre) continue;
    EXPECT_GE(outline[i].turns, outline[i - 1].turns) << i;
  }
}

TEST(SectionOutline, LeavesOutAShallowFluteWithinADeepOne) {
  Case deep = cylinder(), shallow = cylinder();
  deep.width = 6;
  shallow.depth = 0.05;
  const GroundCutter ground(deep.cutter(), {{deep.sweep()}, {shallow.sweep()}}, {{0, 0}, {300 * kDegree, 1}});
  const OutlineGrid grid{2, 64, 300};
  const double expected = area(outlineOf(deep.ground(1), 0.01, {1, 64, 600}));
  EXPECT_NEAR(area(outlineOf(ground, 0.01, grid)), expected, 1e-4 * expected);
}

TEST(SectionOutline, RefusesACoreThatIsCutThrough) {
  Case c;
  c.spiral = c.swivel = 0;
  c.depth = 6;
  c.face = 2;
  const std::string said = test_support::refusalOf<std::invalid_argument>([&] {
    outlineOf(c.ground(2), 0.01, {2, 16, 4});
  });
  EXPECT_NE(said.find("core radius = "), std::string::npos) << said;
  EXPECT_NE(said.find("x = 0.01"), std::string::npos) << said;
  EXPECT_THROW(outlineOf(cylinder().ground(2), 0.01, {3, 16, 4}), std::invalid_argument);
  EXPECT_THROW(outlineOf(cylinder().ground(2), 0.01, {2, 1, 4}), std::invalid_argument);
  EXPECT_THROW(outlineOf(cylinder().ground(2), 0.01, {2, 16, 0}), std::invalid_argument);
}

}  // namespace test_section_outline
}  // namespace grinder
