#pragma once

#include "flute_grinder/core/quantity.h"
#include "flute_grinder/core/setpoint.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Types of the core that messages repeat bear the message's name, in a namespace of their own.
namespace flute_grinder::core {

/// What a reason says.
enum class ReasonKind : std::uint8_t {
  kNone,
  // Why a job cannot be ground.
  kOutOfRange,  ///< of a field: beyond `low` to `limit`
  kNotBelow,    ///< of a field: `limit` or more
  kAbove,       ///< of a field: more than `limit`
  kNotAllowed,  ///< of a field: other than `detail` says; with `limit` behind it, unless 0
  kFeedTooLow,  ///< `detail` holds the feed below `limit`, the slowest that is ground with
  kParkInWork,  ///< the park position is below `limit`, where the work begins
  kTolerance,   ///< the path deviates by more than `limit`
  kTooLong,     ///< the job takes longer than `limit`; value 0: not known how long
  kGivenUp,     ///< planning was
  kOther,       ///< as `detail` says
  // A setpoint that an axis may not follow.
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
  kInterlock,  ///< `detail`; the job did not begin within `limit`
  kCanceled,
};
constexpr int kReasonKindCount = static_cast<int>(ReasonKind::kCanceled) + 1;

/// Why a job is refused or has ended, or why the machine stopped, as data; text() puts it in words.
struct Reason {
  ReasonKind kind = ReasonKind::kNone;
  int axis = 0;             ///< of kParkInWork, the limits, kInvalidFeedback and kFollowingError
  std::string field;        ///< of the kinds of a field: its path, e.g. "process.feed"
  std::string detail;       ///< what else there is to say, without a number that has a unit
  Unit unit = Unit::kNone;  ///< of value, low and limit
  double value = 0;         ///< what is wrong, in SI
  double low = 0;           ///< lower end of the range allowed, of kOutOfRange
  double limit = 0;         ///< what is allowed, or the upper end of it
  bool has_place = false;   ///< whether the five that follow are known
  MoveKind move = MoveKind::kLift;
  int tooth = 0;            ///< from 0
  int pass = 0;             ///< from 0
  double x = 0;             ///< along the cutter [m]
  std::uint64_t cycle = 0;  ///< of the setpoint, of the limits and kTolerance; the last one written, of kUnderrun
  std::uint64_t count = 0;  ///< setpoints of which this is the worst; passes of the job, of kTooLong
};

/// A reason in words. Teeth and passes count from 1 in them.
std::string text(const Reason& reason, UnitSystem units);

/// Reasons in words, with "; " in between.
std::string text(const std::vector<Reason>& reasons, UnitSystem units);

/// A job that cannot be ground on a machine; what() is the reason's text in SI.
class ReasonError : public std::invalid_argument {
 public:
  explicit ReasonError(Reason reason)
      : std::invalid_argument(text(reason, UnitSystem::kSi)), reason_(std::move(reason)) {}
  const Reason& reason() const noexcept { return reason_; }

 private:
  Reason reason_;
};

/// The cause of a feed limit for its reader: "axis_a velocity" is "axis A velocity" for the operator.
std::string causeText(const std::string& cause, UnitSystem units);

}  // namespace flute_grinder::core
