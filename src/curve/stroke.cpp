#include "flute_grinder/curve/stroke.h"

#include "flute_grinder/base/format.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

/// Longest step, as a fraction of the distance to the cone's apex: the interpolation expands the curve in it.
constexpr double kMaxOfApex = 0.125;

/// The speed of X, checked.
double speedOfX(const ConicalCutter& cutter, const LogCurve& curve, double from, double to, const StrokeFeed& feed) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  const auto open = [&](double x) { return positive(curve.u(x)); };
  const double speed = feed.feed / cutter.edgePerTravel();
  const double longest = kMaxOfApex * std::min(curve.u(from), curve.u(to));
  const struct {
    bool good;
    const char* name;
    double value;
    const char* allowed;
  } figures[]{
      {open(from), "from", from, "where the cone is open"},
      {open(to), "to", to, "where the cone is open"},
      {positive(feed.feed), "feed", feed.feed, "finite and positive"},
      {positive(feed.acceleration), "acceleration", feed.acceleration, "finite and positive"},
      {positive(feed.jerk), "jerk", feed.jerk, "finite and positive"},
      {positive(feed.period), "period", feed.period, "finite and positive"},
      {positive(feed.rotary_scale), "rotary_scale", feed.rotary_scale, "finite and positive"},
      {std::abs(curve.b()) * speed * feed.period <= longest, "feed", feed.feed,
       "less, for steps of at most an eighth of the distance to the cone's apex"},
  };
  for (const auto& figure : figures) {
    if (figure.good) continue;
    throw std::invalid_argument(format("stroke: %s = %.17g; allowed: %s", figure.name, figure.value, figure.allowed));
  }
  return speed;
}

}  // namespace

Stroke::Stroke(const Cone& cone, double from, double to, const StrokeFeed& feed)
    : cutter_(cone),
      curve_(cutter_),
      interpolator_(curve_, feed.rotary_scale, feed.rule, from),
      from_(from),
      direction_(to < from ? -1 : 1),
      period_(feed.period) {
  const double speed = speedOfX(cutter_, curve_, from, to, feed);
  law_ = SCurveProfile({speed, feed.acceleration, feed.jerk}, std::abs(to - from), speed);
}

bool Stroke::next(StrokePoint& point) noexcept {
  if (!even_is_next_ && law_.resting()) return false;
  if (even_is_next_) {
    point = at(interpolator_.position());
  } else {
    // The law says how far X is at the end of a pair, whose two steps have the same length.
    law_.advance(2 * period_);
    const double x = from_ + direction_ * law_.position();
    point = at(interpolator_.advance(x - interpolator_.position().x).odd);
  }
  even_is_next_ = !even_is_next_;
  return true;
}

void Stroke::setFeedOverride(double fraction) noexcept { law_.setTarget(fraction * law_.limits().velocity); }

StrokePoint Stroke::at(const CurvePoint& point) const noexcept {
  return {point.x, cutter_.y(point.x), cutter_.z(point.x), point.a, curve_.a(point.x) - point.a};
}

}  // namespace grinder
