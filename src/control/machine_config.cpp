#include "flute_grinder/control/machine_config.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/motion/work_offsets.h"

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
  About about_flag, about;
};
constexpr const char* kOfUrdf = "robot_description";
constexpr LimitName kVelocity{"has_velocity_limits",
                              "max_velocity",
                              {"with the next one; overrides the limit in `robot_description`", "", kOfUrdf, "true"},
                              {"limit at every setpoint", "m/s, rad/s", kOfUrdf}};
constexpr LimitName kAcceleration{"has_acceleration_limits",
                                  "max_acceleration",
                                  {"with the next one", "", nullptr, "true"},
                                  {"limit between pair ends", "m/s^2, rad/s^2"}};
constexpr LimitName kJerk{"has_jerk_limits",
                          "max_jerk",
                          {"with the next one", "", nullptr, "true"},
                          {"limit between pair ends", "m/s^3, rad/s^3"}};

/// Whether the parameters contain a limit; an incomplete or disabled limit is an error.
bool states(const ParameterReader& p, const std::string& joint, const char* flag, const About& about,
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
  if (!p.flag(ns + flag, about)) {
    throw ParameterError("parameter " + p.name(ns + flag) +
                         " = false; allowed: true, since every axis needs this limit");
  }
  return true;
}

double limit(const ParameterReader& p, const std::string& joint, const LimitName& name, double from_urdf) {
  if (states(p, joint, name.flag, name.about_flag, {name.value})) {
    return p.number("joint_limits/" + joint + "/" + name.value, kMin, kMax, name.about);
  }
  if (from_urdf > 0) return from_urdf;
  throw ParameterError("parameter " + p.name("joint_limits/" + joint + "/" + name.flag) +
                       " is missing, and robot_description has no such limit; allowed: true, with " + name.value);
}

constexpr const char* kUpToMaxVelocity = "1e-09 to `joint_limits/<joint>/max_velocity`";

void readProbing(const ParameterReader& p, const std::string& joint, int axis, LoopConfig& config) {
  const auto value = [&](const char* what, double max, const About& about) {
    return p.number(std::string("probing/") + what + "/" + joint, kMin, max, about);
  };
  ProbingConfig& probing = config.probing;
  probing.velocity[axis] =
      value("velocity", config.machine.limits.max_velocity[axis],
            {"speed of the first touch of a probing move", "m/s, rad/s", nullptr, kUpToMaxVelocity});
  probing.back_off[axis] =
      value("back_off", 1, {"distance off the surface between the touches, and at the end", "m, rad"});
  probing.max_spread[axis] = value(
      "max_spread", 1, {"allowed spread of the touches that count; a probing move with a larger one fails", "m, rad"});
}

void readAxis(const MachineModel& model, const ParameterReader& p, int axis, LoopConfig& config) {
  const urdf::Joint& joint = model.joint(kJointNames[static_cast<std::size_t>(axis)]);
  const std::string name = joint.name;
  const std::string ns = "joint_limits/" + name + "/";
  AxisLimits& limits = config.machine.limits;

  if (states(p, name, "has_position_limits",
             {"with the next two; overrides the limits in `robot_description`", "", kOfUrdf, "true"},
             {"min_position", "max_position"})) {
    limits.min_position[axis] = p.number(ns + "min_position", -kMax, kMax, {"below `max_position`", "m, rad", kOfUrdf});
    limits.max_position[axis] = p.number(ns + "max_position", -kMax, kMax, {"above `min_position`", "m, rad", kOfUrdf});
  } else {
    limits.min_position[axis] = joint.limits->lower;
    limits.max_position[axis] = joint.limits->upper;
  }
  if (!(limits.min_position[axis] < limits.max_position[axis])) {
    throw ParameterError("parameters " + p.name(ns + "min_position") +
                         format(", max_position (or the limits of robot_description): %g to %g %s; allowed: the lower "
                                "below the upper",
                                limits.min_position[axis], limits.max_position[axis], axisUnit(axis)));
  }
  limits.max_velocity[axis] = limit(p, name, kVelocity, joint.limits->velocity);
  limits.max_acceleration[axis] = limit(p, name, kAcceleration, 0);
  limits.max_jerk[axis] = limit(p, name, kJerk, 0);
  config.following_error[axis] = p.number("constraints/" + name + "/trajectory", kMin, kMax,
                                          {"maximum following error, command - position", "m, rad"});
  config.jog_velocity[axis] = p.number("jog_velocity/" + name, kMin, limits.max_velocity[axis],
                                       {"speed of a jog that names none", "m/s, rad/s", nullptr, kUpToMaxVelocity});
  readProbing(p, name, axis, config);
  config.machine.park[axis] = p.number("park_position/" + name, limits.min_position[axis], limits.max_position[axis],
                                       {"position at the end of a job, clear of the work", "m, rad", nullptr,
                                        "`joint_limits/<joint>/min_position` to `joint_limits/<joint>/max_position`"});
}

/// @param about of the lower limit. @param up_to of the upper one, which is at least the lower.
DiagnosticLevels readLevels(const ParameterReader& p, const std::string& quantity, double max, const char* about,
                            const char* up_to) {
  const std::string ns = "diagnostics/" + quantity + "/";
  const double warn = p.number(ns + "warn", 0, max, {about});
  return {warn, p.number(ns + "error", warn, max, {"above it, an error", "", nullptr, up_to})};
}

DiagnosticThresholds readDiagnosticThresholds(const ParameterReader& p) {
  DiagnosticThresholds thresholds;
  thresholds.late_cycles =
      readLevels(p, "late_cycles", 1, "fraction of all cycles that are late; above it, `/diagnostics` shows a warning",
                 "`diagnostics/late_cycles/warn` to 1");
  thresholds.following_error =
      readLevels(p, "following_error", 1, "fraction of `constraints/<joint>/trajectory`; above it, a warning",
                 "`diagnostics/following_error/warn` to 1");
  thresholds.limit_use = readLevels(p, "limit_use", 2, "fraction of an axis limit; above it, a warning",
                                    "`diagnostics/limit_use/warn` to 2");
  const double warn =
      p.number("diagnostics/buffer_fill/warn", 0, 1, {"fraction of a full buffer; below it, a warning"});
  thresholds.buffer_fill = {warn, p.number("diagnostics/buffer_fill/error", 0, warn,
                                           {"below it, an error", "", nullptr, "0 to `diagnostics/buffer_fill/warn`"})};
  return thresholds;
}

FirstView readFirstView(const ParameterReader& p) {
  FirstView view;
  view.wheel_diameter = p.number("first_view/wheel_diameter", 1e-3, 0.5,
                                 {"diameter of the straight wheel that rviz shows until there is a job", "m"});
  view.wheel_width = p.number("first_view/wheel_width", 1e-4, 0.1, {"width of that wheel", "m"});
  view.blank_diameter = p.number("first_view/blank_diameter", 1e-4, 0.2,
                                 {"diameter of the round blank that rviz shows until there is a job", "m"});
  view.blank_length =
      p.number("first_view/blank_length", 1e-4, 1, {"length of that blank, from its end face into the collet", "m"});
  return view;
}

}  // namespace

MachineGeometry readMachineGeometry(const ParameterReader& p) {
  constexpr double max = 10;
  const auto place = [&](const char* name, const char* meaning, const char* omitted = nullptr) {
    return p.number(std::string("geometry/") + name, -max, max, {meaning, "m", omitted});
  };
  MachineGeometry geometry;
  geometry.work_axis_y = place("work_axis/y", "Y of the work spindle's axis in machine coordinates");
  geometry.work_axis_z = place("work_axis/z", "Z of the work spindle's axis in machine coordinates");
  geometry.collet_face = place("collet_face/x", "X of the collet's face in machine coordinates, axis X at zero");
  geometry.swivel_centre = {
      place(
          "swivel_centre/x",
          "X of the point where the axes of swivel and wheel spindle cross, in machine coordinates, all axes at zero"),
      place("swivel_centre/y", "Y of that point"), place("swivel_centre/z", "Z of that point")};
  geometry.flange =
      place("flange",
            "distance from the swivel's centre along the wheel's spindle, up at swivel 0, to the face of the "
            "flange that the wheel's upper face lies on");
  if (p.has("geometry/probe")) {
    const char* none = "no probe";
    geometry.probe.emplace();
    geometry.probe->centre = {
        place("probe/x",
              "X of the centre of the measuring probe's ball, swung in, in machine coordinates, all "
              "axes at zero",
              none),
        place("probe/y", "Y of that centre", none), place("probe/z", "Z of that centre", none)};
    geometry.probe->diameter =
        p.number("geometry/probe/diameter", kMinBall, kMaxBall, {"diameter of the ball", "m", none});
  }
  return geometry;
}

LoopConfig readLoopConfig(const MachineModel& model, const ParameterReader& p) {
  LoopConfig config;
  config.name = model.urdf().getName();
  config.machine.period = 1 / p.number("control_rate", 10, 20000, {"one setpoint per cycle", "Hz"});
  config.feedback_timeout =
      p.number("feedback_timeout", 0, 10, {"longest time without fresh positions before the machine stops", "s"});
  config.enable_timeout = p.number("enable_timeout", 0, 60, {"longest time from the enable command to power", "s"});
  config.homing_timeout = p.number("homing_timeout", 0, 3600, {"longest time that homing may take", "s"});
  config.spindle_timeout =
      p.number("spindle_timeout", 0, 600, {"longest time from a job's start to spindle at speed and coolant on", "s"});
  config.machine.max_job_duration = p.number("max_job_duration", 1, kMax, {"longest job accepted", "s"});
  config.machine.collision_clearance = p.number("collision_clearance", 0, 1,
                                                {"minimum distance of wheel, spindle and column from work head, "
                                                 "collet, shank, table and bed; a job that comes closer is refused",
                                                 "m"});
  config.jog_timeout = p.number("jog_timeout", kMinJogTimeout, 1,
                                {"longest time between the messages of a continuous jog; then the axis stops", "s"});
  config.geometry = readMachineGeometry(p);
  config.probing.slow =
      p.number("probing/slow", kMin, 1, {"speed of the touches that count, of `probing/velocity`", "fraction"});
  // A spread needs two touches.
  config.probing.touches = p.whole("probing/touches", 2, 100, {"number of the touches that count"});
  config.late_slow_down =
      p.number("late_cycle/slow_down", 2, kMax,
               {"time since the previous cycle; from there on, moving axes accelerate again, unless the drive has "
                "buffered commands. A second of cycles that take 0.8 of it on average is a fault",
                "control periods", nullptr, "2 to `late_cycle/fault`"});
  config.late_fault = p.number("late_cycle/fault", config.late_slow_down, kMax,
                               {"time since the previous cycle; beyond it, moving axes are stopped with a fault, "
                                "unless the drive has buffered commands",
                                "control periods", nullptr, "`late_cycle/slow_down` to 1e+09"});
  for (int axis = 0; axis < kAxisCount; ++axis) readAxis(model, p, axis, config);
  config.machine.swivel = model.swivel();
  return config;
}

MachineConfig readMachineConfig(const MachineModel& model, const ParameterReader& p, const std::string& drives) {
  MachineConfig config;
  config.loop = readLoopConfig(model, p);
  config.history_limit = static_cast<std::uint64_t>(p.number(
      "history_limit", 0, kMaxHistory,
      {"maximum size of all records in the folder; the oldest are removed first, and the newest is always kept",
       "bytes"}));
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    config.offset_change_limit[axis] =
        p.number("offset_change_limit/" + joint, 0, 2 * kMaxOffset,
                 {"by which a work offset that was set may change without a confirmation", "m, rad"});
  }
  config.thresholds = readDiagnosticThresholds(p);
  config.first_view = readFirstView(p);
  config.drive =
      p.text("hardware/type", drives,
             {"the drive plugin; all other keys under `hardware/` belong to the plugin", "", nullptr, "a text"});
  p.refuseUnknown(
      {"hardware", "journal", "offsets", "history", "tolerances", "configuration", "recorder", "diagnostic_period"});
  return config;
}

}  // namespace grinder
