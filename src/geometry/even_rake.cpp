#include "geometry/even_rake.h"

#include "flute_grinder/curve/units.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace flute_grinder {

namespace {

class EvenRake {
 public:
  EvenRake(const SetupTrial& trial, const SetupRequest& request) : trial_(trial), request_(request) {
    const bool finds_depth = request.core_diameter || isKept(SetupFigure::kSwivel) || isKept(SetupFigure::kHeight);
    if (!isKept(SetupFigure::kSwivel)) figures_.push_back(&SetupPoint::swivel);
    if (!isKept(SetupFigure::kHeight)) figures_.push_back(&SetupPoint::height);
    if (finds_depth) figures_.push_back(&SetupPoint::depth);
  }

  SetupPoint from(SetupPoint point) const {
    double rake = request_.rake;
    std::optional<Errors> here = errorsOverFlute(point);
    for (int i = 0; i < kShifts && here && std::abs(here->middle()) > kEven; ++i) {
      rake -= here->middle();
      const auto next = solve(point, rake);
      const auto there = next ? errorsOverFlute(*next) : std::nullopt;
      if (!there || !(there->largest() < here->largest())) break;
      point = *next;
      here = there;
    }
    return point;
  }

 private:
  static constexpr double kTolerance = 1e-6;  ///< of the rake [rad], and of the core by its radius
  static constexpr double kEven = 0.001 * units::kDegree;
  static constexpr int kShifts = 4;    ///< of the rake at the ends
  static constexpr int kSteps = 12;    ///< of Newton's method
  static constexpr int kHalvings = 6;  ///< of a step, where another part of the wheel begins to form the rake face
  static constexpr double kDerivativeStep = 1e-6;  ///< [rad], and of the small end's radius

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

  /// As many as there are figures. @param rake that both ends shall have.
  Eigen::VectorXd errors(const SetupPoint& point, double rake) const {
    Eigen::VectorXd errors(static_cast<Eigen::Index>(figures_.size()));
    errors[0] = trial_.rake(point, 0) - rake;
    errors[1] = trial_.rake(point, request_.cutter.flute_length) - rake;
    if (request_.core_diameter) errors[2] = 2 * trial_.coreRadius(point) / *request_.core_diameter - 1;
    return errors;
  }

  std::optional<SetupPoint> solve(SetupPoint point, double rake) const {
    Eigen::VectorXd errors = this->errors(point, rake);
    for (int i = 0; i < kSteps && !(errors.cwiseAbs().maxCoeff() <= kTolerance); ++i) {
      const Eigen::VectorXd step = derivatives(point, rake, errors).fullPivLu().solve(-errors);
      if (!descend(point, errors, step, rake)) return std::nullopt;
    }
    const bool good = errors.cwiseAbs().maxCoeff() <= kTolerance && trial_.isSound(point.depth) &&
                      point.swivel >= request_.least_swivel && point.swivel <= request_.largest_swivel;
    return good ? std::optional(point) : std::nullopt;
  }

  Eigen::MatrixXd derivatives(const SetupPoint& point, double rake, const Eigen::VectorXd& errors) const {
    Eigen::MatrixXd by_figure(errors.size(), errors.size());
    for (std::size_t k = 0; k < figures_.size(); ++k) {
      const bool angle = figures_[k] == &SetupPoint::swivel;
      const double step = angle ? kDerivativeStep : kDerivativeStep * trial_.cutter().radius(0);
      SetupPoint moved = point;
      moved.*figures_[k] += step;
      by_figure.col(static_cast<Eigen::Index>(k)) = (this->errors(moved, rake) - errors) / step;
    }
    return by_figure;
  }

  /// Goes a step, or as much of it as makes the errors smaller. @return false if none does.
  bool descend(SetupPoint& point, Eigen::VectorXd& errors, Eigen::VectorXd step, double rake) const {
    for (int i = 0; i < kHalvings; ++i, step /= 2) {
      SetupPoint next = point;
      for (std::size_t k = 0; k < figures_.size(); ++k) next.*figures_[k] += step[static_cast<Eigen::Index>(k)];
      const Eigen::VectorXd there = this->errors(next, rake);
      if (!(there.norm() < errors.norm())) continue;
      point = next;
      errors = there;
      return true;
    }
    return false;
  }

  const SetupTrial& trial_;
  const SetupRequest& request_;
  std::vector<double SetupPoint::*> figures_;  ///< that are free
};

}  // namespace

SetupPoint evenRake(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& exact) {
  return EvenRake(trial, request).from(exact);
}

}  // namespace flute_grinder
