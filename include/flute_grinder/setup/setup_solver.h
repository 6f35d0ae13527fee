#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/setup_file.h"
#include "flute_grinder/job/z_law.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

/// @file
/// Solves the set-up for a tool: the swivel, wheel height and depth that give the asked rake and core.
namespace grinder {

struct SolvedSetup;

/// The asked tool, and the wheel and machine for grinding it. On a cone whose edge or cores are asked at both ends, all
/// values may differ by the cutter's tolerances; a tolerance of 0 asks for the exact value.
struct SetupRequest {
  CutterGeometry cutter;                                    ///< cutter; its rake angle is the one in Z = X tan C sin r
  double rake = 0;                                          ///< radial rake asked over the whole flute [rad]
  std::vector<double> tooth_angles;                         ///< angles of the teeth, ascending within one turn [rad]
  WheelProfile wheel = WheelProfile::straight(0.1, 0.003);  ///< wheel with its present wear
  double nominal_radius = 0;                                ///< wheel radius that touches the small end at Y = 0 [m]
  double depth = 0;                                         ///< depth of the flute at X = 0, where Y = -depth [m]
  double y_per_x = 0;                                       ///< slope of a core taper, added to the cone's
  std::optional<double> core_diameter;                      ///< core diameter at X = 0, instead of the depth [m]
  std::optional<double> core_diameter_end;                  ///< end core diameter, instead of y_per_x [m]
  bool asks_spiral = false;               ///< asks for the edge's angle between the ends, by a shift in X
  bool incomplete_ok = false;             ///< whether the flute may be incomplete at its ends
  double min_swivel = 0, max_swivel = 0;  ///< range that the machine allows [rad]
  /// The figure that stays. If nothing is fixed, the depth is fixed unless a core diameter is asked. A cylinder leaves
  /// one unknown: the rake face is then put at the height R sin r, or at the nearest height that is accepted.
  std::optional<SetupFigure> keep;
  WheelSetup kept;  ///< values of the fixed swivel or height
  /// The published law takes the set-up with the minimum of the maximum rake error over the flute. For a law that
  /// corrects Z, the set-up is exact at both ends, so that the correction is small there.
  ZLaw z_law = ZLaw::kPublished;
  /// Called for every suitable set-up, the best first, to check what the solver does not know; without it, any is
  /// accepted.
  std::function<bool(const SolvedSetup&)> accepts{};
};

/// The property of a set-up that is nearest to its limit.
enum class SetupLimit : std::uint8_t { kSwivel, kLand, kCore };
constexpr EnumRow<SetupLimit> kSetupLimits[] = {
    {SetupLimit::kSwivel, "swivel"}, {SetupLimit::kLand, "land"}, {SetupLimit::kCore, "core"}};
constexpr const auto& rowsOf(SetupLimit) noexcept { return kSetupLimits; }

/// A set-up, and the tool that it grinds with a stroke of the necessary length.
struct SolvedSetup {
  WheelSetup setup;
  double depth = 0;                           ///< depth of the flute: Y = -depth at X = 0 [m]
  double depth_end = 0;                       ///< depth at the flute's end [m]
  double min_rake = 0, max_rake = 0;          ///< range of the rake over the flute [rad]
  double core_diameter = 0;                   ///< core diameter at X = 0 [m]
  double core_diameter_end = 0;               ///< core diameter at the flute's end [m]
  double land = 0;                            ///< minimum land over the flute and the teeth, along the circle [m]
  std::array<double, 2> overtravel{};         ///< overtravel at X = 0 and at the end for a complete flute [m]
  double complete_from = 0, complete_to = 0;  ///< range along the cutter; shorter only near a cone's apex [m]
  SetupLimit limit = SetupLimit::kSwivel;
  double margin = 0;  ///< margin to that limit, relative to the machine's swivel range, the pitch or the radius
};

/// Why there is no set-up.
enum class SetupProblem : std::uint8_t {
  kSwivel,      ///< needs a swivel beyond the machine's: `asked` is the nearest, the reachable range the machine's
  kReach,       ///< the wheel does not reach the cutter in any set-up
  kCore,        ///< the wheel cuts through the core
  kWall,        ///< the wheel's circumference, not its face or edge, forms the rake face
  kTolerance,   ///< not all asked values can be within their tolerances
  kLand,        ///< the flutes meet: `asked` is a land above 0, the reachable one is negative
  kIncomplete,  ///< near the cone's apex no overtravel makes the flute complete
};

/// A problem's name, and the job's field whose change helps.
struct SetupProblemRow : EnumRow<SetupProblem> {
  const char* change = "";
};
constexpr SetupProblemRow kSetupProblems[] = {{{SetupProblem::kSwivel, "swivel"}, "cutter.spiral_angle"},
                                              {{SetupProblem::kReach, "reach"}, "process.wheel_diameter"},
                                              {{SetupProblem::kCore, "core"}, "process.depth"},
                                              {{SetupProblem::kWall, "wall"}, "process.depth"},
                                              {{SetupProblem::kTolerance, "tolerance"}, "process.wheel_diameter"},
                                              {{SetupProblem::kLand, "land"}, "process.wheel_width"},
                                              {{SetupProblem::kIncomplete, "incomplete"}, "process.wheel_diameter"}};
constexpr const auto& rowsOf(SetupProblem) noexcept { return kSetupProblems; }

/// The reason why no set-up exists, with the reachable values. `asked`, `min` and `max` are 0 without a number.
struct SetupRefusal {
  SetupProblem problem = SetupProblem::kTolerance;
  double asked = 0;         ///< [rad] or [m]
  double min = 0, max = 0;  ///< reachable values [rad] or [m]
  /// The tool of the set-up nearest to the tolerances.
  struct Nearest {
    Range rake, chordal_rake, spiral;       ///< ranges over the flute; the spiral angle only if it is asked [rad]
    std::array<double, 2> core_diameter{};  ///< core diameters at the flute's ends [m]
  };
  Nearest nearest{};
  /// What would make the job possible: a smaller wheel, down to a quarter, a narrower one, or other cores. 0: none
  /// found. Where no land is left, only the width is changed.
  struct Mend {
    double wheel_diameter = 0;              ///< diameter with its wear [m]
    double wheel_width = 0;                 ///< width of the wheel [m]
    std::array<double, 2> core_diameter{};  ///< core diameters at the flute's ends [m]
  };
  Mend mend{};
};

/// Solves a set-up: the rake over the flute, according to z_law, and edge and cores if they are asked. Of several
/// solutions it takes the one with the steadiest rake whose rake face is formed deepest by the wheel's face or edge,
/// among the accepted ones, or among all if none is accepted. A depth that is found is above 0 and short of the
/// cutter's axis. Takes some tenths of a second.
/// @throw std::invalid_argument naming the value unless the cutter exists, and every number is finite and in its range.
std::variant<SolvedSetup, SetupRefusal> solveSetup(const SetupRequest& request);

}  // namespace grinder
