#include "flute_grinder/core/setpoint_stream.h"

#include <algorithm>
#include <utility>

namespace flute_grinder {

namespace {

/// What is shorter than this is there already: less than a position's rounding, more than makes limits overflow.
/// [m], A [rad]
constexpr double kNoWay = 1e-30;

/// Bounds of a straight move in its parameter 0..1, such that every axis stays within its own.
MotionLimits limitsAlong(const Axes& way, const AxisLimits& limits) noexcept {
  const Axes size = way.abs();
  return {(limits.max_velocity / size).minCoeff(), (limits.max_acceleration / size).minCoeff(),
          (limits.max_jerk / size).minCoeff()};
}

}  // namespace

SetpointStream::SetpointStream(GrindProgram program)
    : program_(std::move(program)),
      curve_(program_.cutter()),
      period_(program_.machine().period),
      interpolator_(curve_, program_.job().interpolation.rotary_scale, program_.job().interpolation.even_step,
                    program_.strokeFrom()) {
  current_.position = program_.start();
}

bool SetpointStream::next(Setpoint& setpoint) noexcept {
  if (!started_) {
    started_ = true;
    const Move& first = program_.moves().front();
    current_.move = first.kind;
    current_.tooth = first.tooth;
    current_.pass = first.pass;
    setpoint = current_;
    return true;
  }
  if (!mid_pair_ && !beginPair()) return false;

  const Axes before = current_.position;
  if (current_.move == MoveKind::kStroke) {
    if (mid_pair_) {
      strokePoint(even_point_, StepKind::kEven);
    } else {
      strokePair();
    }
  } else {
    straightStep();
  }
  current_.velocity = (current_.position - before) / period_;
  ++current_.cycle;
  mid_pair_ = !mid_pair_;
  setpoint = current_;
  return true;
}

bool SetpointStream::beginPair() noexcept {
  if (stopping_) {
    law_.setTarget(0);
    return !law_.resting();
  }
  while (law_.resting()) {
    if (next_move_ == program_.moves().size()) return false;
    beginMove(program_.moves()[next_move_++]);
  }
  return true;
}

void SetpointStream::beginMove(const Move& move) noexcept {
  current_.move = move.kind;
  current_.tooth = move.tooth;
  current_.pass = move.pass;
  current_.step = StepKind::kNone;
  current_.path_error = 0;
  current_.feed = 0;
  current_.at_feed = false;
  if (move.kind == MoveKind::kStroke) {
    const FeedSchedule& schedule = program_.schedule();
    const double x = program_.strokeFrom();
    interpolator_ = OddEvenInterpolator(curve_, program_.job().interpolation.rotary_scale,
                                        program_.job().interpolation.even_step, x);
    y_offset_ = current_.position[kY] - program_.cutter().y(x);
    a_offset_ = program_.job().tooth_angles[move.tooth];
    law_ = FeedLaw(schedule.limits(), schedule.length(), schedule.limits().velocity);
    return;
  }
  from_ = current_.position;
  way_ = move.to - from_;
  linear_way_ = way_.head<3>().matrix().norm();
  if ((way_.abs() <= kNoWay).all()) {
    current_.position = move.to;
    law_ = FeedLaw();
    return;
  }
  MotionLimits limits = limitsAlong(way_, program_.machine().limits);
  if (move.kind == MoveKind::kInfeed) {
    limits.velocity = std::min(limits.velocity, program_.job().process.feed / linear_way_);
  }
  law_ = FeedLaw(limits, 1, limits.velocity);
}

void SetpointStream::straightStep() noexcept {
  law_.advance(period_);
  const Axes& to = program_.moves()[next_move_ - 1].to;
  if (law_.finished()) {
    current_.position = to;
  } else {
    current_.position = from_ + way_ * law_.position();
  }
  current_.feed = law_.speed() * linear_way_;
}

void SetpointStream::strokePair() noexcept {
  const FeedSchedule& schedule = program_.schedule();
  const auto steady = [&] { return law_.cruising() && schedule.rate(law_.position()) == 1; };
  const bool was_steady = steady();
  law_.advance(2 * period_);
  const double s = law_.position();
  const double dx = schedule.x(s) - interpolator_.position().x;
  const OddEvenPair pair = interpolator_.advance(dx);
  current_.feed = law_.speed() * schedule.rate(s) * program_.cutter().edgePerTravel();
  current_.at_feed = was_steady && steady();
  even_point_ = pair.even;
  strokePoint(pair.odd, StepKind::kOdd);
}

void SetpointStream::strokePoint(const CurvePoint& point, StepKind step) noexcept {
  const ConicalCutter& cutter = program_.cutter();
  current_.position << point.x, cutter.y(point.x) + y_offset_, cutter.z(point.x), a_offset_ + point.a;
  current_.path_error = curve_.a(point.x) - point.a;
  current_.step = step;
}

}  // namespace flute_grinder
