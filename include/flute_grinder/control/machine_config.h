#pragma once

#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/machine/machine_model.h"

namespace grinder {

/// Reads the machine data: limits from the URDF, overridden by the parameters joint_limits/<joint>/..., as in
/// ros_control; control_rate, park_position/<joint>, constraints/<joint>/trajectory, feedback_timeout, enable_timeout,
/// homing_timeout, spindle_timeout, jog_timeout, jog_velocity/<joint>, probing/..., max_job_duration,
/// collision_clearance, geometry/..., late_cycle/slow_down and .../fault; the swivel's range from the URDF alone. Every
/// axis must have complete limits of position, velocity, acceleration and jerk.
/// @param parameters the node's parameters.
/// @throw ParameterError
LoopConfig readMachineConfig(const MachineModel& model, const ParameterReader& parameters);

/// Reads the parameters geometry/... alone; geometry/probe may be missing, on a machine without one.
/// @throw ParameterError
MachineGeometry readMachineGeometry(const ParameterReader& parameters);

}  // namespace grinder
