#include "flute_grinder/record/machine_info.h"

#include "flute_grinder/control/loop_config.h"

namespace flute_grinder {

core::MachineInfo machineInfo(const LoopConfig& config, const std::string& drive) {
  const AxisLimits& limits = config.machine.limits;
  return {config.name,           FLUTE_GRINDER_VERSION, drive,
          config.machine.period, limits.max_velocity,   limits.max_acceleration,
          config.following_error};
}

}  // namespace flute_grinder
