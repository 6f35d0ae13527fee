#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// @file
/// The figures of a tool: each with its meaning, its asked value and tolerance, and its measurement on the ground
/// cutter. Checks and outputs use this table. A new figure is a row here and its measurement in the source.
namespace grinder {

enum class ToolFigure : std::uint8_t {
  kRake,
  kChordalRake,
  kSpiral,
  kOffHelix,
  kCoreDiameter,
  kLand,
  kClearance,
  kSecondClearance,
  kPrimary,
  kEdgeDiameter,
  kEndClearance,
  kEndDish,
  kEndSecondClearance,
  kEndLand,
  kEndRake,
  kUncutDiameter,
  kPeripheryTaken,
  kChamferWidth,
  kChamferAngle,
  kChamferClearance,
  kHeelDrag,
  kShortFrom,
  kGashInCore,
};

/// A figure with its name in files, which is the message constant in lower case.
struct ToolFigureRow : EnumRow<ToolFigure> {
  const char* words = "";  ///< name in texts
  Unit unit = Unit::kNone;
  ReasonKind reason = ReasonKind::kNone;  ///< reason for refusing a plan; none if another check covers it, or none asks
  StrokeForm of = StrokeForm::kFlute;     ///< the operations for which it is judged
  bool of_complete = false;               ///< whether it counts only where the flute is complete
};

constexpr ToolFigureRow figureOfEnd(ToolFigure figure, const char* name, const char* words, Unit unit) {
  return {{figure, name}, words, unit, ReasonKind::kEnd, StrokeForm::kStraight};
}

inline constexpr ToolFigureRow kToolFigures[]{
    {{ToolFigure::kRake, "rake"}, "rake", Unit::kRadian, ReasonKind::kRake, StrokeForm::kFlute, true},
    {{ToolFigure::kChordalRake, "chordal_rake"},
     "chordal rake",
     Unit::kRadian,
     ReasonKind::kChordalRake,
     StrokeForm::kFlute,
     true},
    {{ToolFigure::kSpiral, "spiral"}, "spiral angle", Unit::kRadian, ReasonKind::kSpiral, StrokeForm::kFlute, true},
    {{ToolFigure::kOffHelix, "off_helix"}, "off the helix", Unit::kRadian, ReasonKind::kNone, StrokeForm::kFlute, true},
    {{ToolFigure::kCoreDiameter, "core_diameter"}, "core diameter", Unit::kMetre},
    {{ToolFigure::kLand, "land"}, "land", Unit::kMetre},
    {{ToolFigure::kClearance, "clearance"}, "clearance", Unit::kRadian, ReasonKind::kClearance, StrokeForm::kRelief},
    {{ToolFigure::kSecondClearance, "second_clearance"},
     "second clearance",
     Unit::kRadian,
     ReasonKind::kSecondClearance,
     StrokeForm::kRelief},
    {{ToolFigure::kPrimary, "primary"}, "primary relief", Unit::kMetre, ReasonKind::kPrimaryLand, StrokeForm::kRelief},
    {{ToolFigure::kEdgeDiameter, "edge_diameter"},
     "edge diameter",
     Unit::kMetre,
     ReasonKind::kUndercut,
     StrokeForm::kRelief},
    figureOfEnd(ToolFigure::kEndClearance, "end_clearance", "end clearance", Unit::kRadian),
    figureOfEnd(ToolFigure::kEndDish, "end_dish", "end dish", Unit::kRadian),
    figureOfEnd(ToolFigure::kEndSecondClearance, "end_second_clearance", "second end clearance", Unit::kRadian),
    figureOfEnd(ToolFigure::kEndLand, "end_land", "end land", Unit::kMetre),
    figureOfEnd(ToolFigure::kEndRake, "end_rake", "gash rake", Unit::kRadian),
    figureOfEnd(ToolFigure::kUncutDiameter, "uncut_diameter", "uncut diameter", Unit::kMetre),
    figureOfEnd(ToolFigure::kPeripheryTaken, "periphery_taken", "periphery taken", Unit::kMetre),
    figureOfEnd(ToolFigure::kChamferWidth, "chamfer_width", "chamfer width", Unit::kMetre),
    figureOfEnd(ToolFigure::kChamferAngle, "chamfer_angle", "chamfer angle", Unit::kRadian),
    figureOfEnd(ToolFigure::kChamferClearance, "chamfer_clearance", "chamfer clearance", Unit::kRadian),
    figureOfEnd(ToolFigure::kHeelDrag, "heel_drag", "heel drag", Unit::kMetre),
    figureOfEnd(ToolFigure::kShortFrom, "short_from", "beginning of the short edge", Unit::kMetre),
    {{ToolFigure::kGashInCore, "gash_in_core"},
     "gash in the core",
     Unit::kMetre,
     ReasonKind::kNone,
     StrokeForm::kStraight},
};
constexpr auto& rowsOf(ToolFigure) noexcept { return kToolFigures; }

/// A tooth in a section of a job's ground cutter.
struct FigurePlace {
  const ValidJob& job;
  const GroundSection& section;
  std::size_t number;  ///< number of the tooth, from 0
  /// All measured sections, for a figure that depends on them; null if only this one is known.
  const std::vector<GroundSection>* tool = nullptr;

  const ToothSection& tooth() const { return section.teeth[number]; }
};

using FigureValue = std::optional<double>;

/// The measured value; nothing where there is none, as of a figure of the end, see askedOfEnd(). An incomplete flute
/// has no rake, since a longer stroke would form another rake face.
FigureValue measured(ToolFigure figure, const FigurePlace& place);

/// The asked value; nothing if the job does not ask for it there.
FigureValue asked(ToolFigure figure, const FigurePlace& place);

/// Tolerance of the asked value, to either side.
double tolerance(ToolFigure figure, const FigurePlace& place);

/// Tolerance of a land's or a chamfer's width [m].
double widthTolerance(double width) noexcept;

/// Whether a figure is measured there, and is within its tolerance or not asked.
bool isAsAsked(ToolFigure figure, const FigurePlace& place);

/// A figure over all teeth and all measured sections.
struct GroundFigure {
  struct At {
    double value = 0;
    double x = 0;   ///< along the cutter's axis; of a figure of the end, the distance from it [m]
    int tooth = 0;  ///< from 0
  };

  ToolFigure figure{};
  At least, largest;
  std::optional<Range> asked;  ///< extremes of the asked values there; nothing if the job does not ask for it
  double tolerance = 0;        ///< minimum tolerance at these places
};

/// The figures of a tool that have values, in the order of the table.
using CutterFigures = std::vector<GroundFigure>;
CutterFigures figuresOf(const ValidJob& job, const std::vector<GroundSection>& sections);

/// The figures that a job of an operation on the end asks for, without values.
/// @param job from withLaws().
CutterFigures askedOfEnd(const ValidJob& job);

/// Whether all values are within the tolerance of what is asked, or nothing is.
bool isAsAsked(const GroundFigure& figure);

/// The figure in a list; null if it is not there.
const GroundFigure* find(const CutterFigures& figures, ToolFigure figure);

/// The ground values, in mm or deg: "7.980 to 8.030 deg".
std::string groundText(const GroundFigure& figure);
/// The asked values, in mm or deg without a unit: "6.8 to 12.05"; empty if nothing is asked.
std::string askedText(const GroundFigure& figure);
/// Ground and asked values: "7.980 to 8.030 deg; asked 8 deg within 0.5 deg".
std::string text(const GroundFigure& figure);

}  // namespace grinder
