#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/job/valid_job.h"

#include <cstdint>
#include <optional>

/// @file
/// The figures of a tool that a job asks for within a tolerance: what each is, asked, and measured of the ground
/// cutter. Checks and outputs go through this table.
namespace grinder {

/// A tooth in a section of the cutter that a job grinds.
struct FigurePlace {
  const ValidJob& job;
  const GroundSection& section;
  std::size_t number;  ///< of the tooth, from 0

  const ToothSection& tooth() const { return section.teeth[number]; }
};

using FigureValue = std::optional<double>;

enum class ToolFigure : std::uint8_t {
  kRake,
  kChordalRake,
  kSpiral,
  kCore,
  kClearance,
  kSecondClearance,
  kPrimaryRelief,
};

/// With the figure's words in texts.
struct ToolFigureRow : EnumRow<ToolFigure> {
  Unit unit = Unit::kNone;
  ReasonKind reason = ReasonKind::kOther;  ///< why a plan is refused for it
  /// Nothing where there is none. The rake face of a flute that is not complete is not the one that a longer stroke
  /// would leave: it has no rake.
  FigureValue (*measured)(const FigurePlace&) = nullptr;
  FigureValue (*asked)(const FigurePlace&) = nullptr;  ///< nothing if the job does not ask for it
  double (*tolerance)(const FigurePlace&) = nullptr;   ///< either way
};

/// The functions of the table.
namespace tool_figures {
FigureValue rake(const FigurePlace& p);
FigureValue askedRake(const FigurePlace& p);
double rakeTolerance(const FigurePlace& p);
FigureValue chordalRake(const FigurePlace& p);
double chordalRakeTolerance(const FigurePlace& p);
FigureValue spiral(const FigurePlace& p);
FigureValue askedSpiral(const FigurePlace& p);
double spiralTolerance(const FigurePlace& p);
FigureValue core(const FigurePlace& p);
FigureValue askedCore(const FigurePlace& p);
double coreTolerance(const FigurePlace& p);
FigureValue clearance(const FigurePlace& p);
FigureValue askedClearance(const FigurePlace& p);
double clearanceTolerance(const FigurePlace& p);
FigureValue secondClearance(const FigurePlace& p);
FigureValue askedSecondClearance(const FigurePlace& p);
FigureValue primaryRelief(const FigurePlace& p);
FigureValue askedLand(const FigurePlace& p);
double landTolerance(const FigurePlace& p);
}  // namespace tool_figures

inline constexpr ToolFigureRow kToolFigures[]{
    {{ToolFigure::kRake, "rake"},
     Unit::kRadian,
     ReasonKind::kRake,
     tool_figures::rake,
     tool_figures::askedRake,
     tool_figures::rakeTolerance},
    {{ToolFigure::kChordalRake, "chordal rake"},
     Unit::kRadian,
     ReasonKind::kChordalRake,
     tool_figures::chordalRake,
     tool_figures::askedRake,
     tool_figures::chordalRakeTolerance},
    {{ToolFigure::kSpiral, "spiral angle"},
     Unit::kRadian,
     ReasonKind::kSpiral,
     tool_figures::spiral,
     tool_figures::askedSpiral,
     tool_figures::spiralTolerance},
    {{ToolFigure::kCore, "core"},
     Unit::kMetre,
     ReasonKind::kCoreSize,
     tool_figures::core,
     tool_figures::askedCore,
     tool_figures::coreTolerance},
    {{ToolFigure::kClearance, "clearance"},
     Unit::kRadian,
     ReasonKind::kClearance,
     tool_figures::clearance,
     tool_figures::askedClearance,
     tool_figures::clearanceTolerance},
    {{ToolFigure::kSecondClearance, "second clearance"},
     Unit::kRadian,
     ReasonKind::kSecondClearance,
     tool_figures::secondClearance,
     tool_figures::askedSecondClearance,
     tool_figures::clearanceTolerance},
    {{ToolFigure::kPrimaryRelief, "primary relief"},
     Unit::kMetre,
     ReasonKind::kPrimaryLand,
     tool_figures::primaryRelief,
     tool_figures::askedLand,
     tool_figures::landTolerance},
};
constexpr auto& rowsOf(ToolFigure) noexcept { return kToolFigures; }

/// Whether a figure is measured there, and is as asked within its tolerance, or is not asked.
bool isAsAsked(ToolFigure figure, const FigurePlace& place);

}  // namespace grinder
