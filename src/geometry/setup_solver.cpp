#include "flute_grinder/geometry/setup_solver.h"

#include "flute_grinder/curve/units.h"
#include "geometry/fit_setup.h"
#include "geometry/plane_roots.h"
#include "geometry/setup_trial.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace flute_grinder {

namespace {

constexpr double kTolerance = 1e-6;                    ///< of the rake [rad], and of the core by its radius
constexpr double kSwivelStep = 2 * units::kDegree;     ///< between the columns of the search
constexpr int kFinerOnLine = 32;                       ///< where one unknown is looked for
constexpr double kWidestSwivel = 80 * units::kDegree;  ///< where a solution is looked for that the machine forbids
constexpr int kFaceSteps = 64;
constexpr double kMinDepth = 0.02, kMaxDepth = 0.98;  ///< of the deepest one
constexpr int kDepthSteps = 48;
constexpr double kQuarter = units::kPi / 2;
constexpr int kMinColumns = 4;
constexpr double kFormedByFace = 0.2;  ///< of the rake face's depth, that the wheel's face or edge must form
constexpr double kSameRake = 0.1 * units::kDegree;
constexpr int kFluteHalvings = 20;  ///< of the flute, for where it is complete
constexpr double kNearApex = 0.8;   ///< of the way there, beyond which a stroke is long
constexpr double kBeyond = 1e-5;    ///< added to the overtravel, for the precision of an extremum's place [m]
constexpr double kBesideSpiral = 4 * units::kDegree;  ///< the swivel from which fits start
constexpr int kStartHeights = 4;                      ///< from which they start, on either side of the axis
constexpr double kCylinder = 1e-6;  ///< a cone whose radius changes less than this over its length is a cylinder

/// What is looked for: two unknowns, or v alone.
struct Unknowns {
  std::optional<SearchRange> u;
  SearchRange v;
  std::function<SetupPoint(double u, double v)> point;
};

class Search {
 public:
  Search(const SetupTrial& trial, const SetupRequest& request)
      : trial_(trial), request_(request), radius_(request.cutter.end_diameter / 2) {}

  bool isCylinder() const {
    return std::abs(std::tan(request_.cutter.cone_angle)) < kCylinder && std::abs(request_.y_per_x) < kCylinder;
  }

  /// All the set-ups that give what is asked, with a swivel between two.
  std::vector<SetupPoint> solutions(double least_swivel, double largest_swivel) const {
    const Unknowns unknowns = this->unknowns(least_swivel, largest_swivel);
    std::vector<SetupPoint> points;
    if (!unknowns.u) {
      for (const LineRoot& root : line(unknowns, 0)) points.push_back(unknowns.point(0, root.at));
      // A wheel in the plane of the helix may give the largest rake, and that be the asked one.
      const SetupPoint along = unknowns.point(0, request_.cutter.spiral_angle);
      const bool allowed = along.swivel >= least_swivel && along.swivel <= largest_swivel;
      const double error = std::abs(rakeError(along, 0));
      if (points.empty() && allowed && error <= std::max(kTolerance, request_.cutter.rake_tolerance)) {
        points.push_back(along);
      }
      return points;
    }
    const auto first = [&](double u, double v) { return rakeError(unknowns.point(u, v), 0); };
    const auto second = [&](double u, double v) { return secondError(unknowns.point(u, v)); };
    for (const PlaneRoot& root : planeRoots(first, second, *unknowns.u, unknowns.v, kTolerance)) {
      points.push_back(unknowns.point(root.u, root.v));
    }
    return points;
  }

  /// Why there is no solution: how far rake or core can be had.
  SetupRefusal unreachable() const {
    const Unknowns unknowns = this->unknowns(request_.least_swivel, request_.largest_swivel);
    Reached rakes, seconds, cores;
    for (int i = 0; i <= (unknowns.u ? unknowns.u->steps : 0); ++i) {
      const double u = unknowns.u ? unknowns.u->at(i) : 0;
      for (int j = 0; j <= unknowns.v.steps; ++j) {
        SetupPoint point = unknowns.point(u, unknowns.v.at(j));
        rakes.add(trial_.rake(point, 0));
        if (!request_.core_diameter) continue;
        point.depth = trial_.deepest();
        cores.add(2 * trial_.coreRadius(trial_.sweep(point), 0));
      }
      if (!unknowns.u) continue;
      for (const LineRoot& root : line(unknowns, u)) seconds.add(secondError(unknowns.point(u, root.at)));
    }
    if (rakes.empty() && request_.core_diameter) {
      return {SetupProblem::kCore, *request_.core_diameter, cores.around(0).least, request_.cutter.end_diameter};
    }
    if (seconds.empty()) {
      const auto [least, largest] = rakes.around(request_.rake);
      return {SetupProblem::kRake, request_.rake, least, largest};
    }
    const auto [least, largest] = seconds.around(0);
    if (!isCylinder()) return {SetupProblem::kRake, request_.rake, request_.rake + least, request_.rake + largest};
    const double core = *request_.core_diameter;
    return {SetupProblem::kCore, core, core * (1 + least), core * (1 + largest)};
  }

 private:
  /// Values that were reached.
  class Reached {
   public:
    struct Ends {
      double least, largest;
    };

    void add(double value) {
      if (!std::isnan(value)) values_.push_back(value);
    }
    bool empty() const { return values_.empty(); }

    /// The least and the largest value, or the nearest ones if the asked one lies between them, and was jumped over.
    Ends around(double asked) const {
      constexpr double far = std::numeric_limits<double>::infinity();
      Ends all{far, -far}, nearest{-far, far};
      for (const double value : values_) {
        all = {std::min(all.least, value), std::max(all.largest, value)};
        (value < asked ? nearest.least : nearest.largest) =
            value < asked ? std::max(nearest.least, value) : std::min(nearest.largest, value);
      }
      return all.least < asked && asked < all.largest ? nearest : all;
    }

   private:
    std::vector<double> values_;
  };

  bool keeps(SetupFigure figure) const { return request_.keep == figure; }

  Unknowns unknowns(double least_swivel, double largest_swivel) const {
    const int columns = static_cast<int>(std::ceil((largest_swivel - least_swivel) / kSwivelStep));
    const SearchRange swivels{least_swivel, largest_swivel, std::max(kMinColumns, columns)};
    const SearchRange faces{-1, 1, kFaceSteps};
    const SearchRange depths{kMinDepth * trial_.deepest(), kMaxDepth * trial_.deepest(), kDepthSteps};
    const SearchRange line{least_swivel, largest_swivel, kFinerOnLine * swivels.steps};
    const SearchRange face_line{-1, 1, kFinerOnLine * kFaceSteps};
    const double swivel = request_.kept.swivel, height = request_.kept.height, depth = request_.depth;
    if (!isCylinder()) {
      if (keeps(SetupFigure::kSwivel)) {
        return {depths, faces, [=](double u, double v) {
                  return SetupPoint{swivel, heightAt(swivel, v * highestFace(swivel)), u};
                }};
      }
      if (keeps(SetupFigure::kHeight)) {
        return {depths, swivels, [=](double u, double v) { return SetupPoint{v, height, u}; }};
      }
      return {swivels, faces, [this](double u, double v) { return withDepth(u, heightAt(u, v * highestFace(u))); }};
    }
    if (keeps(SetupFigure::kDepth) && request_.core_diameter) {
      return {swivels, faces, [=](double u, double v) {
                return SetupPoint{u, heightAt(u, v * highestFace(u)), depth};
              }};
    }
    if (keeps(SetupFigure::kSwivel)) {
      return {{}, face_line, [=](double, double v) {
                return withDepth(swivel, heightAt(swivel, v * highestFace(swivel)));
              }};
    }
    if (keeps(SetupFigure::kHeight)) {
      return {{}, line, [=](double, double v) { return withDepth(v, height); }};
    }
    const double face = radius_ * std::sin(request_.rake);
    return {{}, line, [=](double, double v) { return withDepth(v, heightAt(v, face)); }};
  }

  /// The height of the upper face, at its lowest point, beyond which it no longer comes below the outer circle
  /// anywhere.
  double highestFace(double swivel) const {
    const double depth = request_.core_diameter ? radius_ : std::min(request_.depth, radius_);
    const double reach = std::sqrt(2 * trial_.wheel().largestRadius() * depth);
    return radius_ + reach * std::abs(std::sin(swivel));
  }

  /// The wheel's height for its upper face, at its lowest point, to have a height above the axis.
  double heightAt(double swivel, double face) const { return face - trial_.wheel().upperFace() / std::cos(swivel); }

  SetupPoint withDepth(double swivel, double height) const {
    if (!request_.core_diameter) return {swivel, height, request_.depth};
    return {swivel, height, trial_.depthFor(swivel, height, *request_.core_diameter / 2)};
  }

  std::vector<LineRoot> line(const Unknowns& unknowns, double u) const {
    return lineRoots([&](double v) { return rakeError(unknowns.point(u, v), 0); }, unknowns.v, kTolerance);
  }

  double rakeError(const SetupPoint& point, double x) const { return trial_.rake(point, x) - request_.rake; }

  double secondError(const SetupPoint& point) const {
    if (!isCylinder()) return rakeError(point, request_.cutter.flute_length);
    return 2 * trial_.coreRadius(trial_.sweep(point), 0) / *request_.core_diameter - 1;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  double radius_;
};

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
  requireFinite("least_swivel", r.least_swivel, std::abs(r.least_swivel) < kQuarter, "within (-pi/2, pi/2) [rad]");
  requireFinite("largest_swivel", r.largest_swivel, r.largest_swivel > r.least_swivel && r.largest_swivel < kQuarter,
                "above the least one, below pi/2 [rad]");
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

/// The same tool in the mirror: a left-hand cutter becomes a right-hand one.
SetupRequest mirrored(SetupRequest r) {
  r.cutter.cut = CutDirection::kRightHand;
  r.cutter.spiral_angle = -r.cutter.spiral_angle;
  r.wheel = r.wheel.mirrored();
  r.kept = {-r.kept.swivel, -r.kept.height};
  std::swap(r.least_swivel, r.largest_swivel);
  r.least_swivel = -r.least_swivel;
  r.largest_swivel = -r.largest_swivel;
  return r;
}

double leastPitch(const std::vector<double>& angles) {
  double least = angles.front() + 2 * units::kPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) least = std::min(least, angles[i] - angles[i - 1]);
  return least;
}

/// The tool that a set-up grinds, and what is wrong with it.
struct Judged {
  SolvedSetup solved;
  double formed_by_face = 1;  ///< of the depth of the rake face, least over the flute
  bool cut_short = false;     ///< near a cone's apex, where no overtravel makes the flute complete, or a very long one
  std::optional<SetupProblem> problem;
};

/// One end of the range over which the flute is complete, between a place where it is and one where it is not.
double completeEnd(const SetupTrial& trial, const WheelSweep& sweep, double complete, double incomplete) {
  for (int i = 0; i < kFluteHalvings; ++i) {
    const double middle = (complete + incomplete) / 2;
    (trial.reach(sweep, middle).complete ? complete : incomplete) = middle;
  }
  return complete;
}

void measureReach(const SetupTrial& trial, const WheelSweep& sweep, SolvedSetup& solved) {
  const double length = trial.cutter().geometry().flute_length;
  solved.complete_to = length;
  for (const double x : {0.0, length / 2, length}) {
    const auto reach = trial.reach(sweep, x);
    solved.overtravel[0] = std::max(solved.overtravel[0], -reach.from);
    solved.overtravel[1] = std::max(solved.overtravel[1], reach.to - length);
    if (reach.complete) continue;
    if (x <= length / 2) solved.complete_from = completeEnd(trial, sweep, length, x);
    if (x == length) solved.complete_to = completeEnd(trial, sweep, 0, x);
  }
  // As precise as an extremum's place is known.
  for (double& beyond : solved.overtravel) {
    if (beyond > 0) beyond += kBeyond;
  }
}

void findLimit(const SetupRequest& request, double pitch, SolvedSetup& s) {
  const double swivel = std::min(s.setup.swivel - request.least_swivel, request.largest_swivel - s.setup.swivel);
  const double radius = request.cutter.end_diameter / 2;
  const std::pair<SetupLimit, double> margins[] = {
      {SetupLimit::kSwivel, swivel / (request.largest_swivel - request.least_swivel)},
      {SetupLimit::kLand, s.land / (pitch * radius)},
      {SetupLimit::kCore, s.core_diameter / 2 / radius}};
  std::tie(s.limit, s.margin) = *std::min_element(std::begin(margins), std::end(margins),
                                                  [](const auto& a, const auto& b) { return a.second < b.second; });
}

Judged judge(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point) {
  const double pitch = leastPitch(request.tooth_angles);
  const WheelSweep sweep = trial.sweep(point);
  Judged judged;
  SolvedSetup& s = judged.solved;
  s.setup = {point.swivel, point.height, point.lead};
  s.depth = point.depth;
  s.depth_end = point.depth - (request.y_per_x + point.taper) * request.cutter.flute_length;
  s.least_rake = s.land = std::numeric_limits<double>::infinity();
  s.largest_rake = -s.least_rake;
  for (int i = 0; i <= SetupTrial::kSections; ++i) {
    const double x = trial.section(i);
    const double r = trial.cutter().radius(x);
    const auto high = sweep.wall(x, r, true), low = sweep.wall(x, r, false);
    if (!high || !low) {
      judged.problem = SetupProblem::kWall;
      return judged;
    }
    const double rake = std::atan(-r * high->slope);
    s.least_rake = std::min(s.least_rake, rake);
    s.largest_rake = std::max(s.largest_rake, rake);
    s.land = std::min(s.land, r * (pitch - (high->angle - low->angle)));
    judged.formed_by_face = std::min(judged.formed_by_face, trial.formedByFace(sweep, x));
  }
  s.core_diameter = 2 * trial.coreRadius(sweep, 0);
  s.core_diameter_end = 2 * trial.coreRadius(sweep, request.cutter.flute_length);
  measureReach(trial, sweep, s);
  const double tan_cone = trial.cutter().tanCone(), toward_apex = s.overtravel[tan_cone >= 0 ? 0 : 1];
  judged.cut_short = s.complete_from > 0 || s.complete_to < request.cutter.flute_length ||
                     toward_apex * std::abs(tan_cone) > kNearApex * trial.cutter().radius(0);
  findLimit(request, pitch, s);
  if (!(judged.formed_by_face >= kFormedByFace)) {
    judged.problem = SetupProblem::kWall;
  } else if (!(s.core_diameter > 0)) {
    judged.problem = SetupProblem::kCore;
  } else if (!(s.land > 0)) {
    judged.problem = SetupProblem::kLand;
  }
  return judged;
}

/// The better of two: with the lesser problem, then with a complete flute, then with the steadier rake, then with more
/// of the rake face formed by the wheel's face. Differences of the rake that cannot be measured do not count.
bool isBetter(const Judged& a, const Judged& b) {
  const auto order = [](const Judged& j) {
    const SolvedSetup& s = j.solved;
    const double spread = s.largest_rake - s.least_rake;
    return std::tuple(j.problem ? -static_cast<int>(*j.problem) : -countOf<SetupProblem>(), j.cut_short,
                      std::floor(spread / kSameRake), -j.formed_by_face, spread);
  };
  return order(a) < order(b);
}

std::optional<Judged> best(const SetupTrial& trial, const SetupRequest& request,
                           const std::vector<SetupPoint>& points) {
  std::optional<Judged> best;
  for (const SetupPoint& point : points) {
    const Judged judged = judge(trial, request, point);
    if (!best || isBetter(judged, *best)) best = judged;
  }
  return best;
}

/// With a lead by which the wheel's centre is ahead of where it forms the edge amid the flute.
std::optional<SetupPoint> withLead(const SetupTrial& trial, SetupPoint point) {
  const double x = trial.cutter().geometry().flute_length / 2;
  const auto wall = trial.sweep(point).wall(x, trial.cutter().radius(x), true);
  if (!wall) return std::nullopt;
  point.lead = wall->axis_x - x;
  return trial.cutter().radius(-point.lead) > 0 ? std::optional(point) : std::nullopt;
}

bool asksEdge(const SetupRequest& request) { return request.asks_spiral || request.core_diameter_end; }

/// Starts of a fit: the wheel cuts as deep as is asked at several heights, without and with a lead.
std::vector<SetupPoint> startsOf(const SetupTrial& trial, const SetupRequest& request) {
  const double radius = request.cutter.end_diameter / 2;
  const double depth = request.core_diameter ? radius - *request.core_diameter / 2 : request.depth;
  SetupPoint p;
  p.swivel = std::clamp(request.cutter.spiral_angle + kBesideSpiral, request.least_swivel, request.largest_swivel);
  if (request.keep == SetupFigure::kSwivel) p.swivel = request.kept.swivel;
  const double highest = radius + std::sqrt(2 * trial.wheel().largestRadius() * depth) * std::abs(std::sin(p.swivel));
  std::vector<SetupPoint> starts;
  for (int i = -kStartHeights; i <= kStartHeights; ++i) {
    p.height = highest * i / kStartHeights - trial.wheel().upperFace() / std::cos(p.swivel);
    if (request.keep == SetupFigure::kHeight) p.height = request.kept.height;
    p.depth = request.core_diameter ? trial.depthFor(p.swivel, p.height, *request.core_diameter / 2) : depth;
    if (!std::isfinite(p.depth)) continue;
    starts.push_back(p);
    if (const auto ahead = withLead(trial, p)) starts.push_back(*ahead);
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

/// The best set-up of a cone with all that is asked: exact, or else within the tolerances. If there is none, the
/// nearest.
struct Fitted {
  std::optional<Judged> best;
  std::optional<SetupPoint> nearest;
  double error = std::numeric_limits<double>::infinity();  ///< of the nearest one, by the tolerances
};

/// Fits all that is asked from some starts. @param fitted what others came to.
void fitAll(const SetupTrial& trial, const SetupRequest& request, const std::vector<SetupPoint>& starts,
            Fitted& fitted) {
  const bool has_tolerances = hasTolerances(request);
  const auto worst = [&](const SetupPoint& p) {
    return setupErrors(trial, request, p, SetupTrial::kSections).worst(request);
  };
  std::vector<SetupPoint> fits;
  for (const SetupPoint& start : starts) {
    const auto fit = fitSetup(trial, request, start);
    if (fit && !(has_tolerances && worst(*fit) > 1)) fits.push_back(*fit);
  }
  fitted.best = best(trial, request, fits);
  if (fitted.best && !fitted.best->problem && !fitted.best->cut_short) return;
  for (const SetupPoint& start : starts) {
    const auto fit = nearestSetup(trial, request, start);
    if (!fit) continue;
    const double here = worst(*fit);
    if (here < fitted.error || !fitted.nearest) {
      fitted.error = here;
      fitted.nearest = fit;
    }
    if (here <= 1) fits.push_back(*fit);
  }
  fitted.best = best(trial, request, fits);
}

/// Without lead and taper.
SetupPoint pointOf(const SolvedSetup& s) { return {s.setup.swivel, s.setup.height, s.depth}; }

/// That what is asked cannot be had within its tolerances.
SetupRefusal refusal(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& nearest) {
  const SetupErrors errors = setupErrors(trial, request, nearest, SetupTrial::kSections);
  const auto range = [](const Eigen::ArrayXd& error, double asked) {
    return error.size() == 0 ? Range{} : Range{asked + error.minCoeff(), asked + error.maxCoeff()};
  };
  const WheelSweep sweep = trial.sweep(nearest);
  SetupRefusal refusal{SetupProblem::kTolerance};
  refusal.nearest = {range(errors.rake, request.rake),
                     range(errors.spiral, request.cutter.spiral_angle),
                     {2 * trial.coreRadius(sweep, 0), 2 * trial.coreRadius(sweep, request.cutter.flute_length)}};
  return refusal;
}

SetupRefusal refusal(const SetupRequest& request, const Judged& judged) {
  switch (*judged.problem) {
    case SetupProblem::kLand: return {SetupProblem::kLand, 0, judged.solved.land, judged.solved.land};
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
      solved->setup = {-solved->setup.swivel, -solved->setup.height, solved->setup.lead};
    } else if (auto& refusal = std::get<SetupRefusal>(result); refusal.problem == SetupProblem::kSwivel) {
      refusal = {refusal.problem, -refusal.asked, -refusal.largest, -refusal.least};
    } else {
      refusal.nearest.spiral = {-refusal.nearest.spiral.to, -refusal.nearest.spiral.from};
    }
    return result;
  }
  const SetupTrial trial(ConicalCutter(request.cutter), request.wheel, request.nominal_radius, request.y_per_x);
  const Search search(trial, request);
  if (!search.isCylinder() && request.core_diameter && request.keep) return SetupRefusal{SetupProblem::kOverdetermined};
  const auto beyond = [&](double swivel) {
    return SetupRefusal{SetupProblem::kSwivel, swivel, request.least_swivel, request.largest_swivel};
  };
  if (request.keep == SetupFigure::kSwivel &&
      !(request.kept.swivel >= request.least_swivel && request.kept.swivel <= request.largest_swivel)) {
    return beyond(request.kept.swivel);
  }
  const bool asks_edge = !search.isCylinder() && asksEdge(request);
  Fitted all;
  if (asks_edge) fitAll(trial, request, startsOf(trial, request), all);
  std::vector<SetupPoint> solutions;
  if (!all.best) solutions = search.solutions(request.least_swivel, request.largest_swivel);
  // Where the other starts lead nowhere, a set-up without the edge may lead to one.
  if (asks_edge && !all.best) fitAll(trial, request, solutions, all);
  if (all.best && !all.best->problem) return all.best->solved;
  if (all.best) return refusal(request, *all.best);
  const auto here = best(trial, request, solutions);
  const bool good = here && !here->problem;
  if (good && asks_edge) return refusal(trial, request, all.nearest.value_or(pointOf(here->solved)));
  if (good) {
    const SolvedSetup& s = here->solved;
    const auto even = search.isCylinder() ? std::nullopt : fitSetup(trial, request, pointOf(s));
    const auto fit = even ? std::optional(judge(trial, request, *even)) : std::nullopt;
    return fit && !fit->problem && !(fit->cut_short && !here->cut_short) ? fit->solved : s;
  }
  for (const auto& [least, largest] :
       {std::pair{-kWidestSwivel, request.least_swivel}, std::pair{request.largest_swivel, kWidestSwivel}}) {
    if (!(least < largest)) continue;
    const auto there = best(trial, request, search.solutions(least, largest));
    if (there && !there->problem) return beyond(there->solved.setup.swivel);
  }
  if (all.nearest) return refusal(trial, request, *all.nearest);
  return here ? refusal(request, *here) : search.unreachable();
}

}  // namespace flute_grinder
