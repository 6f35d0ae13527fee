#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/job/z_law.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

/// @file
/// The set-up for a tool: which swivel, wheel height and depth give the rake and the core that are asked.
namespace grinder {

/// A figure of the set-up that the operator keeps.
enum class SetupFigure : std::uint8_t { kSwivel, kHeight, kDepth };
constexpr EnumRow<SetupFigure> kSetupFigures[] = {
    {SetupFigure::kSwivel, "swivel"}, {SetupFigure::kHeight, "height"}, {SetupFigure::kDepth, "depth"}};
constexpr const auto& rowsOf(SetupFigure) noexcept { return kSetupFigures; }

struct SolvedSetup;

/// What the tool shall be, and what there is to grind it with. Of a cone whose edge or cores at both ends are asked,
/// all may differ by the cutter's tolerances, and not at all where these are 0.
struct SetupRequest {
  CutterGeometry cutter;                                    ///< its rake angle is the one in Z = X tan C sin r
  double rake = 0;                                          ///< radial, asked over the whole flute [rad]
  std::vector<double> tooth_angles;                         ///< ascending within one turn [rad]
  WheelProfile wheel = WheelProfile::straight(0.1, 0.003);  ///< as it is, with its wear
  double nominal_radius = 0;                                ///< of the wheel, for which Y = 0 touches the small end [m]
  double depth = 0;                                         ///< of the flute at X = 0, where Y = -depth [m]
  double y_per_x = 0;                                       ///< of a core taper, added to the cone's
  std::optional<double> core_diameter;                      ///< at X = 0, in place of the depth [m]
  std::optional<double> core_diameter_end;                  ///< at the flute's end, in place of y_per_x [m]
  bool asks_spiral = false;                                 ///< the edge's angle between the ends, by a shift
  bool incomplete_ok = false;                               ///< the flute may end before its ends
  double min_swivel = 0, max_swivel = 0;                    ///< that the machine allows [rad]
  /// Without it the depth is kept unless a core is asked; on a cylinder, where one unknown is free, the rake face then
  /// passes the axis at the height R sin r, or at the nearest one that is accepted if that is not.
  std::optional<SetupFigure> keep;
  WheelSetup kept;  ///< the swivel or height that is kept
  /// The published one takes the set-up with the minimum of the maximum error of the rake over the flute. For a law
  /// that corrects Z, the set-up is exact at both ends, where the correction then begins and ends with little.
  ZLaw z_law = ZLaw::kPublished;
  /// Asked of every set-up that would do, the best first, for what the solver does not know; without it, any does.
  std::function<bool(const SolvedSetup&)> accepts{};
};

/// What comes nearest to its limit in a set-up.
enum class SetupLimit : std::uint8_t { kSwivel, kLand, kCore };
constexpr EnumRow<SetupLimit> kSetupLimits[] = {
    {SetupLimit::kSwivel, "swivel"}, {SetupLimit::kLand, "land"}, {SetupLimit::kCore, "core"}};
constexpr const auto& rowsOf(SetupLimit) noexcept { return kSetupLimits; }

/// A set-up, and the tool that it grinds with as long a stroke as it needs.
struct SolvedSetup {
  WheelSetup setup;
  double depth = 0;                           ///< of the flute: Y = -depth at X = 0 [m]
  double depth_end = 0;                       ///< the same at the flute's end [m]
  double min_rake = 0, max_rake = 0;          ///< over the flute [rad]
  double core_diameter = 0;                   ///< at X = 0 [m]
  double core_diameter_end = 0;               ///< at the flute's end [m]
  double land = 0;                            ///< minimum over the flute and the teeth, along the circle [m]
  std::array<double, 2> overtravel{};         ///< beyond X = 0 and beyond the flute's end, for it to be complete [m]
  double complete_from = 0, complete_to = 0;  ///< along the cutter; less than the flute only near a cone's apex [m]
  SetupLimit limit = SetupLimit::kSwivel;
  double margin = 0;  ///< to that limit: of the machine's swivel, the pitch or the radius
};

/// Why there is no set-up.
enum class SetupProblem : std::uint8_t {
  kSwivel,      ///< only beyond the machine's swivel: asked is the nearest, reachable the machine's
  kReach,       ///< the wheel reaches the cutter in no set-up
  kCore,        ///< the wheel cuts through it
  kWall,        ///< the wheel's circumference forms the rake face, not its face or edge
  kTolerance,   ///< not all that is asked can be had within its tolerance
  kLand,        ///< the flutes meet: asked is a land above 0, reachable what is left, negative
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

/// No set-up gives what is asked, and what could be had. Without a figure the last three are 0.
struct SetupRefusal {
  SetupProblem problem = SetupProblem::kTolerance;
  double asked = 0;         ///< [rad] or [m]
  double min = 0, max = 0;  ///< reachable [rad] or [m]
  /// What the set-up gives that is nearest to the tolerances.
  struct Nearest {
    Range rake, chordal_rake, spiral;       ///< over the flute [rad]; the spiral angle only if it is asked
    std::array<double, 2> core_diameter{};  ///< at the flute's ends [m]
  };
  Nearest nearest{};
  /// What would be set up with all else as asked: the largest of some smaller wheels, down to a quarter, or the widest
  /// of some narrower ones; or cores. 0 if none was found. Where no land is left, only the width is looked for.
  struct Mend {
    double wheel_diameter = 0;              ///< as worn [m]
    double wheel_width = 0;                 ///< [m]
    std::array<double, 2> core_diameter{};  ///< at the flute's ends [m]
  };
  Mend mend{};
};

/// Solves a set-up: the rake over the flute, as z_law says, and edge and cores if they are asked. Of
/// several solutions, that with the steadiest rake whose rake face the wheel's face or edge forms the deepest, of those
/// that are accepted, or of all if none is. A depth that is found lies above 0 and short of the cutter's axis. Takes
/// some tenths of a second.
/// @throw std::invalid_argument naming the value unless the cutter exists, and every figure is finite and in its range.
std::variant<SolvedSetup, SetupRefusal> solveSetup(const SetupRequest& request);

}  // namespace grinder
