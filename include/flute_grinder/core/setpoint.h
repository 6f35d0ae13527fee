#pragma once

#include "flute_grinder/core/axes.h"
#include "flute_grinder/core/enum_table.h"

#include <cstdint>

namespace flute_grinder {

/// The purpose of a move in a job.
enum class MoveKind : std::uint8_t {
  kLift,      ///< radially up until clear of the workpiece, before any other move
  kIndex,     ///< rapid in A above the workpiece, to the tooth's angle at the start of its stroke
  kPosition,  ///< rapid in X and Z above the workpiece, to the start of a stroke
  kApproach,  ///< rapid down to the clearance above the start
  kInfeed,    ///< down to the depth of the pass, at feed
  kStroke,    ///< along the flute, odd-even interpolated
  kRetract,   ///< radially up to the clearance plane
  kReturn,    ///< rapid to the park position
};

/// The part of a pass that a move belongs to.
enum class PassPhase : std::uint8_t {
  kNone,    ///< does not belong to a pass
  kBefore,  ///< on the way to the stroke
  kStroke,
  kAfter,
};

struct MoveRow : EnumRow<MoveKind> {
  bool at_feed = false;  ///< otherwise rapid
  PassPhase phase = PassPhase::kNone;
};

inline constexpr MoveRow kMoveKinds[]{
    {{MoveKind::kLift, "lift"}, false, PassPhase::kNone},
    {{MoveKind::kIndex, "index"}, false, PassPhase::kBefore},
    {{MoveKind::kPosition, "position"}, false, PassPhase::kBefore},
    {{MoveKind::kApproach, "approach"}, false, PassPhase::kBefore},
    {{MoveKind::kInfeed, "infeed"}, true, PassPhase::kBefore},
    {{MoveKind::kStroke, "stroke"}, true, PassPhase::kStroke},
    {{MoveKind::kRetract, "retract"}, false, PassPhase::kAfter},
    {{MoveKind::kReturn, "return"}, false, PassPhase::kAfter},
};
constexpr auto& rowsOf(MoveKind) noexcept { return kMoveKinds; }
constexpr int kMoveKindCount = countOf<MoveKind>();
constexpr bool isAtFeed(MoveKind kind) noexcept { return rowOf(kind).at_feed; }
constexpr PassPhase phaseOf(MoveKind kind) noexcept { return rowOf(kind).phase; }

/// The step of an odd-even pair that a setpoint belongs to; kNone outside strokes.
enum class StepKind : std::uint8_t { kNone, kOdd, kEven };

inline constexpr EnumRow<StepKind> kStepKinds[]{
    {StepKind::kNone, "none"},
    {StepKind::kOdd, "odd"},
    {StepKind::kEven, "even"},
};
constexpr auto& rowsOf(StepKind) noexcept { return kStepKinds; }

/// The command to the axes for one control cycle.
struct Setpoint {
  std::uint64_t cycle = 0;       ///< since the start of the job, which is cycle 0; even cycles end a pair
  Axes position = Axes::Zero();  ///< [m], A [rad]
  Axes velocity = Axes::Zero();  ///< mean over the cycle that ends at this setpoint [m/s], A [rad/s]
  double path_error = 0;         ///< in A: theory - commanded; 0 outside strokes [rad]
  double feed = 0;               ///< along the cutting edge; outside strokes, of the linear axes [m/s]
  double move_fraction = 0;      ///< completed fraction of the program's move, 0..1; exactly 1 at its end
  std::uint32_t move_index = 0;  ///< of the program's move; while the wheel is lifted, of the interrupted move
  std::uint16_t tooth = 0;       ///< from 0
  std::uint16_t pass = 0;        ///< from 0
  MoveKind move = MoveKind::kLift;
  StepKind step = StepKind::kNone;
  bool at_feed = false;  ///< the stroke runs at its target feed: neither on a ramp nor reduced for an axis
};

}  // namespace flute_grinder
