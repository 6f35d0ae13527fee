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
};

/// A figure with its name in files, which is the message constant in lower case.
struct ToolFigureRow : EnumRow<ToolFigure> {
  const char* words = "";  ///< name in texts
  Unit unit = Unit::kNone;
  ReasonKind reason = ReasonKind::kNone;  ///< reason for refusing a plan; none if another check covers it
  bool of_relief = false;                 ///< whether it is judged for reliefs, rather than for flutes
  bool of_complete = false;               ///< whether it counts only where the flute is complete
};

inline constexpr ToolFigureRow kToolFigures[]{
    {{ToolFigure::kRake, "rake"}, "rake", Unit::kRadian, ReasonKind::kRake, false, true},
    {{ToolFigure::kChordalRake, "chordal_rake"}, "chordal rake", Unit::kRadian, ReasonKind::kChordalRake, false, true},
    {{ToolFigure::kSpiral, "spiral"}, "spiral angle", Unit::kRadian, ReasonKind::kSpiral, false, true},
    {{ToolFigure::kOffHelix, "off_helix"}, "off the helix", Unit::kRadian, ReasonKind::kNone, false, true},
    {{ToolFigure::kCoreDiameter, "core_diameter"}, "core diameter", Unit::kMetre},
    {{ToolFigure::kLand, "land"}, "land", Unit::kMetre},
    {{ToolFigure::kClearance, "clearance"}, "clearance", Unit::kRadian, ReasonKind::kClearance, true},
    {{ToolFigure::kSecondClearance, "second_clearance"},
     "second clearance",
     Unit::kRadian,
     ReasonKind::kSecondClearance,
     true},
    {{ToolFigure::kPrimary, "primary"}, "primary relief", Unit::kMetre, ReasonKind::kPrimaryLand, true},
    {{ToolFigure::kEdgeDiameter, "edge_diameter"}, "edge diameter", Unit::kMetre, ReasonKind::kUndercut, true},
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

/// The measured value; nothing where there is none. An incomplete flute has no rake, since a longer stroke would form
/// another rake face.
FigureValue measured(ToolFigure figure, const FigurePlace& place);

/// The asked value; nothing if the job does not ask for it there.
FigureValue asked(ToolFigure figure, const FigurePlace& place);

/// Tolerance of the asked value, to either side.
double tolerance(ToolFigure figure, const FigurePlace& place);

/// Whether a figure is measured there, and is within its tolerance or not asked.
bool isAsAsked(ToolFigure figure, const FigurePlace& place);

/// A figure over all teeth and all measured sections.
struct GroundFigure {
  struct At {
    double value = 0;
    double x = 0;   ///< along the cutter's axis [m]
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

/// The figure in a list; null if it is not there.
const GroundFigure* find(const CutterFigures& figures, ToolFigure figure);

/// The ground values, in mm or deg: "7.980 to 8.030 deg".
std::string groundText(const GroundFigure& figure);
/// The asked values, in mm or deg without a unit: "6.8 to 12.05"; empty if nothing is asked.
std::string askedText(const GroundFigure& figure);
/// Ground and asked values: "7.980 to 8.030 deg; asked 8 deg within 0.5 deg".
std::string text(const GroundFigure& figure);

}  // namespace grinder
