#pragma once

#include "flute_grinder/record/measured.h"
#include "flute_grinder/setup/setup_turns.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// @file
/// A job's tools over time: what was measured of each, and with which zero points it was ground.
namespace grinder {

/// An axis whose zero point is corrected, with its turn.
struct CorrectedAxis {
  int axis;
  SetupTurn turn;
};
inline constexpr std::array<CorrectedAxis, 2> kCorrectedAxes{{{kY, SetupTurn::kY}, {kZ, SetupTurn::kZ}}};

/// A tool as its record has it.
struct MeasuredTool {
  std::uint64_t number = 0;
  std::string ended;                 ///< text of utcText()
  Turns offset = Turns::Zero();      ///< work offsets of Y and Z [m]
  std::array<double, 2> found_at{};  ///< WorkOffset::found_at of each of kCorrectedAxes
  std::vector<MeasuredFigure> figures;

  /// What was measured of a figure; null if it was not.
  const MeasuredFigure* find(const FigureAt& at) const noexcept;
};

/// Whether two times are the same as far as records keep them.
bool isSameTime(double a, double b) noexcept;

/// Whether two tools were ground with the same zero points, corrected or not.
bool haveSameZeros(const MeasuredTool& a, const MeasuredTool& b) noexcept;

/// Reads the last hundred of some tools: older ones say nothing of today's wheel.
/// @param tools see toolsIn(). @throw FileError for a record that cannot be read.
std::vector<MeasuredTool> measuredTools(const std::vector<ToolNumber>& tools);

/// A figure over the tools of a job, with its asked value and tolerance and the changes of the zero points, as
/// docs/command-line.md has it.
Json figureHistory(const ValidJob& job, const std::vector<MeasuredTool>& tools, const FigureAt& at);

}  // namespace grinder
