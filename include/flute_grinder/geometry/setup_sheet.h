#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The height of a face of the wheel above the cutter's axis at Z = 0, where it is deepest in the cutter [m].
double upperFaceHeight(const GrindJob& job);
double lowerFaceHeight(const GrindJob& job);

/// What a tool gets beside what its job asks for, in mm and deg.
struct AskedAndGround {
  const char* name = "";
  std::string text;
};

/// Rake, spiral angle, edge and core of a tool. @param ground figures that are NaN are left out.
std::vector<AskedAndGround> askedAndGround(const GrindJob& job, const CutterFigures& ground);

/// The set-up sheet for the operator, in mm and deg: what to set, what to touch and what the axes then read, what comes
/// out, and what limits it.
/// @param swivel that the machine allows [rad].
/// @param above_swivel as of wheelAboveSwivel() [m]; if it is not known, the sheet says what it changes.
std::string setupSheet(const JobSetup& setup, const Range& swivel, const std::optional<double>& above_swivel);

/// Why a plan would refuse the tool, a line for each reason; empty if it would not. A set-up with one is not to be
/// written.
std::string planRefusal(const JobSetup& setup);

}  // namespace grinder
