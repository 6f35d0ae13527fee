#pragma once

#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/core/odd_even_interpolator.h"
#include "flute_grinder/core/setpoint.h"

#include <memory>

namespace flute_grinder {

/// The only producer of setpoints: planning, a dry run and the machine all take them from here, so that what was
/// previewed is, bit for bit, what is streamed. Every move takes an even number of cycles, so that even cycles end a
/// pair throughout. It can be held anywhere, slowed down, lifted off the work and brought back; each request takes
/// effect with the next pair, and all motion stays within the axes' limits. While the axes rest there are no setpoints.
/// A stream that cannot go on, which no program that planJob() accepts comes to, gives positions that are not a number
/// from then on, for every check to refuse.
class SetpointStream {
 public:
  /// At the program's start.
  explicit SetpointStream(GrindProgram program);

  /// The same without a copy of the program, which must be there.
  explicit SetpointStream(std::shared_ptr<const GrindProgram> program);

  /// The next setpoint; the first is where the program starts, at rest. Real-time safe.
  /// @return false while the axes rest: at the program's end, after hold(), lifted after retract(), or at a feed
  ///         override of 0; `setpoint` is then left as it was.
  bool next(Setpoint& setpoint) noexcept;

  /// Speeds up or slows down what goes at feed, infeed and stroke; rapids keep their speed. Real-time safe.
  /// @param fraction of the job's feed, 0 to kMaxFeedOverride; others are not taken. Above 1 the feed goes as far as
  ///        the axes allow.
  void setFeedOverride(double fraction) noexcept;

  /// Stops on the path, as soon as the limits allow. Real-time safe.
  void hold() noexcept { holding_ = true; }

  /// Whether hold() is in force.
  bool holding() const noexcept { return holding_; }

  /// For axes that stood still for a while: continues at reduced speed, then accelerates again. Real-time safe.
  /// @param factor of the speed, above 0 and below 1; other values are ignored.
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// Goes on after hold(), from where the axes rest, or after retract(): a stroke is entered again ahead of the place
  /// where it was left, by the way that it takes to reach feed. Real-time safe.
  void resume() noexcept;

  /// Lifts the wheel radially off the work and stays there; not taken unless the axes rest ahead of the program's end.
  /// Real-time safe.
  void retract() noexcept;

  /// Whether the program has ended.
  bool finished() const noexcept;

  /// Whether the axes are on the program's path, and not on a detour after retract().
  bool onPath() const noexcept { return leg_ == Leg::kPath; }

  const GrindProgram& program() const noexcept { return *program_; }

 private:
  /// What the axes are on: the program, or a part of the detour off the work and back.
  enum class Leg : std::uint8_t { kPath, kLift, kBack, kPlunge };

  bool beginPair() noexcept;
  bool beginNext() noexcept;
  void beginMove(const Move& move) noexcept;
  void beginReturn() noexcept;
  void beginStraight(MoveKind kind, const Axes& to) noexcept;
  void beginStroke(double s) noexcept;
  void beginLaw(const MotionLimits& limits, double distance, double feed_speed) noexcept;
  double targetSpeed() const noexcept;
  double strokeParameter() const noexcept;
  void straightStep() noexcept;
  void strokePair() noexcept;
  void strokePoint(const CurvePoint& point, StepKind step) noexcept;

  std::shared_ptr<const GrindProgram> program_;
  // What of it every cycle needs, one step nearer.
  ConicalCutter cutter_;
  FeedSchedule schedule_;
  LogCurve curve_;
  double period_;
  double override_ = 1;
  double slow_down_ = 1;  ///< of the next pair
  bool holding_ = false;
  bool stay_lifted_ = false;
  bool lost_ = false;  ///< cannot go on

  Setpoint current_;
  bool started_ = false;
  bool mid_pair_ = false;
  std::size_t next_move_ = 0;
  Leg leg_ = Leg::kPath;
  FeedLaw law_;
  double move_speed_ = 0;  ///< of the law, without override

  // Of a straight move: the way is from_ + law * way_.
  Axes from_ = Axes::Zero();
  Axes way_ = Axes::Zero();
  Axes to_ = Axes::Zero();
  double linear_way_ = 0;

  // Of a stroke.
  OddEvenInterpolator interpolator_;
  CurvePoint even_point_;
  double stroke_from_ = 0;  ///< parameter at which it was begun, or entered again
  double y_offset_ = 0, a_offset_ = 0;

  double reentry_ = 0;  ///< parameter of the stroke that was left by retract()
};

}  // namespace flute_grinder
