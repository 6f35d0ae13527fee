#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/job/valid_job.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// @file
/// The figures of a tool: what each is, what a job asks for within which tolerance, and what is measured of the ground
/// cutter. Checks and outputs go through this table. A new figure is a row here and its measurement in the source.
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

/// The name is that in files and, in capitals, that of the message's constant.
struct ToolFigureRow : EnumRow<ToolFigure> {
  const char* words = "";  ///< in texts
  Unit unit = Unit::kNone;
  ReasonKind reason = ReasonKind::kNone;  ///< why a plan is refused for it; none if its check is another one
  bool of_relief = false;                 ///< judged of a relief, else of flutes
  bool of_complete = false;               ///< counts where the flute is complete, and nowhere else
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

/// A tooth in a section of the cutter that a job grinds.
struct FigurePlace {
  const ValidJob& job;
  const GroundSection& section;
  std::size_t number;  ///< of the tooth, from 0
  /// All sections that are measured, for a figure that hangs on them; null if only this one is known.
  const std::vector<GroundSection>* tool = nullptr;

  const ToothSection& tooth() const { return section.teeth[number]; }
};

using FigureValue = std::optional<double>;

/// Nothing where there is none. The rake face of a flute that is not complete is not the one that a longer stroke would
/// leave: it has no rake.
FigureValue measured(ToolFigure figure, const FigurePlace& place);

/// Nothing if the job does not ask for it there.
FigureValue asked(ToolFigure figure, const FigurePlace& place);

/// Of what is asked, either way.
double tolerance(ToolFigure figure, const FigurePlace& place);

/// Whether a figure is measured there, and is as asked within its tolerance, or is not asked.
bool isAsAsked(ToolFigure figure, const FigurePlace& place);

/// A figure over all teeth and the sections that were measured.
struct GroundFigure {
  struct At {
    double value = 0;
    double x = 0;   ///< along the cutter's axis [m]
    int tooth = 0;  ///< from 0
  };

  ToolFigure figure{};
  At least, largest;
  std::optional<Range> asked;  ///< least and largest at these places; nothing if the job does not ask for it
  double tolerance = 0;        ///< the least at these places
};

/// The figures of a tool, in the order of the table; those that there are none of are left out.
using CutterFigures = std::vector<GroundFigure>;
CutterFigures figuresOf(const ValidJob& job, const std::vector<GroundSection>& sections);

/// Null if there is none.
const GroundFigure* find(const CutterFigures& figures, ToolFigure figure);

/// What is ground, in mm or deg: "7.980 to 8.030 deg".
std::string groundText(const GroundFigure& figure);
/// What is asked, in mm or deg without a unit: "6.8 to 12.05"; empty if nothing is.
std::string askedText(const GroundFigure& figure);
/// Both: "7.980 to 8.030 deg; asked 8 deg within 0.5 deg".
std::string text(const GroundFigure& figure);

}  // namespace grinder
