#include "brute_force.h"
#include "curve/reference.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/check/job_collision.h"
#include "flute_grinder/motion/setpoint_stream.h"
#include "flute_grinder/tool/ground_job.h"
#include "machine.h"
#include "motion/examples.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

// Outside the cut the wheel keeps off the blank and off the shank.
namespace grinder {
namespace test_clear_of_work {

using Eigen::Vector3d;
using test_support::plainMachine;
using units::kDegree;
using units::kMillimetre;

constexpr double kAccuracy = 3e-6;  ///< of the check and of the brute force [m]

/// jobs/roughing_d10_t4.yaml with a shank of 12 mm into which the wheel runs out, and next to no clearance.
GrindJob thickShankJob(StrokeDirection direction) {
  GrindJob job = test_support::paperJob();
  job.cutter.cone_angle = 0;
  job.cutter.spiral_angle = 35 * kDegree;
  job.cutter.flute_length = 0.022;
  job.cutter.shank_diameter = 0.012;
  job.tooth_angles = {0, units::kPi};
  job.process().direction = direction;
  job.process().depth = job.process().infeed = 1.6e-3;
  job.process().clearance = 0.5e-3;
  job.process().overtravel_end = 3.5e-3;
  job.process().overtravel_shank = 8e-3;
  job.process().setup_swivel = 43.32 * kDegree;
  job.process().setup_height = -1.366e-3;
  return job;
}

/// A machine on which nothing but the work is near.
std::string roomyUrdf() {
  SmallMachine small;
  small.cutter = SmallMachine::cylinder("collet", "0.4 0 0", "0 1.5707963267948966 0", 0.021, 0.023);
  return small.urdf();
}

Machine machineWith(double collision_clearance) {
  Machine machine = plainMachine();
  machine.park[kY] = 0.15;
  machine.collision_clearance = collision_clearance;
  return machine;
}

struct Checked : CollisionResult {
  GrindProgram program;
};

Checked checked(const GrindJob& job, double collision_clearance = 1e-3, const std::optional<Axes>& start = {}) {
  const Machine machine = machineWith(collision_clearance);
  const GrindProgram program(ValidJob(job), machine, start.value_or(machine.park));
  return {checkCollision(program, shapesOf(roomyUrdf())), program};
}

/// The wheel's rim is at a radius of 5 + 0.5 mm when A indexes and X leaves, and the shank's is 6 mm.
TEST(ClearOfWork, AWheelThatIndexesInAShankIsRefused) {
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    const Checked plan = checked(thickShankJob(direction));
    ASSERT_TRUE(plan.reason);
    const Reason& reason = *plan.reason;
    EXPECT_EQ(reason.kind, ReasonKind::kCollision);
    EXPECT_EQ(reason.field, "process.clearance");
    EXPECT_EQ(reason.detail, "wheel and shank");
    EXPECT_EQ(reason.value, 0);
    EXPECT_EQ(reason.low, 0.5e-3);
    EXPECT_EQ(reason.limit, 0.25e-3);
    const Move& move = plan.program.moves().at(plan.closest->leg);
    EXPECT_EQ(reason.move, move.kind);
    EXPECT_EQ(reason.tooth, move.tooth);
    EXPECT_EQ(reason.pass, move.pass);
    EXPECT_FALSE(isAtFeed(reason.move));
  }
}

TEST(ClearOfWork, WithoutACollisionClearanceAContactIsRefused) {
  EXPECT_TRUE(checked(thickShankJob(StrokeDirection::kFromEnd), 0).reason);
  // A shank that the run-out may not cut.
  GrindJob job = thickShankJob(StrokeDirection::kFromEnd);
  job.cutter.shank_diameter = 0.02;
  job.process().clearance = 10e-3;
  const Checked plan = checked(job, 0);
  ASSERT_TRUE(plan.reason);
  EXPECT_EQ(plan.reason->field, "");
}

TEST(ClearOfWork, ALiftOutOfAFluteIsAllowedAndOneFromBelowTheWorkIsNot) {
  GrindJob job = thickShankJob(StrokeDirection::kFromEnd);
  job.process().clearance = 3e-3;
  EXPECT_FALSE(checked(job, 1e-3, Axes(0.01, -1.6e-3, 0, 1)).reason);
  // The wheel's upper side is 3 mm below the cutter.
  const Axes below(0.01, -(0.005 + 0.1 + 3e-3), 0, 0);
  const Checked plan = checked(job, 1e-3, below);
  ASSERT_TRUE(plan.reason);
  EXPECT_EQ(plan.reason->move, MoveKind::kLift);
  EXPECT_EQ(plan.reason->field, "");
}

/// Distance of a point from a cone about X, from 0 to `length`.
struct Frustum {
  double from, to, radius_from, radius_to;

  double distance(const Vector3d& p) const {
    const double x = p.x(), r = std::hypot(p.y(), p.z());
    const double at = (x - from) / (to - from);
    if (at >= 0 && at <= 1 && r <= radius_from + at * (radius_to - radius_from)) return 0;
    const auto segment = [&](double x0, double r0, double x1, double r1) {
      const double dx = x1 - x0, dr = r1 - r0;
      const double t = std::clamp(((x - x0) * dx + (r - r0) * dr) / (dx * dx + dr * dr), 0.0, 1.0);
      return std::hypot(x - x0 - t * dx, r - r0 - t * dr);
    };
    return std::min({segment(from, 0, from, radius_from), segment(from, radius_from, to, radius_to),
                     segment(to, radius_to, to, 0)});
  }

  Vector3d random(std::mt19937& source) const {
    std::uniform_real_distribution<> part(0, 1);
    const double at = part(source), angle = 2 * units::kPi * part(source);
    const double r = std::sqrt(part(source)) * (radius_from + at * (radius_to - radius_from));
    return {from + at * (to - from), r * std::cos(angle), r * std::sin(angle)};
  }
};

/// See CollisionCheck's tests for its place.
Shape wheelOf(const GrindJob& job, const Axes& at) {
  const GrindProcess& p = job.process();
  const double y = job.cutter.end_diameter / 2 + p.wheel_diameter / 2 + at[kY];
  return wheelAt({at[kX], y, p.setup_height + at[kZ]}, p.setup_swivel, p.wheel_diameter / 2, p.wheel_width);
}

std::vector<Frustum> workOf(const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const double shank = c.flute_length + c.neck_length;
  return {{0, c.flute_length, c.end_diameter / 2, c.end_diameter / 2 + c.flute_length * std::tan(c.cone_angle)},
          {shank, 0.3885, c.shank_diameter / 2, c.shank_diameter / 2}};
}

GrindJob randomJob(std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  GrindJob job = test_support::paperJob();
  CutterGeometry& c = job.cutter;
  c.end_diameter = uniform(2, 16) * kMillimetre;
  c.cone_angle = uniform(-1, 18) * kDegree;
  c.spiral_angle = uniform(-40, 40) * kDegree;
  c.flute_length = uniform(5, 25) * kMillimetre;
  const double large = c.end_diameter + 2 * c.flute_length * std::tan(c.cone_angle);
  c.shank_diameter = std::max(1e-3, large + uniform(-2, 6) * kMillimetre);
  c.neck_length = uniform(0, 1) < 0.2 ? uniform(5, 30) * kMillimetre : 0;
  job.tooth_angles = {0, 3};
  GrindProcess& p = job.process();
  p.direction = uniform(0, 1) < 0.5 ? StrokeDirection::kFromEnd : StrokeDirection::kToEnd;
  p.depth = p.infeed = uniform(0.05, 0.2) * c.end_diameter;
  p.clearance = uniform(0.1, 4) * kMillimetre;
  p.overtravel_end = uniform(0.2, 3) * kMillimetre;
  p.overtravel_shank = uniform(0.2, 10) * kMillimetre;
  p.wheel_diameter = uniform(10, 150) * kMillimetre;
  p.wheel_width = uniform(1, 6) * kMillimetre;
  p.setup_swivel = uniform(-50, 50) * kDegree;
  p.setup_height = uniform(-2, 2) * kMillimetre;
  return job;
}

/// Of each rapid move, positions among its setpoints, its last one with them; of those that differ in A alone, one.
std::vector<Setpoint> rapidsOf(const GrindProgram& program) {
  constexpr int kOfEachMove = 2;
  std::vector<std::vector<Setpoint>> moves(program.moves().size());
  SetpointStream stream(program);
  Setpoint p;
  while (stream.next(p)) {
    if (!isAtFeed(p.move)) moves[p.move_index].push_back(p);
  }
  std::vector<Setpoint> rapids;
  for (const std::vector<Setpoint>& move : moves) {
    for (std::size_t i = 0; i < kOfEachMove && !move.empty(); ++i) {
      const Setpoint& at = move[(move.size() - 1) * (i + 1) / kOfEachMove];
      const bool known = std::any_of(rapids.begin(), rapids.end(), [&](const Setpoint& p) {
        return p.move == at.move && (p.position - at.position).head<3>().matrix().norm() < 1e-9;
      });
      if (!known) rapids.push_back(at);
    }
  }
  return rapids;
}

double distanceOf(const GrindJob& job, const Axes& at) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Frustum& body : workOf(job)) distance = std::min(distance, wheelOf(job, at).distance(body, 3e-7));
  return distance;
}

TEST(ClearOfWork, NoSetpointOfAGoodPlanIsTooCloseAndEveryRefusalIsAtItsPlace) {
  std::mt19937 random(20);
  const int cases = test_support::randomCases(60);
  int good = 0, in_work = 0;
  for (int i = 0; i < cases;) {
    const GrindJob job = randomJob(random);
    if (!validate(job).empty()) continue;
    SCOPED_TRACE(i++);
    const Checked plan = checked(job);
    const double allowed = std::min(1e-3, job.process().clearance / 2);
    if (plan.reason && !plan.reason->field.empty()) {
      ++in_work;
      const double distance = distanceOf(job, plan.closest->axes);
      EXPECT_NEAR(distance, plan.closest->distance, kAccuracy);
      EXPECT_LT(distance, allowed + kAccuracy);
    }
    if (plan.reason) continue;
    ++good;
    for (const Setpoint& p : rapidsOf(plan.program)) {
      if (p.move != MoveKind::kRetract) {
        EXPECT_GE(distanceOf(job, p.position), allowed - kAccuracy);
        continue;
      }
      // Up from the stroke's end, nothing is touched that the wheel has not cut there.
      const Move& stroke = plan.program.moves().at(p.move_index - 1);
      EXPECT_EQ(stroke.kind, MoveKind::kStroke);
      Shape cut = wheelOf(job, stroke.to);
      cut.radius += 1e-9;
      cut.half_length += 1e-9;
      for (const Frustum& body : workOf(job)) {
        for (int n = 0; n < 200; ++n) {
          const Vector3d point = body.random(random);
          EXPECT_TRUE(wheelOf(job, p.position).distance(point) > 0 || cut.distance(point) == 0);
        }
      }
    }
  }
  EXPECT_GE(good, cases / 4);
  EXPECT_GE(in_work, cases / 20);
}

}  // namespace test_clear_of_work
}  // namespace grinder
