#pragma once

#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/record/measured_tools.h"
#include "flute_grinder/setup/setup_estimate.h"

#include <cstdint>
#include <string>
#include <vector>

/// @file
/// What the records of measured tools say of a job's set-up.
namespace grinder {

/// The largest corrections: of Y and Z by the machine's limits; of the swivel by 1 deg, since more is another set-up.
/// @param offset_change_limit see OffsetLimits [m], A [rad].
Turns mostTurns(const Axes& offset_change_limit);

/// What the tools of a job say together.
struct SetupFindings {
  FigureModel model;
  SetupEstimate estimate{usualSpread()};
  std::uint64_t since = 0;            ///< the first tool that counts
  int tools = 0;                      ///< tools that count
  int measured = 0;                   ///< measured tools among them that were not left out
  MeasuredTool last;                  ///< the last tool
  std::vector<std::string> left_out;  ///< tools that are not believed, in words
  bool alarm = false;                 ///< whether the last measured tool is one of them

  /// Whether anything is known that a correction can follow from.
  bool isKnown() const noexcept { return measured > 0 && !alarm; }

  /// What to turn for the next tool. @param most see correctionOf().
  Correction correction(const Turns& most) const { return correctionOf(model, estimate.expected(), most); }
};

/// Goes through the tools of a job in the order of grinding: of the last hundred, those since the zero points of the
/// last one were found, see WorkOffset::found_at.
/// @param job with its laws. @param tools see toolsIn(). @param since number of the first tool that counts; 0 for all.
/// @throw FileError for a record that cannot be read. @throw std::invalid_argument if there is no tool, for another
/// operation, and for a measured figure that the planned tool does not have.
SetupFindings findingsOf(const ValidJob& job, std::vector<ToolNumber> tools, std::uint64_t since = 0);

/// What a person has to turn besides, e.g. "turn the swivel by +0.312 deg"; empty if nothing.
std::string byHandText(const Correction& correction);

/// What to set, as lines of text; why nothing is to be set, if so.
std::string settingsText(const SetupFindings& found, const Correction& correction);

/// Work offsets as a request sets them. @param offset of each of kCorrectedAxes.
OffsetValues offsetsOf(const Turns& offset);

/// Why the present zero points cannot be corrected by what is known: they are not those of the last tool, corrected or
/// not, or do not fit the job any longer; empty if they can.
std::string notCorrectable(const MeasuredTool& last, const WorkOffsets& offsets, const OffsetBasis& job);

}  // namespace grinder
