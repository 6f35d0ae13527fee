#include "geometry/fit_setup.h"

#include "flute_grinder/curve/units.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace flute_grinder {

namespace {

constexpr double kExact = 1e-6;  ///< of the angles [rad], and of the cores by the asked ones
constexpr double kEven = 0.001 * units::kDegree;
constexpr int kShifts = 4;                ///< of the rake at the ends
constexpr double kNearEnough = 5;         ///< by the tolerances: an error that more weight may bring within them
constexpr int kFitSteps = 40;             ///< of a fit
constexpr int kStepsBetweenSections = 4;  ///< where errors are weighed by their tolerances
constexpr double kNoGain = 1e-2;          ///< of a step, of the errors, that ends a fit
constexpr double kFigureStep = 1e-6;      ///< [rad], of the taper, and of the small end's radius
constexpr double kLeastSpiral = 1e-3;     ///< below whose tangent a lead has no effect
constexpr double kLeastDamping = 1e-9, kMostDamping = 1e6, kDampingFactor = 8;

/// What a figure may differ by: a tolerance of 0 asks for it exactly.
double allowed(double tolerance) { return std::max(tolerance, kExact); }

double largest(const Eigen::ArrayXd& errors) {
  if (errors.size() == 0) return 0;
  return errors.allFinite() ? errors.abs().maxCoeff() : std::numeric_limits<double>::infinity();
}

/// A damped fit (Levenberg, Marquardt) of the figures of a set-up that are free.
class Fit {
 public:
  using Errors = std::function<Eigen::ArrayXd(const SetupPoint&)>;

  Fit(const SetupTrial& trial, const SetupRequest& request) : trial_(trial), request_(request) {
    const bool keeps_swivel = request.keep == SetupFigure::kSwivel, keeps_height = request.keep == SetupFigure::kHeight;
    if (!keeps_swivel) figures_.push_back(&SetupPoint::swivel);
    if (!keeps_height) figures_.push_back(&SetupPoint::height);
    if (request.core_diameter || keeps_swivel || keeps_height) figures_.push_back(&SetupPoint::depth);
    if (hasLead(request)) figures_.push_back(&SetupPoint::lead);
    if (request.core_diameter_end) figures_.push_back(&SetupPoint::taper);
  }

  static bool hasLead(const SetupRequest& request) {
    return request.asks_spiral && std::abs(std::tan(request.cutter.spiral_angle)) > kLeastSpiral;
  }

  /// @param enough the largest error at which the fit may end. @return nothing if the start gives no tool.
  std::optional<SetupPoint> solve(SetupPoint point, const Errors& errors_of, double enough) const {
    Eigen::VectorXd errors = at(point, errors_of);
    if (!errors.allFinite()) return std::nullopt;
    double damping = kLeastDamping;
    for (int i = 0; i < kFitSteps && largest(errors) > enough; ++i) {
      const double before = errors.norm();
      if (!step(point, errors, damping, errors_of) || errors.norm() > (1 - kNoGain) * before) break;
    }
    return point;
  }

 private:
  Eigen::VectorXd at(const SetupPoint& p, const Errors& errors_of) const {
    const bool is_setup = p.swivel >= request_.least_swivel && p.swivel <= request_.largest_swivel &&
                          std::abs(p.lead) < trial_.wheel().largestRadius() && trial_.cutter().radius(-p.lead) > 0 &&
                          trial_.isSound(p);
    return is_setup ? Eigen::VectorXd(errors_of(p)) : Eigen::VectorXd::Constant(1, std::nan(""));
  }

  double unit(std::size_t k) const {
    const bool number = figures_[k] == &SetupPoint::swivel || figures_[k] == &SetupPoint::taper;
    return number ? 1 : trial_.cutter().radius(0);
  }

  SetupPoint moved(SetupPoint point, const Eigen::VectorXd& step) const {
    for (std::size_t k = 0; k < figures_.size(); ++k)
      point.*figures_[k] += step[static_cast<Eigen::Index>(k)] * unit(k);
    return point;
  }

  /// Goes a step that makes the errors smaller. @return false if there is none.
  bool step(SetupPoint& point, Eigen::VectorXd& errors, double& damping, const Errors& errors_of) const {
    const auto count = static_cast<Eigen::Index>(figures_.size());
    Eigen::MatrixXd by_figure(errors.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::VectorXd there = at(moved(point, kFigureStep * Eigen::VectorXd::Unit(count, k)), errors_of);
      if (!there.allFinite()) return false;
      by_figure.col(k) = (there - errors) / kFigureStep;
    }
    const Eigen::MatrixXd squares = by_figure.transpose() * by_figure;
    for (; damping <= kMostDamping; damping *= kDampingFactor) {
      Eigen::MatrixXd damped = squares;
      damped.diagonal() *= 1 + damping;
      const SetupPoint next = moved(point, damped.ldlt().solve(-by_figure.transpose() * errors));
      const Eigen::VectorXd there = at(next, errors_of);
      if (!(there.allFinite() && there.norm() < errors.norm())) {
        damping = std::max(damping, 1e-4);
        continue;
      }
      point = next;
      errors = there;
      damping = std::max(kLeastDamping, damping / (kDampingFactor * kDampingFactor));
      return true;
    }
    return false;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  std::vector<double SetupPoint::*> figures_;  ///< that are free
};

/// The errors at the ends of the flute, as many as figures are free, with a rake that both ends shall have.
std::optional<SetupPoint> exact(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                double rake) {
  const auto errors_of = [&](const SetupPoint& point) {
    const SetupErrors e = setupErrors(trial, request, point, 1);
    const Eigen::ArrayXd spiral = Fit::hasLead(request) ? e.spiral : Eigen::ArrayXd();
    Eigen::ArrayXd all(e.rake.size() + spiral.size() + e.core.size());
    all << e.rake + request.rake - rake, spiral, e.core;
    return all;
  };
  const auto found = Fit(trial, request).solve(start, errors_of, kExact);
  return found && largest(errors_of(*found)) <= kExact ? found : std::nullopt;
}

}  // namespace

double SetupErrors::worst(const SetupRequest& request) const {
  const CutterGeometry& c = request.cutter;
  return std::max({largest(rake) / allowed(c.rake_tolerance), largest(spiral) / allowed(c.spiral_tolerance),
                   largest(core) / allowed(c.core_tolerance / c.end_diameter)});
}

SetupErrors setupErrors(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point, int steps) {
  const WheelSweep sweep = trial.sweep(point);
  const double length = request.cutter.flute_length, diameter = request.cutter.end_diameter;
  const LogCurve travel(2 * trial.cutter().tanCone() / diameter, 2 / diameter);  // of an edge at 45 deg
  SetupErrors errors;
  errors.rake.resize(steps + 1);
  errors.spiral.resize(request.asks_spiral ? steps : 0);
  double before = 0;
  for (int i = 0; i <= steps; ++i) {
    const double x = length * i / steps;
    const SetupTrial::Edge edge = trial.edge(sweep, x);
    errors.rake[i] = edge.rake - request.rake;
    if (i > 0 && request.asks_spiral) {
      const double turn = (edge.angle - before) / (travel.a(x) - travel.a(length * (i - 1) / steps));
      errors.spiral[i - 1] = std::atan(turn) - request.cutter.spiral_angle;
    }
    before = edge.angle;
  }
  std::vector<double> cores;
  if (request.core_diameter) cores.push_back((2 * trial.coreRadius(sweep, 0) - *request.core_diameter) / diameter);
  if (request.core_diameter_end) {
    cores.push_back((2 * trial.coreRadius(sweep, length) - *request.core_diameter_end) / diameter);
  }
  errors.core = Eigen::Map<Eigen::ArrayXd>(cores.data(), static_cast<Eigen::Index>(cores.size()));
  return errors;
}

std::optional<SetupPoint> fitSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start) {
  auto best = exact(trial, request, start, request.rake);
  if (!best || request.z_law != ZLaw::kPublished) return best;
  const auto rakeErrors = [&](const SetupPoint& p) {
    return setupErrors(trial, request, p, SetupTrial::kSections).rake;
  };
  double rake = request.rake;
  Eigen::ArrayXd here = rakeErrors(*best);
  for (int i = 0; i < kShifts && here.allFinite(); ++i) {
    const double middle = (here.minCoeff() + here.maxCoeff()) / 2;
    if (std::abs(middle) <= kEven) break;
    rake -= middle;
    const auto next = exact(trial, request, *best, rake);
    if (!next) break;
    const Eigen::ArrayXd there = rakeErrors(*next);
    if (!(largest(there) < largest(here))) break;
    best = next;
    here = there;
  }
  return best;
}

std::optional<SetupPoint> nearestSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start) {
  const CutterGeometry& c = request.cutter;
  const auto errors_of = [&](const SetupPoint& point) {
    const SetupErrors e = setupErrors(trial, request, point, kStepsBetweenSections);
    Eigen::ArrayXd all(e.rake.size() + e.spiral.size() + e.core.size());
    all << e.rake / allowed(c.rake_tolerance), e.spiral / allowed(c.spiral_tolerance),
        e.core / allowed(c.core_tolerance / c.end_diameter);
    return all;
  };
  const Fit fit(trial, request);
  const auto found = fit.solve(start, errors_of, 0);
  const double error = found ? largest(errors_of(*found)) : 0;
  if (!(error > 1 && error < kNearEnough)) return found;
  // Cubed, the largest error counts most.
  const auto cubed = [&](const SetupPoint& point) -> Eigen::ArrayXd { return errors_of(point).cube(); };
  return fit.solve(*found, cubed, 1);
}

}  // namespace flute_grinder
