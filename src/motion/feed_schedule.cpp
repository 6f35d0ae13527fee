#include "flute_grinder/motion/feed_schedule.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/curve/formed_edge.h"
#include "flute_grinder/curve/odd_even_interpolator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

/// Longest step of a pair, as a fraction of the distance to the cone's apex: the series expansions hold only for small
/// fractions.
constexpr double kMaxStep = 0.125;

/// The lowest of several bounds, and its cause.
struct Bound {
  double value = std::numeric_limits<double>::infinity();
  std::string cause;

  void add(double candidate, const std::string& of) {
    if (!(candidate < value)) return;
    value = candidate;
    cause = of;
  }
};

}  // namespace

FeedSchedule::FeedSchedule(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine)
    : y_per_x_(std::max(std::abs(cutter.tanCone()), std::abs(cutter.tanCone() + stroke.taper))),
      from_(stroke.from),
      to_(stroke.to) {
  const LogCurve curve(cutter, stroke.x_shift);
  const double z_per_x = cutter.tanCone() * cutter.zPerY();
  const ZCorrection::Bounds correction = stroke.z_correction.bounds();
  z_per_x_ = std::max(std::abs(z_per_x + correction.min_first), std::abs(z_per_x + correction.max_first));
  z_bend_ = correction.second;
  z_twist_ = correction.third;
  chooseSpeeds(cutter, stroke, machine);
  chooseBlendAndLimits(curve, machine.limits);
  placeOnCone(curve);
}

/// The limit on X that results from the limits of X, Y and Z.
FeedSchedule::ForX FeedSchedule::forX(const Axes& limit) const noexcept {
  ForX lowest{limit[kX], kX};
  const auto bound = [&](double candidate, int axis) {
    if (candidate < lowest.limit) lowest = {candidate, axis};
  };
  bound(limit[kY] / y_per_x_, kY);
  bound(limit[kZ] / z_per_x_, kZ);
  return lowest;
}

/// The limit on the acceleration of X that remains beside the curvature of Z. It also keeps the term 3 Z'' v dv/dt in
/// Z's jerk within a quarter of the jerk limit.
FeedSchedule::ForX FeedSchedule::accelerationForX(const AxisLimits& limits, double speed) const noexcept {
  Axes left = limits.max_acceleration;
  if (z_bend_ > 0) {
    const double within_jerk = z_per_x_ * limits.max_jerk[kZ] / (12 * z_bend_ * speed);
    left[kZ] = std::min(left[kZ] - z_bend_ * speed * speed, within_jerk);
  }
  return forX(left);
}

FeedSchedule::ForX FeedSchedule::jerkForX(const AxisLimits& limits, double speed) const noexcept {
  Axes left = limits.max_jerk;
  left[kZ] -= z_twist_ * speed * speed * speed + 3 * z_bend_ * speed * accelerationForX(limits, speed).limit;
  return forX(left);
}

void FeedSchedule::chooseSpeeds(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine) {
  const LogCurve curve(cutter, stroke.x_shift);
  const AxisLimits& limits = machine.limits;
  const double b = std::abs(curve.b());
  const double k = std::abs(curve.k());
  const bool from_thin = curve.u(stroke.from) < curve.u(stroke.to);
  const double thin_x = from_thin ? stroke.from : stroke.to;
  const double u_thin = curve.u(thin_x);
  const double u_thick = curve.u(from_thin ? stroke.to : stroke.from);
  const double wanted = stroke.surface_feed / cutter.edgePerTravel();
  const ForX velocity = forX(limits.max_velocity);

  // The speeds of a pair's steps differ from their mean by at most b v T/u, and must obey the velocity limits too.
  const double turning = std::min(kMaxFeedOverride * wanted, velocity.limit) / u_thin;
  const double longest = kMaxStep / (b * machine.period);
  const double ripple = 1 + b * std::min({turning, limits.max_velocity[kA] / k, longest}) * machine.period;

  Bound even;  // bound on the speed of X, everywhere on the stroke
  // The odd points' deviation is largest at the thin end. The next-order term reduces the leading-order step.
  const double a_error = stroke.tolerance / FormedEdge{cutter, stroke.x_shift}.deviation(thin_x, 1);
  const double step = OddEvenInterpolator::maxStepLength(curve, 1, thin_x, a_error);
  if (std::isfinite(step)) {
    const double dx = step * u_thin / std::hypot(u_thin, curve.k());
    even.add(dx / (1 + b * dx / u_thin) / machine.period, "interpolation tolerance");
  }
  even.add(velocity.limit / ripple, axisName(velocity.axis) + " velocity");
  // Curvature of Z may use a quarter of each of Z's limits.
  even.add(std::sqrt(limits.max_acceleration[kZ] / (4 * z_bend_)), axisName(kZ) + " acceleration");
  even.add(std::cbrt(limits.max_jerk[kZ] / (4 * z_twist_)), axisName(kZ) + " jerk");
  if (even.value < wanted) feed_limits_.push_back({even.cause, stroke.from, stroke.to});
  feed_speed_ = std::min(wanted, even.value);

  // Half of A's acceleration and most of its jerk are reserved for the feed law and the blend.
  Bound per_radius;
  per_radius.add(limits.max_velocity[kA] / k / ripple, axisName(kA) + " velocity");
  per_radius.add(std::sqrt(limits.max_acceleration[kA] / (2 * k * b)), axisName(kA) + " acceleration");
  per_radius.add(std::cbrt(limits.max_jerk[kA] / (20 * k * b * b)), axisName(kA) + " jerk");
  per_radius.add(longest, "control rate");

  if (!(per_radius.value < feed_speed_ / u_thin)) {
    speed_ = std::min({kMaxFeedOverride * wanted, even.value, per_radius.value * u_thin});
    speed_per_radius_ = speed_ / u_thin;
    return;
  }
  // Where A turns at constant speed, X accelerates: dv/dt = b c v.
  const ForX acceleration = accelerationForX(limits, feed_speed_);
  const ForX jerk = jerkForX(limits, feed_speed_);
  per_radius.add(acceleration.limit / (2 * b * feed_speed_), axisName(acceleration.axis) + " acceleration");
  per_radius.add(std::sqrt(jerk.limit / (4 * b * b * feed_speed_)), axisName(jerk.axis) + " jerk");
  feed_limits_.push_back({per_radius.cause, stroke.from, stroke.to});  // placeOnCone() may shorten it
  speed_per_radius_ = per_radius.value;
  feed_speed_ = speed_ = std::min(feed_speed_, speed_per_radius_ * u_thick);
  beta_ = u_thin < u_thick ? b * speed_per_radius_ / speed_ : 0;
}

void FeedSchedule::chooseBlendAndLimits(const LogCurve& curve, const AxisLimits& limits) {
  const double v = speed_;
  const double u = speed_ / speed_per_radius_;  // where the reduced feed or the cone ends: v/u is largest there
  const double b = std::abs(curve.b());
  const double a_slope = std::abs(curve.k()) / u;
  const double a_curvature = a_slope * b / u;
  const double x_acceleration = accelerationForX(limits, v).limit;
  const double x_jerk = jerkForX(limits, v).limit;
  const double a_acceleration = limits.max_acceleration[kA];
  const double a_jerk = limits.max_jerk[kA];

  double blend_jerk = 0;  // jerk of X
  if (beta_ > 0) {
    // A quarter of the jerk limits is for the blend. chooseSpeeds() keeps the blend shorter than 1/beta.
    blend_jerk = std::min(x_jerk, a_jerk / a_slope) / 4;
    blend_ = beta_ * v * v * v / blend_jerk;
    blend_rate_ = 1 / (1 + beta_ * blend_ / 2);
  }

  // The path itself uses part of the limits at full feed; the rest is for the feed law.
  const double x_path_acceleration = beta_ * v * v;
  const double x_path_jerk = std::max(beta_ * beta_ * v * v * v, blend_jerk);
  const double a_path_acceleration = a_curvature * v * v;
  const double a_path_jerk = blend_jerk * a_slope + 3 * a_curvature * b / u * v * v * v;
  const double acceleration =
      std::min({x_acceleration - x_path_acceleration, (a_acceleration - a_path_acceleration) / a_slope,
                x_jerk / (12 * beta_ * v), a_jerk / (12 * a_curvature * v)});
  const double jerk = std::min(x_jerk - x_path_jerk - 3 * beta_ * v * acceleration,
                               (a_jerk - a_path_jerk - 3 * a_curvature * v * acceleration) / a_slope);
  limits_ = {v, acceleration, jerk};
}

void FeedSchedule::placeOnCone(const LogCurve& curve) {
  direction_ = to_ < from_ ? -1 : 1;
  if (beta_ == 0) {
    length_ = std::abs(to_ - from_);
    return;
  }
  const double toward_thick = curve.b() < 0 ? -1 : 1;
  const double blend_x = (blend_rate_ * speed_ / speed_per_radius_ - 1) / curve.b();
  xi_from_ = toward_thick * (from_ - blend_x);
  q_from_ = parameterOf(xi_from_);
  const double q_to = parameterOf(toward_thick * (to_ - blend_x));
  length_ = std::abs(q_to - q_from_);
  q_direction_ = q_to < q_from_ ? -1 : 1;
  double& full_feed_end = q_direction_ > 0 ? feed_limits_.back().to_x : feed_limits_.back().from_x;
  if (std::max(q_from_, q_to) > blend_) full_feed_end = blend_x + toward_thick * distance(blend_);
}

double FeedSchedule::runUp() const noexcept {
  const double v = feed_speed_;
  const double a = limits_.acceleration;
  const double j = limits_.jerk;
  const double time = v > a * a / j ? v / a + a / j : 2 * std::sqrt(v / j);
  return v * time / 2;
}

double FeedSchedule::distance(double q) const noexcept {
  if (beta_ == 0) return q;
  if (q < 0) return blend_rate_ / beta_ * std::expm1(beta_ * q);
  const double curve = beta_ * blend_rate_ / (6 * blend_);
  const double left = std::max(0.0, blend_ - q);
  return q - curve * (blend_ * blend_ * blend_ - left * left * left);
}

double FeedSchedule::slope(double q) const noexcept {
  if (beta_ == 0) return 1;
  if (q < 0) return blend_rate_ * std::exp(beta_ * q);
  const double left = std::max(0.0, blend_ - q);
  return 1 - beta_ * blend_rate_ / (2 * blend_) * left * left;
}

double FeedSchedule::parameterOf(double xi) const noexcept {
  if (xi < 0) return std::log1p(beta_ * xi / blend_rate_) / beta_;
  const double full = beta_ * blend_rate_ * blend_ * blend_ / 6;
  if (xi >= blend_ - full) return xi + full;
  double q = xi;
  for (int i = 0; i < 50; ++i) {
    const double correction = (xi - distance(q)) / slope(q);
    q += correction;
    if (!(std::abs(correction) > 1e-17)) break;
  }
  return q;
}

double FeedSchedule::x(double s) const noexcept {
  if (s <= 0) return from_;
  if (s >= length_) return to_;
  return from_ + direction_ * std::abs(distance(q_from_ + q_direction_ * s) - xi_from_);
}

double FeedSchedule::rate(double s) const noexcept { return slope(q_from_ + q_direction_ * s); }

}  // namespace grinder
