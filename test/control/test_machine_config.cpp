#include "flute_grinder/control/machine_config.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace flute_grinder {
namespace test_machine_config {

using ::testing::TestParamInfo;
using ::testing::TestWithParam;
using ::testing::ValuesIn;
using XmlRpc::XmlRpcValue;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---------------------------------------------------------------------------------------------------------------------
// The package's own files, as roslaunch would load them

std::string fileText(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_TRUE(file) << path;
  return text.str();
}

XmlRpcValue toXmlRpc(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsMap()) {
    for (const auto& item : node) value[item.first.as<std::string>()] = toXmlRpc(item.second);
    return value;
  }
  const std::string text = node.as<std::string>();
  bool flag;
  int whole;
  double number;
  if (text == "true" || text == "false") {
    YAML::convert<bool>::decode(node, flag);
    value = XmlRpcValue(flag);
  } else if (YAML::convert<int>::decode(node, whole)) {
    value = XmlRpcValue(whole);
  } else if (YAML::convert<double>::decode(node, number)) {
    value = XmlRpcValue(number);
  } else {
    value = XmlRpcValue(text);
  }
  return value;
}

std::string packageUrdf() { return fileText("urdf/grinder.urdf"); }
XmlRpcValue packageParameters() { return toXmlRpc(YAML::Load(fileText("config/grinder.yaml"))); }

LoopConfig read(const std::string& urdf, const XmlRpcValue& parameters) {
  return readMachineConfig(urdf, ParameterReader(parameters, "/grinder"));
}

void expectAxes(const Axes& axes, const Axes& expected) {
  EXPECT_TRUE((axes == expected).all()) << axes.transpose() << ", not " << expected.transpose();
}

class PackageMachine : public ::testing::Test {
 protected:
  LoopConfig config_ = read(packageUrdf(), packageParameters());
  AxisLimits& limits_ = config_.machine.limits;
};

TEST_F(PackageMachine, HasPositionLimitsFromTheUrdf) {
  expectAxes(limits_.min_position, {-0.1, -0.02, -0.05, -125.663706});
  expectAxes(limits_.max_position, {0.3, 0.15, 0.1, 125.663706});
}

TEST_F(PackageMachine, HasVelocityLimitsFromTheUrdf) { expectAxes(limits_.max_velocity, {0.2, 0.1, 0.1, 12.566}); }

TEST_F(PackageMachine, HasAccelerationAndJerkLimitsFromTheParameters) {
  expectAxes(limits_.max_acceleration, {0.5, 0.5, 0.5, 62.83});
  expectAxes(limits_.max_jerk, {10, 10, 10, 1257});
}

TEST_F(PackageMachine, HasFollowingErrorsFromTheConstraints) {
  expectAxes(config_.following_error, {0.001, 0.001, 0.001, 0.05});
}

TEST_F(PackageMachine, RunsAtOneKilohertz) { EXPECT_DOUBLE_EQ(config_.machine.period, 0.001); }

TEST_F(PackageMachine, HasJogVelocities) { expectAxes(config_.jog_velocity, {0.01, 0.01, 0.01, 0.5}); }

TEST_F(PackageMachine, HasAParkPosition) { expectAxes(config_.machine.park, {-0.05, 0.05, 0, 0}); }

TEST_F(PackageMachine, SwivelsSixtyDegreesToEitherSide) {
  constexpr double kSixtyDegrees = 1.04719755;
  EXPECT_NEAR(config_.machine.swivel.from, -kSixtyDegrees, 1e-7);
  EXPECT_NEAR(config_.machine.swivel.to, kSixtyDegrees, 1e-7);
}

TEST_F(PackageMachine, HasTimeouts) {
  EXPECT_EQ(config_.feedback_timeout, 0.002);
  EXPECT_EQ(config_.enable_timeout, 2);
  EXPECT_EQ(config_.homing_timeout, 60);
  EXPECT_EQ(config_.spindle_timeout, 10);
  EXPECT_EQ(config_.jog_timeout, 0.2);
  EXPECT_EQ(config_.machine.max_job_duration, 24 * 3600);
  EXPECT_EQ(config_.machine.collision_clearance, 0.001);
  EXPECT_EQ(config_.late_slow_down, 2);
  EXPECT_EQ(config_.late_fault, 10);
}

TEST_F(PackageMachine, HasAGeometry) {
  EXPECT_EQ(config_.geometry.work_axis_y, 0);
  EXPECT_EQ(config_.geometry.work_axis_z, 0);
  EXPECT_EQ(config_.geometry.collet_face, 0.062);
  EXPECT_EQ(config_.geometry.swivel_centre, Eigen::Vector3d(0, 0.055, 0));
  EXPECT_EQ(config_.geometry.flange, 0.0035);
  ASSERT_TRUE(config_.geometry.probe);
  EXPECT_EQ(config_.geometry.probe->centre, Eigen::Vector3d(0.06, -0.02, 0.03));
  EXPECT_EQ(config_.geometry.probe->diameter, 0.001);
}

TEST_F(PackageMachine, ProbesSlowlyThreeTimes) {
  expectAxes(config_.probing.velocity, {0.002, 0.002, 0.002, 0.1});
  expectAxes(config_.probing.back_off, {0.0005, 0.0005, 0.0005, 0.02});
  expectAxes(config_.probing.largest_spread, {5e-6, 5e-6, 5e-6, 5e-4});
  EXPECT_EQ(config_.probing.slow, 0.1);
  EXPECT_EQ(config_.probing.touches, 3);
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
  std::string swivel = joint("wheel_swivel", "revolute", limitOf("-0.7", "1.1", "0"));

  std::string urdf() const {
    return "<robot name=\"grinder\"><link name=\"base\"/>" + x + y + z + a + swivel + "</robot>";
  }
};

XmlRpcValue parameters() {
  XmlRpcValue p;
  p["control_rate"] = 500.0;
  p["feedback_timeout"] = 0.01;
  p["enable_timeout"] = 3.0;
  p["homing_timeout"] = 45.0;
  p["spindle_timeout"] = 7.5;
  p["jog_timeout"] = 0.3;
  p["max_job_duration"] = 7200.0;
  p["collision_clearance"] = 0.002;
  p["geometry"]["work_axis"]["y"] = 0.1;
  p["geometry"]["work_axis"]["z"] = -0.2;
  p["geometry"]["collet_face"]["x"] = 0.3;
  p["geometry"]["swivel_centre"]["x"] = 0.4;
  p["geometry"]["swivel_centre"]["y"] = 0.5;
  p["geometry"]["swivel_centre"]["z"] = 0.6;
  p["geometry"]["flange"] = -0.7;
  p["geometry"]["probe"]["x"] = 0.8;
  p["geometry"]["probe"]["y"] = 0.9;
  p["geometry"]["probe"]["z"] = 1.1;
  p["geometry"]["probe"]["diameter"] = 0.004;
  p["probing"]["slow"] = 0.25;
  p["probing"]["touches"] = 7;
  p["late_cycle"]["slow_down"] = 3.0;
  p["late_cycle"]["fault"] = 25.0;
  for (const char* name : kJointNames) {
    const int axis = name == std::string("axis_a") ? 4 : name[5] - 'x' + 1;
    XmlRpcValue& limits = p["joint_limits"][name];
    limits["has_acceleration_limits"] = true;
    limits["max_acceleration"] = 1 + 0.1 * axis;
    limits["has_jerk_limits"] = true;
    limits["max_jerk"] = 20 + 0.1 * axis;
    p["constraints"][name]["trajectory"] = 0.001 * axis;
    p["park_position"][name] = 0.01 * axis;
    p["jog_velocity"][name] = 0.02 * axis;
    p["probing"]["velocity"][name] = 0.03 * axis;
    p["probing"]["back_off"][name] = 0.04 * axis;
    p["probing"]["largest_spread"][name] = 0.05 * axis;
  }
  return p;
}

/// The parameter at a path, created if it is missing.
XmlRpcValue& at(XmlRpcValue& p, const std::string& path) {
  XmlRpcValue* value = &p;
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '/');) value = &(*value)[name];
  return *value;
}

/// A copy without the parameter at a path; XmlRpcValue cannot remove one.
XmlRpcValue without(XmlRpcValue p, const std::string& path) {
  XmlRpcValue copy;
  const std::string first = path.substr(0, path.find('/'));
  for (auto& item : p) {
    if (item.first != first) {
      copy[item.first] = item.second;
    } else if (path != first) {
      copy[item.first] = without(item.second, path.substr(first.size() + 1));
    }
  }
  return copy;
}

std::string errorOf(const std::string& urdf, const XmlRpcValue& p) {
  try {
    read(urdf, p);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

std::string errorOf(const XmlRpcValue& p) { return errorOf(Description().urdf(), p); }

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
  expectAxes(config.probing.largest_spread, {0.05 * 1, 0.05 * 2, 0.05 * 3, 0.05 * 4});
  EXPECT_EQ(config.probing.slow, 0.25);
  EXPECT_EQ(config.probing.touches, 7);
  EXPECT_EQ(config.late_slow_down, 3);
  EXPECT_EQ(config.late_fault, 25);
}

TEST(MachineConfig, ParameterLimitsGoOverTheUrdfs) {
  XmlRpcValue p = parameters();
  at(p, "joint_limits/axis_y/has_position_limits") = true;
  at(p, "joint_limits/axis_y/min_position") = -0.05;
  at(p, "joint_limits/axis_y/max_position") = 0.06;
  at(p, "joint_limits/axis_a/has_velocity_limits") = true;
  at(p, "joint_limits/axis_a/max_velocity") = 3.5;
  const AxisLimits limits = read(Description().urdf(), p).machine.limits;
  expectAxes(limits.min_position, {-0.11, -0.05, -0.13, -114});
  expectAxes(limits.max_position, {0.31, 0.06, 0.33, 134});
  expectAxes(limits.max_velocity, {0.21, 0.22, 0.23, 3.5});
}

TEST(MachineConfig, TakesWholeNumbersForNumbers) {
  XmlRpcValue p = parameters();
  at(p, "control_rate") = 250;
  at(p, "joint_limits/axis_z/max_jerk") = 7;
  at(p, "park_position/axis_a") = -2;
  const LoopConfig config = read(Description().urdf(), p);
  EXPECT_EQ(config.machine.period, 0.004);
  EXPECT_EQ(config.machine.limits.max_jerk[kZ], 7);
  EXPECT_EQ(config.machine.park[kA], -2);
}

TEST(MachineConfig, AMachineNeedsNoProbe) {
  const XmlRpcValue p = without(parameters(), "geometry/probe");
  EXPECT_FALSE(read(Description().urdf(), p).geometry.probe);
}

TEST(MachineConfig, TakesAParkPositionAtTheLimits) {
  XmlRpcValue p = parameters();
  at(p, "park_position/axis_x") = -0.11;
  at(p, "park_position/axis_y") = 0.32;
  expectAxes(read(Description().urdf(), p).machine.park, {-0.11, 0.32, 0.01 * 3, 0.01 * 4});
}

TEST(MachineConfig, TakesTheEndsOfTheRanges) {
  XmlRpcValue p = parameters();
  for (const double rate : {10.0, 20000.0}) {
    at(p, "control_rate") = rate;
    EXPECT_EQ(read(Description().urdf(), p).machine.period, 1 / rate);
  }
  at(p, "feedback_timeout") = 0.0;
  at(p, "enable_timeout") = 60.0;
  at(p, "homing_timeout") = 3600.0;
  at(p, "spindle_timeout") = 600.0;
  at(p, "jog_timeout") = 1.0;
  at(p, "jog_velocity/axis_x") = 0.21;
  const LoopConfig longest = read(Description().urdf(), p);
  EXPECT_EQ(longest.feedback_timeout, 0);
  EXPECT_EQ(longest.enable_timeout, 60);
  EXPECT_EQ(longest.homing_timeout, 3600);
  EXPECT_EQ(longest.spindle_timeout, 600);
  EXPECT_EQ(longest.jog_timeout, 1);
  EXPECT_EQ(longest.jog_velocity[kX], 0.21);
  at(p, "homing_timeout") = 0;
  at(p, "spindle_timeout") = 0;
  at(p, "jog_timeout") = 0.05;
  const LoopConfig shortest = read(Description().urdf(), p);
  EXPECT_EQ(shortest.homing_timeout, 0);
  EXPECT_EQ(shortest.spindle_timeout, 0);
  EXPECT_EQ(shortest.jog_timeout, 0.05);
}

// ---------------------------------------------------------------------------------------------------------------------
// Refused parameters: the error gives the full name and what is allowed

struct BadParameter {
  std::string name;
  std::function<void(XmlRpcValue&)> spoil;
  std::vector<std::string> words;
};
std::ostream& operator<<(std::ostream& out, const BadParameter& bad) { return out << bad.name; }

/// A required parameter.
struct Number {
  std::string path;
  std::string range;  ///< as a message states it
  bool zero_allowed;
  bool negative_allowed;
};

constexpr std::size_t kNumbersPerAxis = 8;
constexpr std::size_t kMachineNumbers = 23;  ///< that are no axis' own; they come first

std::vector<Number> numbers() {
  std::vector<Number> all{{"control_rate", "10 to 20000", false, false},
                          {"feedback_timeout", "0 to 10", true, false},
                          {"enable_timeout", "0 to 60", true, false},
                          {"homing_timeout", "0 to 3600", true, false},
                          {"spindle_timeout", "0 to 600", true, false},
                          {"max_job_duration", "1 to 1e+09", false, false},
                          {"collision_clearance", "0 to 1", true, false},
                          {"late_cycle/slow_down", "2 to 1e+09", false, false},
                          {"late_cycle/fault", "3 to 1e+09", false, false},
                          {"jog_timeout", "0.05 to 1", false, false},
                          {"probing/slow", "1e-09 to 1", false, false},
                          {"probing/touches", "2 to 100", false, false},
                          {"geometry/probe/diameter", "0.0001 to 0.02", false, false}};
  for (const char* place : {"work_axis/y", "work_axis/z", "collet_face/x", "swivel_centre/x", "swivel_centre/y",
                            "swivel_centre/z", "flange", "probe/x", "probe/y", "probe/z"}) {
    all.push_back({std::string("geometry/") + place, "-10 to 10", true, true});
  }
  const char* park[]{"-0.11 to 0.31", "-0.12 to 0.32", "-0.13 to 0.33", "-114 to 134"};
  const char* fastest[]{"0.21", "0.22", "0.23", "24"};
  for (std::size_t i = 0; i < kJointNames.size(); ++i) {
    const std::string name = kJointNames[i];
    all.push_back({"joint_limits/" + name + "/max_acceleration", "1e-09 to 1e+09", false, false});
    all.push_back({"joint_limits/" + name + "/max_jerk", "1e-09 to 1e+09", false, false});
    all.push_back({"constraints/" + name + "/trajectory", "1e-09 to 1e+09", false, false});
    all.push_back({"park_position/" + name, park[i], true, true});
    all.push_back({"jog_velocity/" + name, std::string("1e-09 to ") + fastest[i], false, false});
    all.push_back({"probing/velocity/" + name, std::string("1e-09 to ") + fastest[i], false, false});
    all.push_back({"probing/back_off/" + name, "1e-09 to 1", false, false});
    all.push_back({"probing/largest_spread/" + name, "1e-09 to 1", false, false});
  }
  return all;
}

std::string camel(const std::string& path) {
  std::string text;
  for (const char c : path) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return text;
}

std::vector<BadParameter> badParameters() {
  std::vector<BadParameter> rows;
  const auto add = [&](const std::string& what, const std::string& path, const XmlRpcValue& value,
                       std::vector<std::string> words) {
    rows.push_back({camel(path) + "_" + what, [=](XmlRpcValue& p) { at(p, path) = value; }, std::move(words)});
  };
  const auto remove = [&](const std::string& path, std::vector<std::string> words) {
    rows.push_back({camel(path) + "_missing", [=](XmlRpcValue& p) { p = without(p, path); }, std::move(words)});
  };

  for (const Number& n : numbers()) {
    const std::string full = "/grinder/" + n.path;
    const std::string range = "allowed: " + n.range;
    remove(n.path, {full + " is missing", "allowed: a number"});
    add("text", n.path, XmlRpcValue("0.1"), {full + " = ", "0.1", "allowed: a number"});
    add("bool", n.path, XmlRpcValue(true), {full + " = ", "allowed: a number"});
    add("nan", n.path, XmlRpcValue(kNan), {full + " = nan", range});
    add("infinite", n.path, XmlRpcValue(kInfinity), {full + " = inf", range});
    add("minus_infinite", n.path, XmlRpcValue(-kInfinity), {full + " = -inf", range});
    if (!n.zero_allowed) add("zero", n.path, XmlRpcValue(0.0), {full + " = 0", range});
    if (!n.negative_allowed) add("negative", n.path, XmlRpcValue(-0.5), {full + " = -0.5", range});
  }
  add("too_slow", "control_rate", XmlRpcValue(9.5), {"/grinder/control_rate = 9.5", "allowed: 10 to 20000"});
  add("too_fast", "control_rate", XmlRpcValue(20001), {"/grinder/control_rate = 20001", "allowed: 10 to 20000"});
  add("too_long", "feedback_timeout", XmlRpcValue(10.5), {"/grinder/feedback_timeout = 10.5", "allowed: 0 to 10"});
  add("too_long", "enable_timeout", XmlRpcValue(61), {"/grinder/enable_timeout = 61", "allowed: 0 to 60"});
  add("too_long", "homing_timeout", XmlRpcValue(3601), {"/grinder/homing_timeout = 3601", "allowed: 0 to 3600"});
  add("too_long", "spindle_timeout", XmlRpcValue(601), {"/grinder/spindle_timeout = 601", "allowed: 0 to 600"});
  add("too_short", "jog_timeout", XmlRpcValue(0.049), {"/grinder/jog_timeout = 0.049", "allowed: 0.05 to 1"});
  add("fraction", "probing/touches", XmlRpcValue(2.5), {"/grinder/probing/touches = 2.5", "allowed: a whole number"});
  add("beyond_the_limit", "jog_velocity/axis_a", XmlRpcValue(24.5),
      {"/grinder/jog_velocity/axis_a = 24.5", "allowed: 1e-09 to 24"});

  for (std::size_t i = 0; i < kJointNames.size(); ++i) {
    const std::string name = kJointNames[i];
    const std::string ns = "joint_limits/" + name + "/";
    const std::string full = "/grinder/" + ns;
    const std::string park = "park_position/" + name;
    const Number allowed = numbers()[kMachineNumbers + kNumbersPerAxis * i + 3];
    add("beyond", park, XmlRpcValue(135.0), {"/grinder/" + park + " = 135", "allowed: " + allowed.range});
    add("short_of", park, XmlRpcValue(-115.0), {"/grinder/" + park + " = -115", "allowed: " + allowed.range});

    for (const std::string kind : {"velocity", "acceleration", "jerk"}) {
      const std::string flag = ns + "has_" + kind + "_limits";
      const std::string value = ns + "max_" + kind;
      add("false", flag, XmlRpcValue(false), {"/grinder/" + flag + " = false", "allowed: true"});
      add("whole", flag, XmlRpcValue(1), {"/grinder/" + flag + " = ", "allowed: true or false"});
      add("text", flag, XmlRpcValue("true"), {"/grinder/" + flag + " = ", "allowed: true or false"});
      rows.push_back({camel(value) + "_without_flag",
                      [=](XmlRpcValue& p) {
                        p = without(p, flag);
                        at(p, value) = 1.0;
                      },
                      {"/grinder/" + flag + " is missing", "/grinder/" + value, "allowed: true"}});
      rows.push_back({camel(flag) + "_without_value",
                      [=](XmlRpcValue& p) {
                        p = without(p, value);
                        at(p, flag) = true;
                      },
                      {"/grinder/" + value + " is missing", "allowed: a number"}});
    }
    // The URDF has no such limits to fall back to.
    for (const std::string kind : {"acceleration", "jerk"}) {
      rows.push_back(
          {camel(ns + kind) + "_nowhere",
           [=](XmlRpcValue& p) { p = without(without(p, ns + "has_" + kind + "_limits"), ns + "max_" + kind); },
           {full + "has_" + kind + "_limits is missing", "robot_description", "allowed: true, with max_" + kind}});
    }
    rows.push_back({camel(ns) + "velocity_zero",
                    [=](XmlRpcValue& p) {
                      at(p, ns + "has_velocity_limits") = true;
                      at(p, ns + "max_velocity") = 0;
                    },
                    {full + "max_velocity = 0", "allowed: 1e-09 to 1e+09"}});

    const auto position = [=](double min, double max) {
      return [=](XmlRpcValue& p) {
        at(p, ns + "has_position_limits") = true;
        at(p, ns + "min_position") = min;
        at(p, ns + "max_position") = max;
      };
    };
    rows.push_back({camel(ns) + "min_above_max",
                    position(0.2, 0.1),
                    {"joint_limits/" + name + "/min_position", ": 0.2 to 0.1", "allowed: the lower below the upper"}});
    rows.push_back({camel(ns) + "min_is_max",
                    position(0.1, 0.1),
                    {"joint_limits/" + name + "/min_position", ": 0.1 to 0.1", "allowed: the lower below the upper"}});
    rows.push_back(
        {camel(ns) + "min_nan", position(kNan, 0.1), {full + "min_position = nan", "allowed: -1e+09 to 1e+09"}});
    rows.push_back({camel(ns) + "max_infinite",
                    position(-0.1, kInfinity),
                    {full + "max_position = inf", "allowed: -1e+09 to 1e+09"}});
    add("false", ns + "has_position_limits", XmlRpcValue(false),
        {full + "has_position_limits = false", "allowed: true"});
    for (const std::string bound : {"min_position", "max_position"}) {
      add("without_flag", ns + bound, XmlRpcValue(0.1),
          {full + "has_position_limits is missing", full + bound, "allowed: true"});
      rows.push_back({camel(ns) + "only_" + bound,
                      [=](XmlRpcValue& p) {
                        at(p, ns + "has_position_limits") = true;
                        at(p, ns + bound) = 0.1;
                      },
                      {full + (bound[1] == 'i' ? "max" : "min") + "_position is missing", "allowed: a number"}});
    }
  }
  remove("joint_limits", {"/grinder/joint_limits/axis_x/has_acceleration_limits is missing"});
  add("number", "joint_limits", XmlRpcValue(1), {"/grinder/joint_limits/axis_x/has_acceleration_limits is missing"});
  remove("constraints", {"/grinder/constraints/axis_x/trajectory is missing"});
  add("number", "constraints/axis_x", XmlRpcValue(0.001), {"/grinder/constraints/axis_x/trajectory is missing"});
  remove("park_position", {"/grinder/park_position/axis_x is missing"});
  remove("jog_velocity", {"/grinder/jog_velocity/axis_x is missing"});
  rows.push_back({"Nothing", [](XmlRpcValue& p) { p = XmlRpcValue(); }, {"/grinder/control_rate is missing"}});
  return rows;
}

class RefusedParameters : public TestWithParam<BadParameter> {};

TEST_P(RefusedParameters, AreNamedInFullWithWhatIsAllowed) {
  XmlRpcValue p = parameters();
  GetParam().spoil(p);
  const std::string error = errorOf(p);
  ASSERT_FALSE(error.empty()) << "taken";
  for (const std::string& word : GetParam().words)
    EXPECT_NE(error.find(word), std::string::npos) << error << "\n" << word;
}

INSTANTIATE_TEST_SUITE_P(, RefusedParameters, ValuesIn(badParameters()),
                         [](const TestParamInfo<BadParameter>& info) { return info.param.name; });

// ---------------------------------------------------------------------------------------------------------------------
// Refused robot descriptions

struct BadDescription {
  const char* name;
  std::function<std::string()> urdf;
  std::vector<std::string> words;
};
std::ostream& operator<<(std::ostream& out, const BadDescription& bad) { return out << bad.name; }

std::vector<BadDescription> badDescriptions() {
  const auto with = [](std::string Description::*which, const std::string& text) {
    return [=] {
      Description description;
      description.*which = text;
      return description.urdf();
    };
  };
  const std::string good = limitOf("-1", "1", "1");
  return {
      {"NotXml", [] { return std::string("this is no XML"); }, {"robot_description is not a URDF"}},
      {"Empty", [] { return std::string(); }, {"robot_description is not a URDF"}},
      {"CutShort", [] { return Description().urdf().substr(0, 200); }, {"robot_description is not a URDF"}},
      {"NoX", with(&Description::x, ""), {"robot_description has no joint axis_x"}},
      {"NoY", with(&Description::y, ""), {"robot_description has no joint axis_y"}},
      {"NoZ", with(&Description::z, ""), {"robot_description has no joint axis_z"}},
      {"NoA", with(&Description::a, ""), {"robot_description has no joint axis_a"}},
      {"NoSwivel", with(&Description::swivel, ""), {"robot_description has no joint wheel_swivel"}},
      {"ContinuousSwivel",
       with(&Description::swivel, joint("wheel_swivel", "continuous", "")),
       {"wheel_swivel", "revolute, with limits"}},
      {"SwivelReversed",
       with(&Description::swivel, joint("wheel_swivel", "revolute", limitOf("0.5", "-0.5", "0"))),
       {"wheel_swivel", "0.5 to -0.5 rad", "the lower below the upper"}},
      {"SwivelTooFar",
       with(&Description::swivel, joint("wheel_swivel", "revolute", limitOf("-1.6", "1", "0"))),
       {"wheel_swivel", "-1.6 to 1 rad", "within -pi/2 to pi/2"}},
      {"RevoluteX", with(&Description::x, joint("axis_x", "revolute", good)), {"axis_x", "prismatic"}},
      {"FixedY", with(&Description::y, joint("axis_y", "fixed", "")), {"axis_y", "prismatic"}},
      {"ContinuousA",
       with(&Description::a, joint("axis_a", "continuous", "")),
       {"axis_a", "revolute", "several turns"}},
      {"PrismaticA", with(&Description::a, joint("axis_a", "prismatic", good)), {"axis_a", "revolute"}},
      {"LowerAboveUpper",
       with(&Description::z, joint("axis_z", "prismatic", limitOf("0.3", "0.1", "1"))),
       {"axis_z", "robot_description): 0.3 to 0.1", "allowed: the lower below the upper"}},
      {"NoPositions",
       with(&Description::a, joint("axis_a", "revolute", "<limit velocity=\"1\" effort=\"1\"/>")),
       {"axis_a", "robot_description): 0 to 0"}},
      {"VelocityZero",
       with(&Description::x, joint("axis_x", "prismatic", limitOf("-1", "1", "0"))),
       {"/grinder/joint_limits/axis_x/has_velocity_limits is missing", "robot_description", "with max_velocity"}},
      {"VelocityNegative",
       with(&Description::x, joint("axis_x", "prismatic", limitOf("-1", "1", "-2"))),
       {"/grinder/joint_limits/axis_x/has_velocity_limits is missing", "robot_description", "with max_velocity"}},
  };
}

class RefusedDescription : public TestWithParam<BadDescription> {};

TEST_P(RefusedDescription, IsNamedWithWhatIsAllowed) {
  const std::string error = errorOf(GetParam().urdf(), parameters());
  ASSERT_FALSE(error.empty()) << "taken";
  for (const std::string& word : GetParam().words)
    EXPECT_NE(error.find(word), std::string::npos) << error << "\n" << word;
}

INSTANTIATE_TEST_SUITE_P(, RefusedDescription, ValuesIn(badDescriptions()),
                         [](const TestParamInfo<BadDescription>& info) { return std::string(info.param.name); });

// Whether or not the URDF reader accepts such a number, the machine must not get it as a limit.
class NotFiniteInTheUrdf : public TestWithParam<const char*> {};

TEST_P(NotFiniteInTheUrdf, IsNoPositionLimit) {
  Description description;
  description.x = joint("axis_x", "prismatic", limitOf("-1", GetParam(), "1"));
  EXPECT_NE(errorOf(description.urdf(), parameters()), "") << "upper";
  description.x = joint("axis_x", "prismatic", limitOf(GetParam(), "1", "1"));
  EXPECT_NE(errorOf(description.urdf(), parameters()), "") << "lower";
}

TEST_P(NotFiniteInTheUrdf, IsNoVelocityLimit) {
  Description description;
  description.x = joint("axis_x", "prismatic", limitOf("-1", "1", GetParam()));
  EXPECT_NE(errorOf(description.urdf(), parameters()), "");
}

INSTANTIATE_TEST_SUITE_P(, NotFiniteInTheUrdf, ::testing::Values("nan", "inf", "-inf", "1e999"),
                         [](const TestParamInfo<const char*>& info) {
                           const std::string text = info.param;
                           return text[0] == '-' ? "minus_inf" : text;
                         });

// ---------------------------------------------------------------------------------------------------------------------
// The reader

XmlRpcValue nested() {
  XmlRpcValue p;
  p["a"]["b"]["number"] = 2.5;
  p["a"]["flag"] = false;
  p["a"]["text"] = "word";
  p["a"]["empty"] = "";
  return p;
}

std::string readerError(const std::function<void(const ParameterReader&)>& use) {
  try {
    use(ParameterReader(nested(), "/ns"));
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

TEST(ParameterReader, FindsWhatIsNested) {
  const ParameterReader reader(nested(), "/ns");
  EXPECT_EQ(reader.number("a/b/number", 0, 10), 2.5);
  EXPECT_FALSE(reader.flag("a/flag"));
  EXPECT_EQ(reader.text("a/text"), "word");
}

TEST(ParameterReader, KnowsWhatIsThere) {
  const ParameterReader reader(nested(), "/ns");
  EXPECT_TRUE(reader.has("a/b/number"));
  EXPECT_TRUE(reader.has("a/b"));
  EXPECT_FALSE(reader.has("b"));
  EXPECT_FALSE(reader.has("a/number"));
  EXPECT_FALSE(reader.has("a/text/word")) << "below what is no struct";
}

TEST(ParameterReader, LeavesTheParametersAsTheyAre) {
  XmlRpcValue p = nested();
  const ParameterReader reader(p, "/ns");
  reader.has("a/b/other");
  reader.number("a/b/number", 0, 10);
  EXPECT_TRUE(p == nested());
  EXPECT_FALSE(reader.has("a/b/other")) << "made by looking for it";
}

TEST(ParameterReader, TakesBothEndsOfTheRange) {
  const ParameterReader reader(nested(), "/ns");
  EXPECT_EQ(reader.number("a/b/number", 2.5, 3), 2.5);
  EXPECT_EQ(reader.number("a/b/number", 2, 2.5), 2.5);
}

TEST(ParameterReader, TellsTheNameTheValueAndTheRange) {
  EXPECT_EQ(readerError([](const ParameterReader& r) { r.number("a/b/number", 3, 4); }),
            "parameter /ns/a/b/number = 2.5; allowed: 3 to 4");
}

TEST(ParameterReader, RefusesAnEmptyText) {
  EXPECT_NE(readerError([](const ParameterReader& r) { r.text("a/empty"); }).find("/ns/a/empty"), std::string::npos);
}

TEST(ParameterReader, RefusesANumberForAText) {
  EXPECT_NE(readerError([](const ParameterReader& r) { r.text("a/b/number"); }).find("/ns/a/b/number = "),
            std::string::npos);
}

TEST(ParameterReader, RefusesAMissingText) {
  EXPECT_EQ(readerError([](const ParameterReader& r) { r.text("a/other"); }),
            "parameter /ns/a/other is missing; allowed: a text");
}

TEST(ParameterReader, RefusesAStructForANumber) {
  EXPECT_NE(readerError([](const ParameterReader& r) { r.number("a/b", 0, 1); }).find("/ns/a/b = "), std::string::npos);
}

}  // namespace test_machine_config
}  // namespace flute_grinder
