#include "setup/fit_setup.h"

#include "flute_grinder/base/units.h"
#include "setup/setup_judge.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace grinder {

namespace {

constexpr double kExact = 1e-6;  ///< tolerance for exact angles [rad], and for cores relative to the asked ones
constexpr double kEven = 0.001 * units::kDegree;
constexpr int kShifts = 4;                       ///< number of shifts of the asked rake at the ends
constexpr double kNearEnough = 5;                ///< error, per tolerance, that more weight may still reduce to 1
constexpr double kWellWithin = 0.9;              ///< target of such a fit, as a fraction of the tolerances
constexpr int kEveningPowers[] = {3, 5, 9, 15};  ///< odd powers, so that the errors keep their signs
constexpr int kEvenings = 4;                     ///< maximum number of steps with each power, as long as they gain
constexpr double kNoEvening = 1e-3;              ///< minimum gain, as a fraction of the tolerances
constexpr double kLandAsked = 0.01;              ///< land that is looked for, as a fraction of the diameter
constexpr double kNoLack = 1e-3;                 ///< negligible lack of land or tolerance, as a fraction of each
constexpr int kStepsBetweenSections = 4;         ///< steps between the sections that are weighed by tolerance
constexpr double kNoGain = 1e-2;                 ///< relative gain of a step below which a fit ends
/// Step of a numerical derivative [rad], of the taper, and as a fraction of the small end's radius: large enough that
/// the positions of extrema, known to 1e-8, cause no noise in a difference.
constexpr double kFigureStep = 1e-4;
constexpr double kMinSpiral = 1e-3;  ///< spiral angle below whose tangent a shift along X has no effect
/// The initial damping keeps a fit near its start along a valley of equally good set-ups.
constexpr double kDamping = 1e-3, kMinDamping = 1e-9, kMostDamping = 1e6, kDampingFactor = 8;

/// The maximum allowed error; a tolerance of 0 asks for the exact value.
double allowed(double tolerance) { return std::max(tolerance, kExact); }

double maxOf(const Eigen::ArrayXd& errors) {
  if (errors.size() == 0) return 0;
  return errors.allFinite() ? errors.abs().maxCoeff() : std::numeric_limits<double>::infinity();
}

/// A damped fit (Levenberg, Marquardt) of the free figures of a set-up.
class DampedFit {
 public:
  using Errors = std::function<Eigen::ArrayXd(const SetupPoint&)>;

  DampedFit(const SetupTrial& trial, const SetupRequest& request)
      : trial_(trial), request_(request), is_height_tied_(isHeightTied(trial, request)) {
    if (request.keep != SetupFigure::kSwivel) figures_.push_back(&SetupPoint::swivel);
    if (request.keep != SetupFigure::kHeight && !is_height_tied_) figures_.push_back(&SetupPoint::height);
    if (findsDepth(trial, request)) figures_.push_back(&SetupPoint::depth);
    if (hasShift(trial, request)) figures_.push_back(&SetupPoint::x_shift);
    if (request.core_diameter_end && !trial.isCylinder()) figures_.push_back(&SetupPoint::taper);
  }

  /// @param enough maximum error at which the fit may end.
  /// @param most maximum number of steps.
  /// @return nothing if the start gives no tool.
  std::optional<SetupPoint> solve(SetupPoint point, const Errors& errors_of, double enough,
                                  int most = kFitSteps) const {
    Eigen::VectorXd errors = at(point, errors_of);
    if (!errors.allFinite()) return std::nullopt;
    double damping = kDamping;
    for (int i = 0; i < most && maxOf(errors) > enough; ++i) {
      const double before = errors.norm();
      if (!step(point, errors, damping, errors_of) || errors.norm() > (1 - kNoGain) * before) break;
    }
    return point;
  }

 private:
  Eigen::VectorXd at(const SetupPoint& p, const Errors& errors_of) const {
    const bool is_setup =
        std::abs(p.x_shift) < trial_.wheel().maxRadius() && trial_.cutter().radius(-p.x_shift) > 0 && trial_.isSound(p);
    return is_setup ? Eigen::VectorXd(errors_of(p)) : Eigen::VectorXd::Constant(1, std::nan(""));
  }

  double unit(std::size_t k) const {
    const bool number = figures_[k] == &SetupPoint::swivel || figures_[k] == &SetupPoint::taper;
    return number ? 1 : trial_.cutter().radius(0);
  }

  SetupPoint moved(SetupPoint point, const Eigen::VectorXd& step) const {
    for (std::size_t k = 0; k < figures_.size(); ++k)
      point.*figures_[k] += step[static_cast<Eigen::Index>(k)] * unit(k);
    point.swivel = std::clamp(point.swivel, request_.min_swivel, request_.max_swivel);
    if (is_height_tied_) point.height = tiedHeight(trial_, request_, point.swivel);
    return point;
  }

  static Eigen::VectorXd dampedStep(const Eigen::MatrixXd& by_figure, const Eigen::VectorXd& errors, double damping) {
    Eigen::MatrixXd squares = by_figure.transpose() * by_figure;
    squares.diagonal() *= 1 + damping;
    return squares.ldlt().solve(-by_figure.transpose() * errors);
  }

  /// The damped step; if it reaches the limit of the swivel, the other figures are fitted for the swivel at the limit.
  Eigen::VectorXd stepWithin(const SetupPoint& point, const Eigen::MatrixXd& by_figure, const Eigen::VectorXd& errors,
                             double damping) const {
    Eigen::VectorXd step = dampedStep(by_figure, errors, damping);
    if (figures_.front() != &SetupPoint::swivel) return step;
    const double swivel = point.swivel + step[0];
    const double limit = std::clamp(swivel, request_.min_swivel, request_.max_swivel);
    if (limit == swivel) return step;
    const double to_limit = limit - point.swivel;
    const Eigen::Index others = step.size() - 1;
    step << to_limit, dampedStep(by_figure.rightCols(others), errors + to_limit * by_figure.col(0), damping);
    return step;
  }

  /// Takes a step that reduces the errors.
  /// @return false if there is none.
  bool step(SetupPoint& point, Eigen::VectorXd& errors, double& damping, const Errors& errors_of) const {
    const auto count = static_cast<Eigen::Index>(figures_.size());
    Eigen::MatrixXd by_figure(errors.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const bool at_limit = figures_[static_cast<std::size_t>(k)] == &SetupPoint::swivel &&
                            point.swivel + kFigureStep > request_.max_swivel;
      const double off = at_limit ? -kFigureStep : kFigureStep;
      const Eigen::VectorXd there = at(moved(point, off * Eigen::VectorXd::Unit(count, k)), errors_of);
      if (!there.allFinite()) return false;
      by_figure.col(k) = (there - errors) / off;
    }
    for (; damping <= kMostDamping; damping *= kDampingFactor) {
      const SetupPoint next = moved(point, stepWithin(point, by_figure, errors, damping));
      const Eigen::VectorXd there = at(next, errors_of);
      if (!(there.allFinite() && there.norm() < errors.norm())) {
        damping = std::max(damping, kDamping);
        continue;
      }
      point = next;
      errors = there;
      damping = std::max(kMinDamping, damping / (kDampingFactor * kDampingFactor));
      return true;
    }
    return false;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  bool is_height_tied_;
  std::vector<double SetupPoint::*> figures_;  ///< the free figures
};

/// @param rake asked rake at both ends.
std::optional<EndsFit> fitEnds(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                               double rake) {
  const auto errors_of = [&](const SetupPoint& point) {
    const SetupErrors e = setupErrors(trial, request, point, 1);
    const Eigen::ArrayXd turn = hasShift(trial, request) ? e.turn : Eigen::ArrayXd();
    Eigen::ArrayXd all(e.rake.size() + turn.size() + e.core.size());
    all << e.rake + request.rake - rake, turn, e.core;
    return all;
  };
  const auto found = DampedFit(trial, request).solve(start, errors_of, kExact);
  if (!found) return std::nullopt;
  return EndsFit{*found, maxOf(errors_of(*found)) <= kExact};
}

/// All errors over the flute, per tolerance.
/// @param chord_from chordal error, per tolerance, that counts as none.
Eigen::ArrayXd weighedErrors(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point,
                             double chord_from) {
  const CutterGeometry& c = request.cutter;
  const SetupErrors e = setupErrors(trial, request, point, kStepsBetweenSections);
  const double chord = c.chordal_rake_tolerance;
  const Eigen::ArrayXd off = chord > 0 ? Eigen::ArrayXd((e.chord.abs() / chord - chord_from).max(0)) : Eigen::ArrayXd();
  Eigen::ArrayXd all(e.rake.size() + e.turn.size() + e.spiral.size() + off.size() + e.core.size());
  all << e.rake / allowed(c.rake_tolerance), e.turn / allowed(c.spiral_tolerance),
      e.spiral / allowed(c.spiral_tolerance), off, e.core / allowed(c.core_tolerance / c.end_diameter);
  return all;
}

}  // namespace

double SetupErrors::worst(const SetupRequest& request) const {
  const CutterGeometry& c = request.cutter;
  return std::max({maxOf(rake) / allowed(c.rake_tolerance),
                   std::max(maxOf(turn), maxOf(spiral)) / allowed(c.spiral_tolerance),
                   c.chordal_rake_tolerance > 0 ? maxOf(chord) / c.chordal_rake_tolerance : 0,
                   maxOf(core) / allowed(c.core_tolerance / c.end_diameter)});
}

bool hasShift(const SetupTrial& trial, const SetupRequest& request) {
  return request.asks_spiral && !trial.isCylinder() && std::abs(std::tan(request.cutter.spiral_angle)) > kMinSpiral;
}

bool isHeightTied(const SetupTrial& trial, const SetupRequest& request) {
  const bool keeps_depth = request.keep == SetupFigure::kDepth;
  return trial.isCylinder() && (!request.keep || (keeps_depth && !request.core_diameter));
}

double tiedHeight(const SetupTrial& trial, const SetupRequest& request, double swivel) {
  return trial.cutter().radius(0) * std::sin(request.rake) - trial.wheel().upperFace() / std::cos(swivel);
}

bool findsDepth(const SetupTrial& trial, const SetupRequest& request) {
  if (request.core_diameter) return request.keep != SetupFigure::kDepth;
  return !trial.isCylinder() && (request.keep == SetupFigure::kSwivel || request.keep == SetupFigure::kHeight);
}

SetupErrors setupErrors(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point, int steps) {
  const bool judges = steps > 1;
  if (trial.isCylinder()) steps = 0;
  const WheelSweep sweep = trial.sweep(point);
  const double length = request.cutter.flute_length, diameter = request.cutter.end_diameter;
  const auto &core = request.core_diameter, &core_end = request.core_diameter_end;
  std::vector<double> rakes, turns, spirals, chords, cores;
  double before = 0;
  for (int i = 0; i <= steps; ++i) {
    const double part = steps > 0 ? static_cast<double>(i) / steps : 0, x = part * length;
    const SetupTrial::Edge edge = trial.edge(sweep, x);
    rakes.push_back(edge.rake - request.rake);
    if (i > 0 && request.asks_spiral) {
      const double mean = meanSpiral(trial.cutter(), length * (i - 1) / steps, x, edge.angle - before);
      turns.push_back(mean - request.cutter.spiral_angle);
    }
    const bool asks_core = core && core_end ? true : core ? i == 0 : core_end && i == steps;
    const double radius = judges || asks_core ? trial.coreRadius(sweep, x) : 0;
    if (judges) chords.push_back(trial.chordalRake(sweep, x, edge.angle, radius) - request.rake);
    if (steps > 1 && request.asks_spiral) spirals.push_back(trial.spiral(sweep, x) - request.cutter.spiral_angle);
    before = edge.angle;
    if (!asks_core) continue;
    const double asked = core && core_end ? *core + part * (*core_end - *core) : core ? *core : *core_end;
    cores.push_back((2 * radius - asked) / diameter);
  }
  const auto array = [](const std::vector<double>& values) -> Eigen::ArrayXd {
    return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  return {array(rakes), array(turns), array(spirals), array(chords), array(cores)};
}

std::optional<EndsFit> fitEnds(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start) {
  auto best = fitEnds(trial, request, start, request.rake);
  if (!best || !best->is_exact || request.z_law != ZLaw::kPublished) return best;
  const auto rake_errors = [&](const EndsFit& fit) {
    return setupErrors(trial, request, fit.point, SetupTrial::kSections).rake;
  };
  double rake = request.rake;
  Eigen::ArrayXd here = rake_errors(*best);
  for (int i = 0; i < kShifts && here.allFinite(); ++i) {
    const double middle = (here.minCoeff() + here.maxCoeff()) / 2;
    if (std::abs(middle) <= kEven) break;
    rake -= middle;
    const auto next = fitEnds(trial, request, best->point, rake);
    if (!next || !next->is_exact) break;
    const Eigen::ArrayXd there = rake_errors(*next);
    if (!(maxOf(there) < maxOf(here))) break;
    best = next;
    here = there;
  }
  return best;
}

std::optional<SetupPoint> nearestSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                       int most) {
  // A chord within its tolerance counts as no error, so that the rake at the edge comes as near as possible to the
  // asked one.
  const auto errors_of = [&](const SetupPoint& point) { return weighedErrors(trial, request, point, kWithin); };
  return DampedFit(trial, request).solve(start, errors_of, 0, most);
}

SetupPoint evenedSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& nearest) {
  const auto worst = [&](const SetupPoint& p) { return maxOf(weighedErrors(trial, request, p, 0)); };
  SetupPoint best = nearest;
  double error = worst(best);
  for (const int power : kEveningPowers) {
    const auto raised = [&](const SetupPoint& p) -> Eigen::ArrayXd {
      return weighedErrors(trial, request, p, 0).pow(power);
    };
    for (int i = 0; i < kEvenings && error > kWithin && error < kNearEnough; ++i) {
      const auto next = DampedFit(trial, request).solve(best, raised, std::pow(kWellWithin, power));
      const double there = next ? worst(*next) : error;
      if (!(there < error - kNoEvening)) break;
      best = *next;
      error = there;
    }
  }
  return best;
}

SetupPoint setupWithLand(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start) {
  const double pitch = minPitch(request.tooth_angles), diameter = request.cutter.end_diameter;
  const auto lacking = [&](const SetupPoint& point) {
    const Eigen::ArrayXd errors = weighedErrors(trial, request, point, 0);
    Eigen::ArrayXd all(errors.size() + SetupTrial::kSections + 1);
    const WheelSweep sweep = trial.sweep(point);
    for (int i = 0; i <= SetupTrial::kSections; ++i) {
      const double land = trial.land(sweep, trial.section(i), pitch);
      all[i] = std::isnan(land) ? land : std::max(0.0, (kLandAsked - land / diameter) / kLandAsked);
    }
    all.tail(errors.size()) = errors.sign() * (errors.abs() - kWellWithin).max(0);
    return all;
  };
  return DampedFit(trial, request).solve(start, lacking, kNoLack).value_or(start);
}

}  // namespace grinder
