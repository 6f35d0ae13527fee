#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/machine/loop_fault.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/machine/swivel.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/setpoint.h"

#include <array>
#include <cstdint>
#include <type_traits>

namespace grinder {

/// The position of the axes in a job's program.
struct Place {
  std::uint32_t move_index = 0;  ///< index of the program's move; while the wheel is lifted, of the interrupted move
  std::uint16_t tooth = 0;       ///< tooth, from 0
  std::uint16_t pass = 0;        ///< pass, from 0
  MoveKind move = MoveKind::kLift;
  double x = 0;              ///< X in work coordinates [m]
  double move_fraction = 0;  ///< completed fraction of the program's move, 0..1; exactly 1 at its end
};

/// Whether the wheel is in the workpiece, and the way out of it. In machine coordinates, so that a change of the
/// work offsets does not matter.
struct Wheel {
  bool in_work = false;
  double clear_y = 0;  ///< Y at which the wheel is clear of the last job's workpiece [m]
  double lift = 0;     ///< distance from the deepest point of the last job to clear_y [m]
  /// Y was read where the axis cannot have been: the reading is not trusted until the axis is homed.
  bool y_doubted = false;
  bool known = true;  ///< if false, `in_work` means that the wheel may be in the workpiece
  /// X to which the wheel backs off before it is lifted, and the largest distance to it; a distance of 0 means that the
  /// wheel is lifted straight up [m].
  double clear_x = 0, back = 0;
};

/// The wheel before the first move of a program, with the lift that clears its workpiece.
Wheel wheelOf(const GrindProgram& program);

/// A wheel that may be in the workpiece of an unknown job: it is clear at the top of Y's travel.
/// @param is_cup whether its rim may be round a tooth: it backs off to the lower end of X's travel before it rises.
Wheel unknownWheel(const AxisLimits& limits, bool is_cup);

/// How a job ended.
enum class JobEnd : std::uint8_t {
  kNone,      ///< the job is running
  kDone,      ///< reached the end of its program
  kCanceled,  ///< stopped on its path; the wheel is lifted off the workpiece unless a hold stopped the lift
  kFault,
};

/// Where the measuring probe touched during a jog, which ended the jog.
struct ProbeContact {
  bool made = false;
  std::array<double, kAxisCount> position{};  ///< machine position read in that cycle [m], A [rad]
};

/// The loop's state in one cycle. Its counts stay correct even if a reader misses cycles.
struct LoopStatus {
  std::uint64_t cycles = 0;  ///< cycles since the start of the loop
  double time = 0;           ///< stamp of the cycle [s]
  MachineState state = MachineState::kDisabled;
  bool homed = false;
  std::array<double, kAxisCount> command{};   ///< machine position as last written [m], A [rad]
  std::array<double, kAxisCount> position{};  ///< machine position as read in this cycle [m], A [rad]
  bool position_valid = false;                ///< all positions are finite and fresh
  double feed_override = 1;                   ///< fraction
  Swivel swivel;                              ///< angle of the swivel, as far as it is known
  bool probe_contact = false;                 ///< the measuring probe touches something
  ProbeContact contact;                       ///< contact of the present jog, or else the last one
  bool client_lost = false;        ///< the present jog, or else the last one, was stopped because its client was silent
  std::uint64_t jogs_begun = 0;    ///< jogs since the start of the loop
  std::uint64_t jogs_ended = 0;    ///< jogs since the start of the loop
  std::uint64_t stops = 1;         ///< 1 + stops requested since the start of the loop
  std::uint64_t jobs_started = 0;  ///< jobs since the start of the loop
  std::uint64_t jobs_ended = 0;    ///< jobs since the start of the loop
  // For the running job, or else the last one:
  std::uint64_t setpoints_written = 0;
  JobEnd end = JobEnd::kNone;
  LoopFault fault;  ///< why the job ended, for JobEnd::kFault; kept until the next job starts
  Place place;      ///< place of the last setpoint that reached the axes; a drive may buffer later ones
  /// 1 + move_index of the last stroke that the axes completed; 0 for none. Never decreases, although a retraction at
  /// the end of a stroke re-enters it.
  std::uint32_t strokes_ended_at = 0;
  Wheel wheel;
};
static_assert(std::is_trivially_copyable_v<LoopStatus>);

}  // namespace grinder
