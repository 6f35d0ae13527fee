#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/setup_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

/// @file
/// The set-up for a job: what `grind setup` and the panel show, and write into its set-up file.
namespace grinder {

/// The property of a set-up that is nearest to its limit.
enum class SetupLimit : std::uint8_t { kSwivel, kLand, kCore };
constexpr EnumRow<SetupLimit> kSetupLimits[] = {
    {SetupLimit::kSwivel, "swivel"}, {SetupLimit::kLand, "land"}, {SetupLimit::kCore, "core"}};
constexpr const auto& rowsOf(SetupLimit) noexcept { return kSetupLimits; }

/// The set-up for a job, and the tool that the job grinds with it.
struct JobSetup {
  GrindJob job;                            ///< the job with the set-up, as it would be read from its files
  std::array<double, 2> overtravel{};      ///< required overtravel, at the small end and at the shank [m]
  CutterCheck check;                       ///< result of the plan's check; a set-up with a reason is not written
  SetupLimit limit = SetupLimit::kSwivel;  ///< the limit with the smallest margin
  double margin = 0;  ///< margin to that limit, relative to the machine's swivel range, the pitch or the end diameter
  /// What else would make the tool possible, if no set-up gives all that is asked: a smaller or a narrower wheel, or
  /// other cores, as "key = value"; empty if none of these does.
  std::string remedy;
  /// Properties of a relief, instead of overtravel, limit and margin.
  struct Relief {
    double rim = 0;        ///< width of the rim behind the relief's start; the land needs all of it except a margin [m]
    double next_edge = 0;  ///< smallest angle between the wheel and the next tooth's edge [rad]
    /// Minimum and maximum over the flute; nothing if the wheel's faces grind a part of the land [rad].
    std::optional<Range> land_end_clearance;
  };
  std::optional<Relief> relief;
  /// Strokes of an operation on the end, instead of overtravel, limit and margin.
  struct Straight {
    FaceStroke last;             ///< the last pass of the first tooth
    Axes travel = Axes::Zero();  ///< travel of each axis in the strokes of all teeth and passes [m], A [rad]
    int passes = 0;              ///< of each tooth
    double stock = 0;            ///< what they remove: of a gash radial, else normal to the plane [m]
    /// How far the wheel's circumference is past the cutter's axis at the end of a stroke, in the direction of Y;
    /// negative before it [m].
    double past_axis = 0;
  };
  std::optional<Straight> straight;
};

/// Solves the set-up of a job: rake, edge and core over the flute, see docs/algorithm.md. Uses the wheel's wear at the
/// job's start, and the middle of unequal spiral angles. The figures are rounded as in a file before the tool is
/// checked, and the overtravel is lengthened as the job's law of Z requires. Takes some tenths of a second, or some
/// seconds if there is none. For a relief, finds swivel and height: the swivel nearest to the flutes' swivel at which
/// the rim covers the land and clears the next tooth. For an operation on the end, takes the swivel of its plane, and
/// the height at which Z is 0 at the end of the last stroke.
/// @param asked as in JobToSetUp; its numbers are rounded to nine digits, see roundedOff().
/// @param swivel range that the machine allows [rad].
/// @param keep the figure that stays.
/// @return the set-up; of flutes that cannot be had, the nearest one, with the reasons in its check. Or, for the
/// operator,
///         why there is none at all, and the key to change.
std::variant<JobSetup, std::string> solveJobSetup(const GrindJob& asked, const Range& swivel,
                                                  std::optional<SetupFigure> keep);

}  // namespace grinder
