#include "flute_grinder/scene/path_markers.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"

#include "motion/generators.h"
#include "scene/end_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace grinder {
namespace test_path_markers {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

GrindProgram programOf(const GrindJob& job, const Machine& machine = test_support::plainMachine()) {
  return GrindProgram(ValidJob(job), machine, machine.park);
}

std::vector<GroundEdge> edgesOf(const GrindProgram& program) { return checkGroundCutter(program.job()).edges; }

/// Under the wheel's centre, where the edge is the helix.
GroundEdge centralEdge(const GrindJob& job) {
  const double length = job.cutter.flute_length;
  return GroundEdge({{0, 0, 0}, {length, length, 0}});
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

double distance(const geometry_msgs::Point& a, const geometry_msgs::Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// The maximum error measured and all markers of the paper's job, with every so-many-th position of an axis replaced.
struct Shown {
  double max = 0;
  MarkerArray flutes, executed, errors;
};

Shown show(int every, int axis, double value) {
  const GrindProgram job = programOf(paper());
  const std::vector<GroundEdge> edges = edgesOf(job);
  ToolPath flutes(job, edges);
  ExecutedPath executed(job, edges);
  PathErrorMarkers errors(job.job(), edges);
  SetpointStream stream(job);
  Shown result;
  for (Setpoint p; stream.next(p);) {
    Axes actual = p.position;
    actual[kA] += 1e-6;
    if (every > 0 && p.cycle % static_cast<unsigned>(every) == 0) actual[axis] = value;
    flutes.add(p, actual);
    executed.add(p, actual);
    errors.add(p);
  }
  result.max = flutes.maxMeasured();
  result.flutes = flutes.markers();
  result.errors = errors.markers();
  executed.append(result.executed);
  return result;
}

/// What each flute looks like: planned (p), active (a) or measured (m).
std::string looksOf(const ToolPath& flutes) {
  std::string looks;
  for (const Marker& m : flutes.markers().markers) {
    if (m.action != Marker::ADD) continue;
    EXPECT_TRUE(m.colors.empty() || m.colors.size() == m.points.size());
    looks += !m.colors.empty() ? 'm' : m.color.r == 1 ? 'a' : 'p';
  }
  return looks;
}

TEST(PathMarkers, FlutesArePlannedActiveAndMeasured) {
  GrindJob job = paper();
  job.tooth_angles = {0, 2, 4};
  job.process().infeed = job.process().depth / 2;
  const GrindProgram of_job = programOf(job);
  ToolPath flutes(of_job, edgesOf(of_job));
  std::string done(job.tooth_angles.size(), 'p');
  EXPECT_EQ(looksOf(flutes), done);
  int changes = 0;
  SetpointStream stream(of_job);
  for (Setpoint p; stream.next(p);) {
    if (!flutes.add(p, p.position)) continue;
    ++changes;
    const bool ends = p.move == MoveKind::kStroke && p.move_fraction == 1;
    EXPECT_TRUE(ends || p.move == MoveKind::kIndex) << "while the wheel is on its way to it";
    if (ends) done[p.tooth] = 'm';
    std::string looks = done;
    if (!ends) looks[p.tooth] = 'a';
    EXPECT_EQ(looksOf(flutes), looks);
    ToolPath canceled = flutes;
    canceled.deactivate();
    EXPECT_EQ(looksOf(canceled), done);
  }
  EXPECT_EQ(changes, 2 * 2 * 3) << "begin and end of each pass";
  EXPECT_EQ(done, "mmm");
}

// The error grows along the flute from nothing to twice the tolerance.
TEST(PathMarkers, MeasuredFlutesHaveTheColoursOfTheirErrors) {
  const GrindProgram job = programOf(paper());
  const ConicalCutter& cutter = job.cutter();
  const double length = job.job()->cutter.flute_length, tolerance = job.job()->interpolation.tolerance;
  ToolPath flutes(job, {centralEdge(paper())});
  SetpointStream stream(job);
  for (Setpoint p; stream.next(p);) {
    Axes actual = p.position;
    const double x = actual[kX], error = 2 * tolerance * x / length;
    actual[kA] = job.helix(0).curve.a(x) + error / (cutter.radius(x) * cutter.cosHelixToGeneratrix());
    flutes.add(p, actual);
  }
  const Marker strip = flutes.markers().markers.at(1);
  ASSERT_EQ(strip.colors.size(), strip.points.size());
  double last = 0;
  for (std::size_t i = 0; i < strip.points.size(); ++i) {
    // Ever lighter, from blue through green to yellow at the tolerance, and red beyond it.
    const double fraction = 2 * strip.points[i].x / length;
    const std_msgs::ColorRGBA& c = strip.colors[i];
    const double light = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    if (fraction < 0.95) {
      EXPECT_GE(light, last - 0.01) << "read by those who are colour-blind";
      last = light;
    }
    if (fraction < 0.05) {
      EXPECT_GT(c.b, 1.7 * c.r);
    }
    if (std::abs(fraction - 0.5) < 0.05) {
      EXPECT_GT(c.g, 2 * c.r);
    }
    if (fraction > 1.05) {
      EXPECT_TRUE(c.r > 0.8 && c.g < 0.2 && c.b < 0.2) << fraction;
    }
  }
}

TEST(PathMarkers, AreLinesOfAWidthAndStayFiniteWhateverTheDriveSaysAndLeaveOutPositionsThatAreNone) {
  const Shown clean = show(0, kX, 0);
  ASSERT_GT(clean.max, 0);
  for (const MarkerArray& array : {clean.flutes, clean.executed, clean.errors}) {
    std::size_t lines = 0;
    for (const Marker& m : array.markers) {
      if (m.type != Marker::LINE_STRIP && m.type != Marker::LINE_LIST) continue;
      ++lines;
      EXPECT_TRUE(m.scale.x > 0 && m.scale.y == 0 && m.scale.z == 0) << m.ns;  // all that rviz knows
      EXPECT_LE(m.scale.x, 0.3e-3) << m.ns;
      EXPECT_EQ(m.pose.orientation.w, 1) << m.ns;
    }
    EXPECT_GT(lines, 0u);
  }
  for (int axis = 0; axis < kAxisCount; ++axis) {
    for (const double value : hostileValues()) {
      SCOPED_TRACE(::testing::Message() << kJointNames[static_cast<std::size_t>(axis)] << " " << value);
      for (const int every : {1, 7}) {
        const Shown spoiled = show(every, axis, value);
        EXPECT_TRUE(std::isfinite(spoiled.max));
        expectFinite(spoiled.flutes);
        expectFinite(spoiled.executed);
        if (every == 1 || std::isfinite(value)) continue;
        EXPECT_GT(spoiled.max, 0.9 * clean.max);
        EXPECT_LE(spoiled.max, clean.max);
        EXPECT_EQ(spoiled.flutes.markers.size(), clean.flutes.markers.size());
      }
    }
  }
}

TEST(PathMarkers, OfErrorsLeaveOutSetpointsThatAreNone) {
  for (const double value : hostileValues()) {
    SCOPED_TRACE(value);
    const GrindProgram job = programOf(paper());
    PathErrorMarkers errors(job.job(), edgesOf(job));
    SetpointStream stream(job);
    for (Setpoint p; stream.next(p);) {
      if (p.cycle % 7 == 0) p.path_error = value;
      if (p.cycle % 11 == 0) p.position[kX] = value;
      errors.add(p);
    }
    expectFinite(errors.markers());
  }
}

/// The edge of the first tooth at a section, by the groove's wall.
geometry_msgs::Point groundAt(const GroundCutter& cutter, double x) {
  const double r = cutter.cutter().radius(x), a = cutter.flutes()[0][0].wall(x, r, true)->angle;
  return point(x, r * std::cos(a), r * std::sin(a));
}

// The wheel's face is ever farther off the flank, up to twice the tolerance where the rim ends.
TEST(PathMarkers, OfStrokesOnTheEndAreTheirLinesWithTheColoursOfTheirErrors) {
  for (const char* operation : {"gash", "end_primary", "end_secondary", "chamfer"}) {
    SCOPED_TRACE(operation);
    const ValidJob job = test_support::endJob(operation);
    const Machine machine = test_support::roomyMachine();
    const GrindProgram of_job(job, machine, machine.park);
    const double tolerance = job->interpolation.tolerance;
    const Eigen::Vector3d spindle(-std::sin(of_job.swivel()), 0, std::cos(of_job.swivel()));
    std::vector<EndLine> lines;
    for (int tooth = 0; tooth < job.teeth(); ++tooth) lines.emplace_back(job, tooth, job.deepest(), 0);
    ToolPath flutes(of_job, {});
    EXPECT_EQ(looksOf(flutes), "pppp");
    ExecutedPath executed(of_job, {});
    SetpointStream stream(of_job);
    int active = 0;
    for (Setpoint p; stream.next(p);) {
      Axes actual = p.position;
      const auto place = lines[p.tooth].placeOf(p.position);
      if (place) actual.head<3>() += (std::clamp(place->part, 0.0, 1.0) * 2 * tolerance * spindle).array();
      flutes.add(p, actual);
      executed.add(p, actual);
      if (p.move == MoveKind::kStroke && p.pass == 0 && p.cycle % 100 == 0)
        active += flutes.markers().markers[1 + p.tooth].color.r == 1;
    }
    EXPECT_EQ(looksOf(flutes), "mmmm");
    EXPECT_GT(active, 4);
    EXPECT_NEAR(flutes.maxMeasured(), 2 * tolerance, 0.2 * tolerance);  // few cycles along the short chamfer
    const MarkerArray strips = flutes.markers();
    for (std::size_t tooth = 0; tooth < lines.size(); ++tooth) {
      const Marker& strip = strips.markers[1 + tooth];
      EXPECT_EQ(strip.header.frame_id, "cutter");
      const auto on_cutter = [&](double part) {
        const Eigen::Vector3d at = lines[tooth].at(part);
        const double r = std::hypot(at[1], at[2]), a = std::atan2(at[2], at[1]) + lines[tooth].a();
        return point(at[0], r * std::cos(a), r * std::sin(a));
      };
      EXPECT_LT(distance(strip.points.front(), on_cutter(0)), 1e-12);
      EXPECT_LT(distance(strip.points.back(), on_cutter(1)), 1e-12);
      EXPECT_GT(strip.colors.front().b, 1.5 * strip.colors.front().r) << "blue";
      EXPECT_GT(strip.colors.back().r, 5 * strip.colors.back().g) << "red";
    }
    MarkerArray path;
    executed.append(path);
    ASSERT_EQ(path.markers.size(), 1u);
    const std::vector<geometry_msgs::Point>& last = path.markers[0].points;
    EXPECT_GT(last.size(), 5u);
    EXPECT_LE(last.size(), 2001u);
    const std::vector<geometry_msgs::Point>& strip = strips.markers.back().points;
    const double length = distance(strip.front(), strip.back()), to_end = distance(last.back(), strip.back());
    EXPECT_LT(distance(last.front(), strip.front()), 0.2 * length);
    EXPECT_LT(to_end, 0.2 * length + 2 * tolerance);
    for (const geometry_msgs::Point& p : last) {
      const double off = distance(p, strip.front()) + distance(p, strip.back()) - length;
      EXPECT_LT(off, 0.01 * length) << "along the line";
    }
  }
}

// A cup along X grinds all of an edge at once: there is nothing to measure along it.
TEST(PathMarkers, OfAFlankByACupHaveNoErrors) {
  const ValidJob job = withLaws(ValidJob(readJobFile("jobs/left_hand_end_mill_d8_t3.yaml", "end_primary")));
  const Machine machine = test_support::roomyMachine();
  const GrindProgram of_job(job, machine, machine.park);
  ToolPath flutes(of_job, {});
  ExecutedPath executed(of_job, {});
  SetpointStream stream(of_job);
  for (Setpoint p; stream.next(p);) {
    flutes.add(p, p.position);
    executed.add(p, p.position);
  }
  EXPECT_EQ(looksOf(flutes), "ppp");
  EXPECT_EQ(flutes.maxMeasured(), 0);
  MarkerArray path;
  executed.append(path);
  EXPECT_TRUE(path.markers.empty());
}

// From one end of the cutter to the other, and nothing beyond.
TEST(PathMarkers, AreWhereTheEdgeIsGround) {
  constexpr double kLinear = 5e-6;  // between the sections of the edge that are known
  for (const char* name : {"jobs/paper.yaml", "test/jobs/paper.yaml", "jobs/taper_d6_t6.yaml"}) {
    SCOPED_TRACE(name);
    GrindJob job = readJobFile(name);
    job.process().wheel_wear = job.process().wheel_wear_per_pass = 0;
    const GrindProgram of_job = programOf(job, test_support::roomyMachine());
    const GroundCutter cutter = groundCutterOf(of_job.job());
    const std::vector<GroundEdge> edges = edgesOf(of_job);
    ToolPath flutes(of_job, edges);
    const MarkerArray strips = flutes.markers();
    ASSERT_EQ(strips.markers.size(), 1 + job.tooth_angles.size());
    const std::vector<geometry_msgs::Point>& edge = strips.markers[1].points;
    EXPECT_EQ(edge.front().x, 0);
    EXPECT_DOUBLE_EQ(edge.back().x, job.cutter.flute_length);
    for (std::size_t i = 0; i < edge.size(); i += 100)
      EXPECT_LT(distance(edge[i], groundAt(cutter, edge[i].x)), kLinear);

    ExecutedPath executed(of_job, edges);
    PathErrorMarkers errors(of_job.job(), edges);
    SetpointStream stream(of_job);
    double max = 0;
    const double normal = std::cos(std::atan(std::tan(job.cutter.spiral_angle) * std::cos(job.cutter.cone_angle)));
    for (Setpoint p; stream.next(p) && p.tooth == 0 && p.move != MoveKind::kRetract;) {
      errors.add(p);
      executed.add(p, p.position);
      Axes off = p.position;
      off[kA] += 1e-5;
      flutes.add(p, off);
      if (p.step == StepKind::kNone) continue;
      const double error = std::abs(of_job.helix(0).curve.a(p.position[kX]) - off[kA]);
      max = std::max(max, error * cutter.cutter().radius(p.position[kX] - job.process().setup_x_shift) * normal);
    }
    EXPECT_NEAR(flutes.maxMeasured(), max, 1e-15);
    const MarkerArray arrows = errors.markers();
    ASSERT_EQ(arrows.markers.size(), 2u);
    const std::vector<geometry_msgs::Point>& ends = arrows.markers[1].points;
    ASSERT_GT(ends.size(), 100u);
    for (std::size_t i = 0; i < ends.size(); i += 2) EXPECT_LT(distance(ends[i], groundAt(cutter, ends[i].x)), kLinear);

    MarkerArray path;
    executed.append(path);
    ASSERT_EQ(path.markers.size(), 1u);
    EXPECT_LE(path.markers[0].points.size(), 2001u) << "thinned out as it grows";
    const DepthLaw depth = of_job.job().depthLaw(0, of_job.job().depths()[0], 0);
    int on_cutter = 0;
    const std::vector<geometry_msgs::Point>& line = path.markers[0].points;
    double length = 0, longest = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      length += distance(line[i - 1], line[i]);
      longest = std::max(longest, distance(line[i - 1], line[i]));
    }
    EXPECT_LT(longest, 2 * length / static_cast<double>(line.size())) << "evenly";
    for (const geometry_msgs::Point& p : line) {
      if (p.x < 0 || p.x > job.cutter.flute_length) continue;
      ++on_cutter;
      const double below = depth.at_end - depth.taper * edges[0].at(p.x).wheel_x;
      const double to_surface = 1 + below / std::hypot(p.y, p.z);
      EXPECT_LT(distance(point(p.x, p.y * to_surface, p.z * to_surface), groundAt(cutter, p.x)), kLinear);
    }
    EXPECT_GT(on_cutter, 100);
  }
}

// A relief's stroke turns the edge away from the wheel's lowest point.
TEST(PathMarkers, OfAReliefAreOnTheEdgeAndMeasureNoErrorOfAPerfectDrive) {
  for (const char* operation : {"primary", "secondary"}) {
    SCOPED_TRACE(operation);
    const ValidJob job = withLaws(ValidJob(readJobFile("jobs/taper_reamer_d6_t6.yaml", operation)));
    const Machine machine = test_support::roomyMachine();
    const GrindProgram of_job(job, machine, machine.park);
    const GroundCutter cutter = groundCutterOf(job);
    ToolPath edges(of_job, edgesOf(of_job));
    SetpointStream stream(of_job);
    for (Setpoint p; stream.next(p);) edges.add(p, p.position);
    EXPECT_GT(edges.maxMeasured(), 0);
    EXPECT_LT(edges.maxMeasured(), job->interpolation.tolerance);
    const std::vector<geometry_msgs::Point> edge = edges.markers().markers.at(1).points;
    for (std::size_t i = 0; i < edge.size(); i += 100) EXPECT_LT(distance(edge[i], groundAt(cutter, edge[i].x)), 5e-6);
  }
}

TEST(PathMarkers, AreChordsCloseToTheHelix) {
  struct Shape {
    double cone, spiral;  // [deg]
  };
  for (const Shape& shape : {Shape{0, 45}, Shape{5, -60}, Shape{20, 8}}) {
    SCOPED_TRACE(shape.cone);
    GrindJob job = paper();
    job.cutter.end_diameter = 6e-3;
    job.cutter.core_diameter = job.cutter.core_diameter_end = 4e-3;
    job.cutter.cone_angle = shape.cone * units::kDegree;
    job.cutter.spiral_angle = shape.spiral * units::kDegree;
    job.cutter.flute_length = 30e-3;
    const GrindProgram of_job = programOf(job);
    const std::vector<geometry_msgs::Point> strip = ToolPath(of_job, {centralEdge(job)}).markers().markers.at(1).points;
    ASSERT_GT(strip.size(), 30u);
    for (std::size_t i = 1; i < strip.size(); ++i) {
      const geometry_msgs::Point &p = strip[i - 1], &q = strip[i];
      const double x = (p.x + q.x) / 2, r = of_job.cutter().radius(x), a = of_job.helix(0).curve.a(x);
      // As far as this from the point of the helix beside it, and so no farther from the helix.
      EXPECT_LT(std::hypot((p.y + q.y) / 2 - r * std::cos(a), (p.z + q.z) / 2 - r * std::sin(a)), 1e-7);
    }
  }
}

// Across the helix in the plane that touches the cone there, all by the same factor.
TEST(PathMarkers, OfErrorsAreArrowsAcrossTheHelix) {
  const GrindProgram job = programOf(paper());
  const ConicalCutter& cutter = job.cutter();
  PathErrorMarkers errors(job.job(), {centralEdge(paper())});  // the arrows begin on the commanded points
  std::map<double, Setpoint> commanded;
  SetpointStream stream(job);
  for (Setpoint p; stream.next(p) && p.move != MoveKind::kRetract;) {
    p.path_error *= 4000;  // up to beyond the tolerance
    errors.add(p);
    commanded[p.position[kX]] = p;
  }
  const double factor = errors.scale(), normal = cutter.cosHelixToGeneratrix();
  const Marker arrows = errors.markers().markers.at(1);
  const std::vector<geometry_msgs::Point>& ends = arrows.points;
  ASSERT_GE(ends.size(), 180u);
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    const Setpoint& p = commanded.lower_bound(ends[i].x - 1e-12)->second;
    EXPECT_EQ(p.step, i % 4 == 0 ? StepKind::kOdd : StepKind::kEven) << "as many of each";
    const double r = cutter.radius(ends[i].x), a = p.position[kA], deviation = -p.path_error * r * normal;
    EXPECT_LT(distance(ends[i], point(ends[i].x, r * std::cos(a), r * std::sin(a))), 1e-12);
    const Eigen::Vector3d arrow(ends[i + 1].x - ends[i].x, ends[i + 1].y - ends[i].y, ends[i + 1].z - ends[i].z);
    const double tan_cone = cutter.tanCone(), tan_spiral = cutter.tanSpiral(),
                 rounding = 1e-9 * std::abs(deviation * factor) + 1e-15;
    EXPECT_NEAR(arrow.norm(), std::abs(deviation * factor), rounding);
    EXPECT_NEAR(arrow.dot(Eigen::Vector3d(0, -std::sin(a), std::cos(a))), deviation * factor * normal, rounding);
    EXPECT_NEAR(arrow.dot(Eigen::Vector3d(-tan_cone, std::cos(a), std::sin(a))), 0, rounding);
    EXPECT_NEAR(arrow.dot(Eigen::Vector3d(1, tan_cone * std::cos(a) - tan_spiral * std::sin(a),
                                          tan_cone * std::sin(a) + tan_spiral * std::cos(a))),
                0, rounding);
    const std_msgs::ColorRGBA expected = errorColour(std::abs(deviation) / job.job()->interpolation.tolerance);
    EXPECT_NEAR(arrows.colors[i].r, expected.r, 1e-6);
    EXPECT_NEAR(arrows.colors[i].g, expected.g, 1e-6);
  }
}

// By a round number, up to 3 mm; below a thousandth of the tolerance there are only rounding errors.
TEST(PathMarkers, OfErrorsAreAsLongAsThereIsRoom) {
  const GrindProgram job = programOf(paper());
  const ConicalCutter& cutter = job.cutter();
  const double tolerance = job.job()->interpolation.tolerance;
  for (double error = 1e-6 * tolerance; error < 10 * tolerance; error *= 1.5) {
    SCOPED_TRACE(error);
    PathErrorMarkers errors(job.job(), {centralEdge(paper())});
    Setpoint p;
    p.position[kX] = 10e-3;
    p.path_error = error / (cutter.radius(10e-3) * cutter.cosHelixToGeneratrix());
    p.step = StepKind::kOdd;
    errors.add(p);
    const double scale = errors.scale(), longest = std::max(error, 1e-3 * tolerance) * scale;
    EXPECT_LE(longest, 3.001e-3);
    EXPECT_GT(longest, 3e-3 / 2.501);
    const double digit = scale / std::pow(10, std::floor(std::log10(scale * 1.000001)));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-5 || std::abs(digit - 2) < 1e-5 || std::abs(digit - 5) < 1e-5) << scale;
  }
}

TEST(PathMarkers, OfErrorsAndOfTheExecutedPathAreOfOneStroke) {
  GrindJob job = paper();
  job.tooth_angles = {0, units::kPi};
  const GrindProgram of_job = programOf(job);
  PathErrorMarkers errors(of_job.job(), {centralEdge(job), centralEdge(job)});
  ExecutedPath executed(of_job, {centralEdge(job), centralEdge(job)});
  SetpointStream stream(of_job);
  int second = 0;
  for (Setpoint p; second < 300 && stream.next(p);) {
    errors.add(p);
    executed.add(p, p.position);
    const bool is_on_edge = p.step != StepKind::kNone && p.position[kX] >= 0;
    if (p.tooth == 1 && is_on_edge) ++second;
  }
  ASSERT_EQ(second, 300);
  const Marker arrows = errors.markers().markers.at(1);
  MarkerArray path;
  executed.append(path);
  for (const Marker& m : {arrows, path.markers.at(0)}) {
    for (const geometry_msgs::Point& p : m.points) EXPECT_LT(p.y, 0) << m.ns << ": the second tooth's side";
  }
}

// On a cylinder X alone may be off.
TEST(PathMarkers, OfTheExecutedPathLeaveOutWhatIsFarAway) {
  GrindJob job = paper();
  job.cutter.cone_angle = 0;
  job.cutter.core_diameter_end = job.cutter.core_diameter;
  const GrindProgram of_job = programOf(job);
  for (const double value : {1e30, -1e30, 2.0}) {
    ExecutedPath executed(of_job, {centralEdge(job)});
    SetpointStream stream(of_job);
    for (Setpoint p; stream.next(p) && p.move != MoveKind::kRetract;) {
      if (p.cycle % 7 == 0) p.position[kX] = value;
      executed.add(p, p.position);
    }
    MarkerArray path;
    executed.append(path);
    EXPECT_GT(path.markers.at(0).points.size(), 500u);
    for (const geometry_msgs::Point& p : path.markers[0].points) EXPECT_LE(std::abs(p.x), 1) << value;
  }
}

TEST(PathMarkers, OfTheLongestFlutesStaySmall) {
  GrindJob job = paper();
  job.cutter.end_diameter = 0.1e-3;
  job.cutter.core_diameter = job.cutter.core_diameter_end = 0.08e-3;
  job.cutter.cone_angle = 0;
  job.cutter.spiral_angle = 1;
  job.cutter.flute_length = 500e-3;
  job.process().depth = job.process().infeed = 0.01e-3;
  const GrindProgram program = programOf(job);
  const MarkerArray array = ToolPath(program, {centralEdge(job)}).markers();
  std::size_t points = 0;
  for (const Marker& m : array.markers) points += m.points.size();
  EXPECT_GT(points, 1000u);
  EXPECT_LT(points, 5000u);
  EXPECT_LT(array.markers.back().scale.x, job.cutter.end_diameter / 8) << "does not cover the cutter";
}

}  // namespace test_path_markers
}  // namespace grinder
