#include "flute_grinder/motion/setpoint_stream.h"

#include "flute_grinder/job/grind_job.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace grinder {

namespace {

/// Shorter moves are skipped: they are below the rounding of a position, and could make the scaled limits overflow.
/// [m], A [rad]
constexpr double kNegligibleDistance = 1e-30;

/// Limits of a straight move in its parameter 0..1 that keep every axis within its own limits.
MotionLimits limitsAlong(const Axes& way, const AxisLimits& limits) noexcept {
  const Axes size = way.abs();
  return {(limits.max_velocity / size).minCoeff(), (limits.max_acceleration / size).minCoeff(),
          (limits.max_jerk / size).minCoeff()};
}

/// @p position, clamped on every axis to [@p from, @p to]: the travel of a straight move is rounded, and its end may be
/// exceeded.
Axes clamped(const Axes& position, const Axes& from, const Axes& to) noexcept {
  return position.max(from.min(to)).min(from.max(to));
}

}  // namespace

bool MoveShape::operator<(const MoveShape& o) const noexcept {
  return std::tie(kind, helix, taper, way[kX], way[kY], way[kZ], way[kA]) <
         std::tie(o.kind, o.helix, o.taper, o.way[kX], o.way[kY], o.way[kZ], o.way[kA]);
}

SetpointStream::SetpointStream(GrindProgram program)
    : SetpointStream(std::make_shared<const GrindProgram>(std::move(program))) {}

SetpointStream::SetpointStream(std::shared_ptr<const GrindProgram> program)
    : program_(std::move(program)), helix_(helixOf(program_->moves().front())), period_(program_->machine().period) {
  const Move& first = program_->moves().front();
  current_.position = program_->start();
  current_.move = first.kind;
  current_.tooth = first.tooth;
  current_.pass = first.pass;
}

bool SetpointStream::next(Setpoint& setpoint) noexcept {
  if (!started_) {
    started_ = true;
    setpoint = current_;
    return true;
  }
  if (!mid_pair_ && !beginPair()) return false;

  const Axes before = current_.position;
  if (lost_) {
    current_.position.setConstant(std::numeric_limits<double>::quiet_NaN());
  } else if (onHelix()) {
    if (mid_pair_) {
      strokePoint(even_point_, StepKind::kEven);
      current_.move_fraction = strokeParameter() / helix_->schedule.length();
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

void SetpointStream::setFeedOverride(double fraction) noexcept {
  if (fraction >= 0 && fraction <= kMaxFeedOverride) override_ = fraction;
}

void SetpointStream::resume() noexcept {
  holding_ = false;
  stay_lifted_ = false;
}

void SetpointStream::retract() noexcept {
  if (mid_pair_ || lost_ || !law_.resting() || rest() == Rest::kEnd) return;
  holding_ = false;
  stay_lifted_ = true;
  if (leg_ == Leg::kBackOff || leg_ == Leg::kLift) {
    // On the way back from a jog the wheel is off the work already.
    if (current_.move != MoveKind::kLift) law_ = SCurveProfile();
    return;
  }
  if (leg_ == Leg::kPath && onHelix()) {
    reentry_ = std::max(0.0, strokeParameter() - helix_->schedule.runUp());
  }
  lifted_ = current_.position;
  if (lifted_[kY] >= program_->clearanceHeight() || lifted_[kX] <= program_->clearX()) return beginLift();
  leg_ = Leg::kBackOff;
  lifted_[kX] = program_->clearX();
  beginStraight(MoveKind::kLift, lifted_);
}

void SetpointStream::beginLift() noexcept {
  leg_ = Leg::kLift;
  lifted_[kY] = std::max(lifted_[kY], program_->clearanceHeight());
  beginStraight(MoveKind::kLift, lifted_);
}

void SetpointStream::adopt(Setpoint& setpoint) noexcept {
  if (rest() != Rest::kLifted) return;
  current_.position = setpoint.position;
  current_.velocity = setpoint.velocity;
  current_.feed = setpoint.feed;
  current_.move = setpoint.move;
  ++current_.cycle;
  setpoint = current_;
}

MoveShape SetpointStream::shape() const noexcept {
  MoveShape shape;
  shape.kind = current_.move;
  if (onHelix()) {
    shape.helix = static_cast<std::size_t>(helix_ - program_->helices().data());
    shape.taper = taper_;
  } else {
    shape.way = way_;
  }
  return shape;
}

void SetpointStream::skip(const SetpointStream& later, std::uint64_t cycles) noexcept {
  law_ = later.law_;
  interpolator_ = later.interpolator_;
  even_point_ = later.even_point_;
  current_.cycle += cycles;
  if (onHelix()) {
    strokePoint(even_point_, StepKind::kEven);
  } else {
    current_.position = clamped(from_ + way_ * law_.position(), from_, to_);
  }
}

std::uint64_t SetpointStream::skipCruise(std::uint64_t cycles, std::uint64_t at_most) noexcept {
  if (onHelix()) return 0;
  const std::uint64_t count = law_.skipCruise(period_, static_cast<double>(cycles) * period_, at_most);
  if (count == 0) return 0;
  current_.cycle += count;
  current_.position = from_ + way_ * law_.position();
  return count;
}

Rest SetpointStream::rest() const noexcept {
  if (!started_ || mid_pair_ || lost_ || !law_.resting()) return Rest::kNone;
  if (law_.finished() && onPath() && next_move_ == program_->moves().size()) return Rest::kEnd;
  if (law_.finished() && leg_ == Leg::kLift && stay_lifted_) return Rest::kLifted;
  if (holding_) return Rest::kHeld;
  return law_.finished() ? Rest::kNone : Rest::kNoFeed;
}

bool SetpointStream::beginPair() noexcept {
  law_.slowDown(slow_down_);
  slow_down_ = 1;
  law_.setTarget(targetSpeed());
  while (!lost_ && law_.resting()) {
    if (rest() != Rest::kNone) return false;
    beginNext();
  }
  return true;
}

//   clearance  + . . . + <- - kBack  - - +
//              |       |                 ^       kBack:   over the stroke to before where it was left
//              |    kPlunge            kLift     kPlunge: at feed, down to the stroke
//              |       v                 |       kPath:   on, at feed again where it was left
//   stroke  ---+-------+== kPath =====>  x  left here
//
// From round the work, kBackOff leads along X to in front of it before kLift.
void SetpointStream::beginNext() noexcept {
  const bool left_stroke = next_move_ > 0 && program_->moves()[next_move_ - 1].kind == MoveKind::kStroke;
  switch (leg_) {
    case Leg::kPath: return beginMove(program_->moves()[next_move_++]);
    case Leg::kBackOff: return beginLift();
    case Leg::kLift:
      if ((current_.position != lifted_).any()) return beginWayBack();
      if (left_stroke) {
        leg_ = Leg::kBack;
        return beginReturn();
      }
      // Another move is restarted: from above, it moves to its original target, unless that is on the way out.
      leg_ = Leg::kPath;
      if (next_move_ > 0 && !isBehind(program_->moves()[next_move_ - 1])) beginMove(program_->moves()[next_move_ - 1]);
      return;
    case Leg::kBack: {
      leg_ = Leg::kPlunge;
      if (helix_ == nullptr) return beginStraight(MoveKind::kApproach, strokeBegin());
      Axes on_path = current_.position;
      on_path[kY] = strokeY(on_path[kX]);
      return beginStraight(MoveKind::kInfeed, on_path);
    }
    case Leg::kPlunge:
      leg_ = Leg::kPath;
      return helix_ != nullptr ? beginStroke(reentry_) : beginMove(program_->moves()[next_move_ - 1]);
  }
}

/// Whether a lift has led the wheel farther out than a move does.
bool SetpointStream::isBehind(const Move& move) const noexcept {
  return move.kind == MoveKind::kRetract && move.to[kY] < current_.position[kY];
}

void SetpointStream::beginMove(const Move& move) noexcept {
  helix_ = helixOf(move);
  current_.tooth = move.tooth;
  current_.pass = move.pass;
  current_.move_index = static_cast<std::uint32_t>(next_move_ - 1);
  current_.move_fraction = 0;
  if (move.kind != MoveKind::kStroke || helix_ == nullptr) return beginStraight(move.kind, move.to);
  taper_ = move.taper;
  y_offset_ = 0;
  y_offset_ = current_.position[kY] - strokeY(program_->strokeFrom());
  a_offset_ = program_->job().strokeLaw(move.tooth).a;
  beginStroke(0);
}

void SetpointStream::beginWayBack() noexcept {
  const Axes& at = current_.position;
  Axes above = lifted_;
  above[kY] = std::max(at[kY], lifted_[kY]);
  if (at[kY] < lifted_[kY]) {
    Axes up = at;
    up[kY] = lifted_[kY];
    return beginStraight(MoveKind::kLift, up);
  }
  if ((at != above).any()) return beginStraight(MoveKind::kPosition, above);
  beginStraight(MoveKind::kApproach, lifted_);
}

void SetpointStream::beginReturn() noexcept {
  if (helix_ == nullptr) {
    Axes above = strokeBegin();
    above[kY] = current_.position[kY];
    return beginStraight(MoveKind::kPosition, above);
  }
  const double x = helix_->schedule.x(reentry_);
  Axes above;
  above << x, current_.position[kY], helix_->z(x), a_offset_ + helix_->curve.a(x);
  beginStraight(MoveKind::kPosition, above);
}

const Helix* SetpointStream::helixOf(const Move& move) const noexcept {
  return program_->isStraight() ? nullptr : &program_->helix(move.tooth);
}

/// Before a stroke the program has the approach to its begin.
const Axes& SetpointStream::strokeBegin() const noexcept { return program_->moves()[next_move_ - 2].to; }

void SetpointStream::beginStraight(MoveKind kind, const Axes& to) noexcept {
  current_.move = kind;
  current_.step = StepKind::kNone;
  current_.path_error = 0;
  from_ = current_.position;
  way_ = to - from_;
  to_ = to;
  linear_way_ = way_.head<3>().matrix().norm();
  if ((way_.abs() <= kNegligibleDistance).all()) {
    current_.position = to;
    law_ = SCurveProfile();
    return;
  }
  const MotionLimits limits = limitsAlong(way_, program_->machine().limits);
  double speed = limits.velocity;
  if (isAtFeed(kind)) speed = std::min(speed, program_->job()->process().feed / linear_way_);
  beginLaw(limits, 1, speed);
}

void SetpointStream::beginStroke(double s) noexcept {
  const GrindInterpolation& settings = program_->job()->interpolation;
  current_.move = MoveKind::kStroke;
  stroke_from_ = s;
  interpolator_.emplace(helix_->curve, settings.rotary_scale, settings.even_step, helix_->schedule.x(s));
  beginLaw(helix_->schedule.limits(), helix_->schedule.length() - s, helix_->schedule.feedSpeed());
}

void SetpointStream::beginLaw(const MotionLimits& limits, double distance, double feed_speed) noexcept {
  move_speed_ = feed_speed;
  if (!law_.begin(limits, distance, 0)) lost_ = true;
  law_.setTarget(targetSpeed());
}

double SetpointStream::targetSpeed() const noexcept {
  if (holding_) return 0;
  return isAtFeed(current_.move) ? std::min(override_ * move_speed_, law_.limits().velocity) : move_speed_;
}

double SetpointStream::strokeParameter() const noexcept {
  return law_.finished() ? helix_->schedule.length() : stroke_from_ + law_.position();
}

void SetpointStream::straightStep() noexcept {
  const bool was_steady = law_.cruising();
  law_.advance(period_);
  if (law_.finished()) {
    current_.position = to_;
  } else {
    current_.position = clamped(from_ + way_ * law_.position(), from_, to_);
  }
  current_.feed = law_.speed() * linear_way_;
  current_.at_feed = current_.move == MoveKind::kStroke && was_steady && law_.cruising();
  if (onPath()) current_.move_fraction = law_.position();
}

void SetpointStream::strokePair() noexcept {
  const auto steady = [&] { return law_.cruising() && helix_->schedule.rate(stroke_from_ + law_.position()) == 1; };
  const bool was_steady = steady();
  law_.advance(2 * period_);
  const double s = strokeParameter();
  const double dx = helix_->schedule.x(s) - interpolator_->position().x;
  const OddEvenPair pair = interpolator_->advance(dx);
  current_.feed = law_.speed() * helix_->schedule.rate(s) * helix_->edge.cutter.edgePerTravel();
  current_.at_feed = was_steady && steady();
  even_point_ = pair.even;
  strokePoint(pair.odd, StepKind::kOdd);
}

void SetpointStream::strokePoint(const CurvePoint& point, StepKind step) noexcept {
  current_.position << point.x, strokeY(point.x), helix_->z(point.x), a_offset_ + point.a;
  current_.path_error = helix_->curve.a(point.x) - point.a;
  current_.step = step;
}

}  // namespace grinder
