#include "flute_grinder/core/feed_schedule.h"

#include "flute_grinder/core/odd_even_interpolator.h"

#include <algorithm>
#include <cmath>

namespace flute_grinder {

namespace {

/// How much a limit of X, Y and Z leaves for X, which they all follow in proportion.
double forX(const Axes& limit, double tan_cone, double sin_rake) {
  return std::min({limit[kX], limit[kY] / std::abs(tan_cone), limit[kZ] / std::abs(tan_cone * sin_rake)});
}

}  // namespace

FeedSchedule::FeedSchedule(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine)
    : tan_cone_(cutter.tanCone()), sin_rake_(cutter.sinRake()), from_(stroke.from), to_(stroke.to) {
  const LogCurve curve(cutter);
  chooseSpeeds(cutter, stroke, machine);
  chooseBlendAndLimits(curve, machine.limits);
  placeOnCone(curve);
}

void FeedSchedule::bound(double& value, double candidate, const char* cause) {
  if (!(candidate < value)) return;
  value = candidate;
  limited_by_ = cause;
}

void FeedSchedule::chooseSpeeds(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine) {
  const LogCurve curve(cutter);
  const AxisLimits& limits = machine.limits;
  const double b = std::abs(curve.b());
  const double k = std::abs(curve.k());
  const bool from_thin = curve.u(stroke.from) < curve.u(stroke.to);
  const double thin_x = from_thin ? stroke.from : stroke.to;
  const double u_thin = curve.u(thin_x);
  const double u_thick = curve.u(from_thin ? stroke.to : stroke.from);

  // The odd points' deviation grows toward the thin end; the leading order is taken back by the next one.
  speed_ = stroke.surface_feed / cutter.edgePerTravel();
  const double a_error = stroke.tolerance / (cutter.radius(thin_x) * cutter.cosHelixToGeneratrix());
  const double step = OddEvenInterpolator::largestStepLength(curve, 1, thin_x, a_error);
  if (std::isfinite(step)) {
    const double dx = step * u_thin / std::hypot(u_thin, curve.k());
    bound(speed_, dx / (1 + b * dx / u_thin) / machine.period, "interpolation tolerance");
  }

  // The steps of a pair differ from their mean speed by b v T/u at the most, and must obey the velocity limits too.
  const double turning = std::min(speed_, forX(limits.max_velocity, tan_cone_, sin_rake_)) / u_thin;
  const double ripple = 1 + b * std::min(turning, limits.max_velocity[kA] / k) * machine.period;
  bound(speed_, limits.max_velocity[kX] / ripple, "axis_x velocity");
  bound(speed_, limits.max_velocity[kY] / std::abs(tan_cone_) / ripple, "axis_y velocity");
  bound(speed_, limits.max_velocity[kZ] / std::abs(tan_cone_ * sin_rake_) / ripple, "axis_z velocity");

  // A keeps half of its acceleration and most of its jerk for the feed law and the blend.
  const double uncut = speed_ / u_thin;
  double cut = uncut;
  bound(cut, limits.max_velocity[kA] / k / ripple, "axis_a velocity");
  bound(cut, std::sqrt(limits.max_acceleration[kA] / (2 * k * b)), "axis_a acceleration");
  bound(cut, std::cbrt(limits.max_jerk[kA] / (20 * k * b * b)), "axis_a jerk");
  if (cut < uncut) {
    // Where A goes evenly X gains speed: dv/dt = b c v.
    bound(cut, forX(limits.max_acceleration, tan_cone_, sin_rake_) / (2 * b * speed_), "linear acceleration");
    bound(cut, std::sqrt(forX(limits.max_jerk, tan_cone_, sin_rake_) / (4 * b * b * speed_)), "linear jerk");
    speed_ = std::min(speed_, cut * u_thick);
  }
  speed_per_radius_ = cut;
  beta_ = cut < uncut && u_thin < u_thick ? b * cut / speed_ : 0;
}

void FeedSchedule::chooseBlendAndLimits(const LogCurve& curve, const AxisLimits& limits) {
  const double v = speed_;
  const double u = speed_ / speed_per_radius_;  // where the cut ends, or the thin end: v/u is largest there
  const double b = std::abs(curve.b());
  const double a_slope = std::abs(curve.k()) / u;
  const double a_curvature = a_slope * b / u;
  const double x_acceleration = forX(limits.max_acceleration, tan_cone_, sin_rake_);
  const double x_jerk = forX(limits.max_jerk, tan_cone_, sin_rake_);
  const double a_acceleration = limits.max_acceleration[kA];
  const double a_jerk = limits.max_jerk[kA];

  double blend_jerk = 0;  // of X
  if (beta_ > 0) {
    // A quarter of the jerk limits for the blend. It stays shorter than 1/beta, since chooseSpeeds() has seen to the
    // rest.
    blend_jerk = std::min(x_jerk, a_jerk / a_slope) / 4;
    blend_ = beta_ * v * v * v / blend_jerk;
    blend_rate_ = 1 / (1 + beta_ * blend_ / 2);
  }

  // What is left for the feed law of what the path itself asks for at full feed.
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

}  // namespace flute_grinder
