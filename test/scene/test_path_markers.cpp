#include "flute_grinder/scene/path_markers.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/job_plan.h"

#include "motion/generators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace flute_grinder {
namespace test_path_markers {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

GrindProgram program() {
  const auto machine = test_support::plainMachine();
  return GrindProgram(readJobFile("test/jobs/paper.yaml"), machine, machine.park);
}

/// What a drive must never say, and may all the same.
std::vector<double> hostileValues() {
  using Limits = std::numeric_limits<double>;
  return {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::lowest(), 1e30, -1e30};
}

void expectFinite(const MarkerArray& array) {
  for (const Marker& m : array.markers) {
    for (const geometry_msgs::Point& p : m.points) {
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << m.ns;
    }
    for (const std_msgs::ColorRGBA& c : m.colors) ASSERT_TRUE(c.r >= 0 && c.r <= 1 && c.g >= 0 && c.b >= 0) << m.ns;
  }
}

/// The largest error measured and all markers of the paper's job, with every so-many-th position of an axis replaced.
struct Shown {
  double largest = 0;
  MarkerArray flutes, executed;
};

Shown show(int every, int axis, double value) {
  const GrindProgram job = program();
  ToolPath flutes(job);
  ExecutedPath executed(job);
  SetpointStream stream(job);
  Shown result;
  for (Setpoint p; stream.next(p);) {
    Axes actual = p.position;
    actual[kA] += 1e-6;
    if (every > 0 && p.cycle % static_cast<unsigned>(every) == 0) actual[axis] = value;
    flutes.add(p, actual);
    executed.add(p, actual);
  }
  result.largest = flutes.largestMeasured();
  result.flutes = flutes.markers();
  executed.append(result.executed);
  return result;
}

TEST(PathMarkers, LeaveOutPositionsThatAreNone) {
  const Shown clean = show(0, kX, 0);
  ASSERT_GT(clean.largest, 0);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()}) {
      SCOPED_TRACE(::testing::Message() << kJointNames[static_cast<std::size_t>(axis)] << " " << value);
      const Shown spoiled = show(7, axis, value);
      EXPECT_GT(spoiled.largest, 0.9 * clean.largest);
      EXPECT_LE(spoiled.largest, clean.largest);
      expectFinite(spoiled.flutes);
      expectFinite(spoiled.executed);
      EXPECT_EQ(spoiled.flutes.markers.size(), clean.flutes.markers.size());
    }
  }
}

TEST(PathMarkers, StayFiniteWhateverTheDriveSays) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const double value : hostileValues()) {
      SCOPED_TRACE(::testing::Message() << kJointNames[static_cast<std::size_t>(axis)] << " " << value);
      for (const int every : {1, 7}) {
        const Shown spoiled = show(every, axis, value);
        EXPECT_TRUE(std::isfinite(spoiled.largest));
        expectFinite(spoiled.flutes);
        expectFinite(spoiled.executed);
      }
    }
  }
}

TEST(PathMarkers, OfErrorsLeaveOutSetpointsThatAreNone) {
  for (const double value : hostileValues()) {
    SCOPED_TRACE(value);
    const GrindProgram job = program();
    PathErrorMarkers errors(job.job());
    SetpointStream stream(job);
    for (Setpoint p; stream.next(p);) {
      if (p.cycle % 7 == 0) p.path_error = value;
      if (p.cycle % 11 == 0) p.position[kX] = value;
      errors.add(p);
    }
    expectFinite(errors.markers());
  }
}

/// All of a line's scale that rviz knows.
void expectLinesOfAWidth(const MarkerArray& array) {
  std::size_t lines = 0;
  for (const Marker& m : array.markers) {
    if (m.type != Marker::LINE_STRIP && m.type != Marker::LINE_LIST) continue;
    ++lines;
    EXPECT_GT(m.scale.x, 0) << m.ns;
    EXPECT_EQ(m.scale.y, 0) << m.ns;
    EXPECT_EQ(m.scale.z, 0) << m.ns;
  }
  EXPECT_GT(lines, 0u);
}

TEST(PathMarkers, AreLinesOfAWidth) {
  const Shown shown = show(0, kX, 0);
  expectLinesOfAWidth(shown.flutes);
  expectLinesOfAWidth(shown.executed);
  const GrindProgram job = program();
  PathErrorMarkers errors(job.job());
  SetpointStream stream(job);
  for (Setpoint p; stream.next(p);) errors.add(p);
  expectLinesOfAWidth(errors.markers());
}

// With a lead, A at X of the wheel's centre is that of the edge at X - lead.
TEST(PathMarkers, AreAtTheEdgeThatIsFormed) {
  GrindJob job = readJobFile("jobs/paper.yaml");
  job.cutter.cone_angle = 9.6 * units::kDegree;
  const double b = 2 * std::tan(job.cutter.cone_angle) / job.cutter.end_diameter;
  const double turn = std::tan(job.cutter.spiral_angle) / std::tan(job.cutter.cone_angle);
  const double normal = std::cos(std::atan(std::tan(job.cutter.spiral_angle) * std::cos(job.cutter.cone_angle)));
  for (const double lead : {0.0, -15e-3, 11.847e-3}) {
    SCOPED_TRACE(lead);
    job.process.setup_lead = lead;
    const GrindProgram of_lead(job, test_support::plainMachine(), test_support::plainMachine().park);
    const auto expect_at_edge = [&](const geometry_msgs::Point& p, double delta) {
      const double r = job.cutter.end_diameter / 2 + p.x * std::tan(job.cutter.cone_angle);
      const double a = turn * std::log1p(b * p.x);
      EXPECT_NEAR(std::hypot(p.y - r * std::cos(a), p.z - r * std::sin(a)), 0, delta);
    };
    ToolPath flutes(of_lead);
    const MarkerArray edges = flutes.markers();
    ASSERT_GT(edges.markers.size(), 1u);
    const std::vector<geometry_msgs::Point>& edge = edges.markers[1].points;
    // What would be formed beyond the cutter, by as much as the lead, is not shown.
    EXPECT_NEAR(edge.front().x, of_lead.strokeFrom() + std::max(0.0, -lead), 1e-3);
    EXPECT_NEAR(edge.back().x, of_lead.strokeTo() - std::max(0.0, lead), 1e-3);
    for (const geometry_msgs::Point& p : edge) expect_at_edge(p, 1e-12);

    PathErrorMarkers errors(job);
    SetpointStream stream(of_lead);
    double largest = 0;
    for (Setpoint p; stream.next(p) && p.pass == 0 && p.tooth == 0;) {
      errors.add(p);
      Axes off = p.position;
      off[kA] += 1e-5;
      flutes.add(p, off);
      if (p.step == StepKind::kNone) continue;
      const double x = p.position[kX] - lead;
      const double error = std::abs(turn * std::log1p(b * x) - off[kA]);
      largest = std::max(largest, error * (job.cutter.end_diameter / 2 + x * std::tan(job.cutter.cone_angle)) * normal);
    }
    EXPECT_NEAR(flutes.largestMeasured(), largest, 1e-15);
    const MarkerArray arrows = errors.markers();
    ASSERT_EQ(arrows.markers.size(), 2u);
    const std::vector<geometry_msgs::Point>& ends = arrows.markers[1].points;
    ASSERT_GT(ends.size(), 100u);
    for (std::size_t i = 0; i < ends.size(); i += 2) expect_at_edge(ends[i], 1e-6);
  }
}

TEST(PathMarkers, OfTheLongestFlutesStaySmall) {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  job.cutter = {0.1e-3, 0, 1, 0, 500e-3};
  job.process.depth = job.process.infeed = 0.01e-3;
  const MarkerArray array =
      ToolPath(GrindProgram(job, test_support::plainMachine(), test_support::plainMachine().park)).markers();
  std::size_t points = 0;
  for (const Marker& m : array.markers) points += m.points.size();
  EXPECT_GT(points, 1000u);
  EXPECT_LT(points, 5000u);
}

}  // namespace test_path_markers
}  // namespace flute_grinder
