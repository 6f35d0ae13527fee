#include "drive/ros_control_parameters.h"

namespace grinder {

namespace {

std::string signal(const ParameterReader& p, const std::string& name) {
  return p.text("signals/" + name, "always, never, or a topic of std_msgs/Bool");
}

std::string signal(const ParameterReader& p, const std::string& name, const char* unstated) {
  return p.has("signals/" + name) ? signal(p, name) : unstated;
}

CommandSink sink(const ParameterReader& p, const std::string& name) {
  const std::string ns = "commands/" + name;
  CommandSink sink;
  if (p.has(ns + "/service")) sink.service = p.text(ns + "/service");
  if (p.has(ns + "/topic")) sink.topic = p.text(ns + "/topic");
  if (p.has(ns) && sink.service.empty() == sink.topic.empty()) {
    throw ParameterError("parameter " + p.name(ns) + "; allowed: either a service or a topic");
  }
  return sink;
}

/// The required command for power: without one a stop leaves the drives energised, unless the RobotHW itself switches
/// them off.
CommandSink power(const ParameterReader& p) {
  if (p.has("commands/power/service") || p.has("commands/power/topic")) return sink(p, "power");
  const std::string what = "a service, a topic, or none";
  const std::string stated = p.text("commands/power", what);
  if (stated == "none") return {};
  throw ParameterError("parameter " + p.name("commands/power") + " = " + stated + "; allowed: " + what);
}

/// The sink of a command that cannot be switched off.
CommandSink service(const ParameterReader& p, const std::string& name) {
  const CommandSink found = sink(p, name);
  if (found.topic.empty()) return found;
  throw ParameterError("parameter " + p.name("commands/" + name) + "/topic; allowed: a service of std_srvs/Trigger");
}

}  // namespace

RosControlParameters readRosControlParameters(const ParameterReader& p) {
  RosControlParameters r;
  r.robot_hw = p.text("robot_hw/type");
  for (std::size_t i = 0; i < r.joints.size(); ++i) {
    const std::string name = std::string("joints/") + kJointNames[i];
    r.joints[i] = p.has(name) ? p.text(name) : kJointNames[i];
  }
  const std::string clocks = "monotonic or read";
  const std::string clock = p.text("clock", clocks);
  r.read_is_clock = clock == "read";
  if (!r.read_is_clock && clock != "monotonic") {
    throw ParameterError("parameter " + p.name("clock") + " = " + clock + "; allowed: " + clocks);
  }
  r.signals.emergency_stop = signal(p, "emergency_stop");
  r.signals.homed = signal(p, "homed");
  r.signals.spindle_at_speed = signal(p, "spindle_at_speed");
  r.signals.coolant_on = signal(p, "coolant_on");
  r.signals.enabled = signal(p, "enabled", "always");
  r.signals.fault = signal(p, "fault", "never");
  r.signals.probe_free = signal(p, "probe_free", "always");
  r.signals.probe_contact = signal(p, "probe_contact", "never");
  r.signal_timeout = p.number("signal_timeout", 0, 60);
  r.commands.power = power(p);
  r.commands.spindle = sink(p, "spindle");
  r.commands.coolant = sink(p, "coolant");
  r.commands.home = service(p, "home");
  r.commands.reset = service(p, "reset");
  p.refuseUnknown({"type", "robot_hw"});
  return r;
}

}  // namespace grinder
