#include "flute_grinder/control/machine_config.h"

#include "refusal.h"
#include "temp_folder.h"
#include "yaml_parameters.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace grinder {
namespace test_machine_config {

using XmlRpc::XmlRpcValue;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

LoopConfig read(const std::string& urdf, const YAML::Node& parameters) {
  return readLoopConfig(MachineModel(urdf), ParameterReader(test_support::toXmlRpc(parameters), "/grinder"));
}

void expectAxes(const Axes& axes, const Axes& expected) {
  EXPECT_TRUE((axes == expected).all()) << axes.transpose() << ", not " << expected.transpose();
}

TEST(MachineConfig, TakesTheShippedMachineWithTheLimitsOfItsUrdf) {
  const LoopConfig config = read(test_support::readFile("urdf/grinder.urdf"), YAML::LoadFile("config/grinder.yaml"));
  expectAxes(config.machine.limits.min_position, {-0.1, -0.02, -0.05, -125.663706});
  expectAxes(config.machine.limits.max_position, {0.3, 0.15, 0.1, 125.663706});
  expectAxes(config.machine.limits.max_velocity, {0.2, 0.1, 0.1, 12.566});
}

// ---------------------------------------------------------------------------------------------------------------------
// A small machine to modify; every value differs by axis

std::string joint(const std::string& name, const std::string& type, const std::string& limit) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"base\"/><child link=\"link_" + name +
         "\"/><axis xyz=\"1 0 0\"/>" + limit + "</joint><link name=\"link_" + name + "\"/>";
}

std::string limitOf(const std::string& lower, const std::string& upper, const std::string& velocity) {
  return "<limit lower=\"" + lower + "\" upper=\"" + upper + "\" velocity=\"" + velocity + "\" effort=\"1\"/>";
}

struct Description {
  std::string x = joint("axis_x", "prismatic", limitOf("-0.11", "0.31", "0.21"));
  std::string y = joint("axis_y", "prismatic", limitOf("-0.12", "0.32", "0.22"));
  std::string z = joint("axis_z", "prismatic", limitOf("-0.13", "0.33", "0.23"));
  std::string a = joint("axis_a", "revolute", limitOf("-114", "134", "24"));
  std::string set_up =
      joint("wheel_swivel", "revolute", limitOf("-0.7", "1.1", "0")) +
      joint("y_zero", "prismatic", limitOf("0", "1", "0")) + joint("z_zero", "prismatic", limitOf("0", "1", "0")) +
      "<link name=\"wheel\"/><joint name=\"spindle\" type=\"fixed\"><parent link=\"link_wheel_swivel\"/>"
      "<child link=\"wheel\"/></joint>";

  std::string urdf() const {
    return "<robot name=\"grinder\"><link name=\"base\"/>" + x + y + z + a + set_up + "</robot>";
  }
};

YAML::Node parameters() {
  YAML::Node p = YAML::Load(R"(
    control_rate: 500
    feedback_timeout: 0.01
    enable_timeout: 3
    homing_timeout: 45
    spindle_timeout: 7.5
    jog_timeout: 0.3
    max_job_duration: 7200
    collision_clearance: 0.002
    geometry:
      work_axis: {y: 0.1, z: -0.2}
      collet_face: {x: 0.3}
      swivel_centre: {x: 0.4, y: 0.5, z: 0.6}
      flange: -0.7
      probe: {x: 0.8, y: 0.9, z: 1.1, diameter: 0.004}
    probing: {slow: 0.25, touches: 7}
    late_cycle: {slow_down: 3, fault: 25})");
  for (const char* name : kJointNames) {
    const int axis = name == std::string("axis_a") ? 4 : name[5] - 'x' + 1;
    YAML::Node limits = p["joint_limits"][name];
    limits["has_acceleration_limits"] = limits["has_jerk_limits"] = true;
    limits["max_acceleration"] = 1 + 0.1 * axis;
    limits["max_jerk"] = 20 + 0.1 * axis;
    p["constraints"][name]["trajectory"] = 0.001 * axis;
    p["park_position"][name] = 0.01 * axis;
    p["jog_velocity"][name] = 0.02 * axis;
    p["probing"]["velocity"][name] = 0.03 * axis;
    p["probing"]["back_off"][name] = 0.04 * axis;
    p["probing"]["max_spread"][name] = 0.05 * axis;
  }
  return p;
}

std::string errorOf(const std::string& urdf, const YAML::Node& p) {
  return test_support::refusalOf<ParameterError>([&] { read(urdf, p); });
}

std::string errorOf(const YAML::Node& p) { return errorOf(Description().urdf(), p); }

TEST(MachineConfig, TakesEveryFigureOfEveryAxis) {
  const LoopConfig config = read(Description().urdf(), parameters());
  expectAxes(config.machine.limits.min_position, {-0.11, -0.12, -0.13, -114});
  expectAxes(config.machine.limits.max_position, {0.31, 0.32, 0.33, 134});
  expectAxes(config.machine.limits.max_velocity, {0.21, 0.22, 0.23, 24});
  expectAxes(config.machine.limits.max_acceleration, {1 + 0.1 * 1, 1 + 0.1 * 2, 1 + 0.1 * 3, 1 + 0.1 * 4});
  expectAxes(config.machine.limits.max_jerk, {20 + 0.1 * 1, 20 + 0.1 * 2, 20 + 0.1 * 3, 20 + 0.1 * 4});
  expectAxes(config.following_error, {0.001 * 1, 0.001 * 2, 0.001 * 3, 0.001 * 4});
  expectAxes(config.machine.park, {0.01 * 1, 0.01 * 2, 0.01 * 3, 0.01 * 4});
  EXPECT_EQ(config.machine.swivel.from, -0.7);
  EXPECT_EQ(config.machine.swivel.to, 1.1);
  expectAxes(config.jog_velocity, {0.02 * 1, 0.02 * 2, 0.02 * 3, 0.02 * 4});
  EXPECT_EQ(config.name, "grinder");
  EXPECT_EQ(config.machine.period, 0.002);
  EXPECT_EQ(config.feedback_timeout, 0.01);
  EXPECT_EQ(config.enable_timeout, 3);
  EXPECT_EQ(config.homing_timeout, 45);
  EXPECT_EQ(config.spindle_timeout, 7.5);
  EXPECT_EQ(config.jog_timeout, 0.3);
  EXPECT_EQ(config.machine.max_job_duration, 7200);
  EXPECT_EQ(config.machine.collision_clearance, 0.002);
  EXPECT_EQ(config.geometry.work_axis_y, 0.1);
  EXPECT_EQ(config.geometry.work_axis_z, -0.2);
  EXPECT_EQ(config.geometry.collet_face, 0.3);
  EXPECT_EQ(config.geometry.swivel_centre, Eigen::Vector3d(0.4, 0.5, 0.6));
  EXPECT_EQ(config.geometry.flange, -0.7);
  ASSERT_TRUE(config.geometry.probe);
  EXPECT_EQ(config.geometry.probe->centre, Eigen::Vector3d(0.8, 0.9, 1.1));
  EXPECT_EQ(config.geometry.probe->diameter, 0.004);
  expectAxes(config.probing.velocity, {0.03 * 1, 0.03 * 2, 0.03 * 3, 0.03 * 4});
  expectAxes(config.probing.back_off, {0.04 * 1, 0.04 * 2, 0.04 * 3, 0.04 * 4});
  expectAxes(config.probing.max_spread, {0.05 * 1, 0.05 * 2, 0.05 * 3, 0.05 * 4});
  EXPECT_EQ(config.probing.slow, 0.25);
  EXPECT_EQ(config.probing.touches, 7);
  EXPECT_EQ(config.late_slow_down, 3);
  EXPECT_EQ(config.late_fault, 25);
}

TEST(MachineConfig, ParameterLimitsGoOverTheUrdfs) {
  YAML::Node p = parameters();
  YAML::Node y = p["joint_limits"]["axis_y"], a = p["joint_limits"]["axis_a"];
  y["has_position_limits"] = a["has_velocity_limits"] = true;
  y["min_position"] = -0.05;
  y["max_position"] = 0.06;
  a["max_velocity"] = 3.5;
  const AxisLimits limits = read(Description().urdf(), p).machine.limits;
  expectAxes(limits.min_position, {-0.11, -0.05, -0.13, -114});
  expectAxes(limits.max_position, {0.31, 0.06, 0.33, 134});
  expectAxes(limits.max_velocity, {0.21, 0.22, 0.23, 3.5});
}

TEST(MachineConfig, AMachineNeedsNoProbe) {
  YAML::Node p = parameters();
  p["geometry"].remove("probe");
  EXPECT_FALSE(read(Description().urdf(), p).geometry.probe);
}

// ---------------------------------------------------------------------------------------------------------------------
// What is refused beside what test_parameters.cpp shows of each parameter by itself

TEST(MachineConfig, RefusesALimitWithoutItsFlagOrSwitchedOff) {
  for (const std::string limit : {"velocity", "position"}) {
    YAML::Node p = parameters();
    p["joint_limits"]["axis_y"]["max_" + limit] = 0.1;
    const std::string flag = "/grinder/joint_limits/axis_y/has_" + limit + "_limits";
    EXPECT_EQ(errorOf(p), "parameter " + flag + " is missing, though /grinder/joint_limits/axis_y/max_" + limit +
                              " is there; allowed: true beside it");
    p["joint_limits"]["axis_y"]["has_" + limit + "_limits"] = false;
    EXPECT_EQ(errorOf(p), "parameter " + flag + " = false; allowed: true, since every axis needs this limit");
  }
}

TEST(MachineConfig, NeedsLimitsThatAUrdfHasNot) {
  for (const std::string kind : {"acceleration", "jerk"}) {
    YAML::Node p = parameters();
    for (const std::string& name : {"has_" + kind + "_limits", "max_" + kind}) p["joint_limits"]["axis_a"].remove(name);
    EXPECT_EQ(errorOf(p), "parameter /grinder/joint_limits/axis_a/has_" + kind +
                              "_limits is missing, and robot_description has no such limit; allowed: true, with max_" +
                              kind);
  }
}

TEST(MachineConfig, RefusesLimitsOfTheUrdfThatAreNone) {
  const std::string no_velocity = "/grinder/joint_limits/axis_x/has_velocity_limits";
  Description swapped, endless;
  swapped.z = joint("axis_z", "prismatic", limitOf("0.3", "0.1", "1"));
  endless.a = joint("axis_a", "revolute", "<limit velocity=\"1\" effort=\"1\"/>");
  EXPECT_EQ(errorOf(swapped.urdf(), parameters()),
            "parameters /grinder/joint_limits/axis_z/min_position, max_position (or the limits of robot_description): "
            "0.3 to 0.1 m; allowed: the lower below the upper");
  EXPECT_NE(errorOf(endless.urdf(), parameters()).find("robot_description): 0 to 0 rad"), std::string::npos);
  for (const char* none : {"0", "-2"}) {
    Description still;
    still.x = joint("axis_x", "prismatic", limitOf("-1", "1", none));
    const std::string error = errorOf(still.urdf(), parameters());
    EXPECT_EQ(error.find("parameter " + no_velocity + " is missing"), 0U) << error;
  }
}

TEST(ParameterReader, KnowsWhatIsThere) {
  const XmlRpcValue p = test_support::toXmlRpc(YAML::Load("{a: {b: {number: 2.5}, text: word}}"));
  const ParameterReader reader(p, "/ns");
  EXPECT_TRUE(reader.has("a/b/number"));
  EXPECT_TRUE(reader.has("a/b"));
  EXPECT_FALSE(reader.has("b"));
  EXPECT_FALSE(reader.has("a/number"));
  EXPECT_FALSE(reader.has("a/text/word")) << "below what is no struct";
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(reader.has("a/b/other")) << "made by looking for it";
}

TEST(ParameterReader, TakesFiniteNumbersAndWordsOnly) {
  XmlRpcValue p;
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    p["number"] = value;
    EXPECT_THROW(ParameterReader(p, "/ns").number("number", -1e9, 1e9), ParameterError) << value;
  }
  p["empty"] = "";
  EXPECT_THROW(ParameterReader(p, "/ns").text("empty"), ParameterError);
}

}  // namespace test_machine_config
}  // namespace grinder
