#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/move_kind.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Core types that have a counterpart among the messages have the same name, in a separate namespace.
namespace grinder {

/// The kind of a reason.
enum class ReasonKind : std::uint8_t {
  kNone,
  // Why a job cannot be ground.
  kOutOfRange,  ///< a field is outside `low` to `limit`; `detail`, if there is one, says whose range
  kNotBelow,    ///< a field is `limit` or more
  kAbove,       ///< a field is more than `limit`
  kNotAllowed,  ///< a field does not meet the requirement `detail`; the text ends with `limit` unless it is 0
  kFeedTooLow,  ///< `detail` restricts the feed to less than `limit`, the slowest allowed feed
  kParkInWork,  ///< the park position is below `limit`, in the workpiece
  kTolerance,   ///< the path deviates by more than `limit`
  kTooLong,     ///< the job takes longer than `limit`; value 0 if the duration is unknown
  kGivenUp,     ///< planning was given up
  kOther,       ///< see `detail`
  // A setpoint that exceeds a limit of an axis.
  kPosition,
  kVelocity,
  kAcceleration,
  kJerk,
  kNotFinite,
  // Why the machine stopped, or does not start.
  kEmergencyStop,
  kDriveFault,
  kPowerLost,
  kStaleFeedback,
  kInvalidFeedback,
  kFollowingError,
  kUnderrun,
  kLate,
  kHoming,
  kInterlock,  ///< see `detail`; the job did not begin within `limit`
  kCanceled,
  // Why a job would grind an unusable tool.
  kRake,         ///< the rake angle ground is `value`, the asked one `limit`, within `low`; at `x` of `tooth`
  kLand,         ///< a flute takes `value` of its tooth's pitch `limit`: no land is left; at `x` of `tooth`
  kCore,         ///< the wheel cuts through the core; at `x`
  kIncomplete,   ///< the flutes are complete from X = `low` to `value`; `limit` is the flute length
  kCollision,    ///< two bodies, `detail`, come within `value`, 0 if they hit; allowed: `limit`, for a `field` of `low`
  kSwivel,       ///< the job needs `limit` within `low`; the swivel is at `value`, by `detail`, or unknown
  kUnevenRake,   ///< the best rake of `tooth` is `low` to `value`, asked `limit`; no rake face if low > value
  kSpiral,       ///< the edge's spiral angle is `value`, the asked one `limit`, within `low`; at `x` of `tooth`
  kCoreSize,     ///< the core's diameter is `value`, the asked one `limit`, within `low`; at `x`; for a relief,
                 ///< `detail` says what to change
  kChordalRake,  ///< the chordal rake is `value`, the asked rake `limit`, within `low`; at `x` of `tooth`
  kClearance,    ///< the clearance ground is `value`, the asked one `limit`, within `low`; at `x` of `tooth`
  kUndercut,  ///< a relief leaves an edge diameter of `value`, the asked one `limit`, within `low`; at `x` of `tooth`
  kNextEdge,  ///< a relief's wheel goes `value` into the tooth behind `tooth`; at `x`
  kHeel,      ///< a relief ends on the land, before the heel or the next relief; at `x` of `tooth`
  kSlow,      ///< the control loop's cycles take `value` on average, allowed `limit`
  kSecondClearance,  ///< like kClearance, for the secondary relief where it begins
  kPrimaryLand,      ///< the primary relief is `value` wide, the asked one `limit`, within `low`; at `x` of `tooth`
  kEnd,              ///< `detail` of `tooth` is `value`, the asked one `limit`, within `low`; at `x` from the axis
};

/// Each kind's name is the message constant in lower case.
struct ReasonRow : EnumRow<ReasonKind> {
  /// The text, with members of Reason in braces: {axis}, {value}, {limit}, {detail}, {cycle}, {low}, {tooth}, {x}.
  /// {excess} is value and limit with the words between them, {number} the value without its unit; a field's path in
  /// braces is its name in a file. Null if text() composes the words.
  const char* text = nullptr;
};

inline constexpr ReasonRow kReasonKinds[]{
    {{ReasonKind::kNone, "none"}, ""},
    {{ReasonKind::kOutOfRange, "out_of_range"}},
    {{ReasonKind::kNotBelow, "not_below"}},
    {{ReasonKind::kAbove, "above"}},
    {{ReasonKind::kNotAllowed, "not_allowed"}},
    {{ReasonKind::kFeedTooLow, "feed_too_low"}},
    {{ReasonKind::kParkInWork, "park_in_work"}},
    {{ReasonKind::kTolerance, "tolerance"}},
    {{ReasonKind::kTooLong, "too_long"}},
    {{ReasonKind::kGivenUp, "given_up"}, "given up while it was planned"},
    {{ReasonKind::kOther, "other"}, "{detail}"},
    {{ReasonKind::kPosition, "position"}, "{axis} machine position {excess}"},
    {{ReasonKind::kVelocity, "velocity"}, "{axis} velocity {excess}"},
    {{ReasonKind::kAcceleration, "acceleration"}, "{axis} acceleration {excess}"},
    {{ReasonKind::kJerk, "jerk"}, "{axis} jerk {excess}"},
    {{ReasonKind::kNotFinite, "not_finite"}, "{axis} position {value} is not a finite number"},
    {{ReasonKind::kEmergencyStop, "emergency_stop"}, "emergency stop"},
    {{ReasonKind::kDriveFault, "drive_fault"}, "the drive reports a fault{detail}"},
    {{ReasonKind::kPowerLost, "power_lost"}, "the drive has switched its power off"},
    {{ReasonKind::kStaleFeedback, "stale_feedback"}, "no fresh positions from the drive for {value}, allowed {limit}"},
    {{ReasonKind::kInvalidFeedback, "invalid_feedback"}, "{axis} position from the drive is {number}"},
    {{ReasonKind::kFollowingError, "following_error"}, "{axis} following error {value} is beyond its limit {limit}"},
    {{ReasonKind::kUnderrun, "underrun"}, "the axes found no setpoint in {value} servo cycles, after setpoint {cycle}"},
    {{ReasonKind::kLate, "late"}, "the control loop came {value} after the cycle before, allowed {limit}"},
    {{ReasonKind::kHoming, "homing"}, "the drive has not found its reference after {value}, allowed {limit}"},
    {{ReasonKind::kInterlock, "interlock"}, "{detail} {value} after the job was started, allowed {limit}"},
    {{ReasonKind::kCanceled, "canceled"}, "canceled; stopped on the path"},
    {{ReasonKind::kRake, "rake"},
     "{cutter.rake_angle} = {limit}: tooth {tooth} is ground with {value} at X = {x}; allowed: within {low} of it; "
     "change {process.setup_swivel} or {process.setup_height}"},
    {{ReasonKind::kLand, "land"},
     "no land is left on tooth {tooth} at X = {x}: its flute takes {value}, its pitch is {limit}; lower "
     "{process.wheel_width} or {process.depth}"},
    {{ReasonKind::kCore, "core"}, "{process.depth}: the core is cut through at X = {x}; lower it"},
    {{ReasonKind::kIncomplete, "incomplete"}},
    {{ReasonKind::kCollision, "collision"}},
    {{ReasonKind::kSwivel, "swivel"}},
    {{ReasonKind::kUnevenRake, "uneven_rake"}},
    {{ReasonKind::kSpiral, "spiral"},
     "{cutter.spiral_angle} = {limit}: the edge of tooth {tooth} is ground with {value} at X = {x}; allowed: within "
     "{low} of it; change {process.setup_x_shift}"},
    {{ReasonKind::kCoreSize, "core_size"}},
    {{ReasonKind::kChordalRake, "chordal_rake"},
     "{cutter.rake_angle} = {limit}: tooth {tooth} has a chordal rake of {value} at X = {x}; allowed: within {low} of "
     "it; change {process.wheel_diameter} or {process.wheel_width}"},
    {{ReasonKind::kClearance, "clearance"},
     "{cutter.clearance} = {limit}: tooth {tooth} is ground with {value} at X = {x}; allowed: within {low} of it; "
     "change the height or the swivel of the relief's set-up"},
    {{ReasonKind::kUndercut, "undercut"},
     "the relief leaves tooth {tooth} an edge diameter of {value} at X = {x}; allowed: within {low} of {limit}; grind "
     "the flutes with an edge nearer to the asked helix"},
    {{ReasonKind::kNextEdge, "next_edge"},
     "the relief's wheel reaches {value} into the tooth behind tooth {tooth} at X = {x}; change the height of the "
     "relief's set-up, or take a narrower wheel"},
    {{ReasonKind::kHeel, "heel"},
     "the relief of tooth {tooth} ends on the land at X = {x}; change the height of the relief's set-up, or take a "
     "wider wheel"},
    {{ReasonKind::kSlow, "slow"}, "the control loop takes {value} for a cycle on average, allowed {limit}"},
    {{ReasonKind::kSecondClearance, "second_clearance"},
     "{cutter.second_clearance} = {limit}: tooth {tooth} is ground with {value} at X = {x}; allowed: within {low} of "
     "it; change the height or the swivel of the relief's set-up, or take a wheel with smaller corner radii"},
    {{ReasonKind::kPrimaryLand, "primary_land"},
     "{cutter.land} = {limit} there: the primary relief of tooth {tooth} is left {value} wide at X = {x}; allowed: "
     "within {low} of it; change the set-up of the secondary relief"},
    {{ReasonKind::kEnd, "end"},
     "the {detail} of tooth {tooth} is {value}, {x} from the axis; allowed: within {low} of {limit}"},
};
constexpr auto& rowsOf(ReasonKind) noexcept { return kReasonKinds; }
constexpr int kReasonKindCount = countOf<ReasonKind>();

/// Why a job was refused or has ended, or why the machine stopped, as data; text() converts it to words.
struct Reason {
  ReasonKind kind = ReasonKind::kNone;
  int axis = 0;             ///< axis, for kParkInWork, the limits, kInvalidFeedback and kFollowingError
  std::string field{};      ///< path of the field, for the kinds about a field, e.g. "process.feed"
  std::string detail{};     ///< further information, without numbers that have a unit
  Unit unit = Unit::kNone;  ///< unit of value, low and limit
  double value = 0;         ///< the wrong value, in SI
  double low = 0;           ///< lower end of the allowed range, for kOutOfRange
  double limit = 0;         ///< the allowed value, or the upper end of the allowed range
  bool has_place = false;   ///< whether the next five members are known
  MoveKind move = MoveKind::kLift;
  int tooth = 0;            ///< from 0
  int pass = 0;             ///< from 0
  double x = 0;             ///< along the cutter; for kEnd, distance from its axis [m]
  std::uint64_t cycle = 0;  ///< cycle of the setpoint, for limits and kTolerance; of the last one, for kUnderrun
  std::uint64_t count = 0;  ///< number of violating setpoints, of which this is the worst; passes, for kTooLong
};

/// A reason of kind kOther.
inline Reason otherReason(std::string detail) { return {ReasonKind::kOther, 0, "", std::move(detail)}; }

/// A reason in words and shop units, in which teeth and passes count from 1.
std::string text(const Reason& reason);

/// Reasons in words, separated by "; ".
std::string text(const std::vector<Reason>& reasons);

/// A job that cannot be ground on a machine; what() is the reason's text.
class ReasonError : public std::invalid_argument {
 public:
  explicit ReasonError(Reason reason) : std::invalid_argument(text(reason)), reason_(std::move(reason)) {}
  const Reason& reason() const noexcept { return reason_; }

 private:
  Reason reason_;
};

}  // namespace grinder
