#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/check/machine_shapes.h"
#include "machine.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {
namespace test_machine_shapes {

using Eigen::Vector3d;
using units::kDegree;

MachinePart partOf(const std::vector<MachinePart>& parts, const std::string& name) {
  const auto part =
      std::find_if(parts.begin(), parts.end(), [&](const MachinePart& p) { return p.solid.name == name; });
  EXPECT_NE(part, parts.end()) << name;
  return part == parts.end() ? MachinePart() : *part;
}

TEST(MachineShapes, HasEveryShapeOfTheShippedMachine) {
  const auto parts = shippedShapes().parts(0.055, 0);
  std::vector<std::string> names;
  for (const MachinePart& part : parts)
    names.push_back((part.with_wheel ? "+" : "") + part.link + "/" + part.solid.name);
  std::sort(names.begin(), names.end());
  const std::vector<std::string> expected{
      "+column/column",       "+column/cross_slide", "+wheel/arbor",   "+wheel/spindle", "+wheel/swivel",
      "+wheel_head/carriage", "base/bed_x",          "base/bed_y",     "base/cabinet",   "chuck/collet",
      "chuck/spindle_nose",   "table/table",         "table/work_head"};
  EXPECT_EQ(names, expected);
}

/// The spindle's axis is (-sin s, 0, cos s), and its centre 147.5 mm up that axis from the wheel's.
TEST(MachineShapes, TheSpindleSwivelsBothWays) {
  const MachineShapes machine = shippedShapes();
  for (const double swivel : {-40 * kDegree, 0.0, 30 * kDegree, 84 * kDegree}) {
    const MachinePart spindle = partOf(machine.parts(0.055, swivel), "spindle");
    const Vector3d axis(-std::sin(swivel), 0, std::cos(swivel));
    EXPECT_TRUE(spindle.solid.pose.translation().isApprox(Vector3d(0, 0.055, 0) + 0.1475 * axis, 1e-12)) << swivel;
    EXPECT_TRUE(spindle.solid.pose.linear().col(2).isApprox(axis, 1e-12)) << swivel;
  }
}

TEST(MachineShapes, XMovesTheWorkAndYAndZTheWheel) {
  const auto parts = shippedShapes().parts(0.055, 0.3);
  EXPECT_TRUE(partOf(parts, "collet").motion.isApprox(Eigen::Matrix3d(Vector3d(-1, 0, 0).asDiagonal())));
  EXPECT_TRUE(partOf(parts, "table").motion.isApprox(Eigen::Matrix3d(Vector3d(-1, 0, 0).asDiagonal())));
  EXPECT_TRUE(partOf(parts, "column").motion.isApprox(Eigen::Matrix3d(Vector3d(0, 1, 0).asDiagonal())));
  EXPECT_TRUE(partOf(parts, "arbor").motion.isApprox(Eigen::Matrix3d(Vector3d(0, 1, 1).asDiagonal())));
  EXPECT_TRUE(partOf(parts, "bed_y").motion.isZero());
}

TEST(MachineShapes, WhatTurnsWithTheCutterCountsAsWhatItSweeps) {
  SmallMachine small;
  small.cutter = SmallMachine::box("driver", "0.07 0.03 0", "0.01 0.02 0.02");
  const Solid driver = shapesOf(small.urdf()).parts(0.055, 0)[0].solid;
  const double reach = std::hypot(0.04, 0.01);
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    const Vector3d direction(0, std::cos(angle), std::sin(angle));
    EXPECT_NEAR(driver.farthest(direction).dot(direction), reach, 1e-12);
  }
  EXPECT_NEAR(driver.farthest({-1, 0, 0}).x(), 0.065, 1e-12);
  EXPECT_NEAR(driver.farthest({1, 0, 0}).x(), 0.075, 1e-12);
}

void expectRefused(const std::string& urdf, const std::string& named) {
  ASSERT_FALSE(urdf.empty());
  const std::string said = test_support::refusalOf<std::invalid_argument>([&] { shapesOf(urdf); });
  EXPECT_NE(said.find(named), std::string::npos) << said << "\nnot: " << named;
}

TEST(MachineShapes, RefusesWhatItCannotCheckByName) {
  const std::string good = shippedUrdf();
  expectRefused(replaced(good, "<geometry><cylinder radius=\"0.022\" length=\"0.075\"/></geometry>",
                         "<geometry><mesh filename=\"package://arbor.stl\"/></geometry>"),
                "link wheel, <collision> arbor");
  expectRefused(
      replaced(good, "<cylinder radius=\"0.022\" length=\"0.075\"/>", "<cylinder radius=\"-0.022\" length=\"0.075\"/>"),
      "link wheel, <collision> arbor: radius = -0.022");
  expectRefused(replaced(good, "<box size=\"0.46 0.14 0.05\"/></geometry>\n    </collision>",
                         "<box size=\"0.46 0 0.05\"/></geometry>\n    </collision>"),
                "link table, <collision> table: size");
}

}  // namespace test_machine_shapes
}  // namespace grinder
