#pragma once

#include "flute_grinder/base/enum_table.h"

#include <cstdint>

namespace grinder {

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

}  // namespace grinder
