#include "flute_grinder/setup/setup_estimate.h"

#include "flute_grinder/base/units.h"

#include <Eigen/Dense>

#include <cmath>
#include <vector>

namespace grinder {

namespace {

using units::kDegree;
using units::kMicrometre;

constexpr double kSurprise = 4;        ///< standard deviations
constexpr double kDeadBand = 0.15;     ///< tolerances
constexpr double kLeftToSwivel = 0.5;  ///< tolerances
constexpr double kSeen = 0.2;          ///< tolerances
constexpr double kReluctance = 0.001;  ///< squared tolerances for a turn of the usual spread

Turns turns(double y, double z, double swivel) {
  Turns turns = Turns::Zero();
  turns[indexOf(SetupTurn::kY)] = y;
  turns[indexOf(SetupTurn::kZ)] = z;
  turns[indexOf(SetupTurn::kSwivel)] = swivel;
  return turns;
}

/// Minimizes |off + slope * turn|^2 + kReluctance |turn / scale|^2 over some turns, each within its limits: one that
/// would go beyond stays at the limit, and the others are sought again.
Turns leastSquares(const Eigen::MatrixXd& slope, const Eigen::VectorXd& off, std::vector<Eigen::Index> free,
                   const Turns& scale, const Turns& most) {
  Turns turn = Turns::Zero();
  while (!free.empty()) {
    const auto count = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd columns(slope.rows() + count, count);
    columns.bottomRows(count).setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index at = free[static_cast<std::size_t>(i)];
      columns.col(i).head(slope.rows()) = slope.col(at) * scale[at];
      columns(slope.rows() + i, i) = std::sqrt(kReluctance);
      turn[at] = 0;
    }
    Eigen::VectorXd target = Eigen::VectorXd::Zero(columns.rows());
    target.head(slope.rows()) = -off - slope * turn;
    const Eigen::VectorXd found = columns.colPivHouseholderQr().solve(target);
    Eigen::Index farthest = -1;
    double beyond = 1;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index at = free[static_cast<std::size_t>(i)];
      turn[at] = found[i] * scale[at];
      if (std::abs(turn[at]) > beyond * most[at]) beyond = std::abs(turn[at]) / most[at], farthest = i;
    }
    if (farthest < 0) break;
    const Eigen::Index at = free[static_cast<std::size_t>(farthest)];
    turn[at] = std::copysign(most[at], turn[at]);
    free.erase(free.begin() + farthest);
  }
  return turn;
}

}  // namespace

SetupSpread usualSpread() {
  return {turns(10 * kMicrometre, 12 * kMicrometre, 0.08 * kDegree),
          turns(0.3 * kMicrometre, 0.3 * kMicrometre, 0.002 * kDegree), 2 * kMicrometre};
}

double gaugeSpread(ToolFigure figure) noexcept {
  return rowOf(figure).unit == Unit::kRadian ? 0.08 * kDegree : 2 * kMicrometre;
}

bool isSeen(ToolFigure figure, double tolerance) noexcept { return gaugeSpread(figure) <= kSeen * tolerance; }

SetupEstimate::SetupEstimate(const SetupSpread& spread) {
  State sigma, noise;
  sigma << spread.setup, spread.wear;
  noise << spread.noise, 0;
  covariance_ = sigma.cwiseAbs2().asDiagonal();
  noise_ = noise.cwiseAbs2().asDiagonal();
}

void SetupEstimate::nextTool() {
  Covariance step = Covariance::Identity();
  step(indexOf(SetupTurn::kY), kSetupTurnCount) = 1;
  error_ = expected();
  covariance_ = step * covariance_ * step.transpose() + noise_;
}

Turns SetupEstimate::expected() const { return error_ + wear_ * Turns::Unit(indexOf(SetupTurn::kY)); }

std::optional<Surprise> SetupEstimate::take(const FigureModel& model, const Eigen::VectorXd& measured,
                                            const Eigen::VectorXd& spread) {
  State state;
  state << error_, wear_;
  Covariance covariance = covariance_;
  for (Eigen::Index i = 0; i < measured.size(); ++i) {
    if (std::isnan(measured[i])) continue;
    State slope;
    slope << model.slope.row(i).transpose(), 0;
    const double expected = model.planned[i] + slope.dot(state), off = measured[i] - expected;
    const double variance = slope.dot(covariance * slope) + spread[i] * spread[i];
    const double most = kSurprise * std::sqrt(variance);
    if (!(std::abs(off) <= most)) return Surprise{i, {expected - most, expected + most}};
    const State gain = covariance * slope / variance;
    state += gain * off;
    // Joseph's form stays symmetric and positive.
    const Covariance rest = Covariance::Identity() - gain * slope.transpose();
    covariance = rest * covariance * rest.transpose() + gain * gain.transpose() * spread[i] * spread[i];
  }
  error_ = state.head<kSetupTurnCount>();
  wear_ = state[kSetupTurnCount];
  covariance_ = covariance;
  return std::nullopt;
}

Correction correctionOf(const FigureModel& model, const Turns& error, const Turns& most) {
  const Eigen::MatrixXd slope = model.tolerance.cwiseInverse().asDiagonal() * model.slope;
  const Turns scale = usualSpread().setup;
  Correction correction;
  correction.now = slope * error;
  std::vector<Eigen::Index> free;
  const auto add = [&](SetupTurn turn) {
    if (most[indexOf(turn)] > 0) free.push_back(indexOf(turn));
  };
  const auto left = [&] { return Eigen::VectorXd(correction.now + slope * correction.turn); };
  add(SetupTurn::kY);
  add(SetupTurn::kZ);
  correction.turn = leastSquares(slope, correction.now, free, scale, most);
  if (left().cwiseAbs().maxCoeff() > kLeftToSwivel && most[indexOf(SetupTurn::kSwivel)] > 0) {
    correction.by_swivel = true;
    add(SetupTurn::kSwivel);
    correction.turn = leastSquares(slope, correction.now, free, scale, most);
  }
  correction.in_dead_band = !((slope * correction.turn).cwiseAbs().maxCoeff() >= kDeadBand);
  if (correction.in_dead_band) correction.turn.setZero(), correction.by_swivel = false;
  correction.after = left();
  return correction;
}

std::vector<CorrectedFigure> correctedFigures(const FigureModel& model, const Correction& correction) {
  std::vector<CorrectedFigure> figures;
  for (std::size_t i = 0; i < model.figures.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double planned = model.planned[row], tolerance = model.tolerance[row];
    figures.push_back({model.figures[i], model.asked[row], tolerance, planned,
                       planned + correction.now[row] * tolerance, planned + correction.after[row] * tolerance,
                       isSeen(model.figures[i].figure, tolerance)});
  }
  return figures;
}

}  // namespace grinder
