#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_fields.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// A set-up file: the figures that the solver has found for the operations of one job, and what they were solved for. A
/// job file names it, and only programs write it.
namespace grinder {

/// The figures of a set-up that a job file may ask for beside a set-up file. The solver then keeps the figure.
enum class SetupFigure : std::uint8_t { kSwivel, kHeight, kDepth };
struct SetupFigureRow : EnumRow<SetupFigure> {
  const char* path = "";  ///< the figure's JobField
};
inline constexpr SetupFigureRow kSetupFigures[] = {{{SetupFigure::kSwivel, "swivel"}, "process.setup_swivel"},
                                                   {{SetupFigure::kHeight, "height"}, "process.setup_height"},
                                                   {{SetupFigure::kDepth, "depth"}, "process.depth"}};
constexpr const auto& rowsOf(SetupFigure) noexcept { return kSetupFigures; }

/// Whether the solver finds the number: swivel, height, shift in X, the depths and the overtravels.
bool isOfSetup(const JobField& field);

/// Sets the figures of a set-up to what the solver starts with: 0, but for flutes a depth that leaves the asked core
/// under an upright wheel, and an overtravel of a millimetre beyond the small end, so that the wheel reaches its feed
/// there.
void clearSetup(GrindJob& job);

/// Reads the set-up of the job's operation into `job`.
/// @param text text of the set-up file; `name` is the file in messages.
/// @param job operation with its cutter and wheel.
/// @throw FileError if the file has no set-up for this operation, if a figure is missing or not a number, or if the
///        set-up was solved for another cutter or wheel: the text names the first difference.
void takeSetup(const std::string& text, const std::string& name, GrindJob& job);

/// The text of a set-up file with the set-up of the job's operation; the file's other operations stay.
/// @param before text of the file; empty if there is none yet.
/// @param name the file in messages.
/// @param job_name name of the job file. A set-up file of another job is not written over.
/// @throw FileError if `before` is not the text of this job's set-up file.
std::string withSetup(const std::string& before, const std::string& name, const std::string& job_name,
                      const GrindJob& job);

}  // namespace grinder
