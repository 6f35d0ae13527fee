#pragma once

#include "flute_grinder/core/axes.h"

#include <cstdint>

namespace flute_grinder {

/// What a move of a job is for.
enum class MoveKind : std::uint8_t {
  kLift,      ///< radially up to where it is clear of all work, before anything else moves
  kIndex,     ///< rapid in A above the work, to the tooth at the start of its stroke
  kPosition,  ///< rapid in X and Z above the work, to the start of a stroke
  kApproach,  ///< rapid down to the clearance above the start
  kInfeed,    ///< down to the pass' depth, at feed
  kStroke,    ///< along the flute, odd-even interpolated
  kRetract,   ///< radially up to the clearance plane
  kReturn,    ///< rapid to the park position
};

constexpr int kMoveKindCount = 8;

/// e.g. "stroke".
const char* toString(MoveKind kind) noexcept;

/// Which step of an odd-even pair a setpoint is; kNone off the stroke.
enum class StepKind : std::uint8_t { kNone, kOdd, kEven };

/// e.g. "odd".
const char* toString(StepKind kind) noexcept;

/// What the axes are to do in one control cycle.
struct Setpoint {
  std::uint64_t cycle = 0;       ///< since the job's start, where it is 0; even cycles end a pair
  Axes position = Axes::Zero();  ///< [m], A [rad]
  Axes velocity = Axes::Zero();  ///< mean over the cycle that ends here [m/s], A [rad/s]
  double path_error = 0;         ///< in A: theory - commanded, 0 off the stroke [rad]
  double feed = 0;               ///< along the cutting edge, or of the linear axes off the stroke [m/s]
  double move_fraction = 0;      ///< done of the program's move, 0..1; exactly 1 at its end
  std::uint32_t move_index = 0;  ///< of the program's move; while the wheel is lifted, of the one that was interrupted
  std::uint16_t tooth = 0;       ///< from 0
  std::uint16_t pass = 0;        ///< from 0
  MoveKind move = MoveKind::kLift;
  StepKind step = StepKind::kNone;
  bool at_feed = false;  ///< the stroke goes at its target feed, neither on a ramp nor cut for an axis
};

}  // namespace flute_grinder
