#pragma once

#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/s_curve_profile.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/setpoint.h"

#include <memory>
#include <optional>

namespace grinder {

/// The properties that determine a move's setpoints except for constant offsets of the axes.
struct MoveShape {
  MoveKind kind = MoveKind::kLift;
  std::size_t helix = 0;    ///< index of the stroke's helix in the program
  double taper = 0;         ///< taper of the stroke, see Move
  Axes way = Axes::Zero();  ///< travel of a straight move [m], A [rad]

  bool operator<(const MoveShape& other) const noexcept;
};

/// Why a SetpointStream gives no setpoint; the axes are then at rest.
enum class Rest : std::uint8_t {
  kNone,    ///< there is a next setpoint
  kHeld,    ///< stopped by hold()
  kLifted,  ///< off the workpiece after retract(), so that something else may move the axes
  kNoFeed,  ///< the feed override is 0
  kEnd,     ///< the program has ended
};

/// The only source of setpoints: planning, dry runs and the machine all use it, so the previewed and the streamed
/// setpoints are bit-identical. Every move takes an even number of cycles, so even cycles always end a pair. The motion
/// can be held anywhere, slowed down, lifted off the workpiece and brought back; each request takes effect at the next
/// pair, and all motion stays within the axis limits. While the axes are at rest there are no setpoints. If a stream
/// cannot continue, which never happens with a program that planJob() accepts, all further positions are NaN, so every
/// check rejects them.
class SetpointStream {
 public:
  /// Starts at the start of the program.
  explicit SetpointStream(GrindProgram program);

  /// Starts at the start of a shared program, which must not be null.
  explicit SetpointStream(std::shared_ptr<const GrindProgram> program);

  /// The next setpoint; the first is the program's start position, at rest. Real-time safe.
  /// @return false while the axes are at rest, see rest(); `setpoint` is then unchanged.
  bool next(Setpoint& setpoint) noexcept;

  /// Why the axes rest. A request that ends the rest may count only from the next call of next(). Real-time safe.
  Rest rest() const noexcept;

  /// Changes the speed of the moves at feed, which are infeed and stroke; rapids keep their speed. Real-time safe.
  /// @param fraction of the job's feed, 0 to kMaxFeedOverride; other values are ignored. Above 1 the feed is raised as
  ///        far as the limits allow, see FeedSchedule::limits().
  void setFeedOverride(double fraction) noexcept;

  /// Stops on the path, as soon as the limits allow. Real-time safe.
  void hold() noexcept { holding_ = true; }

  /// Whether hold() is in effect.
  bool holding() const noexcept { return holding_; }

  /// Continues at reduced speed, then accelerates again, after the axes stood still for a while. Real-time safe.
  /// @param factor speed factor, above 0 and below 1; other values are ignored.
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// Continues after hold() from the current position. After retract(), the wheel re-enters the stroke ahead of the
  /// point where it left it, by the distance needed to reach the feed. Real-time safe.
  void resume() noexcept;

  /// Lifts the wheel radially off the workpiece, where it stays; before that it backs off to GrindProgram::clearX().
  /// Ignored unless the axes are at rest before the end of the program. Real-time safe.
  void retract() noexcept;

  /// Takes over a setpoint from another source of motion, and numbers it as the stream's own. Such setpoints must come
  /// in pairs and end at rest. After resume() the stream first returns to the position to which retract() led the
  /// wheel: up to at least that height, across, then down; from there it continues as if the axes had not been moved.
  /// Ignored unless the rest is Rest::kLifted. Real-time safe.
  /// @param setpoint changed except for position, velocity, feed and kind of move.
  void adopt(Setpoint& setpoint) noexcept;

  /// Whether the axes are on the program's path, rather than on a detour after retract().
  bool onPath() const noexcept { return leg_ == Leg::kPath; }

  const GrindProgram& program() const noexcept { return *program_; }

  /// The shape of the current move, which must be a move of the program.
  MoveShape shape() const noexcept;

  /// Time to the end of the current move, or to an earlier stop [s].
  double timeLeft() const noexcept { return law_.timeLeft(); }

  /// Continues at the state of another stream, as if the setpoints up to there had been taken. Both must be between two
  /// pairs of moves with the same shape, in the same program, neither held nor slowed down.
  /// @param cycles number of cycles by which the other stream is ahead in its move.
  void skip(const SetpointStream& later, std::uint64_t cycles) noexcept;

  /// Leaves out setpoints of a straight move, up to twice `cycles` before its constant speed ends. Applies between two
  /// pairs of a straight move that has run at constant speed for `cycles`.
  /// @param at_most maximum number of setpoints to leave out.
  /// @return the number of setpoints left out; 0 at any other time.
  std::uint64_t skipCruise(std::uint64_t cycles, std::uint64_t at_most) noexcept;

 private:
  /// The part of the motion: the program's path, or a part of the detour off the workpiece and back.
  enum class Leg : std::uint8_t { kPath, kBackOff, kLift, kBack, kPlunge };

  const Helix* helixOf(const Move& move) const noexcept;
  const Axes& strokeBegin() const noexcept;
  bool beginPair() noexcept;
  void beginNext() noexcept;
  bool isBehind(const Move& move) const noexcept;
  void beginMove(const Move& move) noexcept;
  void beginWayBack() noexcept;
  void beginReturn() noexcept;
  void beginStraight(MoveKind kind, const Axes& to) noexcept;
  void beginStroke(double s) noexcept;
  /// Whether the current move is a stroke along a helix.
  bool onHelix() const noexcept { return current_.move == MoveKind::kStroke && helix_ != nullptr; }
  void beginLift() noexcept;
  void beginLaw(const MotionLimits& limits, double distance, double feed_speed) noexcept;
  double targetSpeed() const noexcept;
  double strokeParameter() const noexcept;
  double strokeY(double x) const noexcept { return helix_->edge.cutter.y(x) + x * taper_ + y_offset_; }
  void straightStep() noexcept;
  void strokePair() noexcept;
  void strokePoint(const CurvePoint& point, StepKind step) noexcept;

  std::shared_ptr<const GrindProgram> program_;
  const Helix* helix_;  ///< path of the current tooth in the program; null if its strokes are straight
  double period_;
  double override_ = 1;
  double slow_down_ = 1;  ///< factor for the next pair
  bool holding_ = false;
  bool stay_lifted_ = false;
  bool lost_ = false;  ///< the stream cannot continue

  Setpoint current_;
  bool started_ = false;
  bool mid_pair_ = false;
  std::size_t next_move_ = 0;
  Leg leg_ = Leg::kPath;
  SCurveProfile law_;
  double move_speed_ = 0;  ///< speed of the law without override

  // For a straight move: position = from_ + law * way_.
  Axes from_ = Axes::Zero();
  Axes way_ = Axes::Zero();
  Axes to_ = Axes::Zero();
  double linear_way_ = 0;

  // For a stroke.
  std::optional<OddEvenInterpolator> interpolator_;
  CurvePoint even_point_;
  double stroke_from_ = 0;  ///< parameter at which the stroke was started or re-entered
  double y_offset_ = 0, a_offset_ = 0;
  double taper_ = 0;  ///< slope added to the cone's dY/dX

  double reentry_ = 0;          ///< parameter at which retract() left the stroke
  Axes lifted_ = Axes::Zero();  ///< position to which retract() lifts the wheel [m], A [rad]
};

}  // namespace grinder
