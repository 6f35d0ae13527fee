#include "flute_grinder/geometry/setup_solver.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/on_all_cores.h"
#include "geometry/fit_setup.h"
#include "geometry/setup_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr double kWidestSwivel = 80 * units::kDegree;  ///< where a solution is looked for that the machine forbids
constexpr double kQuarter = units::kPi / 2;
constexpr double kSame = 1e-4;        ///< [rad], of the taper and of the radius: of two fits that came to the same
constexpr double kAlike = 0.02;       ///< likewise, of two that lead on to the same
constexpr double kMeasurable = 1e-3;  ///< [rad], and of the end diameter
constexpr int kMostEvened = 8;        ///< of those nearest to the tolerances
/// Less the spiral angle, the swivels from which fits start: first here, then, if that was for nothing, there.
/// A wheel in the plane of the helix may give the maximum rake on a cylinder, and that be the asked one.
const std::vector<double> kFirstSwivels{4 * units::kDegree};
const std::vector<double> kOtherSwivels{0, -4 * units::kDegree, 12 * units::kDegree, -12 * units::kDegree};
const std::vector<double> kSwivelsOfCylinder{0, 4 * units::kDegree, -4 * units::kDegree};
constexpr int kStartHeights = 4;                    ///< from which they start, on either side of the axis
constexpr int kMoreHeights = 12;                    ///< likewise, if all that was for nothing
constexpr double kStartDepths[] = {0.1, 0.3, 0.6};  ///< of the deepest, where it is found and no core is asked
constexpr int kSmallerWheels = 15;                  ///< that are tried, each by a twentieth of the diameter less
constexpr double kLessWheel = 0.05;
constexpr int kNarrowerWheels = 7;  ///< likewise, each by a tenth of the width less
constexpr double kLessWidth = 0.1;
constexpr int kWiderCores = 12;  ///< times that their tolerance is widened
constexpr double kWider = 1.4;
constexpr double kAtLimit = 5 * units::kDegree;  ///< of the swivel, that may have stopped a fit

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
  solved.setup = {-solved.setup.swivel, -solved.setup.height, solved.setup.lead};
  return solved;
}

/// The same tool in the mirror: a left-hand cutter becomes a right-hand one.
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

/// Whether two fits came to the same. @param difference up to which they are [rad], of the taper and of the radius.
bool isSame(const SetupPoint& a, const SetupPoint& b, double difference, double radius) {
  return std::abs(a.swivel - b.swivel) < difference && std::abs(a.taper - b.taper) < difference &&
         std::max({std::abs(a.height - b.height), std::abs(a.depth - b.depth), std::abs(a.lead - b.lead)}) <
             difference * radius;
}

/// With a lead by which the wheel's centre is ahead of where it forms the edge amid the flute.
std::optional<SetupPoint> withLead(const SetupTrial& trial, SetupPoint point) {
  const double x = trial.cutter().geometry().flute_length / 2;
  const auto wall = trial.sweep(point).wall(x, trial.cutter().radius(x), true);
  if (!wall) return std::nullopt;
  point.lead = wall->axis_x - x;
  return trial.cutter().radius(-point.lead) > 0 ? std::optional(point) : std::nullopt;
}

/// The depths from which fits start with a wheel at a swivel and a height.
std::vector<double> startDepths(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& p) {
  if (!findsDepth(trial, request)) return {request.depth};
  if (request.core_diameter) return {trial.depthFor(p.swivel, p.height, *request.core_diameter / 2)};
  std::vector<double> depths;
  for (const double part : kStartDepths) depths.push_back(part * trial.deepest());
  return depths;
}

/// Starts of a fit: the wheel cuts as deep as is asked at several heights, without and with a lead.
/// @param swivels less the spiral angle [rad]. @param most heights, on either side of the axis.
std::vector<SetupPoint> startsOf(const SetupTrial& trial, const SetupRequest& request,
                                 const std::vector<double>& swivels, int most) {
  const double radius = request.cutter.end_diameter / 2;
  const double depth = request.core_diameter ? radius - *request.core_diameter / 2 : std::min(request.depth, radius);
  std::vector<SetupPoint> starts;
  for (const double swivel : swivels) {
    SetupPoint p;
    p.swivel = std::clamp(request.cutter.spiral_angle + swivel, request.min_swivel, request.max_swivel);
    if (request.keep == SetupFigure::kSwivel) p.swivel = request.kept.swivel;
    const double highest = radius + std::sqrt(2 * trial.wheel().maxRadius() * depth) * std::abs(std::sin(p.swivel));
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
        const auto ahead = hasLead(trial, request) ? withLead(trial, p) : std::nullopt;
        if (ahead) starts.push_back(*ahead);
      }
    }
    if (request.keep == SetupFigure::kSwivel) break;
  }
  return starts;
}

/// Whether an exact set-up is judged over the flute, too. A law that corrects Z makes the rake between its ends.
bool hasTolerances(const SetupRequest& request) {
  const CutterGeometry& c = request.cutter;
  const bool asks_core = request.core_diameter || request.core_diameter_end;
  return request.z_law == ZLaw::kPublished && c.rake_tolerance > 0 &&
         (c.spiral_tolerance > 0 || !request.asks_spiral) && (c.core_tolerance > 0 || !asks_core);
}

/// The tolerances asked, none less than what can be measured: exact set-ups may be alike at the ends of the flute, but
/// not between them.
SetupRequest measurable(SetupRequest r) {
  CutterGeometry& c = r.cutter;
  c.rake_tolerance = std::max(c.rake_tolerance, kMeasurable);
  c.spiral_tolerance = std::max(c.spiral_tolerance, kMeasurable);
  c.core_tolerance = std::max(c.core_tolerance, kMeasurable * c.end_diameter);
  return r;
}

/// The best set-up with all that is asked: exact, or else within the tolerances. If there is none, the nearest.
struct Fitted {
  std::optional<Judged> best;
  std::vector<Judged> unasked;  ///< that would do, and may yet be accepted
  bool settled = false;         ///< the best one is accepted
  std::optional<SetupPoint> nearest;
  double error = std::numeric_limits<double>::infinity();  ///< of the nearest one, by the tolerances

  void take(const Judged& judged) {
    if (!best || isBetter(judged, *best)) best = judged;
    if (!judged.problem && !judged.cut_short && !judged.is_facet) unasked.push_back(judged);
  }

  /// Asks of what would do, the best first. @return whether one is accepted, which then is the best.
  bool settle(const SetupRequest& request) {
    std::stable_sort(unasked.begin(), unasked.end(), isBetter);
    for (const Judged& judged : std::exchange(unasked, {})) {
      if (settled || (request.accepts && !request.accepts(judged.solved))) continue;
      best = judged;
      settled = true;
    }
    return settled;
  }
};

/// Fits all that is asked from some starts. @param fitted what others came to.
void fitAll(const SetupTrial& trial, const SetupRequest& request, const std::vector<SetupPoint>& starts,
            Fitted& fitted) {
  const bool has_tolerances = hasTolerances(request);
  const auto worst = [&](const SetupPoint& p) {
    return setupErrors(trial, request, p, SetupTrial::kSections).worst(request);
  };
  std::vector<SetupPoint> seen, ends, nearest;
  const auto add_new = [&](const SetupPoint& fit, std::vector<SetupPoint>& others, double difference) {
    const auto same = [&](const SetupPoint& other) { return isSame(fit, other, difference, trial.cutter().radius(0)); };
    if (std::any_of(others.begin(), others.end(), same)) return false;
    others.push_back(fit);
    return true;
  };
  const auto take = [&](const SetupPoint& fit) {
    if (!add_new(fit, seen, kSame)) return;
    Judged judged = judge(trial, request, fit);
    if (request.z_law == ZLaw::kPublished) {
      judged.error = setupErrors(trial, request, fit, SetupTrial::kSections).worst(measurable(request));
    }
    fitted.take(judged);
  };
  std::vector<std::optional<EndsFit>> fits(starts.size());
  onAllCores(starts.size(), [&](std::size_t i) { fits[i] = fitEnds(trial, request, starts[i]); });
  for (const auto& fit : fits) {
    if (!fit) continue;
    add_new(fit->point, ends, kAlike);
    if (fit->is_exact && !(has_tolerances && !(worst(fit->point) <= kWithin))) take(fit->point);
  }
  if (fitted.settle(request)) return;
  std::vector<std::optional<SetupPoint>> nearest_to(ends.size());
  onAllCores(ends.size(), [&](std::size_t i) { nearest_to[i] = nearestSetup(trial, request, ends[i]); });
  for (const auto& fit : nearest_to) {
    if (fit) add_new(*fit, nearest, kAlike);
  }
  std::multimap<double, SetupPoint> by_error;
  for (const SetupPoint& fit : nearest) by_error.emplace(worst(fit), fit);
  std::vector<SetupPoint> bests;
  for (const auto& [error, fit] : by_error) bests.push_back(fit);
  const auto within = static_cast<std::size_t>(std::distance(by_error.begin(), by_error.upper_bound(kWithin)));
  onAllCores(std::min<std::size_t>(bests.size() - within, kMostEvened),
             [&](std::size_t i) { bests[within + i] = evenedSetup(trial, request, bests[within + i]); });
  for (const SetupPoint& best : bests) {
    const double here = worst(best);
    if (here < fitted.error || !fitted.nearest) {
      fitted.error = here;
      fitted.nearest = best;
    }
    if (here <= kWithin) take(best);
  }
}

/// The set-up that would be without the figure that is kept, with that figure: near it are those with it.
std::vector<SetupPoint> startsBesideFree(const SetupTrial& trial, SetupRequest request) {
  const auto keep = request.keep;
  if (!keep || trial.isCylinder() || !request.core_diameter) return {};
  request.keep.reset();
  request.accepts = {};
  Fitted free;
  fitAll(trial, request, startsOf(trial, request, kFirstSwivels, kStartHeights), free);
  if (!free.best) return {};
  SetupPoint point = free.best->point;
  switch (*keep) {
    case SetupFigure::kSwivel: point.swivel = request.kept.swivel; break;
    case SetupFigure::kHeight: point.height = request.kept.height; break;
    case SetupFigure::kDepth: point.depth = request.depth; break;
  }
  return {point};
}

/// @param everywhere starts from the other swivels, too, if the first ones lead nowhere.
Fitted fitted(const SetupTrial& trial, const SetupRequest& request, bool everywhere) {
  Fitted all;
  fitAll(trial, request, startsBesideFree(trial, request), all);
  if (all.settle(request)) return all;
  const bool asks_edge = request.asks_spiral || request.core_diameter_end;
  const bool is_alone = !trial.isCylinder() && asks_edge;
  const std::vector<double>& first = is_alone ? kFirstSwivels : kSwivelsOfCylinder;
  fitAll(trial, request, startsOf(trial, request, first, kStartHeights), all);
  if (all.settle(request) || !everywhere) return all;
  fitAll(trial, request, startsOf(trial, request, kOtherSwivels, kStartHeights), all);
  if (all.settle(request)) return all;
  fitAll(trial, request, startsOf(trial, request, kFirstSwivels, kMoreHeights), all);
  all.settle(request);
  return all;
}

/// The nearest set-up with a changed request, if it is one, and leads on to the next change.
std::optional<SolvedSetup> changed(const SetupRequest& request, SetupPoint& nearest) {
  const SetupTrial trial(ConicalCutter(request.cutter), request.wheel, request.nominal_radius, request.y_per_x);
  const auto fit = nearestSetup(trial, request, nearest);
  if (!fit) return std::nullopt;
  nearest = evenedSetup(trial, request, *fit);
  if (!(setupErrors(trial, request, nearest, SetupTrial::kSections).worst(request) <= kWithin)) return std::nullopt;
  const Judged judged = judge(trial, request, nearest);
  return judged.problem ? std::nullopt : std::optional(judged.solved);
}

/// The widest of some narrower wheels that mends it; 0 if none does [m].
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

/// The largest of some smaller wheels that mends it; 0 if none does [m].
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

/// What would mend it: a smaller wheel, else a narrower one, else the cores that can be had.
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
  const Fitted all = fitted(SetupTrial(ConicalCutter(even.cutter), even.wheel, even.nominal_radius, 0), even, false);
  if (!all.best || all.best->problem) return {};
  return {0, 0, {all.best->solved.core_diameter, all.best->solved.core_diameter_end}};
}

/// That what is asked cannot be had within its tolerances.
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
  const SetupTrial trial(ConicalCutter(request.cutter), request.wheel, request.nominal_radius, request.y_per_x);
  const auto beyond = [&](double swivel) {
    return SetupRefusal{SetupProblem::kSwivel, swivel, request.min_swivel, request.max_swivel};
  };
  if (request.keep == SetupFigure::kSwivel &&
      !(request.kept.swivel >= request.min_swivel && request.kept.swivel <= request.max_swivel)) {
    return beyond(request.kept.swivel);
  }
  const Fitted here = fitted(trial, request, true);
  if (here.best && !here.best->problem) return here.best->solved;
  // What the machine's range does not stop is not beyond it either.
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
