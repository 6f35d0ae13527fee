#pragma once

#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/enum_table.h"
#include "flute_grinder/core/odd_even_interpolator.h"
#include "flute_grinder/core/reason.h"

#include <cstdint>
#include <string>
#include <vector>

namespace flute_grinder {

/// The order of teeth and passes.
enum class GrindOrder { kToothMajor, kPassMajor };
/// The direction of the strokes.
enum class StrokeDirection { kFromEnd, kToEnd };

/// With the names used in job files.
inline constexpr EnumRow<GrindOrder> kGrindOrders[]{
    {GrindOrder::kToothMajor, "tooth_major"},
    {GrindOrder::kPassMajor, "pass_major"},
};
inline constexpr EnumRow<StrokeDirection> kStrokeDirections[]{
    {StrokeDirection::kFromEnd, "from_end"},
    {StrokeDirection::kToEnd, "to_end"},
};
constexpr auto& rowsOf(GrindOrder) noexcept { return kGrindOrders; }
constexpr auto& rowsOf(StrokeDirection) noexcept { return kStrokeDirections; }

/// How the flutes are ground.
struct GrindProcess {
  double feed = 0;              ///< along the cutting edge, and during infeed [m/s]
  double depth = 0;             ///< flute depth, radial [m]
  double infeed = 0;            ///< per pass; the last may be smaller [m]
  double finish_infeed = 0;     ///< of a single finishing pass at the end; 0 for none [m]
  int spark_out = 0;            ///< number of passes without infeed at the end
  double clearance = 0;         ///< between wheel and workpiece, for moves outside the cut [m]
  double overtravel_end = 0;    ///< of the stroke beyond the small end, X < 0 [m]
  double overtravel_shank = 0;  ///< of the stroke beyond the flute on the shank side [m]
  GrindOrder order = GrindOrder::kToothMajor;
  StrokeDirection direction = StrokeDirection::kFromEnd;
  double wheel_diameter = 0;       ///< when new [m]
  double wheel_width = 0;          ///< [m]
  double wheel_wear = 0;           ///< of the wheel's radius since Y was set; compensated in Y [m]
  double wheel_wear_per_pass = 0;  ///< added to that by each pass of any tooth; compensated before the next [m]
};

/// A pass of a tooth.
struct ToothPass {
  int tooth = 0;  ///< from 0
  int pass = 0;   ///< from 0
};

/// How the flutes are interpolated.
struct GrindInterpolation {
  EvenStepRule even_step = EvenStepRule::kPublished;
  double tolerance = 0;     ///< largest allowed deviation at the cutter's surface [m]
  double rotary_scale = 0;  ///< step length equivalent to one radian of A [m/rad]
};

/// The complete data of a job in SI units, the same for a job from a file or from a goal.
struct GrindJob {
  CutterGeometry cutter;
  std::vector<double> tooth_angles;  ///< of every tooth, from 0, ascending, below one full turn [rad]
  GrindProcess process;
  GrindInterpolation interpolation;
};

/// The tool in words for people, in shop units, e.g. "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth".
std::string toolText(const CutterGeometry& cutter, std::size_t teeth);

constexpr int kMaxTeeth = 64;
constexpr int kMaxSparkOut = 100;
constexpr int kMaxPasses = 10000;         ///< per tooth
constexpr int kMaxPassesOfAll = 20000;    ///< of all teeth together
constexpr double kMinFeed = 0.1e-3 / 60;  ///< slowest allowed feed [m/s]

/// Checks all numbers of a job, individually and against each other.
/// @return one reason for each number that is not allowed; empty if the job is valid.
std::vector<core::Reason> validate(const GrindJob& job);

/// The depth of every pass in order: infeed steps, the finishing pass, spark-out. [m]
std::vector<double> passDepths(const GrindProcess& process);

/// The passes of all teeth, in grinding order.
std::vector<ToothPass> passOrder(const GrindJob& job);

}  // namespace flute_grinder
