#pragma once

#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/enum_table.h"
#include "flute_grinder/core/odd_even_interpolator.h"
#include "flute_grinder/core/reason.h"

#include <cstdint>
#include <string>
#include <vector>

namespace flute_grinder {

/// In which order teeth and passes follow one another.
enum class GrindOrder { kToothMajor, kPassMajor };
/// Which way the strokes go.
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
  double feed = 0;              ///< along the cutting edge, and of the infeed [m/s]
  double depth = 0;             ///< flute depth, radial [m]
  double infeed = 0;            ///< per pass; the last may be smaller [m]
  double finish_infeed = 0;     ///< of one finishing pass at the end; 0 for none [m]
  int spark_out = 0;            ///< passes without infeed after the last
  double clearance = 0;         ///< between wheel and work for moves outside the cut [m]
  double overtravel_end = 0;    ///< of the stroke beyond the small end, X < 0 [m]
  double overtravel_shank = 0;  ///< of the stroke beyond the flute on the shank's side [m]
  GrindOrder order = GrindOrder::kToothMajor;
  StrokeDirection direction = StrokeDirection::kFromEnd;
  double wheel_diameter = 0;       ///< when new [m]
  double wheel_width = 0;          ///< [m]
  double wheel_wear = 0;           ///< of the wheel's radius since Y was set; taken up by Y [m]
  double wheel_wear_per_pass = 0;  ///< what each pass of any tooth adds to that; taken up before the next pass [m]
};

/// A pass of a tooth.
struct ToothPass {
  int tooth = 0;  ///< from 0
  int pass = 0;   ///< from 0
};

/// How the flutes are interpolated.
struct GrindInterpolation {
  EvenStepRule even_step = EvenStepRule::kPublished;
  double tolerance = 0;     ///< largest deviation at the cutter's surface [m]
  double rotary_scale = 0;  ///< what one radian of A counts for in the step length [m/rad]
};

/// All that describes a job, in SI, the same whether it came from a file or from a goal.
struct GrindJob {
  CutterGeometry cutter;
  std::vector<double> tooth_angles;  ///< of every tooth, from 0, ascending, below a full turn [rad]
  GrindProcess process;
  GrindInterpolation interpolation;
};

/// The tool for people, in shop units, e.g. "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth".
std::string toolText(const CutterGeometry& cutter, std::size_t teeth);

constexpr int kMaxTeeth = 64;
constexpr int kMaxSparkOut = 100;
constexpr int kMaxPasses = 10000;         ///< of a tooth
constexpr int kMaxPassesOfAll = 20000;    ///< of all teeth together
constexpr double kMinFeed = 0.1e-3 / 60;  ///< slowest feed that is ground with [m/s]

/// Checks all numbers of a job, each for itself and against the others.
/// @return one reason for each that is not allowed; empty for a good job.
std::vector<core::Reason> validate(const GrindJob& job);

/// The depth of every pass, first to last: infeed steps, the finishing pass, spark-out. [m]
std::vector<double> passDepths(const GrindProcess& process);

/// The passes of all teeth in the order in which they are ground.
std::vector<ToothPass> passOrder(const GrindJob& job);

}  // namespace flute_grinder
