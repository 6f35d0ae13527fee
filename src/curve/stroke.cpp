#include "flute_grinder/curve/stroke.h"

#include "flute_grinder/base/require.h"

#include <algorithm>
#include <cmath>

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
  require(open(from), "stroke: from", from, "where the cone is open");
  require(open(to), "stroke: to", to, "where the cone is open");
  require(positive(feed.feed), "stroke: feed", feed.feed, "finite and positive");
  require(positive(feed.acceleration), "stroke: acceleration", feed.acceleration, "finite and positive");
  require(positive(feed.jerk), "stroke: jerk", feed.jerk, "finite and positive");
  require(positive(feed.period), "stroke: period", feed.period, "finite and positive");
  require(positive(feed.rotary_scale), "stroke: rotary_scale", feed.rotary_scale, "finite and positive");
  require(std::abs(curve.b()) * speed * feed.period <= longest, "stroke: feed", feed.feed,
          "less, for steps of at most an eighth of the distance to the cone's apex");
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
