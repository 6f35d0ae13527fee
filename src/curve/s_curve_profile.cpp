#include "flute_grinder/curve/s_curve_profile.h"

#include "flute_grinder/base/require.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

/// A parameter of a motion, and whether it is valid.
struct Figure {
  bool good;
  const char* name;
  double value;
  const char* allowed;
};

std::array<Figure, 5> figures(const MotionLimits& limits, double distance, double target) noexcept {
  const auto limit = [](const char* name, double v) {
    return Figure{v > 0 && std::isfinite(v), name, v, "finite and positive"};
  };
  return {
      limit("feed law: velocity limit", limits.velocity), limit("feed law: acceleration limit", limits.acceleration),
      limit("feed law: jerk limit", limits.jerk),
      Figure{distance >= 0 && std::isfinite(distance), "feed law: distance", distance, "finite, not negative"},
      Figure{target >= 0 && target <= limits.velocity, "feed law: target speed", target, "0 to the velocity limit"}};
}

}  // namespace

SCurveProfile::SCurveProfile(const MotionLimits& limits, double distance, double target) {
  if (begin(limits, distance, target)) return;
  for (const Figure& figure : figures(limits, distance, target)) {
    require(figure.good, figure.name, figure.value, figure.allowed);
  }
}

bool SCurveProfile::begin(const MotionLimits& limits, double distance, double target) noexcept {
  const auto all = figures(limits, distance, target);
  if (!std::all_of(all.begin(), all.end(), [](const Figure& f) { return f.good; })) return false;
  *this = SCurveProfile();
  limits_ = limits;
  distance_ = distance;
  target_ = target;
  plan();
  return true;
}

bool SCurveProfile::setTarget(double target) noexcept {
  if (!(target >= 0 && target <= limits_.velocity)) return false;
  if (target == target_) return true;
  target_ = target;
  // During final braking the remaining distance only just suffices for a stop, so there is no other profile.
  const bool final_braking = !resting() && segment_ >= final_braking_;
  if (!final_braking) plan();
  return true;
}

void SCurveProfile::slowDown(double factor) noexcept {
  if (!(factor > 0 && factor < 1) || resting()) return;
  speed_ *= factor;
  acceleration_ *= factor * factor;
  plan();
}

void SCurveProfile::advance(double dt) noexcept {
  time_ += dt;
  if (resting()) {
    segment_ = segment_count_;
    return rest();
  }
  while (segment_ + 1 < segment_count_ && time_ >= segments_[segment_ + 1].start_time) ++segment_;
  follow(segment_);
}

void SCurveProfile::follow(int segment) noexcept {
  const Segment& s = segments_[segment];
  const State state = after(s.start, s.jerk, time_ - s.start_time);
  position_ = std::min(state.position, distance_);
  speed_ = state.speed;
  acceleration_ = state.acceleration;
}

std::uint64_t SCurveProfile::skipCruise(double dt, double margin, std::uint64_t at_most) noexcept {
  if (!cruising() || time_ < segments_[segment_].start_time + margin) return 0;
  const double end = segment_ + 1 < segment_count_ ? segments_[segment_ + 1].start_time : end_time_;
  std::uint64_t count = 0;
  for (; count + 2 <= at_most && time_ + 2 * dt < end - 2 * margin; count += 2) {
    // Two separate additions, to round as advance() does.
    time_ += dt;
    time_ += dt;
  }
  follow(segment_);
  return count;
}

SCurveProfile::State SCurveProfile::after(const State& s, double jerk, double t) noexcept {
  // At constant speed, which is most of the time: the same result without a division.
  if (jerk == 0 && s.acceleration == 0) return {s.position + t * s.speed, s.speed, 0};
  return {s.position + t * (s.speed + t * (s.acceleration / 2 + t * jerk / 6)),
          s.speed + t * (s.acceleration + t * jerk / 2), s.acceleration + t * jerk};
}

SCurveProfile::SpeedChange SCurveProfile::changeSpeed(double speed, double acceleration, double to) const noexcept {
  const double j = limits_.jerk;
  // The speed that would result from reducing the acceleration to 0 immediately decides whether to speed up or slow
  // down.
  const double settled = speed + acceleration * std::abs(acceleration) / (2 * j);
  const double sign = to >= settled ? 1 : -1;
  const double a0 = sign * acceleration;
  const double change = sign * (to - speed);
  const double peak_squared = std::max(0.0, j * change + a0 * a0 / 2);
  double peak = std::max(a0, std::sqrt(peak_squared));
  double hold = 0;
  if (peak > limits_.acceleration) {
    peak = std::max(a0, limits_.acceleration);
    hold = std::max(0.0, (change - (peak * peak - a0 * a0 / 2) / j) / peak);
  }
  return {Phase{(peak - a0) / j, sign * j}, Phase{hold, 0}, Phase{peak / j, -sign * j}};
}

double SCurveProfile::stoppingDistance(double through) const noexcept {
  State s{0, speed_, acceleration_};
  for (const Phase& p : changeSpeed(speed_, acceleration_, through)) s = after(s, p.jerk, p.duration);
  s.speed = through;
  s.acceleration = 0;
  for (const Phase& p : changeSpeed(through, 0, 0)) s = after(s, p.jerk, p.duration);
  return s.position;
}

void SCurveProfile::plan() noexcept {
  State s{position_, speed_, acceleration_};
  segment_count_ = 0;
  segment_ = 0;
  time_ = 0;
  end_time_ = 0;
  const double left = distance_ - position_;
  const double cruise = left > 0 ? cruiseSpeed(left) : 0;
  if (left > 0) append(changeSpeed(s.speed, s.acceleration, cruise), cruise, s);
  if (cruise > 0) append(Phase{std::max(0.0, left - stoppingDistance(cruise)) / cruise, 0}, s);
  final_braking_ = target_ > 0 && cruise == 0 ? 0 : segment_count_;
  if (cruise > 0) append(changeSpeed(cruise, 0, 0), 0, s);
  const bool to_end = target_ > 0 || left <= 0;
  end_ = {to_end ? distance_ : std::min(s.position, distance_), 0, 0};
  if (resting()) rest();
}

void SCurveProfile::rest() noexcept {
  position_ = end_.position;
  speed_ = 0;
  acceleration_ = 0;
}

double SCurveProfile::cruiseSpeed(double left) const noexcept {
  if (stoppingDistance(target_) <= left) return target_;
  double low = 0;
  double high = target_;
  for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2) {
    (stoppingDistance(middle) <= left ? low : high) = middle;
  }
  return low;
}

void SCurveProfile::append(const Phase& phase, State& state) noexcept {
  if (!(phase.duration > 0)) return;
  segments_[segment_count_++] = {end_time_, state, phase.jerk};
  state = after(state, phase.jerk, phase.duration);
  end_time_ += phase.duration;
}

void SCurveProfile::append(const SpeedChange& change, double end_speed, State& state) noexcept {
  for (const Phase& phase : change) append(phase, state);
  state.speed = end_speed;
  state.acceleration = 0;
}

}  // namespace grinder
