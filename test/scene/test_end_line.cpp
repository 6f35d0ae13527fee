#include "flute_grinder/scene/end_line.h"

#include "scene/end_job.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <vector>

namespace grinder {
namespace test_end_line {

using Eigen::Vector3d;
using test_support::endJob;
using test_support::leftHandEndJob;
using units::kDegree;
using units::kMillimetre;

constexpr double kRadius = 5 * kMillimetre, kWheel = 50 * kMillimetre;

/// The job file's.
constexpr double kDish = 2 * kDegree, kClearance = 8 * kDegree, kSecond = 18 * kDegree, kRake = 3 * kDegree;
constexpr double kLand = 0.4 * kMillimetre, kWidth = 0.2 * kMillimetre, kPast = 0.2 * kMillimetre;
constexpr double kSpiral = 35 * kDegree, kHook = 8 * kDegree;

Vector3d turned(const Vector3d& at, double a) { return Eigen::AngleAxisd(a, Vector3d::UnitX()) * at; }

std::vector<ValidJob> allJobs() {
  std::vector<ValidJob> jobs;
  for (const char* operation : {"gash", "end_primary", "end_secondary", "chamfer"}) jobs.push_back(endJob(operation));
  for (const OperationKind kind : {OperationKind::kGash, OperationKind::kChamfer}) jobs.push_back(leftHandEndJob(kind));
  return jobs;
}

EndLine deepest(const ValidJob& job, int tooth) {
  return {job, tooth, job.deepest(), job.wearOfTeeth()[static_cast<std::size_t>(tooth)]};
}

/// A point on a tooth: along the axis, along the radius through its edge at the end, behind the edge.
Vector3d onTooth(const ValidJob& job, int tooth, const EndLine& line, const Vector3d& at) {
  const auto i = static_cast<std::size_t>(tooth);
  Vector3d place = turned(at, line.a() - job->tooth_angles[i] - job.edges()[i].at_end);
  if (job->cutter.cut == CutDirection::kLeftHand) place[2] = -place[2];
  return place;
}

void expectNear(const Vector3d& at, const Vector3d& expected, double within) {
  EXPECT_LT((at - expected).norm(), within) << at.transpose() << " instead of " << expected.transpose();
}

// On the dished end, and inward to where the rim leaves the edge blunt.
TEST(EndLine, OfAFlankIsItsEdge) {
  for (const bool second : {false, true}) {
    const ValidJob job = endJob(second ? "end_secondary" : "end_primary");
    const double land = second ? kLand : 0, fall = land * std::tan(kClearance);
    for (int tooth = 0; tooth < job.teeth(); ++tooth) {
      const EndLine line = deepest(job, tooth);
      expectNear(onTooth(job, tooth, line, line.at(0)), {fall, kRadius, land}, 1e-12);
      for (const double part : {0.25, 1.0}) {
        const Vector3d at = onTooth(job, tooth, line, line.at(part));
        expectNear(at, {fall + (kRadius - at[1]) * std::tan(kDish), at[1], land}, 1e-12);
        EXPECT_NEAR(at[1], (1 - part) * kRadius, 0.11 * kMillimetre * part + 1e-12);
      }
    }
  }
}

// The rim of a cup that comes along X is over the whole edge at once; that of a tooth over the centre passes the axis.
TEST(EndLine, OfAFlankByACupOrOverTheCentreIsItsWholeEdge) {
  for (const char* file : {"jobs/left_hand_end_mill_d8_t3.yaml", "jobs/slot_drill_d8_t2.yaml"}) {
    SCOPED_TRACE(file);
    const ValidJob job = withLaws(ValidJob(readJobFile(file, "end_primary")));
    const EndLine line = deepest(job, 0);
    Vector3d begin = onTooth(job, 0, line, line.at(0)), end = onTooth(job, 0, line, line.at(1));
    if (begin[1] < end[1]) std::swap(begin, end);
    const double radius = 4 * kMillimetre;
    expectNear(begin, {0, radius, 0}, 1e-12);
    expectNear(end, {radius * std::tan(kDish), 0, 0}, 1e-12);
    const FaceStroke stroke = job.faceStroke(0, job.deepest(), 0);
    EXPECT_EQ(line.placeOf(stroke.to).has_value(), !job->comesAlongX()) << "nothing to measure along it";
  }
}

// From the flute's edge to the end's, which the hook lifts.
TEST(EndLine, OfAChamferIsItsEdge) {
  for (const ValidJob& job : {endJob("chamfer"), leftHandEndJob(OperationKind::kChamfer)}) {
    const EndLine line = deepest(job, 1);
    const double hollow = std::tan(kDish) + std::tan(kHook) * std::tan(kClearance), outer = kWidth * (1 + hollow);
    const double round = outer * std::tan(kSpiral) / kRadius;
    const Vector3d periphery(outer, kRadius * std::cos(round), kRadius * std::sin(round));
    const Vector3d way = kWidth * Vector3d(-1, -1, std::tan(kHook) - outer / kWidth * std::tan(kSpiral));
    Vector3d begin = onTooth(job, 1, line, line.at(0)), end = onTooth(job, 1, line, line.at(1));
    if (begin[0] < end[0]) std::swap(begin, end);
    expectNear(begin, periphery, 1e-12);
    expectNear(end, periphery + way, 1e-12);
  }
}

// In the plane of the rake face, at the gash's angle, past the axis at the end, and inside the blank.
TEST(EndLine, OfAGashIsItsBottom) {
  for (const ValidJob& job : {endJob("gash"), leftHandEndJob(OperationKind::kGash)}) {
    for (int tooth = 0; tooth < job.teeth(); ++tooth) {
      const EndLine line = deepest(job, tooth);
      const Vector3d normal =
          Vector3d(std::sin(kRake), std::tan(kDish) * std::sin(kRake), -std::cos(kRake)).normalized();
      const Vector3d corner(0, kRadius, 0);
      const Vector3d outer = onTooth(job, tooth, line, line.at(0)), inner = onTooth(job, tooth, line, line.at(1));
      for (const Vector3d& at : {outer, inner}) EXPECT_NEAR(normal.dot(at - corner), 0, 1e-12);
      EXPECT_NEAR(std::hypot(outer[1], outer[2]), kRadius, 1e-12);
      EXPECT_NEAR(line.at(1)[1], -kPast, 1e-12);
      EXPECT_NEAR((line.at(0) - line.at(1)).normalized()[1], std::sin(45 * kDegree), 1e-12) << "in the wheel's face";
    }
  }
}

// Whatever the pass, and with wear: of a gash of the rim, else of the face.
TEST(EndLine, HasTheRimOfTheWheelOverItAllAlongTheStroke) {
  constexpr double kWear = 0.1 * kMillimetre;
  for (const ValidJob& job : allJobs()) {
    SCOPED_TRACE(toString(job->process().kind));
    for (const double stock : {0.0, 0.05 * kMillimetre, job.deepest()}) {
      const double depth = job.deepest() - stock;
      const EndLine line(job, 2, depth, kWear);
      const FaceStroke stroke = job.faceStroke(2, depth, kWear);
      const Vector3d spindle(-std::sin(stroke.swivel), 0, std::cos(stroke.swivel));
      const bool upper = job->process().kind == OperationKind::kGash && job->cutter.cut == CutDirection::kRightHand;
      int on_line = 0;
      double before = -1;
      constexpr int kPlaces = 5000;
      for (int i = 0; i <= kPlaces; ++i) {
        const Axes position = stroke.from + (stroke.to - stroke.from) * i / kPlaces;
        const std::optional<EndLine::Place> place = line.placeOf(position);
        if (!place || place->part < 0 || place->part > 1) continue;
        ++on_line;
        EXPECT_GT(place->part, before);
        before = place->part;
        expectNear(place->at, line.at(place->part), 1e-12);
        EXPECT_LT(place->error, 1e-12);
        const Vector3d centre =
            Vector3d(position[kX], kRadius + kWheel + position[kY], job->process().setup_height + position[kZ]);
        const bool gash = job->process().kind == OperationKind::kGash;
        const double half_width = job->process().wheel_width / 2 - (gash ? 0 : kWear);
        const Vector3d rim = place->at - centre - (upper ? half_width : -half_width) * spindle;
        EXPECT_NEAR(rim.norm(), kWheel - (gash ? kWear : 0), 1e-12);
        EXPECT_NEAR(rim.dot(spindle), 0, 1e-12);
        expectNear(line.outward(), gash ? Vector3d(-rim.normalized()) : spindle, 1e-9);
      }
      EXPECT_GT(on_line, 3);
      EXPECT_GT(before, 0.8);
    }
  }
}

// Along the spindle it lifts the face of a flank; across the bottom of a gash it moves the bottom.
TEST(EndLine, TellsHowFarTheWheelIsOff) {
  constexpr double kOff = 3e-6;
  for (const ValidJob& job : allJobs()) {
    SCOPED_TRACE(toString(job->process().kind));
    const bool gash = job->process().kind == OperationKind::kGash;
    const EndLine line = deepest(job, 0);
    const FaceStroke stroke = job.faceStroke(0, job.deepest(), job.wearOfTeeth()[0]);
    const Vector3d spindle(-std::sin(stroke.swivel), 0, std::cos(stroke.swivel));
    const Vector3d along = (stroke.to - stroke.from).head<3>().matrix().normalized();
    const auto at = [&](const Vector3d& off, double a_off) {
      Axes position = stroke.to;
      position.head<3>() += off.array();
      position[kA] += a_off;
      return *line.placeOf(position);
    };
    const EndLine::Place exact = at(Vector3d::Zero(), 0), lifted = at(kOff * spindle, 0);
    EXPECT_NEAR(lifted.error, kOff, 1e-12);
    EXPECT_NEAR(lifted.part, exact.part, 1e-9);
    expectNear(lifted.at, exact.at + kOff * spindle, 1e-12);
    EXPECT_NEAR(at(-kOff * along, 0).error, 0, 1e-12) << "that is progress";
    EXPECT_NEAR(at(kOff * along.cross(spindle), 0).error, gash ? kOff : 0, 1e-12);
    // A turns what is ground by its distance from the axis.
    const Vector3d turn = kOff * Vector3d::UnitX().cross(exact.at);
    const Vector3d way = (line.at(1) - line.at(0)).normalized();
    EXPECT_NEAR(at(Vector3d::Zero(), kOff).error, gash ? turn.cross(way).norm() : std::abs(turn.dot(spindle)), 1e-12);
  }
}

TEST(EndLine, IsNowhereForAPositionThatIsNone) {
  using Limits = std::numeric_limits<double>;
  for (const ValidJob& job : allJobs()) {
    const EndLine line = deepest(job, 0);
    for (int axis = 0; axis < kAxisCount; ++axis) {
      for (const double value : {Limits::quiet_NaN(), Limits::infinity(), -Limits::max()}) {
        Axes position = job.faceStroke(0, job.deepest(), 0).to;
        position[axis] = value;
        const std::optional<EndLine::Place> place = line.placeOf(position);
        EXPECT_FALSE(place && place->error <= 1 && std::abs(place->part) <= 1 && !std::isfinite(value));
      }
    }
  }
}

}  // namespace test_end_line
}  // namespace grinder
