#include "setup/flute_setup.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/units.h"
#include "setup/flute_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace grinder {

namespace {

using units::kDegree;

constexpr double kWithin = 0.98;  ///< fraction of the tolerances for a set-up: figures are rounded, the wheel wears
constexpr double kSame = 1e-4;    ///< difference of equal set-ups [rad], of the taper, and per radius
constexpr double kAlike = 0.02;   ///< difference of set-ups that would be fitted to the same one, in the same units
/// The stages of a search: all starts are fitted coarsely, and only the most promising ones go on.
struct Stage {
  int sections;      ///< intervals between the sections that are measured
  int steps;         ///< maximum number of steps of a fit
  std::size_t most;  ///< maximum number of results that go on
};
constexpr Stage kStages[] = {{1, 4, 48}, {1, 8, 24}, {4, 8, 8}, {4, 40, 8}};
/// Starting swivels, relative to the spiral angle, and numbers of starting heights on either side of the axis. On a
/// cylinder, a wheel in the plane of the helix may give the maximum rake, which may be the asked one.
const std::vector<double> kFirstSwivels{4 * kDegree};
const std::vector<double> kOtherSwivels{0, -4 * kDegree, 12 * kDegree, -12 * kDegree};
constexpr int kHeights = 4, kMoreHeights = 12;
constexpr std::size_t kMostAsked = 4;  ///< number of the best set-ups that are asked whether they may be taken
constexpr double kStartDepths[] = {0.1, 0.3, 0.6};  ///< starting depths, per radius, if the core has no influence
constexpr double kAtLimit = 5 * kDegree;            ///< angle to the swivel's limit that may have stopped a fit
constexpr double kLeastWheel = 0.25;                ///< part of a wheel's diameter and width that a hint leaves

/// The results of a function for each point, in their order.
template <typename Function>
auto all(const std::vector<SetupPoint>& points, const Function& function) {
  std::vector<decltype(function(points.front()))> results(points.size());
  onAllCores(points.size(), [&](std::size_t i) { results[i] = function(points[i]); });
  return results;
}

bool isSame(const SetupPoint& a, const SetupPoint& b, double difference, double radius) {
  return std::abs(a.swivel - b.swivel) < difference && std::abs(a.taper - b.taper) < difference &&
         std::max({std::abs(a.height - b.height), std::abs(a.depth - b.depth), std::abs(a.x_shift - b.x_shift)}) <
             difference * radius;
}

/// The point with a shift along X: the distance of the wheel's centre ahead of the edge that it forms at mid-flute.
std::optional<SetupPoint> withShift(const FluteTrial& trial, SetupPoint point) {
  const double x = trial.cutter().cone().flute_length / 2;
  const auto wall = trial.sweep(point).wall(x, trial.cutter().radius(x), true);
  if (!wall) return std::nullopt;
  point.x_shift = wall->axis_x - x;
  return trial.isSound(point) ? std::optional(point) : std::nullopt;
}

/// The depths from which fits start: the one that leaves the asked core at X = 0.
std::vector<double> startDepths(const FluteTrial& trial, SetupPoint point) {
  const FluteRequest& request = trial.request();
  if (request.keep == SetupFigure::kDepth) return {request.kept.depth};
  point.depth = 0;
  point.depth = trial.sweep(point).deeperFor(0, request.cutter.core_diameter / 2);
  if (trial.isSound(point)) return {point.depth};
  std::vector<double> depths;
  for (const double part : kStartDepths) depths.push_back(part * trial.cutter().radius(0));
  return depths;
}

/// Starts of fits, without and with a shift along X.
/// @param swivels swivels relative to the spiral angle [rad].
/// @param most number of heights on either side of the axis.
std::vector<SetupPoint> startsOf(const FluteTrial& trial, std::vector<double> swivels, int most) {
  const FluteRequest& request = trial.request();
  const CutterGeometry& c = request.cutter;
  if (request.keep == SetupFigure::kSwivel) swivels = {0};
  std::vector<SetupPoint> starts;
  for (const double aside : swivels) {
    SetupPoint p;
    p.swivel = std::clamp(c.spiral_angle + aside, request.swivel.from, request.swivel.to);
    if (request.keep == SetupFigure::kSwivel) p.swivel = request.kept.swivel;
    p.taper = trial.isCylinder() ? 0 : trial.askedTaper();
    const double depth = (c.end_diameter - c.core_diameter) / 2;
    const double highest =
        c.end_diameter / 2 + std::sqrt(2 * request.wheel.maxRadius() * depth) * std::abs(std::sin(p.swivel));
    const double face = request.wheel.upperFace() / std::cos(p.swivel);
    // The height with which a straight wheel's face alone forms the rake face of a cylinder.
    std::vector<double> heights{c.end_diameter / 2 * std::sin(c.rake_angle) - face};
    for (int i = -most; i <= most; ++i) heights.push_back(highest * i / most - face);
    if (request.keep == SetupFigure::kHeight) heights = {request.kept.height};
    for (const double height : heights) {
      p.height = height;
      for (const double start_depth : startDepths(trial, p)) {
        p.depth = start_depth;
        starts.push_back(p);
        const auto ahead = trial.hasShift() ? withShift(trial, p) : std::nullopt;
        if (ahead) starts.push_back(*ahead);
      }
    }
  }
  return starts;
}

/// Looks for a set-up from several lists of starts in turn, until one is accepted.
class Search {
 public:
  Search(const FluteTrial& trial, AcceptsFlute accepts) : Search(trial, std::move(accepts), freeFigures(trial)) {}
  Search(const FluteTrial& trial, AcceptsFlute accepts, std::vector<FreeFigure> figures)
      : trial_(trial), accepts_(std::move(accepts)), figures_(std::move(figures)) {}

  /// @return whether a set-up is accepted.
  bool findFrom(const std::vector<SetupPoint>& starts) {
    std::vector<SetupPoint> points = starts;
    for (const Stage& stage : kStages) points = fitted(points, stage);
    const std::vector<double> errors = all(points, [&](const SetupPoint& p) { return error(p, kFluteSections); });
    std::vector<SetupPoint> within;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (errors[i] <= kWithin && addNew(points[i], seen_, kSame)) within.push_back(points[i]);
      if (errors[i] < nearest_error_) nearest_ = points[i], nearest_error_ = errors[i];
    }
    std::vector<JudgedFlute> judged = all(within, [&](const SetupPoint& p) { return judge(trial_, p); });
    std::stable_sort(judged.begin(), judged.end(), isBetter);
    if (!judged.empty() && (!found_.best || isBetter(judged.front(), *found_.best))) found_.best = judged.front();
    if (judged.size() > kMostAsked) judged.resize(kMostAsked);
    const auto accepted = std::find_if(judged.begin(), judged.end(),
                                       [&](const JudgedFlute& one) { return one.land > 0 && accepts_(one); });
    if (accepted == judged.end()) return false;
    found_.best = *accepted;
    found_.accepted = true;
    return true;
  }

  /// @return the accepted or else the best set-up within the tolerances, or else the nearest one.
  FoundFlute result() && {
    if (!found_.best && nearest_) found_.best = judge(trial_, *nearest_);
    return std::move(found_);
  }

 private:
  double error(const SetupPoint& p, int sections) const { return trial_.errors(p, sections).worst(); }

  /// The distinct results of fits, the nearest to the asked tool first.
  std::vector<SetupPoint> fitted(const std::vector<SetupPoint>& starts, const Stage& stage) const {
    const auto fit = [&](const SetupPoint& p) { return fitFlute(trial_, figures_, p, stage.sections, stage.steps); };
    std::vector<SetupPoint> distinct;
    for (const auto& found : all(starts, fit)) {
      if (found) addNew(*found, distinct, kAlike);
    }
    const std::vector<double> errors = all(distinct, [&](const SetupPoint& p) { return error(p, stage.sections); });
    std::multimap<double, SetupPoint> by_error;
    for (std::size_t i = 0; i < distinct.size(); ++i) by_error.emplace(errors[i], distinct[i]);
    std::vector<SetupPoint> nearest;
    for (const auto& [_, point] : by_error) {
      if (nearest.size() < stage.most) nearest.push_back(point);
    }
    return nearest;
  }

  bool addNew(const SetupPoint& fit, std::vector<SetupPoint>& others, double difference) const {
    const double radius = trial_.cutter().radius(0);
    const auto same = [&](const SetupPoint& other) { return isSame(fit, other, difference, radius); };
    if (std::any_of(others.begin(), others.end(), same)) return false;
    others.push_back(fit);
    return true;
  }

  const FluteTrial& trial_;
  const AcceptsFlute accepts_;
  const std::vector<FreeFigure> figures_;
  FoundFlute found_;
  std::optional<SetupPoint> nearest_;
  double nearest_error_ = std::numeric_limits<double>::infinity();
  std::vector<SetupPoint> seen_;  ///< set-ups that were judged
};

/// @param everywhere whether to start from all swivels and heights if the first ones fail.
FoundFlute found(const FluteRequest& request, const AcceptsFlute& accepts, bool everywhere) {
  const FluteTrial trial(request);
  Search search(trial, accepts);
  if (!search.findFrom(startsOf(trial, kFirstSwivels, kHeights)) && everywhere) {
    std::vector<SetupPoint> starts = startsOf(trial, kFirstSwivels, kMoreHeights);
    for (const SetupPoint& start : startsOf(trial, kOtherSwivels, kHeights)) starts.push_back(start);
    search.findFrom(starts);
  }
  return std::move(search).result();
}

}  // namespace

FoundFlute findFluteSetup(const FluteRequest& request, const AcceptsFlute& accepts) {
  FoundFlute here = found(request, accepts, true);
  if (here.accepted || request.keep == SetupFigure::kSwivel) return here;
  // A set-up that the machine's range does not stop is not beyond it either.
  const double nearest = here.best ? here.best->point.swivel : request.swivel.to;
  if (std::min(nearest - request.swivel.from, request.swivel.to - nearest) >= kAtLimit) return here;
  FluteRequest wide = request;
  wide.swivel = {-kWidestSwivel, kWidestSwivel};
  if (request.swivel.from <= wide.swivel.from && request.swivel.to >= wide.swivel.to) return here;
  const FoundFlute anywhere = found(
      wide, [](const JudgedFlute&) { return true; }, false);
  if (anywhere.accepted) here.swivel_beyond = anywhere.best->point.swivel;
  return here;
}

FluteRemedy remedyFor(const FluteRequest& request, const SetupPoint& nearest) {
  const auto mended = [&](const FluteTrial& trial, std::vector<FreeFigure> figures) {
    for (const FreeFigure& one : freeFigures(trial)) figures.push_back(one);
    Search search(
        trial, [](const JudgedFlute& flute) { return flute.complete; }, std::move(figures));
    std::vector<SetupPoint> starts = startsOf(trial, kFirstSwivels, kHeights);
    starts.push_back(nearest);
    search.findFrom(starts);
    const FoundFlute found = std::move(search).result();
    return found.accepted ? std::optional(found.best->point) : std::nullopt;
  };
  const FluteTrial trial(request);
  const double diameter = 2 * request.wheel.maxRadius(), width = request.wheel.upperFace() - request.wheel.lowerFace();
  const double most = 1 - kLeastWheel;
  if (const auto narrower = mended(trial, {{&SetupPoint::less_width, width, 0, most * width}})) {
    return {0, narrower->less_width, {}};
  }
  if (const auto smaller = mended(trial, {{&SetupPoint::less_diameter, diameter, 0, most * diameter}})) {
    return {smaller->less_diameter, 0, {}};
  }
  FluteRequest any_core = request;
  any_core.cutter.core_tolerance = request.cutter.end_diameter;
  const FluteTrial trial_of_any(any_core);
  const auto other = mended(trial_of_any, {});
  if (!other) return {};
  const GroundCutter ground = trial_of_any.ground(trial_of_any.sweep(*other));
  return {0, 0, {2 * ground.section(0).core_radius, 2 * ground.section(request.cutter.flute_length).core_radius}};
}

}  // namespace grinder
