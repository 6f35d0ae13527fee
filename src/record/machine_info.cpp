#include "flute_grinder/record/machine_info.h"

#include "flute_grinder/control/loop_config.h"

namespace grinder {

MachineInfo machineInfo(const LoopConfig& config, const std::string& drive) {
  const AxisLimits& limits = config.machine.limits;
  return {config.name,           FLUTE_GRINDER_VERSION, drive,
          config.machine.period, limits.max_velocity,   limits.max_acceleration,
          config.following_error};
}

Json toJson(const MachineInfo& machine) {
  return {{"name", machine.name},
          {"software", machine.version},
          {"drive", machine.drive},
          {"period_ms", machine.period * 1e3},
          {"max_velocity", toJson(machine.max_velocity, "_s")},
          {"max_acceleration", toJson(machine.max_acceleration, "_s2")},
          {"max_following_error", toJson(machine.max_following_error, "")}};
}

}  // namespace grinder
