#pragma once

#include "flute_grinder/setup/setup_turns.h"

#include <optional>

/// @file
/// What measured tools say of a machine's set-up, and what to turn about it.
namespace grinder {

/// Standard deviations of what is not known of a set-up before a tool is measured.
struct SetupSpread {
  Turns setup = Turns::Zero();  ///< of touching off and of the swivel's scale [m], [rad]
  Turns noise = Turns::Zero();  ///< from a tool to the next [m], [rad]
  double wear = 0;              ///< of the wheel's radius by a tool, beyond what the job compensates [m]
};

/// A careful touch-off, with a wheel that wears by up to some micrometres a tool.
SetupSpread usualSpread();

/// The standard deviation of a gauge: 2 um, or 0.08 deg.
double gaugeSpread(ToolFigure figure) noexcept;

/// Whether a gauge can see a figure: its standard deviation is no more than a fifth of the tolerance.
bool isSeen(ToolFigure figure, double tolerance) noexcept;

/// A measured figure that the machine cannot have ground by what is known of it.
struct Surprise {
  Eigen::Index figure = 0;  ///< index in the model
  Range allowed;            ///< [m], [rad]
};

/// How far a machine's set-up is off from the planned one, by a Kalman filter over the tools that were measured. Its
/// state is the error of each turn, and its drift from a tool to the next, which acts like Y.
class SetupEstimate {
 public:
  explicit SetupEstimate(const SetupSpread& spread);

  /// The set-up was turned on purpose.
  void turn(const Turns& by) { error_ += by; }

  /// A tool was ground: the wheel wore.
  void nextTool();

  /// What was measured of the last tool. A surprise leaves the estimate as it was.
  /// @param measured NaN for a figure that was not measured [m], [rad].
  /// @param spread standard deviation of each figure's gauge [m], [rad].
  /// @return the first figure more than four standard deviations from what was expected, if any.
  std::optional<Surprise> take(const FigureModel& model, const Eigen::VectorXd& measured,
                               const Eigen::VectorXd& spread);

  /// How far the set-up is off [m], [rad].
  const Turns& error() const noexcept { return error_; }
  /// How far it will be off for the next tool [m], [rad].
  Turns expected() const;
  /// Wear of the wheel's radius by a tool [m].
  double wear() const noexcept { return wear_; }

 private:
  static constexpr int kStates = kSetupTurnCount + 1;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  Turns error_ = Turns::Zero();
  double wear_ = 0;
  Covariance covariance_;
  Covariance noise_;
};

/// What to turn so that the next tool is as planned.
struct Correction {
  Turns turn = Turns::Zero();
  Eigen::VectorXd now, after;  ///< expected differences from the plan, per tolerance
  bool by_swivel = false;      ///< whether Y and Z alone would leave more than half a tolerance
  bool in_dead_band = false;   ///< whether no figure would change by 0.15 of its tolerance; nothing is turned then
};

/// The turns that bring the figures nearest to the plan: of Y and Z, and of the swivel, which a person sets, only if
/// these leave more than half a tolerance.
/// @param error how far the set-up is off for the next tool.
/// @param most largest turn of each to either side, 0 for what is not to be turned.
Correction correctionOf(const FigureModel& model, const Turns& error, const Turns& most);

/// A figure of the next tool, as the set-up is and as it would be after a correction [m], [rad].
struct CorrectedFigure {
  FigureAt at;
  double asked = 0, tolerance = 0, planned = 0, now = 0, after = 0;
  bool seen = false;  ///< see isSeen()
};
std::vector<CorrectedFigure> correctedFigures(const FigureModel& model, const Correction& correction);

}  // namespace grinder
