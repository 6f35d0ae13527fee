#include "geometry/fit_setup.h"

#include "flute_grinder/curve/units.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace flute_grinder {

namespace {

/// Newton's method on as many figures of a set-up as the tool has figures that are asked.
class Fit {
 public:
  /// @param cores whether the asked cores count.
  Fit(const SetupTrial& trial, const SetupRequest& request, bool cores)
      : trial_(trial),
        request_(request),
        asks_core_(cores && request.core_diameter),
        asks_core_end_(cores && request.core_diameter_end) {
    if (!isKept(SetupFigure::kSwivel)) figures_.push_back(&SetupPoint::swivel);
    if (!isKept(SetupFigure::kHeight)) figures_.push_back(&SetupPoint::height);
    if (asks_core_ || isKept(SetupFigure::kSwivel) || isKept(SetupFigure::kHeight)) {
      figures_.push_back(&SetupPoint::depth);
    }
    if (request.asks_spiral) figures_.push_back(&SetupPoint::lead);
    if (asks_core_end_) figures_.push_back(&SetupPoint::taper);
  }

  /// The set-up that is exact at both ends. What is asked is approached from what the start gives, in steps from which
  /// Newton's method converges; nothing if the way ends before.
  std::optional<SetupPoint> exact(SetupPoint point) const {
    const Eigen::VectorXd from = tool(point), to = asked(request_.rake);
    double reached = 0;
    for (double step = 1; reached < 1 && step >= kMinStep;) {
      const double next = std::min(1.0, reached + step);
      const auto there = solve(point, next < 1 ? Eigen::VectorXd(from + next * (to - from)) : to);
      if (there) {
        point = *there;
        reached = next;
      } else {
        step /= 2;
      }
    }
    const bool good = reached == 1 && point.swivel >= request_.least_swivel && point.swivel <= request_.largest_swivel;
    return good ? std::optional(point) : std::nullopt;
  }

  /// From an exact one, that with the least largest error of the rake.
  SetupPoint even(SetupPoint point) const {
    double rake = request_.rake;
    std::optional<Errors> here = errorsOverFlute(point);
    for (int i = 0; i < kShifts && here && std::abs(here->middle()) > kEven; ++i) {
      rake -= here->middle();
      const auto next = solve(point, asked(rake));
      const bool allowed = next && next->swivel >= request_.least_swivel && next->swivel <= request_.largest_swivel;
      const auto there = allowed ? errorsOverFlute(*next) : std::nullopt;
      if (!there || !(there->largest() < here->largest())) break;
      point = *next;
      here = there;
    }
    return point;
  }

 private:
  static constexpr double kTolerance = 1e-6;  ///< of the angles [rad], and of the cores by the asked ones
  static constexpr double kEven = 0.001 * units::kDegree;
  static constexpr double kMinStep = 1.0 / 64;  ///< of the way to what is asked
  static constexpr int kShifts = 4;             ///< of the rake at the ends
  static constexpr int kSteps = 12;             ///< of Newton's method
  static constexpr int kHalvings = 6;  ///< of a step, where another part of the wheel begins to form the rake face
  static constexpr double kDerivativeStep = 1e-6;  ///< [rad], of the taper, and of the small end's radius

  /// Of the rake over the flute [rad].
  struct Errors {
    double least = 0, most = 0;
    double middle() const { return (least + most) / 2; }
    double largest() const { return std::max(std::abs(least), std::abs(most)); }
  };

  bool isKept(SetupFigure figure) const { return request_.keep == figure; }

  std::optional<Errors> errorsOverFlute(const SetupPoint& point) const {
    Eigen::ArrayXd errors(SetupTrial::kSections + 1);
    for (int i = 0; i <= SetupTrial::kSections; ++i) errors[i] = trial_.rake(point, trial_.section(i)) - request_.rake;
    if (!errors.allFinite()) return std::nullopt;
    return Errors{errors.minCoeff(), errors.maxCoeff()};
  }

  /// The figures of the tool, as many as those of the set-up: the rake at both ends [rad], then what else is asked: the
  /// error of the edge's turn [rad], the cores by the asked ones. NaN where there is none.
  Eigen::VectorXd tool(const SetupPoint& point) const {
    Eigen::VectorXd tool(static_cast<Eigen::Index>(figures_.size()));
    const bool is_setup = std::abs(point.swivel) < units::kPi / 2 && trial_.cutter().radius(-point.lead) > 0;
    if (!is_setup) return tool.setConstant(std::nan(""));
    const double length = request_.cutter.flute_length;
    tool[0] = trial_.rake(point, 0);
    tool[1] = trial_.rake(point, length);
    Eigen::Index next = 2;
    if (request_.asks_spiral) tool[next++] = trial_.turnError(point);
    if (asks_core_) tool[next++] = 2 * trial_.coreRadius(point, 0) / *request_.core_diameter;
    if (asks_core_end_) tool[next++] = 2 * trial_.coreRadius(point, length) / *request_.core_diameter_end;
    return tool;
  }

  /// What is asked of them. @param rake that both ends shall have.
  Eigen::VectorXd asked(double rake) const {
    Eigen::VectorXd asked = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(figures_.size()));
    asked[0] = asked[1] = rake;
    if (request_.asks_spiral) asked[2] = 0;
    return asked;
  }

  std::optional<SetupPoint> solve(SetupPoint point, const Eigen::VectorXd& asked) const {
    Eigen::VectorXd errors = tool(point) - asked;
    for (int i = 0; i < kSteps && !(errors.cwiseAbs().maxCoeff() <= kTolerance); ++i) {
      const Eigen::VectorXd step = derivatives(point, errors + asked).fullPivLu().solve(-errors);
      if (!descend(point, errors, step, asked)) return std::nullopt;
    }
    const bool good = errors.cwiseAbs().maxCoeff() <= kTolerance && trial_.isSound(point);
    return good ? std::optional(point) : std::nullopt;
  }

  Eigen::MatrixXd derivatives(const SetupPoint& point, const Eigen::VectorXd& here) const {
    Eigen::MatrixXd by_figure(here.size(), here.size());
    for (std::size_t k = 0; k < figures_.size(); ++k) {
      const bool number = figures_[k] == &SetupPoint::swivel || figures_[k] == &SetupPoint::taper;
      const double step = number ? kDerivativeStep : kDerivativeStep * trial_.cutter().radius(0);
      SetupPoint moved = point;
      moved.*figures_[k] += step;
      by_figure.col(static_cast<Eigen::Index>(k)) = (tool(moved) - here) / step;
    }
    return by_figure;
  }

  /// Goes a step, or as much of it as makes the errors smaller. @return false if none does.
  bool descend(SetupPoint& point, Eigen::VectorXd& errors, Eigen::VectorXd step, const Eigen::VectorXd& asked) const {
    for (int i = 0; i < kHalvings; ++i, step /= 2) {
      SetupPoint next = point;
      for (std::size_t k = 0; k < figures_.size(); ++k) next.*figures_[k] += step[static_cast<Eigen::Index>(k)];
      const Eigen::VectorXd there = tool(next) - asked;
      if (!(there.norm() < errors.norm())) continue;
      point = next;
      errors = there;
      return true;
    }
    return false;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  bool asks_core_, asks_core_end_;
  std::vector<double SetupPoint::*> figures_;  ///< that are free
};

}  // namespace

std::optional<SetupPoint> fitSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                   bool cores) {
  const Fit fit(trial, request, cores);
  const auto exact = fit.exact(start);
  return exact && request.z_law == ZLaw::kPublished ? fit.even(*exact) : exact;
}

}  // namespace flute_grinder
