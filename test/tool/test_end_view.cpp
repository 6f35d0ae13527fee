// The view of the shipped tools' ends, beside their teeth in closed form.

#include "flute_grinder/tool/end_view.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"
#include "tool/end_cuts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_end_view {

using Eigen::Vector2d;
using units::kMillimetre;
using units::kPi;

constexpr double kExact = 0.01 * kMillimetre;                       ///< allowed error of a line
constexpr double kFrom = 0.5 * kMillimetre, kTo = 2 * kMillimetre;  ///< a ring within the core

/// They are on the periphery, and take long.
GrindJob withoutReliefs(GrindJob job) {
  const OperationKind kind = job.process().kind;
  auto& all = job.operations;
  all.erase(std::remove_if(all.begin(), all.end(), [](const GrindProcess& p) { return isRelief(p.kind); }), all.end());
  const auto is = [kind](const GrindProcess& p) { return p.kind == kind; };
  return job.ofOperation(static_cast<int>(std::find_if(all.begin(), all.end(), is) - all.begin()));
}

/// A shipped job with the view of its end.
struct Shipped {
  Shipped(const std::string& name, const std::string& operation)
      : job(withLaws(ValidJob(withoutReliefs(readJobFile("jobs/" + name + ".yaml", operation))))),
        cutter(job->cutter),
        view(endView(groundCutterOf(job), endVolumesOf(job))) {}

  /// A place by its distance along the radius through a tooth's corner at X = 0, and behind it against the cut.
  Vector2d onTooth(std::size_t tooth, const Vector2d& place) const {
    const double angle = job->tooth_angles[tooth] + job.edges()[tooth].at_end;
    const double behind = place.y() * std::cos(angle) - place.x() * std::sin(angle);
    return {place.x() * std::cos(angle) + place.y() * std::sin(angle),
            cutter.cut == CutDirection::kRightHand ? behind : -behind};
  }

  const EndRegion& region(SurfaceKind kind, std::uint16_t tooth) const {
    return *std::find_if(view.regions.begin(), view.regions.end(),
                         [&](const EndRegion& region) { return region.kind == kind && region.tooth == tooth; });
  }

  ValidJob job;
  CutterGeometry cutter;
  EndView view;
};

/// Each is computed once.
const Shipped& shipped(const std::string& name, const std::string& operation = "chamfer") {
  static std::map<std::pair<std::string, std::string>, Shipped> all;
  return all.try_emplace({name, operation}, name, operation).first->second;
}

const std::vector<const char*> kTools{"end_mill_d10_t4", "left_hand_end_mill_d8_t3"};

double areaOf(const EndPolyline& outline) {
  double twice = 0;
  for (std::size_t i = 1; i < outline.size(); ++i) {
    twice += outline[i - 1].x() * outline[i].y() - outline[i - 1].y() * outline[i].x();
  }
  return twice / 2;
}

/// How often a region goes round a place.
int turnsAbout(const EndRegion& region, const Vector2d& place) {
  double angle = 0;
  for (const EndPolyline& outline : region.outlines) {
    for (std::size_t i = 1; i < outline.size(); ++i) {
      const Vector2d a = outline[i - 1] - place, b = outline[i] - place;
      angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    }
  }
  return static_cast<int>(std::lround(angle / (2 * kPi)));
}

TEST(EndView, EdgesRunFromTheUncutDiameterToTheCorners) {
  for (const char* name : kTools) {
    SCOPED_TRACE(name);
    const Shipped& tool = shipped(name);
    const CutterGeometry& c = tool.cutter;
    ASSERT_EQ(tool.view.edges.size(), tool.job->tooth_angles.size());
    // The chamfer's end on the periphery, where the helix has turned on.
    const double radius = c.end_diameter / 2;
    const double corner_x = c.chamfer_width * (std::tan(c.end_dish) + 1 / std::tan(c.chamfer_angle));
    const double ahead = corner_x * std::tan(std::abs(c.spiral_angle));
    for (std::size_t k = 0; k < tool.view.edges.size(); ++k) {
      const EndEdge& edge = tool.view.edges[k];
      EXPECT_EQ(edge.tooth, k);
      EXPECT_LT(edge.line.front().norm(), c.end_uncut_diameter / 2);
      EXPECT_NEAR(edge.line.back().norm(), radius, kExact);
      EXPECT_NEAR(std::abs(tool.onTooth(k, edge.line.back()).y()), ahead, kExact);
      // The gash alone forms it within the core.
      for (const Vector2d& point : edge.line) {
        const double behind = tool.onTooth(k, point).y();
        EXPECT_TRUE(point.norm() >= kTo || std::abs(behind) <= kExact) << behind;
      }
    }
  }
}

/// One that goes to the axis ends by the gap before it, at the rim of the opposite flank; the only one crosses it.
TEST(EndView, AnEdgeToTheCentreIsOneLine) {
  for (const char* name : {"center_cutting_d10_t4", "slot_drill_d8_t2"}) {
    SCOPED_TRACE(name);
    const Shipped& tool = shipped(name);
    ASSERT_EQ(tool.view.edges.size(), tool.job->tooth_angles.size());
    for (std::size_t k = 0; k < tool.view.edges.size(); ++k) {
      const double begin = tool.onTooth(k, tool.view.edges[k].line.front()).x();
      EXPECT_EQ(tool.view.edges[k].tooth, k);
      if (tool.job->isShort(static_cast<int>(k))) {
        EXPECT_GT(begin, kFrom);
      } else if (tool.cutter.end_center_teeth > 1) {
        EXPECT_NEAR(begin, kEndGap, kExact);
      } else {
        EXPECT_LT(begin, 0);
      }
    }
  }
}

/// How far behind the radius a line is at a distance along it.
double behindAt(const Shipped& tool, const EndEdge& edge, double along) {
  std::size_t i = 1;
  while (i + 1 < edge.line.size() && tool.onTooth(edge.tooth, edge.line[i]).x() < along) ++i;
  const Vector2d from = tool.onTooth(edge.tooth, edge.line[i - 1]), to = tool.onTooth(edge.tooth, edge.line[i]);
  return from.y() + (along - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
}

/// Also where a flute's hook forms them.
TEST(EndView, EdgesAreWhereRaysFindThem) {
  for (const char* name : kTools) {
    SCOPED_TRACE(name);
    const Shipped& tool = shipped(name);
    const CutterGeometry& c = tool.cutter;
    EndCuts end = endCutsOf(tool.job, plannedStrokes(tool.job));
    std::vector<double> angles = tool.job->tooth_angles;
    for (std::size_t i = 0; i < angles.size(); ++i) angles[i] += tool.job.edges()[i].at_end;
    const GroundEnd rays(c.end_diameter / 2, c.cut, angles, std::move(end.cuts), end.blank_x,
                         EndFlutes(groundCutterOf(tool.job.flutes())));
    const double outer = c.end_diameter / 2 - c.chamfer_width - 0.1 * kMillimetre;
    for (const EndEdge& edge : tool.view.edges) {
      for (double r = kFrom; r < outer; r += 0.1 * kMillimetre) {
        const EndSection section = rays.section(edge.tooth, r);
        ASSERT_TRUE(section.edge) << r;
        EXPECT_NEAR(behindAt(tool, edge, r), section.behind, kExact) << r;
      }
    }
  }
}

TEST(EndView, PrimaryFlanksAreAsWideAsTheLand) {
  for (const char* name : kTools) {
    SCOPED_TRACE(name);
    const Shipped& tool = shipped(name);
    for (std::uint16_t tooth = 0; tooth < tool.job->tooth_angles.size(); ++tooth) {
      EndPolyline strip;
      double widest = 0;
      const EndRegion& flank = tool.region(SurfaceKind::kEndPrimary, tooth);
      ASSERT_EQ(flank.outlines.size(), 1u);
      for (const Vector2d& point : flank.outlines.front()) {
        const Vector2d at = tool.onTooth(tooth, point);
        widest = std::max(widest, at.y());
        strip.emplace_back(std::clamp(at.x(), kFrom, kTo), at.y());
      }
      EXPECT_NEAR(widest, tool.cutter.end_land, kExact);
      // What is beyond the strip's ends is flattened onto them and has no area.
      EXPECT_NEAR(std::abs(areaOf(strip)), tool.cutter.end_land * (kTo - kFrom), kExact * (kTo - kFrom));
    }
  }
}

/// Within the core every place of the end is one face, before the flanks and after them.
TEST(EndView, FacesCoverTheCoreOnce) {
  const std::pair<const char*, const char*> ends[]{
      {kTools[0], "gash"}, {kTools[1], "end_primary"}, {kTools[0], "chamfer"}, {kTools[1], "chamfer"}};
  for (const auto& [name, operation] : ends) {
    SCOPED_TRACE(testing::Message() << name << ' ' << operation);
    std::map<SurfaceKind, int> found;
    for (int i = 0; i < 200; ++i) {
      const double r = kTo * std::sqrt((i + 0.5) / 200), angle = 2.399963 * i;
      int turns = 0;
      for (const EndRegion& region : shipped(name, operation).view.regions) {
        const int about = turnsAbout(region, {r * std::cos(angle), r * std::sin(angle)});
        turns += std::abs(about);
        if (about != 0) ++found[region.kind];
      }
      EXPECT_EQ(turns, 1) << r << ' ' << angle;
    }
    EXPECT_GT(found[SurfaceKind::kGash], 0);
    EXPECT_EQ(found[SurfaceKind::kEndFace] > 0, std::string(operation) == "gash");
  }
}

TEST(EndView, OfAToolWithoutAGroundEndIsEmpty) {
  const Shipped& tool = shipped("end_mill_d10_t4", "flute");
  EXPECT_TRUE(tool.view.regions.empty() && tool.view.edges.empty());
}

}  // namespace test_end_view
}  // namespace grinder
