#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/move_kind.h"

#include <cstdint>

namespace grinder {

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
  std::uint64_t cycle = 0;       ///< number of the cycle; the job starts at 0, and even cycles end a pair
  Axes position = Axes::Zero();  ///< [m], A [rad]
  Axes velocity = Axes::Zero();  ///< mean velocity over the cycle that ends at this setpoint [m/s], A [rad/s]
  double path_error = 0;         ///< theory - commanded of A; 0 outside strokes [rad]
  double feed = 0;               ///< feed along the cutting edge; outside strokes, speed of the linear axes [m/s]
  double move_fraction = 0;      ///< completed fraction of the program's move, 0..1; exactly 1 at its end
  std::uint32_t move_index = 0;  ///< index of the program's move; while the wheel is lifted, of the interrupted move
  std::uint16_t tooth = 0;       ///< from 0
  std::uint16_t pass = 0;        ///< from 0
  MoveKind move = MoveKind::kLift;
  StepKind step = StepKind::kNone;
  bool at_feed = false;  ///< the stroke runs at its target feed: neither on a ramp nor reduced for an axis
};

}  // namespace grinder
