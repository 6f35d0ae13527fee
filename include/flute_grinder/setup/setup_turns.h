#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/tool_figure.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

/// @file
/// The figures of a planned flute or relief over small changes of its set-up.
namespace grinder {

/// A number of a set-up that an operator or a job can change.
enum class SetupTurn : std::uint8_t { kY, kZ, kSwivel, kEndDepth, kShift };
struct SetupTurnRow : EnumRow<SetupTurn> {
  Unit unit = Unit::kMetre;
  double step = 0;  ///< for differences: small beside a tolerance, large beside what a section is measured to
};
inline constexpr SetupTurnRow kSetupTurns[] = {
    {{SetupTurn::kY, "y"}, Unit::kMetre, 5e-6},                 ///< wheel away from the cutter's axis
    {{SetupTurn::kZ, "z"}, Unit::kMetre, 5e-6},                 ///< wheel up
    {{SetupTurn::kSwivel, "swivel"}, Unit::kRadian, 2e-4},      ///< swivel of the wheel's plane
    {{SetupTurn::kEndDepth, "end_depth"}, Unit::kMetre, 5e-6},  ///< deeper at the flute's end, X = 0 as it is
    {{SetupTurn::kShift, "x_shift"}, Unit::kMetre, 5e-6},       ///< shift of A's curve along X, see LogCurve
};
constexpr const auto& rowsOf(SetupTurn) noexcept { return kSetupTurns; }
constexpr int kSetupTurnCount = countOf<SetupTurn>();

/// A value for each SetupTurn, in the order of the table [m], of the swivel [rad].
using Turns = Eigen::Matrix<double, kSetupTurnCount, 1>;

constexpr Eigen::Index indexOf(SetupTurn turn) noexcept { return static_cast<Eigen::Index>(turn); }

/// A figure in a section.
struct FigureAt {
  ToolFigure figure{};
  double x = 0;  ///< from the small end [m]
};
/// E.g. "core_diameter@15", with X in mm.
std::string text(const FigureAt& at);

/// The figures of a job's first tooth, near its planned set-up: planned + slope * turns. A relief that is too high
/// leaves an edge as it is, so its diameter has a slope to one side alone. Of its figures the steeper side counts.
struct FigureModel {
  std::vector<FigureAt> figures;
  Eigen::VectorXd planned;    ///< with the planned set-up [m], [rad]
  Eigen::VectorXd asked;      ///< [m], [rad]
  Eigen::VectorXd tolerance;  ///< [m], [rad]
  Eigen::Matrix<double, Eigen::Dynamic, kSetupTurnCount> slope;
};

/// Whether an operation's set-up can be corrected by what was measured of its tools: of flutes and reliefs.
bool isCorrectable(OperationKind kind) noexcept;

/// The figures in which an operation is judged when its set-up is corrected, near both ends of the flute and in the
/// middle: rake and core; of a primary relief clearance and edge diameter; of a secondary one its clearance, and the
/// width that it leaves of the primary. @param job an operation that isCorrectable().
std::vector<FigureAt> judgedFigures(const GrindJob& job);

/// The figures of the first tooth that a job's strokes grind on a machine whose set-up is off, after earlier
/// operations as planned.
/// @param job an operation that isCorrectable(), with its laws.
/// @param off how far the set-up is off.
/// @return NaN where there is no figure [m], [rad].
Eigen::VectorXd figuresOffBy(const ValidJob& job, const std::vector<FigureAt>& figures, const Turns& off);

/// Measures the planned tooth with each turn a little to either side; takes some ten milliseconds.
/// @param job see figuresOffBy().
/// @throw std::invalid_argument naming a figure that is not asked, or that the planned tooth does not have.
FigureModel figureModel(const ValidJob& job, const std::vector<FigureAt>& figures);

}  // namespace grinder
