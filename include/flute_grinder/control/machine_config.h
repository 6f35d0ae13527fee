#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/control/diagnostic_thresholds.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/machine/first_view.h"
#include "flute_grinder/machine/machine_model.h"

#include <cstdint>
#include <string>

namespace grinder {

/// The parameters in a machine's file, without the drive's.
struct MachineConfig {
  LoopConfig loop;
  Axes offset_change_limit;         ///< largest change of a work offset [m], A [rad]
  std::uint64_t history_limit = 0;  ///< size limit of the history [bytes]
  DiagnosticThresholds thresholds;
  FirstView first_view;
  std::string drive;  ///< type of the drive's plugin
};

/// Reads what the control loop needs: limits from the URDF, overridden by the parameters joint_limits/<joint>/..., as
/// in ros_control; control_rate, park_position/<joint>, constraints/<joint>/trajectory, feedback_timeout,
/// enable_timeout, homing_timeout, spindle_timeout, jog_timeout, jog_velocity/<joint>, probing/..., max_job_duration,
/// collision_clearance, geometry/..., late_cycle/slow_down and .../fault; the swivel's range from the URDF alone. Every
/// axis must have complete limits of position, velocity, acceleration and jerk.
/// @param parameters the node's parameters.
/// @throw ParameterError
LoopConfig readLoopConfig(const MachineModel& model, const ParameterReader& parameters);

/// Reads all of MachineConfig: the parameters of readLoopConfig(), and history_limit, offset_change_limit/<joint>,
/// diagnostics/..., first_view/... and hardware/type.
/// @param drives the available types of plugins, for error messages.
/// @throw ParameterError also for an unknown parameter, unless it is in hardware/, which the drive reads.
MachineConfig readMachineConfig(const MachineModel& model, const ParameterReader& parameters,
                                const std::string& drives);

/// Reads only the parameters geometry/...; geometry/probe is missing on a machine without a probe.
/// @throw ParameterError
MachineGeometry readMachineGeometry(const ParameterReader& parameters);

}  // namespace grinder
