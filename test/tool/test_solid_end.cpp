// The end of a solid: what strokes on the end leave, beside rays along the axis.

#include "flute_grinder/tool/cutter_solid.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/end_volumes.h"
#include "flute_grinder/tool/stl.h"
#include "flute_grinder/tool/z_law.h"
#include "refusal.h"
#include "tool/face_sweep.h"
#include "tool/open_edges.h"
#include "tool/seams.h"
#include "tool/solid_cases.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_solid_end {

using Eigen::Vector3d;
using test_support::openEdges;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

constexpr double kLength = 12 * kMillimetre;
constexpr SolidExtent kExtent{0, kLength};

/// A cylindrical end mill of 10 mm with four teeth: gashed, with both flanks of its end teeth, and chamfered.
struct EndMill {
  explicit EndMill(CutDirection cut)
      : tooth{5 * kMillimetre, kPi / 2, cut}, ground(fluted(cut)), first_edge(*ground.section(0).teeth[0].edge) {
    FaceWheel wheel;
    wheel.nominal_radius = wheel.radius = 50 * kMillimetre;
    wheel.width = 10 * kMillimetre;
    FaceWheel thin = wheel, flat = wheel;
    thin.width = 1.5 * kMillimetre;
    if (cut == CutDirection::kLeftHand) flat.inner_radius = 44 * kMillimetre;
    const double dish = 2 * kDegree, gap = 0.05 * kMillimetre, clear = 1 * kMillimetre;
    const auto add = [&](SurfaceKind kind, const FaceStroke& stroke, const FaceWheel& its) {
      for (int k = 0; k < 4; ++k) {
        const WheelProfile profile = WheelProfile::straight(2 * its.radius, its.width);
        sweeps.emplace_back(stroke, its, profile, tooth.radius, angle(k));
        RemovedVolume& volume = removed.emplace_back(sweeps.back().volume(1.5e-6));
        volume.kind = kind;
        volume.tooth = static_cast<std::uint16_t>(k);
      }
    };
    add(SurfaceKind::kGash,
        gashStroke(tooth, gashNormal(3 * kDegree, dish), 45 * kDegree, -0.2 * kMillimetre, thin, clear), thin);
    const double land = 0.4 * kMillimetre, clearance = 8 * kDegree;
    const OnTooth edge(0, tooth.radius, 0), land_end(land * std::tan(clearance), tooth.radius, land);
    const auto flank = [&](SurfaceKind kind, const OnTooth& normal, const OnTooth& through) {
      add(kind, endStroke(tooth, normal, through, flat, gap, clear), flat);
    };
    flank(SurfaceKind::kEndPrimary, endNormal(clearance, dish), edge);
    flank(SurfaceKind::kEndSecondary, endNormal(18 * kDegree, dish), land_end);
    const double x = 0.3 * kMillimetre;
    const OnTooth normal = chamferNormal(45 * kDegree, 10 * kDegree, dish, std::tan(3 * kDegree));
    const OnTooth through(x, tooth.radius, x * std::tan(3 * kDegree));
    add(SurfaceKind::kChamfer, chamferStroke(tooth, normal, through, wheel, gap, clear), wheel);
  }

  static GroundCutter fluted(CutDirection cut) {
    test_support::Case c = test_support::cylinder();
    if (cut == CutDirection::kLeftHand) {
      c.spiral = -c.spiral;
      c.face = c.width / std::cos(c.swivel * kDegree) - c.face;
      c.swivel = -c.swivel;
      c.cut = cut;
    }
    return c.ground(4);
  }
  /// Of the edge of a tooth at the end.
  double angle(int k) const { return first_edge + k * kPi / 2; }

  /// The volume that the strokes take from the fluted tool, on rays along the axis; a quarter turn stands for all four.
  double removedOnRays() const {
    constexpr int kRings = 60, kAround = 40;
    double volume = 0;
    for (int i = 0; i < kRings; ++i) {
      const double r = (i + 0.5) * tooth.radius / kRings;
      for (int k = 0; k < kAround; ++k) {
        const double at = kPi / 2 * (k + 0.5) / kAround;
        std::vector<Range> gone = flutesOn(r, at), all = gone;
        for (const FaceSweep& sweep : sweeps) addRemoved(sweep, {r * std::cos(at), r * std::sin(at)}, all);
        volume += (length(all) - length(gone)) * r * (tooth.radius / kRings) * (2 * kPi / kAround);
      }
    }
    return volume;
  }

  /// Where a stroke takes something from a ray: in steps up to where that begins, which is half a step off on average.
  static void addRemoved(const FaceSweep& sweep, const Eigen::Vector2d& ray, std::vector<Range>& ranges) {
    constexpr double kStep = 0.1 * kMillimetre, kDeepest = 8 * kMillimetre;
    for (double x = 0; x < kDeepest; x += kStep) {
      if (!sweep.removes(ray, x)) continue;
      ranges.push_back({x - kStep / 2, *sweep.removedTo(ray, x)});
      x = ranges.back().to;
    }
  }

  /// Where a ray along the axis is in a flute: its arc turns with X as the helix does.
  std::vector<Range> flutesOn(double r, double at) const {
    std::vector<Range> ranges;
    const auto arc = ground.arc(ground.flutes().front(), 0, r);
    if (!arc) return ranges;
    const double per_x = (ground.arc(ground.flutes().front(), kLength, r)->low - arc->low) / kLength;
    for (int turn = -8; turn < 8; ++turn) {  // of the teeth, a quarter each
      const double a = (at + turn * kPi / 2 - arc->low) / per_x, b = (at + turn * kPi / 2 - arc->high) / per_x;
      ranges.push_back({std::min(a, b), std::max(a, b)});
    }
    return ranges;
  }

  /// The length of ranges that may overlap, on the tool.
  static double length(std::vector<Range> ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.from < b.from; });
    double sum = 0, to = 0;
    for (const Range& range : ranges) {
      const double end = std::min(range.to, kLength);
      sum += std::max(0.0, end - std::max(range.from, to));
      to = std::max(to, end);
    }
    return sum;
  }

  EndTooth tooth;
  GroundCutter ground;
  double first_edge;  ///< angle of the first tooth's edge at the end [rad]
  std::vector<FaceSweep> sweeps;
  std::vector<RemovedVolume> removed;
};

constexpr CutDirection kHands[] = {CutDirection::kRightHand, CutDirection::kLeftHand};
constexpr SolidResolution kCoarse{24, 12, 60}, kFine{24, 16, 120};

TEST(SolidEnd, LacksWhatTheWheelPassesThroughOnRays) {
  for (const CutDirection cut : kHands) {
    SCOPED_TRACE(toString(cut));
    const EndMill mill(cut);
    const double removed = cutterSolid(mill.ground, kExtent, kFine).volume() -
                           cutterSolid(mill.ground, kExtent, kFine, mill.removed).volume();
    const double on_rays = mill.removedOnRays();
    EXPECT_GT(on_rays, 20e-9);
    EXPECT_NEAR(removed, on_rays, 3e-3 * on_rays);
  }
}

TEST(SolidEnd, IsClosedAlsoWhereItIsCutOpen) {
  for (const CutDirection cut : kHands) {
    SCOPED_TRACE(toString(cut));
    EndMill mill(cut);
    EXPECT_EQ(openEdges(cutterSolid(mill.ground, kExtent, kCoarse, mill.removed)), 0u);
    mill.removed.push_back(wedge(35 * kDegree, 120 * kDegree));
    EXPECT_EQ(openEdges(cutterSolid(mill.ground, kExtent, kCoarse, mill.removed)), 0u);
  }
}

double area(const CutterSolid& solid, const SolidTriangle& t) {
  const auto at = [&](std::size_t i) { return solid.vertices[t.vertices[i]]; };
  return (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
}

/// The tool of the shipped job after some of its operations has the faces of those up to it.
TEST(SolidEnd, OfAJobHasTheFacesOfItsOperations) {
  const std::vector<std::pair<std::string, std::map<SurfaceKind, int>>> rows{
      {"flute", {}},
      {"end_primary", {{SurfaceKind::kGash, 4}, {SurfaceKind::kEndPrimary, 4}}},
      {"chamfer",
       {{SurfaceKind::kGash, 4},
        {SurfaceKind::kEndPrimary, 4},
        {SurfaceKind::kEndSecondary, 4},
        {SurfaceKind::kChamfer, 4}}}};
  for (const auto& [operation, faces] : rows) {
    SCOPED_TRACE(operation);
    const EndVolumes end = endVolumesOf(withLaws(ValidJob(readJobFile("jobs/end_mill_d10_t4.yaml", operation))));
    std::map<SurfaceKind, int> count;
    std::map<int, std::size_t> of_tooth;
    for (const RemovedVolume& volume : end.removed) {
      ++count[volume.kind];
      ++of_tooth[volume.tooth];
    }
    EXPECT_EQ(of_tooth[3], end.removed.size() / 4);
    EXPECT_EQ(count, faces);
    EXPECT_EQ(end.blank_x, 0);
  }
}

/// A corner of a tetrahedron, on one of its faces.
CutterSolid tetrahedron(const Vector3d& corner) {
  CutterSolid solid;
  const Vector3d one(1e-3, 0, 0), other(0, 1e-3, 0), top(0, 0, 1e-3);
  solid.vertices = {Vector3d::Zero(), one, other, top, corner};
  for (const std::array<std::uint32_t, 3>& v : {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 4}, {1, 2, 3}, {2, 0, 3}})
    solid.triangles.push_back({v, SurfaceKind::kGash, 0});
  return solid;
}

TEST(SolidEnd, ASeamClosesUpToAMicrometreAndAnOpenOneMakesNoStlFile) {
  for (const double off : {0.5e-9, 5e-9, 0.5e-6}) {
    CutterSolid solid = tetrahedron({off, 0, 1e-3});
    closeSeams(solid);
    EXPECT_EQ(openEdges(solid), 0u) << off;
    EXPECT_EQ(solid.triangles.size(), 4u);
  }
  CutterSolid open = tetrahedron({5e-6, 0, 1e-3});
  closeSeams(open);
  EXPECT_EQ(open.open_edges, openEdges(open));
  EXPECT_GT(open.open_edges, 0u);
  EXPECT_EQ(test_support::refusalOf<std::invalid_argument>([&] { stlOf(open); }).find("the solid has "), 0u);
}

TEST(SolidEnd, CornersOfAClosedSolidStayApart) {
  CutterSolid solid;
  const double near = 0.5e-6;  // the length of its shortest edge
  solid.vertices = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}, {near, 0, 1e-3}};
  for (const std::array<std::uint32_t, 3>& v :
       {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 3, 4}, {2, 0, 3}})
    solid.triangles.push_back({v, SurfaceKind::kGash, 0});
  closeSeams(solid);
  EXPECT_EQ(solid.open_edges, 0u);
  EXPECT_EQ(solid.vertices.size(), 5u);
}

TEST(SolidEnd, AChipThatIsCutOffIsNotShown) {
  const GroundCutter ground = test_support::cylinder().ground(4);
  const double from = 2 * kMillimetre, to = 3 * kMillimetre;
  const RemovedVolume slot{{{{1, 0, 0}, from}, {{-1, 0, 0}, -to}}, {}, SurfaceKind::kGash, 0};
  const CutterSolid solid = cutterSolid(ground, kExtent, kCoarse, {slot});
  EXPECT_EQ(openEdges(solid), 0u);
  for (const SolidTriangle& t : solid.triangles) {
    for (const std::uint32_t v : t.vertices) EXPECT_GT(solid.vertices[v].x(), to - 1e-9);
  }
}

/// Of two volumes that end in the same plane, one leaves the face.
TEST(SolidEnd, ASharedPlaneHasOneFace) {
  const GroundCutter ground = test_support::cylinder().ground(4);
  const auto behind = [](const Vector3d& normal, double offset) { return Plane{normal, offset}; };
  const double depth = 2 * kMillimetre;
  const Plane front = behind({-1, 0, 0}, -depth);
  const RemovedVolume low{{front, behind({0, -1, 0}, -kMillimetre)}, {}, SurfaceKind::kEndPrimary, 0};
  const RemovedVolume high{{front, behind({0, 1, 0}, -kMillimetre)}, {}, SurfaceKind::kChamfer, 1};
  const CutterSolid solid = cutterSolid(ground, kExtent, kCoarse, {low, high});
  EXPECT_EQ(openEdges(solid), 0u);
  const CutterSolid rest = cutterSolid(ground, {depth, kLength}, kFine);
  EXPECT_NEAR(solid.volume(), rest.volume(), 5e-3 * rest.volume());
  double faces = 0;
  for (const SolidTriangle& t : solid.triangles) {
    if (t.kind == SurfaceKind::kEndPrimary || t.kind == SurfaceKind::kChamfer) faces += area(solid, t);
  }
  double section = 0;
  for (const SolidTriangle& t : cutterSolid(ground, {depth, kLength}, kFine).triangles) {
    if (t.kind == SurfaceKind::kEndFace) section += area(rest, t) / 2;
  }
  EXPECT_NEAR(faces, section, 5e-3 * section);
}

}  // namespace test_solid_end
}  // namespace grinder
