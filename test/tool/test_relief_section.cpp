#include "flute_grinder/tool/ground_cutter.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/relief_path.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/cutter_solid.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace grinder {
namespace test_relief_section {

using units::kDegree;
using units::kMillimetre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A stroke of a straight, sharp wheel: where its centre is, and how far the cutter is turned, by X.
struct Stroke {
  double from, to, radius, width, swivel;
  double y, y_per_x, z, z_per_x;  ///< of the centre, from the cutter's axis
  LogCurve a;
  double a0;

  /// Where a ray from the axis first meets the wheel.
  double ray(double x, double angle, double axis_x) const {
    const double w_x = -std::sin(swivel), w_z = std::cos(swivel);
    const double psi = angle - a.a(axis_x) - a0, e_y = std::cos(psi), e_z = std::sin(psi);
    const double c_y = y + axis_x * y_per_x, c_z = z + axis_x * z_per_x, d_x = x - axis_x;
    const double along0 = w_x * d_x - w_z * c_z, along1 = w_z * e_z;
    double nearest = kInfinity;
    const auto take = [&](double r) {
      if (!(r > 0)) return;
      const double along = along0 + r * along1;
      const double square = d_x * d_x + (r * e_y - c_y) * (r * e_y - c_y) + (r * e_z - c_z) * (r * e_z - c_z);
      if (std::abs(along) > width / 2 + 1e-12 || square - along * along > radius * radius + 1e-12) return;
      nearest = std::min(nearest, r);
    };
    const double a2 = 1 - along1 * along1, a1 = -c_y * e_y - c_z * e_z - along0 * along1;
    const double root = a1 * a1 - a2 * (d_x * d_x + c_y * c_y + c_z * c_z - along0 * along0 - radius * radius);
    if (root >= 0) take((-a1 - std::sqrt(root)) / a2);
    for (const double face : {-width / 2, width / 2}) take((face - along0) / along1);
    return nearest;
  }

  /// The radius that is left along a ray.
  double left(double x, double angle) const {
    constexpr int kPoses = 150;
    const double low = std::max(from, x - 20e-3), step = (std::min(to, x + 20e-3) - low) / kPoses;
    const auto at = [&](double i) { return ray(x, angle, low + i * step); };
    int best = 0;
    for (int i = 1; i <= kPoses; ++i) {
      if (at(i) < at(best)) best = i;
    }
    double begin = std::max(best - 1, 0), end = std::min(best + 1, kPoses);
    for (int i = 0; i < 40; ++i) {
      const double third = (end - begin) / 3;
      at(begin + third) < at(end - third) ? end -= third : begin += third;
    }
    return std::min(at(best), at((begin + end) / 2));
  }
};

/// The last stroke of a tooth.
Stroke strokeOf(const ValidJob& job, int tooth) {
  const StrokeLaw& along = job.strokeLaw(tooth);
  const GrindProcess& p = job->process();
  const DepthLaw depth = job.depthLaw(tooth, job.deepest(), 0);
  const ConicalCutter cutter(along.cutter);
  return {std::min(along.from, along.to),
          std::max(along.from, along.to),
          p.wheel_diameter / 2,
          p.wheel_width,
          p.setup_swivel,
          job->cutter.end_diameter / 2 + p.wheel_diameter / 2 - depth.at_end,
          cutter.tanCone() + depth.taper,
          p.setup_height,
          cutter.tanCone() * cutter.zPerY(),
          LogCurve(cutter, along.x_shift),
          along.a};
}

/// The stroke that grinds a relief at its full depth, as if the tooth were at angle 0. @param edge as of Tool.
WheelSweep sweepOf(const ConicalCutter& cutter, const ReliefPath& path, const ReliefWheel& wheel, double edge) {
  GrindStroke stroke;
  stroke.from = path.xShift() - path.beyondEnd();
  stroke.to = cutter.cone().flute_length + path.xShift() + path.beyondShank();
  stroke.y = path.y();
  stroke.y_per_x = path.taper();
  stroke.a = path.a() + edge;
  return {path.cutter(),
          WheelProfile::straight(2 * wheel.nominal_radius, wheel.width),
          wheel.nominal_radius,
          {wheel.swivel, wheel.height, path.xShift()},
          stroke};
}

/// A job's flutes with a primary relief whose start is at a place of the rim.
struct Tool {
  GrindJob job;
  GroundCutter cutter;
  ConicalCutter cone;
  double hand;
  ReliefStart start;
  ReliefWheel wheel;
  ReliefPath path;
  double edge;            ///< of a tooth at angle 0, against its asked helix
  GroundCutter relieved;  ///< with that

  /// @param margin in front of the relief, along the circle at the small end [mm].
  Tool(const std::string& file, double clearance, double swivel, double width, double contact, double margin = 0)
      : job(readJobFile(file)),
        cutter(groundCutterOf(ValidJob(job))),
        cone(job.cutter),
        hand(job.cutter.cut == CutDirection::kLeftHand ? -1 : 1),
        start{clearance * kDegree, 1, margin * kMillimetre / cone.radius(0)},
        wheel(wheelOf(start, hand * swivel, width, contact)),
        path(cone, start, wheel),
        edge(edgeOf()),
        relieved(cone, cutter.flutes(), cutter.teeth(),
                 std::vector<Reliefs>(cutter.flutes().size(), {{sweepOf(cone, path, wheel, edge)}})) {}

  ReliefWheel wheelOf(const ReliefStart& start, double swivel, double width, double contact) const {
    ReliefWheel w{50 * kMillimetre, 0, width * kMillimetre, swivel * kDegree, 0};
    w.height = ReliefPath::heightFor(cone, start, w, contact * kMillimetre);
    return w;
  }
  double edgeOf() const {
    const double x = job.cutter.flute_length / 2;
    return *cutter.section(x).teeth[0].edge - LogCurve(cone).a(x);
  }
  Stroke reliefStroke() const {
    return {path.xShift() - path.beyondEnd(),
            job.cutter.flute_length + path.xShift() + path.beyondShank(),
            wheel.nominal_radius,
            wheel.width,
            wheel.swivel,
            job.cutter.end_diameter / 2 + wheel.nominal_radius + path.y(),
            cone.tanCone() + path.taper(),
            wheel.height,
            cone.tanCone() * path.cutter().zPerY(),
            LogCurve(cone, path.xShift()),
            path.a() + edge};
  }
  /// Of the tooth behind the first one.
  Stroke nextFlute() const {
    const bool left = hand < 0;
    Stroke next =
        test_relief_section::strokeOf(ValidJob(job), left ? static_cast<int>(job.tooth_angles.size()) - 1 : 1);
    if (left) next.a0 -= units::kTurn;
    return next;
  }
};

/// The angle behind an edge at which a relief meets the blank. In front of that, it would undercut it.
double beginOf(const Stroke& relief, double x, double radius, double edge, double hand, double about) {
  double low = about - 1 * kDegree, high = about + 1 * kDegree;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (relief.left(x, edge + hand * middle) > radius ? low : high) = middle;
  }
  return high;
}

/// The clearance of a relief there.
double clearanceAt(const Stroke& relief, double x, double radius, double edge, double hand, double begin) {
  const double fall = relief.left(x, edge + hand * (begin + 1e-6)) - relief.left(x, edge + hand * (begin + 11e-6));
  return std::atan(fall / (10e-6 * radius));
}

/// The angle behind an edge from which on the flute takes more than the relief.
double heelOf(const Stroke& relief, const Stroke& flute, double x, double edge, double hand) {
  const auto on_land = [&](double behind) {
    return flute.left(x, edge + hand * behind) > relief.left(x, edge + hand * behind);
  };
  double high = 0;
  while (on_land(high)) high += 0.25 * kDegree;
  double low = high - 0.25 * kDegree;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (on_land(middle) ? low : high) = middle;
  }
  return low;
}

/// From an edge to a place behind it.
double distanceTo(double radius, double r, double behind) {
  return std::hypot(r * std::cos(behind) - radius, r * std::sin(behind));
}

/// The least radius that a stroke leaves in a section.
double coreOf(const Stroke& stroke, double x) {
  const double step = 2 * kDegree;
  double best = 0;
  for (double angle = 0; angle < units::kTurn; angle += step) {
    if (stroke.left(x, angle) < stroke.left(x, best)) best = angle;
  }
  double low = best - step, high = best + step;
  for (int i = 0; i < 40; ++i) {
    const double third = (high - low) / 3;
    stroke.left(x, low + third) < stroke.left(x, high - third) ? high -= third : low += third;
  }
  return stroke.left(x, (low + high) / 2);
}

// The land is gone through in steps: what is left of it by the relief, and by the next tooth's flute.
TEST(ReliefSection, IsWhatTheWheelsLeave) {
  for (const Tool& tool :
       {Tool("jobs/taper_d6_t6.yaml", 10, 20, 3, -1.3), Tool("jobs/left_hand_d8_t3.yaml", 12, 30, 6, -2),
        Tool("jobs/left_hand_d8_t3.yaml", 12, 30, 6, -2, 0.2)}) {
    const Stroke relief = tool.reliefStroke(), flute = tool.nextFlute();
    for (const double part : {0.0, 0.5, 1.0}) {
      const double x = part * tool.job.cutter.flute_length;
      const GroundSection section = tool.relieved.section(x);
      const ReliefSection measured = section.teeth[0].relief.value();
      const double edge = *section.teeth[0].edge;
      const auto left = [&](const Stroke& stroke, double behind) { return stroke.left(x, edge + tool.hand * behind); };

      const double begin = beginOf(relief, x, section.radius, edge, tool.hand, tool.start.behind);
      if (tool.start.behind > 0) {
        EXPECT_NEAR(begin, tool.start.behind, 10e-6);  // the margin is left as wide as asked
      }
      EXPECT_NEAR(measured.edge_radius, std::min(section.radius, left(relief, 0)), 5e-9);
      EXPECT_NEAR(*measured.clearance, clearanceAt(relief, x, section.radius, edge, tool.hand, begin), 0.01 * kDegree);

      const double low = heelOf(relief, flute, x, edge, tool.hand), r = left(relief, low);
      ASSERT_LT(r, section.radius);
      const auto distance = [&](double from) { return distanceTo(section.radius, r, low - from); };
      ASSERT_TRUE(measured.heel && measured.land && measured.land_end_clearance);
      EXPECT_NEAR(*measured.heel, distance(0), 1e-6);
      EXPECT_NEAR(*measured.land, distance(std::max(0.0, begin)), 1e-6);
      const double end =
          (left(relief, low - 0.01 * kDegree) - left(relief, low + 0.01 * kDegree)) / (0.02 * kDegree * r);
      EXPECT_NEAR(*measured.land_end_clearance, std::atan(end), 0.02 * kDegree);
    }
  }
}

// The outline follows the relief from the edge to the heel, and the solid is closed over it.
TEST(ReliefSection, TheOutlineAndTheSolidHaveIt) {
  for (const Tool& tool :
       {Tool("jobs/taper_d6_t6.yaml", 10, 20, 3, -1.3), Tool("jobs/left_hand_d8_t3.yaml", 12, 30, 6, -2),
        Tool("jobs/roughing_d10_t4.yaml", 24, 25, 4, -2)}) {
    const double length = tool.job.cutter.flute_length, x = 0.4 * length;
    const OutlineGrid grid{tool.job.tooth_angles.size(), 20, 12};
    const auto outline = sectionOutline(tool.relieved, x, tool.cone.radius(x), grid);
    const Stroke relief = tool.reliefStroke();
    // The first tooth's body: of a left-hand cutter, its edge is at the land's end.
    const std::size_t body = tool.hand > 0 ? 0 : grid.teeth - 1;
    for (std::size_t column = 1; column + 1 < grid.columns; ++column) {
      const PolarPoint p = outline[grid.land(body, column)];
      EXPECT_NEAR(relief.left(x, p.angle()), p.radius, 2e-7) << column;
      EXPECT_LT(p.radius, tool.cone.radius(x));
    }
    // A quarter of the flute, whose sections are as far apart as in a whole solid.
    const double part = length / 4;
    const SolidExtent extent{0, part, 0, 0};
    const SolidResolution coarse{6, 12, 60};
    const double without = cutterSolid(tool.cutter, extent, coarse).volume();
    const double fell = without - cutterSolid(tool.relieved, extent, coarse).volume();
    // Of one tooth, what the relief takes of the blank and the flute behind it does not.
    double fallen = 0;
    constexpr int kSections = 3;
    const Stroke flute = tool.nextFlute();
    for (int i = 0; i < kSections; ++i) {
      const GroundSection section = tool.cutter.section((i + 0.5) / kSections * part);
      const double step = 0.25 * kDegree;
      for (double behind = step / 2;; behind += step) {
        const double at = *section.teeth[0].edge + tool.hand * behind;
        const double left = std::min(relief.left(section.x, at), section.radius);
        if (flute.left(section.x, at) < section.radius) break;
        fallen += part / kSections * step * (section.radius * section.radius - left * left) / 2;
      }
    }
    fallen *= static_cast<double>(tool.job.tooth_angles.size());
    EXPECT_NEAR(fell, fallen, 0.03 * fallen);
  }
}

// Unequal angles and a helix per tooth: each relief follows the edge of its own tooth.
TEST(ReliefSection, EveryToothHasTheClearanceBehindItsOwnEdge) {
  GrindJob job = readJobFile("jobs/unequal_d12_t4.yaml");
  job.spiral_angles = {36 * kDegree, 38 * kDegree, 36 * kDegree, 38 * kDegree};
  job.cutter.spiral_angle = job.spiral_angles[0];
  job.cutter.clearance = 10 * kDegree;
  job.cutter.clearance_tolerance = 0.5 * kDegree;
  GrindProcess p;
  p.kind = OperationKind::kPrimaryRelief;
  p.feed = 5e-3, p.infeed = 0.1e-3, p.clearance = 4e-3;
  p.wheel_diameter = 100e-3, p.wheel_width = 6e-3;
  p.setup_swivel = 38 * kDegree;
  const ReliefWheel wheel{p.wheel_diameter / 2, 0, p.wheel_width, p.setup_swivel, 0};
  p.setup_height = ReliefPath::heightFor(ConicalCutter(job.cutter), {job.cutter.clearance}, wheel, -2e-3);
  job.operations.push_back(p);
  job.operation = 1;
  const ValidJob ground = withLaws(ValidJob(job));
  const GroundCutter cutter = groundCutterOf(ground);
  for (const double part : {0.0, 0.5, 1.0}) {
    const double x = part * job.cutter.flute_length;
    const GroundSection section = cutter.section(x);
    for (int tooth = 0; tooth < 4; ++tooth) {
      SCOPED_TRACE(tooth);
      const ToothSection& measured = section.teeth[static_cast<std::size_t>(tooth)];
      const Stroke stroke = strokeOf(ground, tooth);
      const double begin = beginOf(stroke, x, section.radius, *measured.edge, 1, 0);
      EXPECT_NEAR(clearanceAt(stroke, x, section.radius, *measured.edge, 1, begin) / kDegree, 10, 0.02);
      EXPECT_NEAR(*measured.relief->clearance / kDegree, 10, 0.02);
    }
  }
}

// A steep relief that is wide takes some of the next flute's floor, too. The land still ends where the flute's wall
// first comes through the relief, or, where that is ground away, at what the relief leaves of it at the floor.
TEST(ReliefSection, OnTheFloorOfTheNextFluteTakesTheCoreAndLeavesTheHeel) {
  struct Case {
    double clearance, swivel, width, contact;
    bool below_the_core;
  };
  for (const Case& c :
       {Case{24, 25, 4, -2, true}, Case{24, 40, 4, -2, false}, Case{18, 40, 8, -2, true}, Case{30, 25, 4, -1, true}}) {
    const Tool tool("jobs/roughing_d10_t4.yaml", c.clearance, c.swivel, c.width, c.contact);
    const Stroke relief = tool.reliefStroke(), flute = tool.nextFlute();
    for (const double part : {0.0, 1.0}) {
      const double x = part * tool.job.cutter.flute_length;
      const GroundSection section = tool.relieved.section(x);
      const ReliefSection measured = section.teeth[0].relief.value();
      const double core = coreOf(relief, x), of_flutes = coreOf(flute, x), edge = *section.teeth[0].edge;
      EXPECT_EQ(core < of_flutes, c.below_the_core);
      EXPECT_NEAR(measured.core_radius, core, 10e-9);
      EXPECT_NEAR(section.core_radius, std::min(core, of_flutes), 10e-9);
      const double behind = heelOf(relief, flute, x, edge, tool.hand);
      ASSERT_TRUE(measured.heel);
      EXPECT_NEAR(*measured.heel, distanceTo(section.radius, relief.left(x, edge + tool.hand * behind), behind), 1e-6);
      EXPECT_GT(measured.next_edge, 0);
    }
  }
}

/// The angle behind an edge from which on one stroke leaves less than another.
double crossingOf(const Stroke& first, const Stroke& second, double x, double edge, double low, double high) {
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (first.left(x, edge + middle) < second.left(x, edge + middle) ? low : high) = middle;
  }
  return low;
}

// The primary ends where the secondary begins, with its clearance. A secondary with less clearance than the primary
// goes below that in front of its land's end, and takes some of the edge: rake and clearance are those of what is left.
TEST(ReliefSection, OfTwoReliefsIsWhatBothLeave) {
  for (const double second : {20.0, 5.0}) {
    SCOPED_TRACE(second);
    GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "secondary");
    job.tooth_angles = {0};
    if (second < 10) {
      job.cutter.second_clearance = second * kDegree;
      job.process().setup_height = job.operations[2].setup_height = -4.30473 * kMillimetre;
    }
    const ValidJob secondary = withLaws(ValidJob(job)), primary = withLaws(ValidJob(job.ofOperation(1)));
    const Stroke front = strokeOf(primary, 0), back = strokeOf(secondary, 0);
    const double x = 0.5 * job.cutter.flute_length, radius = job.cutter.end_diameter / 2;
    const ToothSection tooth = groundCutterOf(secondary).section(x).teeth[0];
    const ReliefSection relief = tooth.relief.value();
    const double edge = *tooth.edge;
    // The rake face is straight over so little, and the tooth's tip where the reliefs meet it.
    const double tan_rake = std::tan(groundCutterOf(secondary.flutes()).section(x).teeth[0].rake.value());
    double taken = 0;
    for (int i = 0; i < 20; ++i) {
      const double at = edge + taken * tan_rake / radius;
      taken = std::max(0.0, radius - std::min(front.left(x, at), back.left(x, at)));
    }
    EXPECT_EQ(taken > 3e-6, second < 10);
    EXPECT_NEAR(radius - relief.edge_radius, taken, 0.05e-6);
    const double behind = taken * tan_rake / radius, tip = radius - taken;
    const Stroke& at_edge = second < 10 ? back : front;
    EXPECT_NEAR(*relief.clearance, clearanceAt(at_edge, x, tip, edge, 1, behind), 0.03 * kDegree);

    if (second < 10) {
      EXPECT_LT(*relief.land, 1e-6);
      EXPECT_NEAR(*relief.second_clearance, *relief.clearance, 0.01 * kDegree);
      continue;
    }
    const double end = crossingOf(front, back, x, edge, behind, 10 * kDegree), r = front.left(x, edge + end);
    EXPECT_NEAR(*relief.land, std::hypot(r * std::cos(end) - tip, r * std::sin(end)), 1e-6);
    EXPECT_NEAR(*relief.land, job.cutter.land, 1e-6);
    EXPECT_NEAR(*relief.second_clearance, second * kDegree, 0.02 * kDegree);
  }
}

/// A relief that reaches the next edge is seen, and one that ends before the heel.
TEST(ReliefSection, SeesTheNextToothAndALandThatIsNotRelieved) {
  const Tool wide("jobs/taper_d6_t6.yaml", 10, 25, 6, -2.5), narrow("jobs/left_hand_d8_t3.yaml", 12, 30, 3, 0);
  const GroundSection section = wide.relieved.section(0);
  EXPECT_LT(section.teeth[0].relief.value().next_edge, 0);
  // The relief is below the blank where the next edge is.
  EXPECT_LT(wide.reliefStroke().left(0, *section.teeth[1].edge), section.radius - 1e-6);

  const ReliefSection short_of = narrow.relieved.section(0).teeth[0].relief.value();
  EXPECT_FALSE(short_of.heel);
  EXPECT_GT(short_of.next_edge, 0);
  // That it is deeper than the flutes makes no difference: some of the land stands behind it.
  const Tool deep("jobs/left_hand_d8_t3.yaml", 30, 40, 4, -1);
  const GroundSection deep_section = deep.relieved.section(0);
  EXPECT_LT(deep_section.core_radius, deep.cutter.section(0).core_radius - 50e-6);
  EXPECT_FALSE(deep_section.teeth[0].relief.value().heel);
}

/// A primary relief without its secondary one must reach the heel, whatever is ground after it.
TEST(ReliefSection, MustReachTheHeelUnlessASecondaryReliefFollows) {
  GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "primary");
  const auto refused = [&] {
    const std::vector<Reason> reasons = checkGroundCutter(withLaws(ValidJob(job))).reasons;
    return std::any_of(reasons.begin(), reasons.end(), [](const Reason& r) { return r.kind == ReasonKind::kHeel; });
  };
  EXPECT_FALSE(refused());
  job.operations.erase(job.operations.begin() + 2);
  EXPECT_TRUE(refused());
}

}  // namespace test_relief_section
}  // namespace grinder
