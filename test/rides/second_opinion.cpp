#include "second_opinion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace second_opinion {

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr Real kRest = 10e-6L;  ///< how far before its end an axis may rest that leads out of the work [m]

std::string text(const char* what, int axis, Real value, Real allowed) {
  std::ostringstream out;
  out.precision(17);
  out << what << " of axis "
      << "XYZA"[axis] << " = " << static_cast<double>(value) << ", allowed " << static_cast<double>(allowed);
  return out.str();
}

/// The B-spline of degree 5 with knots 0, 1, ... 6, by truncated powers.
Real spline(Real t) {
  if (!(t > 0 && t < 6)) return 0;
  if (t > 3) t = 6 - t;
  constexpr int choose[]{1, 6, 15};
  Real sum = 0;
  for (int j = 0; j < 3 && t > j; ++j) {
    const Real part = t - j;
    sum += (j % 2 == 0 ? choose[j] : -choose[j]) * part * part * part * part * part;
  }
  return sum / 120;
}

}  // namespace

Watch::Watch(Asked asked) : asked_(std::move(asked)), progress_{0, asked_.from, false, false} {
  for (const Tooth& t : asked_.teeth) {
    // A is a difference of turns, and X in it is rounded.
    for (const Real x : {Real(0), asked_.from, asked_.to}) {
      const Real slope = t.k / (1 + t.b * (x - t.x_shift));
      turn_ = std::max({turn_, std::abs(t.a), std::abs(curve(t, x) - t.a), std::abs(slope * x)});
    }
  }
}

/// What the rounding of a place and of what it is computed from comes to.
Real Watch::noiseOf(int axis) const {
  return 64 * kEps * (farthest_[static_cast<std::size_t>(axis)] + (axis == 3 ? turn_ : 0) + 1e-3L);
}

Real Watch::curve(const Tooth& t, Real x) const {
  const Real way = x - t.x_shift;
  return t.a + (t.b == 0 ? t.k * way : t.k / t.b * std::log1p(t.b * way));
}

Real Watch::edge(const Tooth& t) const {
  // The helix goes round by radius * k a way along the cone.
  return std::sqrt(1 + asked_.radius * asked_.radius * t.k * t.k / (1 + t.growth * t.growth));
}

Real Watch::deviation(const Tooth& t, Real x, Real a) const {
  return (a - curve(t, x)) * (asked_.radius + (x - t.x_shift) * t.growth) / edge(t);
}

Real Watch::z(const Tooth& t, Real x) const {
  Real z = x * t.growth * t.z_per_y;
  for (std::size_t i = 0; i < t.coefficients.size(); ++i) {
    z += t.coefficients[i] * spline((x - t.from) / t.piece - static_cast<Real>(i) + 5);
  }
  return z;
}

void Watch::see(const Row& row) {
  // A move is computed from its ends, which may lie far from where it is.
  for (std::size_t i = 0; i < row.at.size(); ++i) {
    farthest_[i] = std::max({farthest_[i], std::abs(row.at[i]), row.of_job ? std::abs(row.work[i]) : 0});
  }
  if (has_last_ && !row.free && !last_.free) {
    checkMotion(row);
  } else {
    ends_.fill(row.at);
  }
  if (row.moves && row.rises && !goesOut(last_.at, row.at, asked_.offset_x)) {
    throw Violation("a lift moves another axis, or the wrong way");
  }
  if (row.of_job) {
    checkPlace(row);
    if (row.in_stroke) checkStroke(row);
  }
  checkWayOut(row);
  // Without a setpoint, its place means nothing.
  const Point work = row.moves ? row.work : last_.work;
  last_ = row;
  last_.work = work;
  has_last_ = true;
}

void Watch::checkMotion(const Row& row) {
  if (!row.moves) {
    if (row.at != last_.at) throw Violation("the command moves without a setpoint");
    return;
  }
  if (row.cycle == 0) {
    ends_.fill(row.at);
  } else if (row.cycle != cycle_ + 1) {
    throw Violation("setpoint " + std::to_string(row.cycle) + " follows " + std::to_string(cycle_));
  }
  cycle_ = row.cycle;
  if (row.late) broken_ = 4;
  const Real t = asked_.period;
  for (int i = 0; i < 4; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const Real noise = noiseOf(i);
    const double place = row.at[axis] - (i == 1 ? row.y_off : 0);
    if (!(place >= asked_.low[axis] - noise && place <= asked_.high[axis] + noise)) {
      throw Violation(text("place", i, place, place < asked_.low[axis] ? asked_.low[axis] : asked_.high[axis]));
    }
    const Real velocity = (Real(row.at[axis]) - last_.at[axis]) / t;
    if (!(std::abs(velocity) <= asked_.velocity[axis] * (1 + 1e-9L) + noise / t)) {
      throw Violation(text("velocity", i, velocity, asked_.velocity[axis]));
    }
    if (row.cycle % 2 != 0 || broken_ > 0) continue;
    // The odd and even steps within a pair differ from the path's.
    const Real pair = 2 * t;
    const Real acceleration = (Real(row.at[axis]) - 2 * Real(ends_[0][axis]) + ends_[1][axis]) / (pair * pair);
    const Real jerk = (Real(row.at[axis]) - 3 * Real(ends_[0][axis]) + 3 * Real(ends_[1][axis]) - ends_[2][axis]) /
                      (pair * pair * pair);
    if (!(std::abs(acceleration) <= asked_.acceleration[axis] * (1 + 1e-9L) + 4 * noise / (pair * pair))) {
      throw Violation(text("acceleration", i, acceleration, asked_.acceleration[axis]));
    }
    if (!(std::abs(jerk) <= asked_.jerk[axis] * (1 + 1e-9L) + 8 * noise / (pair * pair * pair))) {
      throw Violation(text("jerk", i, jerk, asked_.jerk[axis]));
    }
  }
  if (row.cycle % 2 != 0) return;
  ends_ = {row.at, ends_[0], ends_[1]};
  if (broken_ > 0) --broken_;
}

/// The lowest Y that any pass so far has, or that the one in progress is to have.
Real Watch::lowest(Real x) const {
  Real y = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i <= std::min(progress_.ground, asked_.passes.size() - 1); ++i) {
    const Pass& pass = asked_.passes[i];
    y = std::min(y, x * asked_.teeth[static_cast<std::size_t>(pass.tooth)].growth - pass.at_end + x * pass.taper);
  }
  return y;
}

/// Above all of the work.
Real Watch::clearHeight() const {
  if (asked_.straight) return asked_.clearance;
  const Real growth = asked_.teeth.front().growth;
  return std::max(asked_.from * growth, asked_.to * growth) + asked_.clearance;
}

/// Whatever a job leaves in the work goes out of it, and nowhere else.
void Watch::checkWayOut(const Row& row) {
  if (!row.moves && !row.free) return;
  const Real y = row.free ? row.y + kRest : row.at[1] - row.y_off;
  if (y - asked_.offset_y >= clearHeight() - noiseOf(1)) {
    progress_.in_work = progress_.entered = false;
  } else if (row.of_job) {
    const auto [low, high] = std::minmax(asked_.from, asked_.to);
    progress_.in_work = asked_.straight || (row.work[0] >= low && row.work[0] <= high);
    progress_.entered = progress_.entered || row.in_stroke;
  } else if (progress_.in_work && row.moves && !goesOut(last_.at, row.at, asked_.offset_x)) {
    throw Violation("the wheel leaves the work another way than out");
  }
}

bool Watch::risesFrom(const Point& from, const Point& to) const {
  return to[0] == from[0] && to[2] == from[2] && to[3] == from[3] && to[1] >= from[1] - noiseOf(1);
}

/// Up; or back along X, before it rises from round the work.
bool Watch::goesOut(const Point& from, const Point& to, Real offset_x) const {
  const bool is_round = asked_.round_work && progress_.entered;
  if (risesFrom(from, to)) return !is_round || to[1] == from[1] || from[0] - offset_x <= asked_.clear_x + kRest;
  return asked_.round_work && to[0] <= from[0] && to[1] == from[1] && to[2] == from[2] && to[3] == from[3];
}

void Watch::checkPlace(const Row& row) {
  if (row.lifts) {
    // A run begins wherever the axes are.
    if (row.cycle == 0 || !last_.of_job || goesOut(last_.work, row.work, 0)) return;
    throw Violation("a lift moves another axis, or the wrong way");
  }
  if (asked_.straight) return checkStraightPlace(row);
  const Real x = row.work[0], y = row.work[1];
  const Tooth& tooth = asked_.teeth[static_cast<std::size_t>(row.tooth)];
  const Real surface = x * tooth.growth;
  const Real noise = noiseOf(1);
  if (y >= surface + asked_.clearance - noise) return;
  if (y >= clearHeight() - noise) return;
  const auto [low, high] = std::minmax(asked_.from, asked_.to);
  if (!(x >= low - noise && x <= high + noise)) throw Violation(text("in the work, place", 0, x, x < low ? low : high));
  if (!(y >= lowest(x) - noise)) throw Violation(text("depth: place", 1, y, lowest(x)));
  // Wherever the wheel is near the work, it is on the path of the tooth.
  const Real off = deviation(tooth, x, row.work[3]);
  const Real a_noise = noiseOf(3) * (asked_.radius + std::abs(x)) + 1e-15L;
  if (!(std::abs(off) <= asked_.deviation * (1 + 1e-9L) + a_noise)) {
    throw Violation(text("off the curve: deviation", 3, off, asked_.deviation));
  }
  if (!(std::abs(row.work[2] - z(tooth, x)) <= noiseOf(2))) {
    throw Violation(text("off the law of Z: place", 2, row.work[2], z(tooth, x)));
  }
  const auto goes = [&](int axis) {
    const auto i = static_cast<std::size_t>(axis);
    return !(std::abs(row.work[i] - last_.work[i]) <= noiseOf(axis));
  };
  // A stroke ends off the curve by what the deviation allows.
  const bool across = last_.of_job && (goes(0) || goes(2));
  if (across && !row.in_stroke) throw Violation("the wheel goes across in the work without a stroke");
}

/// Beside the work a wheel goes out, or comes down to where a stroke begins; only strokes go elsewhere.
void Watch::checkStraightPlace(const Row& row) {
  if (row.in_stroke || row.work[1] >= clearHeight() - noiseOf(1)) return;
  if (goesOut(last_.work, row.work, 0) || beginsPass(row)) return;
  throw Violation("the wheel is beside the work without a stroke, and goes not out");
}

bool Watch::beginsPass(const Row& row) const {
  return std::any_of(asked_.passes.begin(), asked_.passes.end(), [&](const Pass& pass) {
    const Point& from = pass.from;
    // A wheel that goes round the work is clear of it all along its way in front.
    const bool in_front = asked_.round_work && row.work[0] <= from[0];
    return pass.tooth == row.tooth && pass.pass == row.pass && (row.work[0] == from[0] || in_front) &&
           row.work[1] >= from[1] && row.work[2] == from[2] && row.work[3] == from[3];
  });
}

/// A straight stroke is begun again at its beginning after whatever has left it.
void Watch::checkStraightStroke(const Row& row, const Pass& pass, bool next) {
  Point way{};
  Real length = 0, along = 0, before = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    way[i] = pass.to[i] - pass.from[i];
    length = std::hypot(length, Real(way[i]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    along += (Real(row.work[i]) - pass.from[i]) * way[i] / length;
    before += (Real(last_.work[i]) - pass.from[i]) * way[i] / length;
  }
  for (int i = 0; i < 4; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const Real at = i == 3 ? Real(pass.from[3]) : pass.from[axis] + way[axis] * along / length;
    if (!(std::abs(row.work[axis] - at) <= 4 * noiseOf(i)))
      throw Violation(text("off the stroke: place", i, row.work[axis], at));
  }
  const Real noise = noiseOf(0) + noiseOf(1) + noiseOf(2), step = along - before;
  if (!(along <= length + noise)) throw Violation(text("beyond the stroke: place", 1, along, length));
  if (!(step >= -noise)) throw Violation(text("a stroke goes back: place", 1, along, before));
  const Real most = asked_.period * asked_.feed * (1 + 1e-9L);
  if (!(step <= most + noise)) throw Violation(text("feed: way", 1, step, most));
  if (!next) return;
  if (!(along - progress_.reached <= most + noise)) throw Violation(text("a gap: place", 1, along, progress_.reached));
  progress_.reached = std::max(progress_.reached, along);
  if (length - along > noise) return;
  ++progress_.ground;
  progress_.reached = 0;
  progress_.again = !row.ends_stroke;
}

void Watch::checkStroke(const Row& row) {
  const auto is = [&](std::size_t i) {
    return i < asked_.passes.size() && asked_.passes[i].tooth == row.tooth && asked_.passes[i].pass == row.pass;
  };
  // A wheel that was lifted at the very end of a stroke enters that stroke again.
  const bool next = is(progress_.ground);
  const bool again = progress_.ground > 0 && is(progress_.ground - 1);
  if (!next && !again) {
    throw Violation("a stroke of tooth " + std::to_string(row.tooth) + ", pass " + std::to_string(row.pass) +
                    " after " + std::to_string(progress_.ground) + " passes");
  }
  progress_.again = !next && !row.ends_stroke;
  const Pass& own = asked_.passes[next ? progress_.ground : progress_.ground - 1];
  if (asked_.straight) return checkStraightStroke(row, own, next);
  checkFeed(row, asked_.teeth[static_cast<std::size_t>(row.tooth)]);
  const Real x = row.work[0];
  const Real y = x * asked_.teeth[static_cast<std::size_t>(row.tooth)].growth - own.at_end + x * own.taper;
  if (!(std::abs(row.work[1] - y) <= 2 * noiseOf(1))) throw Violation(text("stroke: place", 1, row.work[1], y));
  if (!next) return;
  const Real forward = asked_.to < asked_.from ? -1 : 1;
  const Real step = 2 * asked_.period * asked_.feed * (1 + 1e-9L);
  if (!(forward * (x - progress_.reached) <= step + noiseOf(0)))
    throw Violation(text("a gap: place", 0, x, progress_.reached));
  progress_.reached = forward * (x - progress_.reached) > 0 ? x : progress_.reached;
  if (std::abs(x - asked_.to) > noiseOf(0)) return;
  ++progress_.ground;
  progress_.reached = asked_.from;
  progress_.again = !row.ends_stroke;
}

/// A stroke goes forward, and a pair no faster than the feed.
void Watch::checkFeed(const Row& row, const Tooth& tooth) {
  const Real forward = asked_.to < asked_.from ? -1 : 1;
  const Real noise = 2 * noiseOf(0);
  if (!(forward * (Real(row.work[0]) - last_.work[0]) >= -noise)) {
    throw Violation(text("a stroke goes back: place", 0, row.work[0], last_.work[0]));
  }
  if (row.cycle % 2 != 0) {
    pair_from_ = last_.work[0];
    return;
  }
  const Real pair = std::abs(row.work[0] - pair_from_) * std::sqrt(1 + tooth.growth * tooth.growth) * edge(tooth);
  const Real most = 2 * asked_.period * asked_.feed;
  if (!(pair <= most * (1 + 1e-9L) + noise)) throw Violation(text("feed: way", 0, pair, most));
}

void Button::wait(Real period) {
  age_ += period;
  barred_ = barred_ || (pressed_ && age_ > timeout_);
}

void Button::stall() {
  if (!stalled_ && age_ <= timeout_) age_ = 0;
  stalled_ = true;
}

void Button::press(int axis) {
  if (pressed_ && axis != axis_) return;
  pressed_ = true;
  axis_ = axis;
  age_ = 0;
  stalled_ = false;
}

}  // namespace second_opinion
