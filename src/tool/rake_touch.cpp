#include "flute_grinder/tool/rake_touch.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace grinder {

namespace {

using units::kPi;

constexpr int kTouchSteps = 12;                ///< steps to either side over the ball before a touch is refined
constexpr std::size_t kCandidates = 3;         ///< number of places of the ball that may touch first
constexpr int kBits = 20;                      ///< precision of a refined place: the angle is far better
constexpr std::uintmax_t kMaxTouchSteps = 60;  ///< maximum number of steps of a refinement
constexpr int kDistances = 24;                 ///< number of distances tried to find the allowed range
constexpr int kDiameterHalvings = 6;           ///< number of halvings of the diameter, likewise
constexpr double kAtEdge = 10e-6;              ///< distance from the edge that is not yet the rake face [m]
constexpr double kFar = 1e3;                   ///< more than any angle of a wall [rad]
constexpr double kRounding = 1e-6;             ///< rounding of lengths in texts, and the minimum ball [m]

/// The result for a ball turned to the rake face; all but kTouches are refusals.
enum class Fit { kTouches, kOutside, kEdge, kFloor, kOtherWall };

const char* whatItTouches(Fit fit) {
  switch (fit) {
    case Fit::kTouches: return "the rake face";
    case Fit::kOutside: return "nothing of the flute";
    case Fit::kEdge: return "the cutting edge";
    case Fit::kFloor: return "the flute's floor first";
    case Fit::kOtherWall: break;
  }
  return "the flute's other wall first";
}

const Flute& firstFlute(const GroundCutter& cutter) { return cutter.flutes().at(cutter.teeth().at(0).flute); }

/// A ball that turns about the cutter's axis in the first tooth's flute. On every circle about that axis the ball has
/// an arc about its centre's angle, and the flute has an arc between its walls. The ball is free as long as its arc
/// lies within the flute's arc on all circles; it touches on the circle that lets it turn least.
class TurningBall {
 public:
  TurningBall(const GroundCutter& cutter, double x, double from_axis, double radius)
      : cutter_(cutter), flute_(firstFlute(cutter)), x_(x), from_axis_(from_axis), radius_(radius) {}

  struct Result {
    Fit fit = Fit::kOutside;
    double angle = 0;  ///< angle of the ball's centre in the cutter's frame when it touches the rake face [rad]
  };
  Result turn() const {
    return resultOf([this](int side) { return first(side); });
  }

  /// The result from a grid of places on the ball only.
  Fit coarseFit() const {
    return resultOf([this](int side) { return coarse(side, 1).front(); }).fit;
  }

 private:
  /// A place on the ball, in angles, and the angle of the ball's centre when the place touches a wall, times the sign
  /// of that wall.
  struct Place {
    double along = 0;   ///< angle from the ball's middle along the axis, in its section
    double across = 0;  ///< from the innermost place of the section to the outermost in the blank, 0 to 1
    double angle = kFar;
  };
  /// The circle about the cutter's axis through a place.
  struct Circle {
    double x, r;
    double half_angle;  ///< half angle of the circle's arc inside the ball
  };

  /// Sign of the rake face's wall: 1 for the wall at the larger angles, -1 for the other one.
  int rakeSide() const { return cutter_.direction() == CutDirection::kRightHand ? 1 : -1; }

  std::optional<Circle> circleAt(double along, double across) const {
    const double x = x_ + radius_ * std::sin(along);
    const double section = radius_ * std::cos(along);
    const double outward = cutter_.cutter().radius(x) - from_axis_;
    if (!(outward > -section)) return std::nullopt;
    const double outermost = outward < section ? std::asin(outward / section) : kPi / 2;
    const double at = -kPi / 2 + across * (outermost + kPi / 2);
    const double r = from_axis_ + section * std::sin(at);
    if (!(r > 0)) return Circle{x, 0, 0};
    return Circle{x, r, 2 * std::asin(std::min(1.0, section * std::cos(at) / (2 * std::sqrt(r * from_axis_))))};
  }

  /// The angle that the ball may turn before it touches a wall on the circle of a place.
  double angleAt(int side, double along, double across) const {
    const auto circle = circleAt(along, across);
    if (!circle) return kFar;
    double wall = -kFar;
    for (const WheelSweep& sweep : flute_) {
      if (!(circle->r > 0)) break;
      const auto at = sweep.wall(circle->x, circle->r, side > 0);
      if (at) wall = std::max(wall, side * at->angle);
    }
    return wall - circle->half_angle;
  }

  /// The places of a grid that touch a wall before their neighbours; the first ones, in order.
  std::vector<Place> coarse(int side, std::size_t count) const {
    std::array<std::array<Place, kTouchSteps + 1>, kTouchSteps + 1> grid;
    for (std::size_t i = 0; i <= kTouchSteps; ++i) {
      for (std::size_t k = 0; k <= kTouchSteps; ++k) {
        const double along = kPi * (static_cast<double>(i) / kTouchSteps - 0.5),
                     across = static_cast<double>(k) / kTouchSteps;
        grid[i][k] = {along, across, angleAt(side, along, across)};
      }
    }
    std::vector<Place> found;
    for (std::size_t i = 0; i <= kTouchSteps; ++i) {
      for (std::size_t k = 0; k <= kTouchSteps; ++k) {
        bool is_first = true;
        for (std::size_t m = i == 0 ? 0 : i - 1; m <= std::min<std::size_t>(i + 1, kTouchSteps); ++m) {
          for (std::size_t n = k == 0 ? 0 : k - 1; n <= std::min<std::size_t>(k + 1, kTouchSteps); ++n)
            is_first = is_first && grid[i][k].angle <= grid[m][n].angle;
        }
        if (is_first) found.push_back(grid[i][k]);
      }
    }
    std::sort(found.begin(), found.end(), [](const Place& a, const Place& b) { return a.angle < b.angle; });
    found.resize(std::min(found.size(), count));
    return found;
  }

  template <typename Function>
  static std::pair<double, double> minimum(const Function& f, double middle, double step, double from, double to) {
    std::uintmax_t steps = kMaxTouchSteps;
    return boost::math::tools::brent_find_minima(f, std::max(from, middle - step), std::min(to, middle + step), kBits,
                                                 steps);
  }

  Place refined(int side, const Place& place) const {
    const auto in_section = [&](double along) {
      const auto f = [&](double across) { return angleAt(side, along, across); };
      return minimum(f, place.across, 1.0 / kTouchSteps, 0, 1);
    };
    const auto f = [&](double along) { return in_section(along).second; };
    const auto [along, angle] = minimum(f, place.along, kPi / kTouchSteps, -kPi / 2, kPi / 2);
    return {along, in_section(along).first, angle};
  }

  /// The place where the ball first touches a wall.
  Place first(int side) const {
    const std::vector<Place> candidates = coarse(side, kCandidates);
    Place best = candidates.front();
    for (const Place& candidate : candidates) {
      if (!(std::abs(candidate.angle) < kFar / 2)) continue;
      const Place place = refined(side, candidate);
      if (place.angle < best.angle) best = place;
    }
    return best;
  }

  Fit fitAt(const Place& rake) const {
    if (rake.angle < -kFar / 2) return Fit::kFloor;
    const auto circle = circleAt(rake.along, rake.across);
    if (!circle || !(rake.angle < kFar / 2)) return Fit::kOutside;
    if (!(circle->r < cutter_.cutter().radius(circle->x) - kAtEdge)) return Fit::kEdge;
    // Where a wall is more across the radius than along it, it is the floor.
    const double inward = from_axis_ * std::cos(circle->half_angle) - circle->r;
    const double around = from_axis_ * std::sin(circle->half_angle);
    return inward < around ? Fit::kTouches : Fit::kFloor;
  }

  /// @param find returns the place where the ball first touches the wall of a side.
  template <typename Function>
  Result resultOf(const Function& find) const {
    const Place rake = find(rakeSide());
    Result result{fitAt(rake), rakeSide() * rake.angle};
    // Both walls bound the ball's angle; the other wall bounds its negative.
    if (result.fit == Fit::kTouches && !(rake.angle + find(-rakeSide()).angle > 0)) result.fit = Fit::kOtherWall;
    return result;
  }

  const GroundCutter& cutter_;
  const Flute& flute_;
  double x_, from_axis_, radius_;
};

double rounded(double length) { return std::nearbyint(length / kRounding) * kRounding; }

/// Refuses a value of a ball.
/// @param why text after the allowed range.
[[noreturn]] void refuse(const char* what, double value, const Range& allowed, std::string why) {
  throw ReasonError({ReasonKind::kOutOfRange, 0, what, std::move(why), Unit::kMetre, rounded(value),
                     rounded(allowed.from), rounded(allowed.to)});
}

/// The distances from the axis at which a ball touches the rake face: the innermost run of consecutive distances tried.
std::optional<Range> fittingDistances(const GroundCutter& cutter, double x, double radius) {
  const double blank = cutter.cutter().radius(x);
  const double core = std::min(blank, firstFlute(cutter).front().minRadius(x, blank));
  const auto at = [&](int i) { return rounded(core + (blank + radius - core) * i / kDistances); };
  const auto fits = [&](int i) { return TurningBall(cutter, x, at(i), radius).coarseFit() == Fit::kTouches; };
  int from = 1;
  while (from < kDistances && !fits(from)) ++from;
  int to = from;
  while (to + 1 < kDistances && fits(to + 1)) ++to;
  // Checks the ends precisely, where the grid may err.
  const auto touches = [&](int i) { return TurningBall(cutter, x, at(i), radius).turn().fit == Fit::kTouches; };
  while (from <= to && !(from < kDistances && touches(from))) ++from;
  while (from < to && !touches(to)) --to;
  if (from > to) return std::nullopt;
  return Range{at(from), at(to)};
}

/// Refuses a ball that does not touch the rake face, with the allowed values.
[[noreturn]] void refuseFit(Fit fit, const GroundCutter& cutter, double x, double from_axis, double radius) {
  const std::string else_touches = std::string("else it touches ") + whatItTouches(fit);
  if (const auto distances = fittingDistances(cutter, x, radius))
    refuse("ball's distance from the axis", from_axis, *distances, else_touches);
  double smaller = radius;
  for (int i = 0; i < kDiameterHalvings; ++i) {
    smaller /= 2;
    if (fittingDistances(cutter, x, smaller))
      refuse("ball diameter", 2 * radius, {kRounding, 2 * smaller}, else_touches);
  }
  throw ReasonError(
      {ReasonKind::kNotAllowed, 0, "ball's X", "where the first tooth has a rake face", Unit::kMetre, rounded(x)});
}

}  // namespace

double rakeTouchAngle(const ValidJob& job, const Eigen::Vector3d& ball, double ball_diameter) {
  const double length = job->cutter.flute_length, radius = ball_diameter / 2;
  if (!(ball_diameter >= kRounding && ball_diameter <= length))
    refuse("ball diameter", ball_diameter, {kRounding, length}, "no longer than the flute");
  if (!(ball.x() >= radius && ball.x() <= length - radius))
    refuse("ball's X", ball.x(), {radius, length - radius}, "with the whole ball within the flute's length");
  const double from_axis = std::hypot(ball.y(), ball.z());
  if (!std::isfinite(from_axis))
    refuse("ball's distance from the axis", from_axis, {0, ConicalCutter(job->cutter).radius(ball.x()) + radius},
           "a finite number");
  const GroundCutter cutter = groundCutterOf(job);
  const TurningBall::Result result = TurningBall(cutter, ball.x(), from_axis, radius).turn();
  if (result.fit != Fit::kTouches) refuseFit(result.fit, cutter, ball.x(), from_axis, radius);
  return result.angle - std::atan2(ball.z(), ball.y());
}

}  // namespace grinder
