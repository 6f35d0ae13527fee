#pragma once

#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/setup_solver.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_edit.h"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// @file
/// The set-up for a job: what `grind setup` and the panel show, and write into the job's file.
namespace grinder {

/// The set-up for a job, and the tool that the job then grinds.
struct JobSetup {
  GrindJob job;                               ///< with the set-up, as it would be read from its file
  std::vector<JobEdit> edits;                 ///< what makes the file say so
  std::array<double, 2> overtravel{};         ///< that the set-up needs, at the small end and at the shank [m]
  std::array<double, 2> overtravel_before{};  ///< of the job as it was [m]
  CutterCheck check;                          ///< as of a plan; with a reason the set-up is not written
  SetupLimit limit = SetupLimit::kSwivel;     ///< what comes nearest to its limit
  double margin = 0;                          ///< as of SolvedSetup
  /// Of a relief, in place of overtravel, limit and margin.
  struct Relief {
    double rim = 0;  ///< width of the wheel behind the relief's start, of which the land needs all but a margin [m]
    double next_edge = 0;  ///< how near the wheel comes to the next tooth's edge [rad]
    /// Minimum and maximum over the flute [rad]; nothing if the wheel's faces grind a part of the land.
    std::optional<Range> land_end_clearance;
  };
  std::optional<Relief> relief;
};

/// The fields that a job may leave to the set-up, for readJobFile(). @param keep the figure that stays.
std::vector<std::string> unsolvedFields(std::optional<SetupFigure> keep);

/// Solves the set-up of a job: rake and edge over the flute, and the cores at its ends. The
/// wheel is taken with its wear at the job's start, and of unequal spirals the middle. The figures are rounded to what
/// is written into a file, and measured as such, and the overtravel is lengthened to what the job's law of Z needs.
/// Takes up to some tenths of a second, and seconds if it is refused. Of a relief, swivel and height are found: the
/// swivel nearest to the flutes' with which the rim reaches over the land, and nothing of the next tooth.
/// @param asked read with unsolvedFields(); its numbers count with nine digits, see roundedOff().
/// @param swivel that the machine allows [rad].
/// @return the set-up; or for the operator what is asked, what is reachable, and which key to change.
std::variant<JobSetup, std::string> solveJobSetup(const GrindJob& asked, const Range& swivel,
                                                  std::optional<SetupFigure> keep);

}  // namespace grinder
