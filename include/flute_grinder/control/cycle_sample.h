#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/drive/drive.h"
#include "flute_grinder/machine/loop_fault.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/machine/swivel.h"
#include "flute_grinder/motion/setpoint.h"

#include <cmath>
#include <cstdint>

namespace grinder {

/// The data of one cycle, for the other threads. Positions and commands are in machine coordinates, a job's setpoints
/// in its work coordinates.
struct CycleSample {
  double time = 0;    ///< time since the ROS epoch, monotonic [s]
  double period = 0;  ///< time since the previous cycle [s]
  double busy = 0;    ///< duration of the previous cycle without the wait for this one; 0 in the first cycle [s]
  MachineState state = MachineState::kDisabled;
  DriveStatus drive;
  bool power_stays = false;      ///< the drive still reports power enable_timeout after it was commanded off
  double feedback_age = 0;       ///< time since the drive last delivered fresh positions [s]
  Axes position = Axes::Zero();  ///< positions read in this cycle [m], A [rad]
  Axes velocity = Axes::Zero();  ///< velocities read in this cycle [m/s], A [rad/s]
  Axes command = Axes::Zero();   ///< command written in this cycle [m], A [rad]
  /// The command that the positions should follow; older than `command` if the drive buffers commands [m], A [rad].
  Axes command_in_effect = Axes::Zero();
  bool has_setpoint = false;
  Setpoint setpoint;       ///< the setpoint written, if there was one
  std::uint64_t job = 0;   ///< number of the running job, or else the last one; 0 for a setpoint without a job
  bool job_ended = false;  ///< the job's stream is no longer in use; passed on to the next sample if this one is lost
  bool wheel_in_work = false;
  bool wheel_backs_off = false;  ///< with wheel_in_work: the way out leads along X first
  bool spindle_commanded = false;
  bool coolant_commanded = false;
  Axes distance_to_go = Axes::Zero();      ///< distance from the positions to the end of the running move [m], A [rad]
  Swivel swivel;                           ///< angle of the swivel, as far as it is known
  LoopFault fault;                         ///< the fault in state kFault, or why the last job did not begin
  Interlock interlock = Interlock::kNone;  ///< why the loop itself held the job; kept until the job is resumed
  double feed_override = 1;                ///< fraction
  std::uint64_t samples_lost = 0;          ///< samples dropped since the loop started, because the queue was full

  /// Following error of an axis, |command_in_effect - position| [m], A [rad]; NaN if the drive read NaN. Real-time
  /// safe.
  double followingError(int axis) const noexcept { return std::abs(command_in_effect[axis] - position[axis]); }
};

}  // namespace grinder
