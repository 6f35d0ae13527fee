#include "flute_grinder/setup/setup_solver.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/units.h"
#include "setup/fit_setup.h"
#include "setup/setup_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr double kWidestSwivel = 80 * units::kDegree;  ///< maximum swivel of a solution beyond the machine's range
constexpr double kQuarter = units::kPi / 2;
constexpr double kSame = 1e-4;        ///< difference of equal fits [rad], of the taper, and per radius
constexpr double kAlike = 0.02;       ///< difference of fits that would continue to the same result, in the same units
constexpr double kMeasurable = 1e-3;  ///< smallest measurable difference [rad], and relative to the end diameter
constexpr int kFirstSteps = 10;       ///< steps of all fits, after which only the most promising ones continue
constexpr std::size_t kMostPromising = 24;
constexpr std::size_t kMostEvened = 8;  ///< number of fits nearest to the tolerances
/// Tolerances, per asked tolerance, within which set-ups for a correction of Z are sought: for the rake, and for spiral
/// angle and core.
constexpr std::pair<double, double> kTolerancesForCorrection[] = {{4, 0.8}, {2, 0.8}, {4, 1}};
/// Starting swivels, relative to the spiral angle: the first list, then the second. On a cylinder, a wheel in the plane
/// of the helix may give the maximum rake, which may be the asked one.
const std::vector<double> kFirstSwivels{4 * units::kDegree};
const std::vector<double> kOtherSwivels{0, -4 * units::kDegree, 12 * units::kDegree, -12 * units::kDegree};
const std::vector<double> kSwivelsOfCylinder{0, 4 * units::kDegree, -4 * units::kDegree};
constexpr int kStartHeights = 4;                    ///< number of starting heights on either side of the axis
constexpr int kMoreHeights = 12;                    ///< number of starting heights if the first ones fail
constexpr double kStartDepths[] = {0.1, 0.3, 0.6};  ///< starting depths, per deepest, if it is free and no core asked
constexpr int kSmallerWheels = 15;                  ///< number of smaller wheels, each by a twentieth of the diameter
constexpr double kLessWheel = 0.05;
constexpr int kNarrowerWheels = 7;  ///< number of narrower wheels tried, each narrower by a tenth of the width
constexpr double kLessWidth = 0.1;
constexpr int kWiderCores = 12;  ///< number of times that the cores' tolerance is widened
constexpr double kWider = 1.4;
constexpr double kAtLimit = 5 * units::kDegree;  ///< angle to the swivel's limit that may have stopped a fit

void requireFinite(const char* name, double value, bool good, const char* allowed) {
  if (good && std::isfinite(value)) return;
  std::ostringstream text;
  text << name << " = " << value << "; allowed: " << allowed;
  throw std::invalid_argument(text.str());
}

void check(const SetupRequest& r) {
  requireFinite("rake", r.rake, std::abs(r.rake) < kQuarter, "within (-pi/2, pi/2) [rad]");
  requireFinite("nominal_radius", r.nominal_radius, r.nominal_radius > 0, "positive [m]");
  requireFinite("y_per_x", r.y_per_x, true, "finite");
  requireFinite("min_swivel", r.min_swivel, std::abs(r.min_swivel) < kQuarter, "within (-pi/2, pi/2) [rad]");
  requireFinite("max_swivel", r.max_swivel, r.max_swivel > r.min_swivel && r.max_swivel < kQuarter,
                "above the minimum, below pi/2 [rad]");
  if (r.core_diameter) {
    requireFinite("core_diameter", *r.core_diameter, *r.core_diameter > 0 && *r.core_diameter < r.cutter.end_diameter,
                  "positive, below the end diameter [m]");
  }
  if (!r.core_diameter || r.keep == SetupFigure::kDepth) {
    requireFinite("depth", r.depth, r.depth > 0, "positive [m]");
  }
  if (r.keep == SetupFigure::kHeight) requireFinite("kept.height", r.kept.height, true, "finite [m]");
  if (r.keep == SetupFigure::kSwivel) {
    requireFinite("kept.swivel", r.kept.swivel, std::abs(r.kept.swivel) < kQuarter, "within (-pi/2, pi/2) [rad]");
  }
  requireFinite("teeth", static_cast<double>(r.tooth_angles.size()), !r.tooth_angles.empty(), "1 or more");
}

SolvedSetup mirrored(SolvedSetup solved) {
  solved.setup = {-solved.setup.swivel, -solved.setup.height, solved.setup.x_shift};
  return solved;
}

/// The mirror image of a request: a left-hand cutter becomes a right-hand one.
SetupRequest mirrored(SetupRequest r) {
  r.cutter.cut = CutDirection::kRightHand;
  r.cutter.spiral_angle = -r.cutter.spiral_angle;
  r.wheel = r.wheel.mirrored();
  r.kept = {-r.kept.swivel, -r.kept.height};
  std::swap(r.min_swivel, r.max_swivel);
  r.min_swivel = -r.min_swivel;
  r.max_swivel = -r.max_swivel;
  if (r.accepts) r.accepts = [asked = r.accepts](const SolvedSetup& solved) { return asked(mirrored(solved)); };
  return r;
}

/// Whether two fits have the same result.
/// @param difference maximum difference [rad], of the taper, and per radius.
bool isSame(const SetupPoint& a, const SetupPoint& b, double difference, double radius) {
  return std::abs(a.swivel - b.swivel) < difference && std::abs(a.taper - b.taper) < difference &&
         std::max({std::abs(a.height - b.height), std::abs(a.depth - b.depth), std::abs(a.x_shift - b.x_shift)}) <
             difference * radius;
}

/// The point with a shift along X: the distance of the wheel's centre ahead of the edge that it forms at mid-flute.
std::optional<SetupPoint> withShift(const SetupTrial& trial, SetupPoint point) {
  const double x = trial.cutter().cone().flute_length / 2;
  const auto wall = trial.sweep(point).wall(x, trial.cutter().radius(x), true);
  if (!wall) return std::nullopt;
  point.x_shift = wall->axis_x - x;
  return trial.cutter().radius(-point.x_shift) > 0 ? std::optional(point) : std::nullopt;
}

/// The depths from which fits start with a wheel at a swivel and a height.
std::vector<double> startDepths(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& p) {
  if (!findsDepth(trial, request)) return {request.depth};
  if (request.core_diameter) return {trial.depthFor(p.swivel, p.height, *request.core_diameter / 2)};
  std::vector<double> depths;
  for (const double part : kStartDepths) depths.push_back(part * trial.deepest());
  return depths;
}

/// The maximum height at which a wheel reaches the flute's depth, on either side of the axis [m].
double highestOf(const SetupTrial& trial, const SetupRequest& request, double swivel) {
  const double radius = request.cutter.end_diameter / 2;
  const double depth = request.core_diameter ? radius - *request.core_diameter / 2 : std::min(request.depth, radius);
  return radius + std::sqrt(2 * trial.wheel().maxRadius() * depth) * std::abs(std::sin(swivel));
}

/// Starts of a fit: the wheel cuts to the asked depth at several heights, without and with a shift along X.
/// @param swivels swivels relative to the spiral angle [rad].
/// @param most number of heights on either side of the axis.
std::vector<SetupPoint> startsOf(const SetupTrial& trial, const SetupRequest& request,
                                 const std::vector<double>& swivels, int most) {
  std::vector<SetupPoint> starts;
  for (const double swivel : swivels) {
    SetupPoint p;
    p.swivel = std::clamp(request.cutter.spiral_angle + swivel, request.min_swivel, request.max_swivel);
    if (request.keep == SetupFigure::kSwivel) p.swivel = request.kept.swivel;
    const double highest = highestOf(trial, request, p.swivel);
    const bool has_heights = request.keep != SetupFigure::kHeight && !isHeightTied(trial, request);
    const int heights = has_heights ? most : 0;
    for (int i = -heights; i <= heights; ++i) {
      p.height = request.keep == SetupFigure::kHeight ? request.kept.height
                 : has_heights ? highest * i / heights - trial.wheel().upperFace() / std::cos(p.swivel)
                               : tiedHeight(trial, request, p.swivel);
      for (const double start_depth : startDepths(trial, request, p)) {
        if (!std::isfinite(start_depth)) continue;
        p.depth = start_depth;
        starts.push_back(p);
        const auto ahead = hasShift(trial, request) ? withShift(trial, p) : std::nullopt;
        if (ahead) starts.push_back(*ahead);
      }
    }
    if (request.keep == SetupFigure::kSwivel) break;
  }
  return starts;
}

/// Whether an exact set-up is also judged over the flute. A law that corrects Z gives the rake between the ends.
bool hasTolerances(const SetupRequest& request) {
  const CutterGeometry& c = request.cutter;
  const bool asks_core = request.core_diameter || request.core_diameter_end;
  return request.z_law == ZLaw::kPublished && c.rake_tolerance > 0 &&
         (c.spiral_tolerance > 0 || !request.asks_spiral) && (c.core_tolerance > 0 || !asks_core);
}

/// The request with no tolerance below the measurable one: exact set-ups may be equal at the ends of the flute, but not
/// between them.
SetupRequest measurable(SetupRequest r) {
  CutterGeometry& c = r.cutter;
  c.rake_tolerance = std::max(c.rake_tolerance, kMeasurable);
  c.spiral_tolerance = std::max(c.spiral_tolerance, kMeasurable);
  c.core_tolerance = std::max(c.core_tolerance, kMeasurable * c.end_diameter);
  return r;
}

/// The best set-up that meets the request: exact, or else within the tolerances. If there is none, the nearest one.
struct Fitted {
  std::optional<Judged> best;
  bool settled = false;  ///< whether the best one is accepted
  std::optional<SetupPoint> nearest;
  double error = std::numeric_limits<double>::infinity();  ///< error of the nearest one, per tolerance
};

/// The results of a function for each point, in their order.
template <typename Function>
auto all(const std::vector<SetupPoint>& points, const Function& function) {
  std::vector<decltype(function(points.front()))> results(points.size());
  onAllCores(points.size(), [&](std::size_t i) { results[i] = function(points[i]); });
  return results;
}

/// Looks for a set-up from several lists of starts in turn, until one is accepted.
class Search {
 public:
  Search(const SetupTrial& trial, const SetupRequest& request) : trial_(trial), request_(request) {}

  /// Fits all asked values, first at the flute's ends.
  /// @return whether a set-up is accepted.
  bool findFromEnds(const std::vector<SetupPoint>& starts) {
    const bool has_tolerances = hasTolerances(request_);
    std::vector<SetupPoint> ends;
    for (const auto& fit : all(starts, [&](const SetupPoint& p) { return fitEnds(trial_, request_, p); })) {
      if (!fit) continue;
      addNew(fit->point, ends, kAlike);
      if (fit->is_exact && !(has_tolerances && !(worst(fit->point) <= kWithin))) take(fit->point);
    }
    if (settle()) return true;
    takeNearest(ends);
    return settle();
  }

  /// Fits the asked values over the flute at once, and a land if no set-up found has one.
  bool findFrom(const std::vector<SetupPoint>& starts) {
    const std::vector<SetupPoint> best = takeNearest(starts);
    if (settle()) return true;
    if (!fitted_.best || fitted_.best->problem != SetupProblem::kLand) return false;
    const auto with_land = all(best, [&](const SetupPoint& p) { return setupWithLand(trial_, request_, p); });
    for (const SetupPoint& point : with_land) {
      if (worst(point) <= kWithin) take(point);
    }
    return settle();
  }

  Fitted result() && { return std::move(fitted_); }

 private:
  double worst(const SetupPoint& p) const {
    return setupErrors(trial_, request_, p, SetupTrial::kSections).worst(request_);
  }

  bool addNew(const SetupPoint& fit, std::vector<SetupPoint>& others, double difference) const {
    const double radius = trial_.cutter().radius(0);
    const auto same = [&](const SetupPoint& other) { return isSame(fit, other, difference, radius); };
    if (std::any_of(others.begin(), others.end(), same)) return false;
    others.push_back(fit);
    return true;
  }

  void take(const SetupPoint& fit) {
    if (!addNew(fit, seen_, kSame)) return;
    Judged judged = judge(trial_, request_, fit);
    if (request_.z_law == ZLaw::kPublished) {
      judged.error = setupErrors(trial_, request_, fit, SetupTrial::kSections).worst(measurable(request_));
    }
    if (!fitted_.best || isBetter(judged, *fitted_.best)) fitted_.best = judged;
    if (!judged.problem && !judged.cut_short && !judged.is_facet) unasked_.push_back(judged);
  }

  /// The distinct results of fits, the nearest to the tolerances first.
  std::multimap<double, SetupPoint> nearestTo(const std::vector<SetupPoint>& starts, int steps) const {
    const auto fit = [&](const SetupPoint& p) { return nearestSetup(trial_, request_, p, steps); };
    std::vector<SetupPoint> nearest;
    for (const auto& found : all(starts, fit)) {
      if (found) addNew(*found, nearest, kAlike);
    }
    const std::vector<double> errors = all(nearest, [&](const SetupPoint& p) { return worst(p); });
    std::multimap<double, SetupPoint> by_error;
    for (std::size_t i = 0; i < nearest.size(); ++i) by_error.emplace(errors[i], nearest[i]);
    return by_error;
  }

  /// Takes the results within the tolerances near some starts.
  /// @return the nearest results.
  std::vector<SetupPoint> takeNearest(const std::vector<SetupPoint>& starts) {
    std::vector<SetupPoint> promising;
    for (const auto& [error, fit] : nearestTo(starts, kFirstSteps)) {
      if (promising.size() < kMostPromising) promising.push_back(fit);
    }
    const std::multimap<double, SetupPoint> by_error = nearestTo(promising, kFitSteps);
    std::vector<SetupPoint> best;
    for (const auto& [error, fit] : by_error) {
      if (error <= kWithin) take(fit);
      if (best.size() < kMostEvened) best.push_back(fit);
    }
    best = all(best, [&](const SetupPoint& p) { return evenedSetup(trial_, request_, p); });
    for (const SetupPoint& fit : best) {
      const double here = worst(fit);
      if (here < fitted_.error || !fitted_.nearest) {
        fitted_.error = here;
        fitted_.nearest = fit;
      }
      if (here <= kWithin) take(fit);
    }
    return best;
  }

  /// Asks for acceptance of the suitable set-ups, the best first.
  /// @return whether one is accepted; it is then the best.
  bool settle() {
    std::stable_sort(unasked_.begin(), unasked_.end(), isBetter);
    for (const Judged& judged : std::exchange(unasked_, {})) {
      if (fitted_.settled || (request_.accepts && !request_.accepts(judged.solved))) continue;
      fitted_.best = judged;
      fitted_.settled = true;
    }
    return fitted_.settled;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  Fitted fitted_;
  std::vector<SetupPoint> seen_;  ///< set-ups that were judged
  std::vector<Judged> unasked_;   ///< suitable set-ups that may yet be accepted
};

/// Starts near the set-up without the fixed figure, but with that figure set.
std::vector<SetupPoint> startsBesideFree(const SetupTrial& trial, SetupRequest request) {
  const auto keep = request.keep;
  if (!keep || trial.isCylinder() || !request.core_diameter) return {};
  request.keep.reset();
  request.accepts = {};
  Search search(trial, request);
  search.findFromEnds(startsOf(trial, request, kFirstSwivels, kStartHeights));
  const Fitted free = std::move(search).result();
  if (!free.best) return {};
  SetupPoint point = free.best->point;
  switch (*keep) {
    case SetupFigure::kSwivel: point.swivel = request.kept.swivel; break;
    case SetupFigure::kHeight: point.height = request.kept.height; break;
    case SetupFigure::kDepth: point.depth = request.depth; break;
  }
  return {point};
}

/// For a cylinder whose rake face need not pass the axis at R sin r: other heights, the nearest first.
std::optional<Fitted> fittedAtOtherHeights(const SetupTrial& trial, SetupRequest request) {
  if (!isHeightTied(trial, request) || request.keep) return std::nullopt;
  const double tied = tiedHeight(trial, request, request.cutter.spiral_angle);
  const double highest = highestOf(trial, request, request.cutter.spiral_angle);
  std::vector<double> heights;
  for (int i = -kMoreHeights; i <= kMoreHeights; ++i) {
    heights.push_back(highest * i / kMoreHeights - trial.wheel().upperFace());
  }
  std::stable_sort(heights.begin(), heights.end(),
                   [&](double a, double b) { return std::abs(a - tied) < std::abs(b - tied); });
  request.keep = SetupFigure::kHeight;
  for (const double height : heights) {
    request.kept.height = height;
    Search search(trial, request);
    if (search.findFrom(startsOf(trial, request, kSwivelsOfCylinder, 0))) return std::move(search).result();
  }
  return std::nullopt;
}

/// A law that corrects Z changes core and edge so much that other set-ups may suit it.
std::optional<Fitted> fittedForCorrection(const SetupTrial& trial, const SetupRequest& request,
                                          const std::vector<SetupPoint>& starts) {
  if (request.z_law == ZLaw::kPublished) return std::nullopt;
  for (const auto& [rake, others] : kTolerancesForCorrection) {
    SetupRequest wider = request;
    wider.cutter.rake_tolerance *= rake;
    wider.cutter.spiral_tolerance *= others;
    wider.cutter.core_tolerance *= others;
    Search search(trial, wider);
    if (search.findFrom(starts)) return std::move(search).result();
  }
  return std::nullopt;
}

/// @param everywhere whether to start from the other swivels, too, if the first ones fail.
Fitted fitted(const SetupTrial& trial, const SetupRequest& request, bool everywhere) {
  Search search(trial, request);
  const bool asks_edge = request.asks_spiral || request.core_diameter_end;
  const bool is_alone = !trial.isCylinder() && asks_edge;
  const std::vector<double>& first = is_alone ? kFirstSwivels : kSwivelsOfCylinder;
  if (search.findFromEnds(startsBesideFree(trial, request)) ||
      search.findFromEnds(startsOf(trial, request, first, kStartHeights)) || !everywhere) {
    return std::move(search).result();
  }
  const std::vector<SetupPoint> others = startsOf(trial, request, kOtherSwivels, kStartHeights);
  if (search.findFromEnds(others)) return std::move(search).result();
  std::vector<SetupPoint> starts = startsOf(trial, request, kFirstSwivels, kMoreHeights);
  starts.insert(starts.end(), others.begin(), others.end());
  if (search.findFrom(starts)) return std::move(search).result();
  if (auto other = fittedAtOtherHeights(trial, request)) return std::move(*other);
  if (auto other = fittedForCorrection(trial, request, starts)) return std::move(*other);
  return std::move(search).result();
}

/// The nearest set-up with a changed request, if it is suitable; it is then the start for the next change.
std::optional<SolvedSetup> changed(const SetupRequest& request, SetupPoint& nearest) {
  const SetupTrial trial(request.cutter, request.wheel, request.nominal_radius, request.y_per_x);
  const auto fit = nearestSetup(trial, request, nearest);
  if (!fit) return std::nullopt;
  nearest = evenedSetup(trial, request, *fit);
  if (!(setupErrors(trial, request, nearest, SetupTrial::kSections).worst(request) <= kWithin)) return std::nullopt;
  const Judged judged = judge(trial, request, nearest);
  return judged.problem ? std::nullopt : std::optional(judged.solved);
}

/// The widest of some narrower wheels that makes the job possible; 0 if none does [m].
double mendingWidth(const SetupRequest& request, SetupPoint nearest) {
  const double width = request.wheel.upperFace() - request.wheel.lowerFace();
  for (int i = 1; i <= kNarrowerWheels; ++i) {
    const double of_new = width * (1 - kLessWidth * i);
    const auto wheel = request.wheel.withWidth(of_new);
    if (!wheel) return 0;
    SetupRequest narrower = request;
    narrower.wheel = *wheel;
    if (changed(narrower, nearest)) return of_new;
  }
  return 0;
}

/// The largest of some smaller wheels that makes the job possible; 0 if none does [m].
double mendingDiameter(const SetupRequest& request, SetupPoint nearest) {
  const double diameter = 2 * request.wheel.maxRadius();
  for (int i = 1; i <= kSmallerWheels; ++i) {
    SetupRequest smaller = request;
    const double of_new = diameter * (1 - kLessWheel * i);
    smaller.wheel = request.wheel.withDiameter(of_new);
    smaller.nominal_radius = request.nominal_radius - (diameter - of_new) / 2;
    if (changed(smaller, nearest)) return of_new;
  }
  return 0;
}

/// What would make the job possible: a smaller wheel, else a narrower one, else other cores.
SetupRefusal::Mend mendOf(const SetupRequest& request, const SetupPoint& nearest) {
  if (const double diameter = mendingDiameter(request, nearest); diameter > 0) return {diameter, 0, {}};
  if (const double width = mendingWidth(request, nearest); width > 0) return {0, width, {}};
  SetupPoint here = nearest;
  for (int i = 1; i <= kWiderCores && request.core_diameter; ++i) {
    SetupRequest wider = request;
    wider.cutter.core_tolerance *= std::pow(kWider, i);
    if (const auto solved = changed(wider, here)) return {0, 0, {solved->core_diameter, solved->core_diameter_end}};
  }
  if (!request.core_diameter || !request.core_diameter_end) return {};
  SetupRequest even = request;
  even.core_diameter_end.reset();
  even.y_per_x = 0;
  even.accepts = {};
  const Fitted all = fitted(SetupTrial(even.cutter, even.wheel, even.nominal_radius, 0), even, false);
  if (!all.best || all.best->problem) return {};
  return {0, 0, {all.best->solved.core_diameter, all.best->solved.core_diameter_end}};
}

/// The refusal of asked values that are not possible within their tolerances.
SetupRefusal refusal(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& nearest) {
  const SetupErrors errors = setupErrors(trial, request, nearest, SetupTrial::kSections);
  const auto range = [](const Eigen::ArrayXd& error, double asked) {
    return error.size() == 0 ? Range{} : Range{asked + error.minCoeff(), asked + error.maxCoeff()};
  };
  const WheelSweep sweep = trial.sweep(nearest);
  SetupRefusal refusal{SetupProblem::kTolerance};
  refusal.nearest = {range(errors.rake, request.rake),
                     range(errors.chord, request.rake),
                     range(errors.spiral, request.cutter.spiral_angle),
                     {2 * trial.coreRadius(sweep, 0), 2 * trial.coreRadius(sweep, request.cutter.flute_length)}};
  refusal.mend = mendOf(request, nearest);
  return refusal;
}

SetupRefusal refusal(const SetupRequest& request, const Judged& judged) {
  switch (*judged.problem) {
    case SetupProblem::kLand: {
      SetupRefusal refusal{SetupProblem::kLand, 0, judged.solved.land, judged.solved.land};
      refusal.mend.wheel_width = mendingWidth(request, judged.point);
      return refusal;
    }
    case SetupProblem::kCore: return {SetupProblem::kCore, request.core_diameter.value_or(0), 0, 0};
    default: return {*judged.problem};
  }
}

}  // namespace

std::variant<SolvedSetup, SetupRefusal> solveSetup(const SetupRequest& request) {
  check(request);
  if (request.cutter.cut == CutDirection::kLeftHand) {
    auto result = solveSetup(mirrored(request));
    if (auto* solved = std::get_if<SolvedSetup>(&result)) {
      *solved = mirrored(*solved);
    } else if (auto& refusal = std::get<SetupRefusal>(result); refusal.problem == SetupProblem::kSwivel) {
      refusal = {refusal.problem, -refusal.asked, -refusal.max, -refusal.min};
    } else {
      refusal.nearest.spiral = {-refusal.nearest.spiral.to, -refusal.nearest.spiral.from};
    }
    return result;
  }
  const SetupTrial trial(request.cutter, request.wheel, request.nominal_radius, request.y_per_x);
  const auto beyond = [&](double swivel) {
    return SetupRefusal{SetupProblem::kSwivel, swivel, request.min_swivel, request.max_swivel};
  };
  if (request.keep == SetupFigure::kSwivel &&
      !(request.kept.swivel >= request.min_swivel && request.kept.swivel <= request.max_swivel)) {
    return beyond(request.kept.swivel);
  }
  const Fitted here = fitted(trial, request, true);
  if (here.best && !here.best->problem) return here.best->solved;
  // A set-up that the machine's range does not stop is not beyond it either.
  const double nearest = here.nearest ? here.nearest->swivel : request.max_swivel;
  const double to_limit = std::min(nearest - request.min_swivel, request.max_swivel - nearest);
  if (request.keep != SetupFigure::kSwivel && to_limit < kAtLimit) {
    SetupRequest wide = request;
    wide.min_swivel = -kWidestSwivel;
    wide.max_swivel = kWidestSwivel;
    wide.accepts = {};
    const Fitted anywhere = fitted(trial, wide, false);
    if (anywhere.best && !anywhere.best->problem) return beyond(anywhere.best->solved.setup.swivel);
  }
  if (here.best) return refusal(request, *here.best);
  if (here.nearest) return refusal(trial, request, *here.nearest);
  return SetupRefusal{SetupProblem::kReach};
}

}  // namespace grinder
