#pragma once

#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/core/odd_even_interpolator.h"
#include "flute_grinder/core/setpoint.h"

namespace flute_grinder {

/// The only producer of setpoints: planning, a dry run and the machine all take them from here, so that what was
/// previewed is, bit for bit, what is streamed. Every move takes an even number of cycles, so that even cycles end a
/// pair throughout.
class SetpointStream {
 public:
  /// At the program's start.
  explicit SetpointStream(GrindProgram program);

  /// The next setpoint; the first is where the program starts, at rest. Real-time safe.
  /// @return false when the program has ended, or rests after stop(); `setpoint` is then left as it was.
  bool next(Setpoint& setpoint) noexcept;

  /// Stops on the path under the limits, beginning with the next pair; next() returns false once the axes rest.
  /// Real-time safe.
  void stop() noexcept { stopping_ = true; }

  const GrindProgram& program() const noexcept { return program_; }

 private:
  bool beginPair() noexcept;
  void beginMove(const Move& move) noexcept;
  void straightStep() noexcept;
  void strokePair() noexcept;
  void strokePoint(const CurvePoint& point, StepKind step) noexcept;

  GrindProgram program_;
  LogCurve curve_;
  double period_;
  bool stopping_ = false;

  Setpoint current_;
  bool started_ = false;
  bool mid_pair_ = false;
  std::size_t next_move_ = 0;
  FeedLaw law_;

  // Of a straight move: the way is from_ + law * way_.
  Axes from_ = Axes::Zero();
  Axes way_ = Axes::Zero();
  double linear_way_ = 0;

  // Of a stroke.
  OddEvenInterpolator interpolator_;
  CurvePoint even_point_;
  double y_offset_ = 0, a_offset_ = 0;
};

}  // namespace flute_grinder
