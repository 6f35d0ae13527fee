// Solids: closed, facing outward, and of the volume that the sections have, as admesh, another program, reads them,
// too.

#include "flute_grinder/tool/cutter_solid.h"

#include "flute_grinder/tool/stl.h"
#include "temp_folder.h"
#include "tool/open_edges.h"
#include "tool/solid_cases.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <regex>

namespace grinder {
namespace test_cutter_solid {

using test_support::Case;
using test_support::cylinder;
using test_support::openEdges;
using test_support::SolidCase;
using units::kDegree;
using units::kMillimetre;

/// So fine that the volume is right to a thousandth.
constexpr SolidResolution kMiddling{30, 16, 120};

double blankVolume(const ConicalCutter& cutter, double from, double to) {
  const double a = cutter.radius(from), b = cutter.radius(to);
  return units::kPi * (to - from) * (a * a + a * b + b * b) / 3;
}

/// What admesh says of a file.
std::string admesh(const std::string& path) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("admesh '" + path + "' 2>&1").c_str(), "r"), pclose);
  std::string text;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get())) text += buffer.data();
  return text;
}

/// The figure behind a name.
double figure(const std::string& text, const std::string& name) {
  std::smatch match;
  if (std::regex_search(text, match, std::regex(name + " *: *([-+.e0-9]+)"))) return std::stod(match[1]);
  ADD_FAILURE() << name << " is not in:\n" << text;
  return -1;
}

TEST(CutterSolid, IsClosedAndHasTheVolumeOfTheSectionsAlsoInAnStlFile) {
  const test_support::TempFolder folder;
  const std::string path = folder.path() / "cutter.stl";
  for (const SolidCase& c : test_support::solidCases()) {
    SCOPED_TRACE(c.name);
    const CutterSolid solid = cutterSolid(c.ground, {c.from, c.to}, kMiddling);
    EXPECT_EQ(openEdges(solid), 0u);
    const double volume = blankVolume(c.ground.cutter(), c.from, c.to) - c.ground.volumeRemoved(c.from, c.to, 20);
    EXPECT_NEAR(solid.volume(), volume, 1e-3 * volume);

    std::ofstream out(path, std::ios::binary);
    out << stlOf(solid);
    out.close();
    EXPECT_TRUE(out.good());
    const std::string said = admesh(path);
    for (const char* wrong : {"Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed",
                              "Facets added", "Facets reversed", "Backwards edges", "Normals fixed"}) {
      EXPECT_EQ(figure(said, wrong), 0) << said;
    }
    EXPECT_EQ(figure(said, "Number of parts"), 1);
    EXPECT_NEAR(figure(said, "Volume") * std::pow(kMillimetre, 3), solid.volume(), 1e-4 * solid.volume());
  }
}

/// How far a solid's corners are from where a wheel has been, along their circle; not those on lands, and beside a
/// floor, where an angle says nothing [m].
double offTheWalls(const GroundCutter& ground, const CutterSolid& solid, double from, double to) {
  double most = 0;
  std::size_t walls = 0;
  for (const Eigen::Vector3d& v : solid.vertices) {
    const double x = v.x(), r = v.tail<2>().norm(), blank = ground.cutter().radius(x);
    if (!(x > from && x < to && r < 0.999 * blank)) continue;
    double nearest = blank;
    for (const GroundTooth& tooth : ground.teeth()) {
      const Flute& flute = ground.flutes()[tooth.flute];
      if (r < leastRadius(flute, x, blank) + 0.02 * blank) nearest = 0;
      const auto arc = nearest > 0 ? ground.arc(flute, x, r) : std::nullopt;
      if (!arc) continue;
      for (const double end : {arc->low, arc->high}) {
        const double off = std::remainder(std::atan2(v.z(), v.y()) - tooth.angle - end, 2 * units::kPi);
        nearest = std::min(nearest, r * std::abs(off));
      }
    }
    walls += nearest > 0;
    most = std::max(most, nearest);
  }
  EXPECT_GT(walls, 500u);
  return most;
}

/// Sections that are not computed, and layers between sections, are where a wheel has been.
TEST(CutterSolid, KeepsToTheWallsOfTheFlutesBetweenItsSections) {
  for (const SolidCase& c : test_support::solidCases()) {
    if (c.name != "paper" && c.name != "left hand" && c.name != "back taper") continue;
    const CutterSolid solid = cutterSolid(c.ground, {c.from, c.to}, {60, 8, 60});
    EXPECT_LT(offTheWalls(c.ground, solid, c.from, c.to), 1e-4 * c.ground.cutter().radius(c.from)) << c.name;
  }
}

/// What was recorded differs from the plan along less than a stride between sections.
TEST(CutterSolid, KeepsToWhatWasRecordedBetweenSectionsThatForetellEachOther) {
  Case c = cylinder();
  c.from = -20, c.to = 50;
  GrindStroke stroke = c.stroke();
  constexpr double kOff = 2e-3, kWave = 2.034e-3, kSteps = 350;  // [rad], half a stride [m]
  for (double i = 0; i <= kSteps; ++i) {
    const double x = stroke.from + i / kSteps * (stroke.to - stroke.from);
    stroke.deviations.push_back({0, 0, kOff * std::sin(2 * units::kPi * x / kWave)});
  }
  const WheelSweep sweep(c.cutter(), c.profile(), c.wheel / 2 * kMillimetre, c.setup(), stroke);
  const GroundCutter ground(c.cutter(), {{sweep}}, {{0, 0}});
  const CutterSolid solid = cutterSolid(ground, {0, 0.03}, {60, 8, 60});
  EXPECT_LT(offTheWalls(ground, solid, 0, 0.03), kOff / 2 * c.cutter().radius(0));
}

TEST(CutterSolid, HasTheFlutesRunOutIntoTheShank) {
  Case c = cylinder();
  c.to = 15;
  const GroundCutter ground = c.ground(2);
  const double cone = cutterSolid(ground, {0, 0.02}, kMiddling).volume();
  for (const double diameter : {14.0, 10.0, 9.0}) {
    SCOPED_TRACE(diameter);
    const CutterSolid solid = cutterSolid(ground, {0, 0.02, diameter * kMillimetre, 0.05}, kMiddling);
    EXPECT_EQ(openEdges(solid), 0u);
    const double shank = units::kPi * diameter * diameter / 4 * 30e-9;
    const double taken = cone + shank - solid.volume();
    EXPECT_GT(taken, -1e-3 * solid.volume());
    EXPECT_LT(taken, 0.1 * shank);
    EXPECT_EQ(solid.vertices.back().x(), 0.05);
  }
}

/// The area that an outline encloses [m^2].
double areaOf(const std::vector<PolarPoint>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const PolarPoint &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.radius * b.radius * std::sin(b.angle() - a.angle());
  }
  return twice / 2;
}

TEST(CutterSolid, HasTheVolumeOfTheSectionsInTheShankToo) {
  Case c = cylinder();
  c.to = 15;
  const GroundCutter ground = c.ground(2);
  constexpr double kShank = 0.05, kRadius = 0.007;
  const SolidResolution fine{60, 16, 120};
  const OutlineGrid grid{2, 16, 120};
  double shank = 0;
  constexpr int kSections = 600;
  for (int i = 0; i < kSections; ++i) {
    const double x = 0.02 + (i + 0.5) / kSections * (kShank - 0.02);
    shank += (kShank - 0.02) / kSections * areaOf(sectionOutline(ground, x, kRadius, grid));
  }
  const double cone = cutterSolid(ground, {0, 0.02}, fine).volume();
  const double all = cutterSolid(ground, {0, 0.02, 2 * kRadius, kShank}, fine).volume();
  const double run_out = units::kPi * kRadius * kRadius * (kShank - 0.02) - shank;
  EXPECT_GT(run_out, 1e-9);
  EXPECT_NEAR(all - cone, shank, 0.1 * run_out);
}

/// A triangle across the turn of a land leans along X by several times as much, and looks like a scale.
TEST(CutterSolid, OfACylinderHasLandsWithoutScales) {
  for (const double spiral : {-30.0, 30.0}) {
    Case c = cylinder();
    c.spiral = spiral;
    c.swivel = spiral;
    const CutterSolid solid = cutterSolid(c.ground(3), {0, 0.02}, {40, 16, 72});
    double leans = 0;
    for (const SolidTriangle& t : solid.triangles) {
      if (t.kind != SurfaceKind::kLand) continue;
      const auto at = [&](std::size_t i) { return solid.vertices[t.vertices[i]]; };
      leans = std::max(leans, std::abs((at(1) - at(0)).cross(at(2) - at(0)).normalized().x()));
    }
    EXPECT_GT(leans, 0) << spiral;
    EXPECT_LT(leans, 0.02) << spiral;
  }
}

TEST(CutterSolid, CutOpenIsClosedAndLacksTheWedge) {
  for (const SolidCase& c : test_support::solidCases()) {
    if (c.name != "left hand" && c.name != "lands gone") continue;
    SCOPED_TRACE(c.name);
    const SolidExtent extent{c.from, c.to, 2.4 * c.ground.cutter().radius(c.to), c.to + 0.02};
    const SolidResolution coarse{6, 6, 24};
    const double whole = cutterSolid(c.ground, extent, coarse).volume();
    double rest = 0;
    for (int third = 0; third < 3; ++third) {
      const double from = (third * 120 + 17) * kDegree;
      const CutterSolid open = cutterSolid(c.ground, extent, coarse, {wedge(from, from + 120 * kDegree)});
      EXPECT_EQ(openEdges(open), 0u);
      rest += open.volume();
      for (const SolidTriangle& t : open.triangles) {
        const Eigen::Vector3d middle =
            (open.vertices[t.vertices[0]] + open.vertices[t.vertices[1]] + open.vertices[t.vertices[2]]) / 3;
        const double into = std::remainder(std::atan2(middle.z(), middle.y()) - from - 60 * kDegree, 2 * units::kPi);
        EXPECT_TRUE(middle.tail<2>().norm() < 1e-6 || std::abs(into) > 60 * kDegree - 1e-6);
      }
    }
    EXPECT_NEAR(rest, 2 * whole, 1e-9 * whole);
  }
}

TEST(CutterSolid, ReportsWhatEachTriangleIs) {
  for (const SolidCase& c : test_support::solidCases()) {
    if (c.name != "unequal pitch" && c.name != "left hand") continue;
    SCOPED_TRACE(c.name);
    const GroundSection section = c.ground.section(0.01);
    const CutterSolid solid = cutterSolid(c.ground, {0.0099, 0.0101}, {2, 64, 60});
    std::array<std::size_t, static_cast<std::size_t>(SurfaceKind::kCut) + 1> count{};
    for (const SolidTriangle& t : solid.triangles) {
      ++count[static_cast<std::size_t>(t.kind)];
      const Eigen::Vector3d middle =
          (solid.vertices[t.vertices[0]] + solid.vertices[t.vertices[1]] + solid.vertices[t.vertices[2]]) / 3;
      const double angle = std::atan2(middle.z(), middle.y());
      const double behind = std::remainder(angle - *section.teeth[t.tooth].edge, 2 * units::kPi);
      // Behind an edge that moves toward falling angles are the larger ones.
      const bool right = c.ground.direction() == CutDirection::kRightHand;
      if (t.kind == SurfaceKind::kLand) {
        EXPECT_NEAR(std::hypot(middle.y(), middle.z()), section.radius, 0.01 * kMillimetre);
        EXPECT_GT(right ? behind : -behind, -0.02);
        EXPECT_LT(right ? behind : -behind, *section.teeth[t.tooth].land + 0.02);
      }
      if (t.kind == SurfaceKind::kRakeFace && middle.tail<2>().norm() > 0.9 * section.radius) {
        EXPECT_NEAR(behind, 0, 0.05);
      }
    }
    for (const SurfaceKind kind :
         {SurfaceKind::kRakeFace, SurfaceKind::kFluteBack, SurfaceKind::kLand, SurfaceKind::kEndFace}) {
      EXPECT_GT(count[static_cast<std::size_t>(kind)], 100u);
    }
  }
}

TEST(CutterSolid, RefusesWhatCannotBeShown) {
  const GroundCutter ground = cylinder().ground(4);
  const double nan = std::nan("");
  for (const SolidExtent& extent : {SolidExtent{0, 0},
                                    {0.01, 0},
                                    {nan, 0.01},
                                    {0, nan},
                                    {0, 0.01, 0, 0.02},
                                    {0, 0.01, nan, 0.02},
                                    {0, 0.01, 0.01, nan}}) {
    EXPECT_THROW(cutterSolid(ground, extent), std::invalid_argument) << extent.from << ' ' << extent.to;
  }
  for (const SolidResolution& resolution : {SolidResolution{1, 64, 180}, {60, 1, 180}, {60, 64, 2}}) {
    EXPECT_THROW(cutterSolid(ground, {0, 0.01}, resolution), std::invalid_argument) << resolution.sections;
  }
  for (const double to : {1.0, 5.0}) {
    EXPECT_THROW(wedge(1, to), std::invalid_argument) << to;
  }
}

}  // namespace test_cutter_solid
}  // namespace grinder
