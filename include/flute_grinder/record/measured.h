#pragma once

#include "flute_grinder/record/record_file.h"
#include "flute_grinder/setup/setup_turns.h"
#include "flute_grinder/tool/tool_figure.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// @file
/// What people measure of ground tools, kept in the tools' records.
namespace grinder {

/// A figure of a tool, as it was measured.
struct MeasuredFigure {
  ToolFigure figure{};
  double x = 0;          ///< from the small end; 0 for a figure of the end [m]
  double value = 0;      ///< [m], [rad]
  std::string when, by;  ///< time in the form of utcText(), and `user@host`
};

/// Reads `FIGURE` or `FIGURE@X`, in mm; see measuredFrom().
FigureAt figureFrom(const std::string& text, const GrindJob& job);

/// Reads `FIGURE=VALUE` or `FIGURE@X=VALUE`, in mm or deg; `core` stands for `core_diameter`. Without X, the middle of
/// a flute that is the same everywhere is meant.
/// @param job operation that ground the figure. @throw std::invalid_argument for any other text, a figure that the
/// operation does not grind, and a place or a value that the tool cannot have, with what is allowed.
MeasuredFigure measuredFrom(const std::string& text, const GrindJob& job);

/// The name of a figure as measuredFrom() reads it, e.g. "core". @throw std::invalid_argument with the allowed ones.
ToolFigure measurableOf(const std::string& name, const std::vector<ToolFigure>& allowed);

/// The figures that an operation grinds and that can be measured.
std::vector<ToolFigure> measurableOf(const GrindJob& job);

/// What a job asks of a figure at a place.
struct AskedFigure {
  double value = 0, tolerance = 0;  ///< [m], [rad]
};
/// @return nothing if the job does not ask for it there.
std::optional<AskedFigure> askedAt(const ValidJob& job, ToolFigure figure, double x);

/// A figure in words, e.g. "core diameter at X = 15 mm: 6.62 mm; asked 6.8 mm within 0.02 mm".
std::string text(const MeasuredFigure& measured, const ValidJob& job);

/// A tool in a folder of records: the record of the run that ground an operation to its end.
struct ToolNumber {
  std::uint64_t number = 0;  ///< number at the beginning of the record's file name
  std::string path;
};

/// Appends a figure to a record, whose earlier ones stay.
void addMeasured(Record& record, const MeasuredFigure& measured);

/// Appends figures to the record of a tool, as measured now. @param by `user@host`. @return the record.
/// @throw FileError
Record keepMeasured(const ToolNumber& tool, std::vector<MeasuredFigure> figures, const std::string& by);

/// The figures measured of a record's tool; of those of one figure and place, the last.
/// @throw std::exception for JSON that addMeasured() does not write.
std::vector<MeasuredFigure> measuredOf(const Record& record);

/// The tools of an operation, in the order of grinding. Unreadable records are left out: `grind history` names them.
/// @param digest see jobDigest(). @throw std::filesystem::filesystem_error if the folder cannot be read.
std::vector<ToolNumber> toolsIn(const std::string& folder, const std::string& digest);

/// The tool with a number. @param tools see toolsIn(). @param number 0 for the last.
/// @throw std::invalid_argument with the numbers that are allowed.
const ToolNumber& toolOf(const std::vector<ToolNumber>& tools, std::uint64_t number);

}  // namespace grinder
