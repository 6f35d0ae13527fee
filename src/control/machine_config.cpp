#include "flute_grinder/control/machine_config.h"

#include "flute_grinder/motion/work_offsets.h"

#include <cmath>
#include <sstream>

namespace grinder {

namespace {

constexpr double kMin = kMinFigure;
constexpr double kMax = kMaxFigure;
/// Twice the period at which the panel repeats its messages [s].
constexpr double kMinJogTimeout = 0.05;
constexpr double kMaxHistory = 1e12;                ///< largest history_limit [bytes]
constexpr double kMinBall = 1e-4, kMaxBall = 0.02;  ///< diameter of a probe's ball [m]

/// One kind of limit, with its names in ros_control.
struct LimitName {
  const char* flag;
  const char* value;
};
constexpr LimitName kVelocity{"has_velocity_limits", "max_velocity"};
constexpr LimitName kAcceleration{"has_acceleration_limits", "max_acceleration"};
constexpr LimitName kJerk{"has_jerk_limits", "max_jerk"};

/// Whether the parameters contain a limit; an incomplete or disabled limit is an error.
bool states(const ParameterReader& p, const std::string& joint, const char* flag,
            std::initializer_list<const char*> values) {
  const std::string ns = "joint_limits/" + joint + "/";
  if (!p.has(ns + flag)) {
    for (const char* value : values) {
      if (p.has(ns + value)) {
        throw ParameterError("parameter " + p.name(ns + flag) + " is missing, though " + p.name(ns + value) +
                             " is there; allowed: true beside it");
      }
    }
    return false;
  }
  if (!p.flag(ns + flag)) {
    throw ParameterError("parameter " + p.name(ns + flag) +
                         " = false; allowed: true, since every axis needs this limit");
  }
  return true;
}

double limit(const ParameterReader& p, const std::string& joint, const LimitName& name, double from_urdf) {
  if (states(p, joint, name.flag, {name.value})) {
    return p.number("joint_limits/" + joint + "/" + name.value, kMin, kMax);
  }
  if (from_urdf > 0 && std::isfinite(from_urdf)) return from_urdf;
  throw ParameterError("parameter " + p.name("joint_limits/" + joint + "/" + name.flag) +
                       " is missing, and robot_description has no such limit; allowed: true, with " + name.value);
}

void readProbing(const ParameterReader& p, const std::string& joint, int axis, LoopConfig& config) {
  const auto value = [&](const char* what, double max) {
    return p.number(std::string("probing/") + what + "/" + joint, kMin, max);
  };
  ProbingConfig& probing = config.probing;
  probing.velocity[axis] = value("velocity", config.machine.limits.max_velocity[axis]);
  probing.back_off[axis] = value("back_off", 1);
  probing.max_spread[axis] = value("max_spread", 1);
}

void readAxis(const MachineModel& model, const ParameterReader& p, int axis, LoopConfig& config) {
  const urdf::Joint& joint = model.joint(kJointNames[static_cast<std::size_t>(axis)]);
  const std::string name = joint.name;
  const std::string ns = "joint_limits/" + name + "/";
  AxisLimits& limits = config.machine.limits;

  if (states(p, name, "has_position_limits", {"min_position", "max_position"})) {
    limits.min_position[axis] = p.number(ns + "min_position", -kMax, kMax);
    limits.max_position[axis] = p.number(ns + "max_position", -kMax, kMax);
  } else {
    limits.min_position[axis] = joint.limits->lower;
    limits.max_position[axis] = joint.limits->upper;
  }
  if (!(limits.min_position[axis] < limits.max_position[axis])) {
    std::ostringstream text;
    text << "parameters " << p.name(ns + "min_position")
         << ", max_position (or the limits of robot_description): " << limits.min_position[axis] << " to "
         << limits.max_position[axis] << " " << axisUnit(axis) << "; allowed: the lower below the upper";
    throw ParameterError(text.str());
  }
  limits.max_velocity[axis] = limit(p, name, kVelocity, joint.limits->velocity);
  limits.max_acceleration[axis] = limit(p, name, kAcceleration, 0);
  limits.max_jerk[axis] = limit(p, name, kJerk, 0);
  config.following_error[axis] = p.number("constraints/" + name + "/trajectory", kMin, kMax);
  config.jog_velocity[axis] = p.number("jog_velocity/" + name, kMin, limits.max_velocity[axis]);
  readProbing(p, name, axis, config);
  config.machine.park[axis] = p.number("park_position/" + name, limits.min_position[axis], limits.max_position[axis]);
}

DiagnosticLevels readLevels(const ParameterReader& p, const std::string& quantity, double max) {
  const std::string ns = "diagnostics/" + quantity + "/";
  const double warn = p.number(ns + "warn", 0, max);
  return {warn, p.number(ns + "error", warn, max)};
}

DiagnosticThresholds readDiagnosticThresholds(const ParameterReader& parameters) {
  DiagnosticThresholds thresholds;
  thresholds.late_cycles = readLevels(parameters, "late_cycles", 1);
  thresholds.following_error = readLevels(parameters, "following_error", 1);
  thresholds.limit_use = readLevels(parameters, "limit_use", 2);
  const double warn = parameters.number("diagnostics/buffer_fill/warn", 0, 1);
  thresholds.buffer_fill = {warn, parameters.number("diagnostics/buffer_fill/error", 0, warn)};
  return thresholds;
}

FirstView readFirstView(const ParameterReader& p) {
  FirstView view;
  view.wheel_diameter = p.number("first_view/wheel_diameter", 1e-3, 0.5);
  view.wheel_width = p.number("first_view/wheel_width", 1e-4, 0.1);
  view.blank_diameter = p.number("first_view/blank_diameter", 1e-4, 0.2);
  view.blank_length = p.number("first_view/blank_length", 1e-4, 1);
  return view;
}

}  // namespace

MachineGeometry readMachineGeometry(const ParameterReader& p) {
  constexpr double max = 10;
  const auto place = [&](const char* name) { return p.number(std::string("geometry/") + name, -max, max); };
  MachineGeometry geometry;
  geometry.work_axis_y = place("work_axis/y");
  geometry.work_axis_z = place("work_axis/z");
  geometry.collet_face = place("collet_face/x");
  geometry.swivel_centre = {place("swivel_centre/x"), place("swivel_centre/y"), place("swivel_centre/z")};
  geometry.flange = place("flange");
  if (p.has("geometry/probe")) {
    geometry.probe.emplace();
    geometry.probe->centre = {place("probe/x"), place("probe/y"), place("probe/z")};
    geometry.probe->diameter = p.number("geometry/probe/diameter", kMinBall, kMaxBall);
  }
  return geometry;
}

LoopConfig readLoopConfig(const MachineModel& model, const ParameterReader& p) {
  LoopConfig config;
  config.name = model.urdf().getName();
  config.machine.period = 1 / p.number("control_rate", 10, 20000);
  config.feedback_timeout = p.number("feedback_timeout", 0, 10);
  config.enable_timeout = p.number("enable_timeout", 0, 60);
  config.homing_timeout = p.number("homing_timeout", 0, 3600);
  config.spindle_timeout = p.number("spindle_timeout", 0, 600);
  config.machine.max_job_duration = p.number("max_job_duration", 1, kMax);
  config.machine.collision_clearance = p.number("collision_clearance", 0, 1);
  config.jog_timeout = p.number("jog_timeout", kMinJogTimeout, 1);
  config.geometry = readMachineGeometry(p);
  config.probing.slow = p.number("probing/slow", kMin, 1);
  // A spread needs two touches.
  config.probing.touches = p.whole("probing/touches", 2, 100);
  config.late_slow_down = p.number("late_cycle/slow_down", 2, kMax);
  config.late_fault = p.number("late_cycle/fault", config.late_slow_down, kMax);
  for (int axis = 0; axis < kAxisCount; ++axis) readAxis(model, p, axis, config);
  config.machine.swivel = model.swivel();
  return config;
}

MachineConfig readMachineConfig(const MachineModel& model, const ParameterReader& p, const std::string& drives) {
  MachineConfig config;
  config.loop = readLoopConfig(model, p);
  config.history_limit = static_cast<std::uint64_t>(p.number("history_limit", 0, kMaxHistory));
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    config.offset_change_limit[axis] = p.number("offset_change_limit/" + joint, 0, 2 * kMaxOffset);
  }
  config.thresholds = readDiagnosticThresholds(p);
  config.first_view = readFirstView(p);
  config.drive = p.text("hardware/type", drives);
  p.refuseUnknown(
      {"hardware", "journal", "offsets", "history", "tolerances", "configuration", "recorder", "diagnostic_period"});
  return config;
}

}  // namespace grinder
