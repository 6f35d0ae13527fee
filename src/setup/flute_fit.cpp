#include "setup/flute_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMost = 0.9;          ///< fraction of a tolerance beyond which an error counts in full
constexpr double kPull = 0.1;          ///< weight of an error within its tolerance
constexpr double kPullOfChord = 0.01;  ///< a chord may differ from the tangent: the rake at the edge comes first
constexpr double kLand = 0.01;         ///< land below which it counts as an error, as a fraction of the end diameter
constexpr double kNoGain = 1e-2;       ///< relative gain of a step below which a fit ends
/// Step of a numerical derivative, per unit of the figure: large enough that the positions of extrema, known to 1e-8,
/// cause no noise in a difference.
constexpr double kFigureStep = 1e-4;
/// The initial damping keeps a fit near its start along a valley of equally good set-ups.
constexpr double kDamping = 1e-3, kMinDamping = 1e-9, kMostDamping = 1e6, kDampingFactor = 8;

Eigen::ArrayXd beyond(const Eigen::ArrayXd& errors) { return errors.sign() * (errors.abs() - kMost).max(0); }

/// What the fit makes small; NaN if there is no tool.
Eigen::VectorXd residuals(const FluteTrial& trial, const SetupPoint& p, int sections) {
  if (!trial.isSound(p)) return Eigen::VectorXd::Constant(1, std::nan(""));
  const FluteErrors e = trial.errors(p, sections);
  Eigen::ArrayXd all(e.asked.size() + e.chord.size() + e.land.size() + 2);
  const WheelProfile& wheel = trial.request().wheel;
  all << kPull * e.asked + beyond(e.asked), kPullOfChord * e.chord + beyond(e.chord), (1 - e.land / kLand).max(0),
      p.less_diameter / wheel.maxRadius() / 2, p.less_width / (wheel.upperFace() - wheel.lowerFace());
  // max() drops a NaN.
  return e.land.allFinite() ? Eigen::VectorXd(all) : Eigen::VectorXd::Constant(1, std::nan(""));
}

class Fit {
 public:
  Fit(const FluteTrial& trial, const std::vector<FreeFigure>& figures, int sections)
      : trial_(trial), figures_(figures), sections_(sections) {}

  std::optional<SetupPoint> solve(SetupPoint point, int most) const {
    Eigen::VectorXd errors = residuals(trial_, point, sections_);
    if (!errors.allFinite()) return std::nullopt;
    double damping = kDamping;
    for (int i = 0; i < most; ++i) {
      const double before = errors.norm();
      if (!step(point, errors, damping) || errors.norm() > (1 - kNoGain) * before) break;
    }
    return point;
  }

 private:
  Eigen::Index count() const { return static_cast<Eigen::Index>(figures_.size()); }
  const FreeFigure& free(Eigen::Index k) const { return figures_[static_cast<std::size_t>(k)]; }

  SetupPoint moved(SetupPoint point, const Eigen::VectorXd& step) const {
    for (Eigen::Index k = 0; k < count(); ++k) {
      double& figure = point.*free(k).figure;
      figure = std::clamp(figure + step[k] * free(k).unit, free(k).low, free(k).high);
    }
    return point;
  }

  /// The derivatives of the residuals; NaN if one of them leads to no tool.
  Eigen::MatrixXd byFigure(const SetupPoint& point, const Eigen::VectorXd& errors) const {
    Eigen::MatrixXd by_figure(errors.size(), count());
    for (Eigen::Index k = 0; k < count(); ++k) {
      const bool at_limit = point.*free(k).figure + kFigureStep * free(k).unit > free(k).high;
      const double off = at_limit ? -kFigureStep : kFigureStep;
      const Eigen::VectorXd there = residuals(trial_, moved(point, off * Eigen::VectorXd::Unit(count(), k)), sections_);
      if (!there.allFinite()) return Eigen::MatrixXd::Constant(1, 1, std::nan(""));
      by_figure.col(k) = (there - errors) / off;
    }
    return by_figure;
  }

  /// The damped step. A figure that would leave its range goes to the end of it, and the others are fitted for that.
  Eigen::VectorXd dampedStep(const SetupPoint& point, Eigen::MatrixXd by_figure, Eigen::VectorXd errors,
                             double damping) const {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(count());
    for (;;) {
      Eigen::MatrixXd squares = by_figure.transpose() * by_figure;
      squares.diagonal() *= 1 + damping;
      const Eigen::VectorXd all = step + squares.ldlt().solve(-by_figure.transpose() * errors);
      bool stays = true;
      for (Eigen::Index k = 0; k < count() && stays; ++k) {
        const double from = point.*free(k).figure, to = from + all[k] * free(k).unit;
        if (step[k] != 0 || by_figure.col(k).isZero(0) || (to >= free(k).low && to <= free(k).high)) continue;
        step[k] = (std::clamp(to, free(k).low, free(k).high) - from) / free(k).unit;
        errors += step[k] * by_figure.col(k);
        by_figure.col(k).setZero();
        stays = false;
      }
      if (stays) return all;
    }
  }

  /// Takes a step that reduces the errors.
  /// @return false if there is none.
  bool step(SetupPoint& point, Eigen::VectorXd& errors, double& damping) const {
    const Eigen::MatrixXd by_figure = byFigure(point, errors);
    if (!by_figure.allFinite()) return false;
    for (; damping <= kMostDamping; damping *= kDampingFactor) {
      const SetupPoint next = moved(point, dampedStep(point, by_figure, errors, damping));
      const Eigen::VectorXd there = residuals(trial_, next, sections_);
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

  const FluteTrial& trial_;
  const std::vector<FreeFigure>& figures_;
  int sections_;
};

}  // namespace

std::vector<FreeFigure> freeFigures(const FluteTrial& trial) {
  const FluteRequest& r = trial.request();
  const double radius = trial.cutter().radius(0);
  std::vector<FreeFigure> figures;
  if (r.keep != SetupFigure::kSwivel) figures.push_back({&SetupPoint::swivel, 1, r.swivel.from, r.swivel.to});
  if (r.keep != SetupFigure::kHeight) figures.push_back({&SetupPoint::height, radius, -kInfinity, kInfinity});
  if (r.keep != SetupFigure::kDepth) figures.push_back({&SetupPoint::depth, radius, 0, radius});
  if (trial.hasShift()) figures.push_back({&SetupPoint::x_shift, radius, -kInfinity, kInfinity});
  if (!trial.isCylinder()) figures.push_back({&SetupPoint::taper, 1, -kInfinity, kInfinity});
  return figures;
}

std::optional<SetupPoint> fitFlute(const FluteTrial& trial, const std::vector<FreeFigure>& figures, SetupPoint start,
                                   int sections, int most) {
  return Fit(trial, figures, sections).solve(start, most);
}

}  // namespace grinder
