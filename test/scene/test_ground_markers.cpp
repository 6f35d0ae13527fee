// The ground cutter in rviz: what is shown of it, how far it is ground, its colours and its size.

#include "flute_grinder/scene/ground_markers.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"
#include "jobs.h"
#include "scene/end_job.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <map>

namespace grinder {
namespace test_ground_markers {

using test_support::endJob;
using test_support::jobOf;
using test_support::lightEndJob;
using test_support::paper;
using units::kDegree;
using units::kMillimetre;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::uint32_t kMaxBytes = 3000000;

std::vector<Marker> solidOf(const MarkerArray& array, const std::string& ns) {
  std::vector<Marker> found;
  for (const Marker& m : array.markers) {
    if (m.ns == ns) found.push_back(m);
  }
  return found;
}

std::string textsOf(const MarkerArray& array) {
  std::string all;
  for (const Marker& m : array.markers) all += m.text + "\n";
  return all;
}

MarkerArray plannedMarkers(const GrindJob& asked) {
  const ValidJob job = withLaws(ValidJob(asked));
  return groundMarkers(groundCutterOf(job), job, "planned");
}

MarkerArray markersSoFar(const ValidJob& job, const Reached& reached) {
  return groundMarkers(groundSoFar(job, reached), job, "ground", reached);
}

/// Whether these are faces of the cut, pale yellow.
bool isCut(const Marker& m) { return m.color.r > 0.9 && m.color.g > 0.85 && m.color.b > 0.6; }

void expectFit(const GrindJob& job) {
  const MarkerArray array = plannedMarkers(job);
  EXPECT_LT(ros::serialization::serializationLength(array), kMaxBytes);
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  EXPECT_EQ(textsOf(array).find_first_not_of('\n'), std::string::npos) << textsOf(array);
  std::size_t triangles = 0;
  for (const Marker& m : array.markers) triangles += m.points.size() / 3;
  // Guards against a change: no closed form gives the number that is fine enough, and that each frame has time for.
  EXPECT_GT(triangles, 13000u);
  EXPECT_LT(triangles, 21000u);
  for (const std::string ns : {"planned", kCutOut}) {
    const std::vector<Marker> solid = solidOf(array, ns);
    EXPECT_GT(solid.size(), 3u) << textsOf(array);
    for (const Marker& m : solid) {
      EXPECT_EQ(m.header.frame_id, "cutter");
      EXPECT_TRUE(m.frame_locked) << "turns with A between messages";
      EXPECT_TRUE(m.pose.orientation.w == 1 && m.scale.x == 1 && m.scale.y == 1 && m.scale.z == 1) << "as rviz asks";
      EXPECT_LE(m.points.size(), 16384u);
      EXPECT_EQ(m.points.size() % 3, 0u);
      EXPECT_EQ(m.colors.size(), isCut(m) ? 0 : m.points.size());
      for (const std_msgs::ColorRGBA& c : m.colors) {
        // A shade of its colour.
        ASSERT_NEAR(c.r * m.color.g, c.g * m.color.r, 1e-5);
        ASSERT_NEAR(c.g * m.color.b, c.b * m.color.g, 1e-5);
        ASSERT_GT(c.g, 0.3 * m.color.g);
      }
    }
  }
}

TEST(GroundMarkers, OfManyTeethAndOfASteepSpiralFitAMessage) {
  for (const char* heavy : {"left_hand_d8_t3", "paper"}) expectFit(jobOf(heavy));
  GrindJob many = jobOf("finishing_d20_t8");
  many.tooth_angles.clear();
  for (int i = 0; i < kMaxTeeth; ++i) many.tooth_angles.push_back(2 * units::kPi * i / kMaxTeeth);
  expectFit(many);
  GrindJob steep = jobOf("roughing_d10_t4");
  steep.cutter.spiral_angle = 60 * kDegree;
  steep.cutter.flute_length = 100 * kMillimetre;
  expectFit(steep);
}

TEST(GroundMarkers, AfterTheLastStrokeTheCutterIsThePlannedOne) {
  GrindJob even = paper();
  even.process().z_law = ZLaw::kConstantRake;
  for (const GrindJob& asked : {jobOf("left_hand_d8_t3"), jobOf("unequal_d12_t4"), even}) {
    const ValidJob job = withLaws(ValidJob(asked));
    SCOPED_TRACE(toolText(job->cutter, job->tooth_angles.size()) + " " + toString(job->process().z_law));
    const GroundCutter planned = groundCutterOf(job),
                       done = groundSoFar(job, {job.passes().back().place, PassPhase::kAfter, 0});
    for (const double part : {0.1, 0.5, 0.9}) {
      const GroundSection a = planned.section(part * job->cutter.flute_length);
      const GroundSection b = done.section(part * job->cutter.flute_length);
      EXPECT_NEAR(a.core_radius, b.core_radius, 1e-7);
      for (std::size_t i = 0; i < a.teeth.size(); ++i) {
        ASSERT_EQ(a.teeth[i].rake.has_value(), b.teeth[i].rake.has_value());
        EXPECT_NEAR(a.teeth[i].rake.value_or(0), b.teeth[i].rake.value_or(0), 5e-3 * kDegree);  // with other wear
      }
    }
  }
}

TEST(GroundMarkers, InAStrokeTheCutterIsGroundToWhereTheWheelIs) {
  GrindJob job = jobOf("roughing_d10_t4");
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    job.process().direction = direction;
    const double length = job.cutter.flute_length, reached = length / 2;
    // The second tooth in its last pass; the first is done.
    const ToothPass pass{1, static_cast<int>(passDepths(job.process()).size()) - 1};
    const GroundCutter cutter = groundSoFar(ValidJob(job), {pass, PassPhase::kStroke, reached});
    const GroundCutter planned = groundCutterOf(ValidJob(job));
    const bool from_end = direction == StrokeDirection::kFromEnd;
    const double ground_at = from_end ? 0.0 : length, whole_at = from_end ? length : 0.0;
    const double finished = planned.section(ground_at).teeth[1].depth;
    EXPECT_NEAR(cutter.section(ground_at).teeth[1].depth, finished, 1e-6);
    EXPECT_NEAR(cutter.section(whole_at).teeth[0].depth, planned.section(whole_at).teeth[0].depth, 1e-6);
    // Up to the pass before.
    EXPECT_LT(cutter.section(whole_at).teeth[1].depth, finished + 1e-9);
    EXPECT_EQ(cutter.section(ground_at).teeth[2].depth, 0);
    EXPECT_EQ(cutter.section(ground_at).teeth[3].depth, 0);
    const GroundCutter first = groundSoFar(ValidJob(job), {{1, 0}, PassPhase::kStroke, reached});
    EXPECT_GT(first.section(ground_at).teeth[1].depth, 0.9 * job.process().infeed);
    EXPECT_EQ(first.section(whole_at).teeth[1].depth, 0);
  }
}

// Back along the stroke nothing is ground, and a lift belongs to no pass.
TEST(GroundMarkers, WhatIsReachedFollowsTheJob) {
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    Reached reached;
    const double way = direction == StrokeDirection::kFromEnd ? 1 : -1;
    const auto after = [&](MoveKind move, double commanded, double actual) {
      Setpoint p;
      p.tooth = 1;
      p.pass = 2;
      p.move = move;
      p.position[kX] = commanded;
      reached.add(p, Axes::Constant(actual), direction);
      return reached;
    };
    EXPECT_EQ(after(MoveKind::kLift, 0.1, 0.1), Reached{});
    EXPECT_EQ(after(MoveKind::kInfeed, 0.1, 0.1), (Reached{{1, 2}, PassPhase::kBefore, 0}));
    const auto in_stroke = [&](double x) { return Reached{{1, 2}, PassPhase::kStroke, x}; };
    EXPECT_EQ(after(MoveKind::kStroke, 0.1, std::nan("")), in_stroke(0.1));
    EXPECT_EQ(after(MoveKind::kStroke, 0.1 + way * 0.03, 0.1 + way * 0.02), in_stroke(0.1 + way * 0.02));
    EXPECT_EQ(after(MoveKind::kStroke, 0.1, 0.1), in_stroke(0.1 + way * 0.02));
    EXPECT_EQ(after(MoveKind::kLift, 0.1, 0.5), in_stroke(0.1 + way * 0.02));
    EXPECT_EQ(after(MoveKind::kRetract, 0.1, 0.1), (Reached{{1, 2}, PassPhase::kAfter, 0}));
  }
}

/// The part of the tolerance that a rake face's colour stands for, beyond 1 if it is out; nothing for the colours of
/// other surfaces.
std::optional<double> deviationOf(const Marker& m) {
  for (int level = 0; level <= 16; ++level) {
    const std_msgs::ColorRGBA c = errorColour((level + 0.5) / 16);
    if (m.color.r == c.r && m.color.g == c.g && m.color.b == c.b) return (level + 0.5) / 16;
  }
  return std::nullopt;
}

TEST(GroundMarkers, ColourTheRakeFacesByTheirDeviationWithinTheTolerance) {
  GrindJob job = jobOf("roughing_d10_t4");
  const double ground = *groundCutterOf(ValidJob(job)).section(job.cutter.flute_length / 2).teeth[0].rake;
  for (const auto& [deviation, expected] : {std::pair{-0.25, 0.5}, {0.45, 0.9}, {3.0, 1.0}}) {
    SCOPED_TRACE(deviation);
    job.cutter.rake_angle = ground - deviation * kDegree;
    job.cutter.rake_tolerance = 0.5 * kDegree;
    const MarkerArray array = plannedMarkers(job);
    std::size_t coloured = 0;
    for (const Marker& m : solidOf(array, "planned")) {
      const auto level = deviationOf(m);
      if (!level) continue;
      coloured += m.points.size();
      EXPECT_NEAR(*level, expected, 0.1);
    }
    EXPECT_GT(coloured, 300u);
  }
}

TEST(GroundMarkers, ColourTheRakeFacesOnlyWhereTheLastPassHasBeen) {
  GrindJob asked = jobOf("roughing_d10_t4");
  const int last = static_cast<int>(passDepths(asked.process()).size()) - 1;
  ASSERT_GT(last, 0);
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    asked.process().direction = direction;
    const ValidJob job(asked);
    const double half = job->cutter.flute_length / 2;
    // X between which points are coloured; none if the first is larger.
    const auto coloured = [&](const Reached& reached) {
      std::pair<double, double> x{1, -1};
      for (const Marker& m : solidOf(markersSoFar(job, reached), "ground")) {
        if (!deviationOf(m)) continue;
        for (const geometry_msgs::Point& p : m.points) x = {std::min(x.first, p.x), std::max(x.second, p.x)};
      }
      return x;
    };
    const auto roughed = coloured({{1, last - 1}, PassPhase::kAfter, 0});
    const auto begun = coloured({{0, last}, PassPhase::kBefore, 0});
    EXPECT_GT(begun.first, begun.second) << "a flute that is only roughed has the rake of no tool";
    EXPECT_GT(solidOf(markersSoFar(job, {{1, 0}, PassPhase::kBefore, 0}), "ground").size(), 3u) << "but it is shown";
    if (job.passes()[1].place.tooth == 1) {
      EXPECT_GT(roughed.first, roughed.second);
    }
    const auto in_stroke = coloured({{0, last}, PassPhase::kStroke, half});
    ASSERT_LT(in_stroke.first, in_stroke.second);
    const double facet = 2 * kMillimetre;
    if (direction == StrokeDirection::kFromEnd) {
      EXPECT_LT(in_stroke.second, half + facet);
    } else {
      EXPECT_GT(in_stroke.first, half - facet);
    }
    const auto done = coloured({job.passes().back().place, PassPhase::kAfter, 0});
    EXPECT_LT(done.first, facet);
    EXPECT_GT(done.second, job->cutter.flute_length - facet);
  }
}

// On a cone it changes along the flute; where the stroke ends too early, the flute is not whole and has no rake.
TEST(GroundMarkers, ColourTheRakeFacesByTheRakeThatIsThere) {
  GrindJob job = paper();
  job.process().overtravel_shank = 0;
  const GroundCutter cutter = groundCutterOf(ValidJob(job));
  const double length = job.cutter.flute_length, place = length / 12;
  const auto rake_at = [&](double x) { return cutter.section(x).teeth[0].rake.value_or(0); };
  const double to = cutter.completeRange(0, length)->to, begin = rake_at(0);
  ASSERT_GT(to, length / 2);
  ASSERT_LT(to, length - place);
  job.cutter.rake_angle = begin;
  job.cutter.rake_tolerance = 1.25 * std::abs(rake_at(to) - begin);
  double last = 0;
  for (const Marker& m : solidOf(groundMarkers(cutter, ValidJob(job), "planned"), "planned")) {
    const auto level = deviationOf(m);
    for (std::size_t i = 0; level && i < m.points.size(); i += 7) {
      const double x = m.points[i].x;
      EXPECT_NEAR(*level, std::abs(rake_at(x) - begin) / job.cutter.rake_tolerance, 0.15) << x;
      last = std::max(last, x);
    }
  }
  EXPECT_NEAR(last, to, place);
}

/// One operation of a taper reamer of 6 mm and 2 deg, with six teeth and a clearance of 10 deg.
GrindJob reamer(const char* operation) { return readJobFile("jobs/taper_reamer_d6_t6.yaml", operation); }

/// The corners of the triangles whose colour stands for a part of the tolerance, by threes.
std::vector<geometry_msgs::Point> colouredAs(const MarkerArray& array, double expected) {
  std::vector<geometry_msgs::Point> found;
  for (const Marker& m : array.markers) {
    const auto level = deviationOf(m);
    if (level && std::abs(*level - expected) < 0.1) found.insert(found.end(), m.points.begin(), m.points.end());
  }
  return found;
}

double areaOf(const std::vector<geometry_msgs::Point>& corners) {
  double area = 0;
  const auto at = [&](std::size_t i) { return Eigen::Vector3d(corners[i].x, corners[i].y, corners[i].z); };
  for (std::size_t i = 0; i < corners.size(); i += 3) area += (at(i + 1) - at(i)).cross(at(i + 2) - at(i)).norm() / 2;
  return area;
}

TEST(GroundMarkers, ColourThePrimaryReliefsByTheirDeviationWithinTheTolerance) {
  const GroundCutter cutter = groundCutterOf(withLaws(ValidJob(reamer("secondary"))));
  const double length = 16 * kMillimetre;
  // As wide as asked at the small end, and wider with the diameter, of six edges.
  const double width = (0.3 + 0.353) / 2 * kMillimetre;
  const double area = 6 * width * length / std::cos(12 * kDegree);
  GrindJob asked = reamer("secondary");
  asked.cutter.clearance = 10.25 * kDegree;
  asked.cutter.rake_tolerance = 90 * kDegree;
  const auto coloured = colouredAs(groundMarkers(cutter, withLaws(ValidJob(asked)), "planned"), 0.5);
  EXPECT_NEAR(areaOf(coloured), area, 0.1 * area);
  for (const geometry_msgs::Point& p : coloured) {
    const double below = 3 * kMillimetre + p.x * std::tan(2 * kDegree) - std::hypot(p.y, p.z);
    EXPECT_GE(below, -1e-9);
    EXPECT_LE(below, 0.353 * kMillimetre * std::tan(10 * kDegree) + 2e-6);
  }
}

TEST(GroundMarkers, ColourAReliefOnlyWhereItsLastPassHasBeenAndTheRakeFacesFromTheBegin) {
  GrindJob job = reamer("primary");
  job.cutter.rake_tolerance = job.cutter.clearance_tolerance = 45 * kDegree;
  const ValidJob primary = withLaws(ValidJob(job));
  const int last = primary.passes().back().place.pass;
  const auto coloured = [&](const Reached& reached) {
    const MarkerArray array = markersSoFar(primary, reached);
    EXPECT_GT(solidOf(array, "ground").size(), 3u) << "the flutes are there from the begin";
    return areaOf(colouredAs(array, 0));
  };
  const double begun = coloured({{0, 0}, PassPhase::kBefore, 0});
  const double half = coloured({{5, last}, PassPhase::kStroke, 8 * kMillimetre}) - begun;
  const double done = coloured({{5, last}, PassPhase::kAfter, 0}) - begun;
  EXPECT_GT(begun, 6 * 16 * kMillimetre * 0.5 * kMillimetre);
  EXPECT_GT(half, 0.6 * done);
  EXPECT_LT(half, done);
  // Without the secondary one it reaches far beyond the land.
  EXPECT_GT(done, 6 * 16 * kMillimetre * 0.353 * kMillimetre);
}

TEST(GroundMarkers, AreWholeAndCutOpenWithoutAWedge) {
  const MarkerArray array = plannedMarkers(jobOf("roughing_d10_t4"));
  const auto angles = [&](const std::string& ns, bool faces_of_cut) {
    std::set<long> found;
    for (const Marker& m : solidOf(array, ns)) {
      if (isCut(m) != faces_of_cut) continue;
      for (const geometry_msgs::Point& p : m.points) {
        if (std::hypot(p.y, p.z) > kMillimetre) found.insert(std::lround(std::atan2(p.z, p.y) / kDegree));
      }
    }
    return found;
  };
  const std::set<long> wedge = angles(kCutOut, false), rest = angles("planned", false);
  EXPECT_EQ(*wedge.begin(), 35);
  EXPECT_EQ(*wedge.rbegin(), 120);
  EXPECT_TRUE(angles(kCutOut, true).empty());
  EXPECT_EQ(angles("planned", true), (std::set<long>{35, 120}));
  // The shank, which nothing touches, is not cut.
  EXPECT_GT(rest.size(), 300U);
}

/// The maximum radius of all points between two X [m]; 0 if there are none.
double maxRadius(const std::vector<Marker>& solid, double from, double to) {
  double max = 0;
  for (const Marker& m : solid) {
    for (const geometry_msgs::Point& p : m.points) {
      if (from < p.x && p.x < to) max = std::max(max, std::hypot(p.y, p.z));
    }
  }
  return max;
}

TEST(GroundMarkers, ABlankIsRoundBeforeTheFirstStroke) {
  for (const char* name : {"paper", "roughing_d10_t4", "micro_d05_t2"}) {
    const ValidJob job = withLaws(ValidJob(jobOf(name)));
    const Reached reached{job.passes().front().place, PassPhase::kBefore, 0};
    const std::vector<Marker> solid = solidOf(markersSoFar(job, reached), "ground");
    ASSERT_EQ(solid.size(), 1U);
    const Marker& m = solid[0];
    EXPECT_NEAR(maxRadius(solid, -1e-9, 1e-9), job->cutter.end_diameter / 2, 1e-12);
    EXPECT_NEAR(maxRadius(solid, 60 * kMillimetre, 1), job->cutter.shank_diameter / 2, 1e-12);
    EXPECT_EQ(maxRadius(solid, 66.001 * kMillimetre, 1), 0) << "in the collet";
    // Edges across the facets: a circle of so many corners that none shows.
    std::set<long> angles;
    for (const geometry_msgs::Point& p : m.points) {
      if (std::hypot(p.y, p.z) > 0) angles.insert(std::lround(std::atan2(p.z, p.y) / kDegree));
    }
    EXPECT_GE(angles.size(), 180U);
  }
}

TEST(GroundMarkers, AMicroToolHasItsNeckAndItsShank) {
  GrindJob job = jobOf("micro_d05_t2");
  job.cutter.end_diameter = 0.2 * kMillimetre;
  job.cutter.core_diameter = job.cutter.core_diameter_end = 0.12 * kMillimetre;
  job.process().depth = 0.04 * kMillimetre;
  job.process().depth_end = job.process().setup_x_shift = 0;
  for (const auto& [shank, neck] : {std::pair(3.0, 4.0), {6.0, 13.0}}) {
    SCOPED_TRACE(neck);
    job.cutter.shank_diameter = shank * kMillimetre;
    job.cutter.neck_length = neck * kMillimetre;
    const ValidJob valid = withLaws(ValidJob(job));
    for (const GroundCutter& cutter :
         {groundCutterOf(valid), groundSoFar(valid, Reached{{0, 0}, PassPhase::kBefore, 0})}) {
      const std::vector<Marker> solid = solidOf(groundMarkers(cutter, valid, "ground"), "ground");
      const double begin = job.cutter.flute_length + job.cutter.neck_length, end = 66 * kMillimetre;
      EXPECT_NEAR(maxRadius(solid, begin - 1e-9, begin + 1e-9), shank / 2 * kMillimetre, 1e-9);
      EXPECT_NEAR(maxRadius(solid, end - 1e-9, end + 1e-9), shank / 2 * kMillimetre, 1e-9);
      EXPECT_EQ(maxRadius(solid, end + 1e-9, 1), 0);
      std::vector<geometry_msgs::Point> face;  // the small end's
      for (const Marker& m : groundMarkers(cutter, valid, "ground").markers) {
        for (std::size_t i = 0; i + 2 < m.points.size() && !isCut(m); i += 3) {
          if (m.points[i].x + m.points[i + 1].x + m.points[i + 2].x == 0)
            face.insert(face.end(), &m.points[i], &m.points[i] + 3);
        }
      }
      EXPECT_GT(areaOf(face), units::kPi / 4 * std::pow(job.cutter.core_diameter, 2));
      EXPECT_LT(areaOf(face), units::kPi / 4 * std::pow(job.cutter.end_diameter, 2));
      // On the cone all the way to the shank, flutes and neck.
      for (int i = 1; i <= 8; ++i) {
        const double x = begin * i / 8, cone = 0.1 * kMillimetre + x * std::tan(3 * kDegree);
        EXPECT_LE(maxRadius(solid, begin * (i - 1) / 8, x - 1e-9), cone);
      }
    }
  }
}

TEST(GroundMarkers, WithoutANeckTheShankBeginsWhereTheStrokeEnds) {
  GrindJob job = paper();
  job.cutter.shank_diameter = 20 * kMillimetre;
  const std::vector<Marker> solid = solidOf(plannedMarkers(job), "planned");
  const double stroke_end = 37 * kMillimetre;
  EXPECT_LT(maxRadius(solid, 0, stroke_end - 1e-9), 9 * kMillimetre);
  EXPECT_NEAR(maxRadius(solid, stroke_end - 1e-9, stroke_end + 1e-9), 10 * kMillimetre, 1e-9);
  EXPECT_NEAR(maxRadius(solid, 60 * kMillimetre, 1), 10 * kMillimetre, 1e-9);
}

/// The number of points of each colour of what is shown of the end mill.
std::map<std::array<float, 3>, std::size_t> pointsByColour(const MarkerArray& array) {
  std::map<std::array<float, 3>, std::size_t> points;
  for (const Marker& m : array.markers) points[{m.color.r, m.color.g, m.color.b}] += m.points.size();
  return points;
}

TEST(GroundMarkers, OfTheEndShowEachOfItsOperations) {
  std::size_t colours = 0;
  for (const OperationKind kind : {OperationKind::kGash, OperationKind::kPrimaryEnd, OperationKind::kChamfer}) {
    SCOPED_TRACE(rowOf(kind).words);
    const ValidJob job = lightEndJob(kind);
    const std::size_t shown = pointsByColour(groundMarkers(groundCutterOf(job), job, "planned")).size();
    EXPECT_TRUE(colours == 0 || shown == colours + 1);
    colours = shown;
  }
}

TEST(GroundMarkers, OfAWholeEndFitAMessage) {
  const ValidJob job = endJob("chamfer");
  EXPECT_LT(ros::serialization::serializationLength(groundMarkers(groundCutterOf(job), job, "planned")), kMaxBytes);
}

TEST(GroundMarkers, ShowTheStrokesOnTheEndThatHaveEnded) {
  const ValidJob job = lightEndJob(OperationKind::kGash);
  const auto shown = [&](const ToothPass& pass, PassPhase phase) {
    return pointsByColour(markersSoFar(job, {pass, phase, 0}));
  };
  const std::vector<JobPass>& passes = job.passes();
  // Halfway, one tooth is done: the job is ground tooth by tooth.
  const std::size_t half = passes.size() / 2;
  const auto before = shown(passes.front().place, PassPhase::kStroke),
             all = shown(passes.back().place, PassPhase::kAfter);
  const auto done = shown(passes[half - 1].place, PassPhase::kAfter);
  EXPECT_EQ(all.size(), before.size() + 1);
  EXPECT_NE(done, before);
  EXPECT_NE(done, all);
  EXPECT_EQ(shown(passes[half].place, PassPhase::kStroke), done);
  EXPECT_NE(shown(passes[half].place, PassPhase::kAfter), done);
  EXPECT_EQ(pointsByColour(groundMarkers(groundCutterOf(job), job, "planned")), all);
}

TEST(GroundMarkers, TellWhyACutterCannotBeShown) {
  GrindJob job = jobOf("roughing_d10_t4");
  job.process().depth = job.process().infeed = 0.49999 * job.cutter.end_diameter;
  job.process().setup_height = 0;
  const MarkerArray array = plannedMarkers(job);
  EXPECT_TRUE(solidOf(array, "planned").empty());
  EXPECT_NE(textsOf(array).find("core radius = "), std::string::npos) << textsOf(array);
  const Marker& label = array.markers.back();
  EXPECT_EQ(label.pose.position.x, job.cutter.flute_length / 2) << "where the cutter would be";
}

}  // namespace test_ground_markers
}  // namespace grinder
