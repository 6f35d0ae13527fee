#pragma once

#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/enum_table.h"
#include "flute_grinder/core/odd_even_interpolator.h"

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

/// A figure of a job that cannot be ground.
struct JobError {
  std::string field;    ///< e.g. "cutter.cone_angle", or "cutter.cone_angle_deg" in a job file
  std::string value;    ///< as given, with unit
  std::string allowed;  ///< what is allowed, with unit

  /// "field = value; allowed: ..."
  std::string text() const { return field + " = " + value + "; allowed: " + allowed; }
};

/// In which units, and by whose names, errors are told: those of messages, or those of job files.
enum class UnitSystem { kSi, kShop };

/// One number of a job: its name, its units, its range and where it is kept. The job file, the check and their messages
/// all go by the table of these.
struct JobField {
  const char* path;       ///< in messages and in errors about SI figures, e.g. "process.wheel_diameter"
  const char* file_key;   ///< in a job file, e.g. "process.wheel.diameter_mm"
  const char* si_unit;    ///< e.g. "m"
  const char* shop_unit;  ///< e.g. "mm"
  double shop_scale;      ///< SI value over shop value
  double min, max;        ///< allowed, in shop units, both included
  double& (*at)(GrindJob& job);
  bool optional = false;  ///< 0 where a job file leaves it out

  double get(const GrindJob& job) const { return at(const_cast<GrindJob&>(job)); }

  /// A value in SI as text, with the unit.
  std::string format(double value, UnitSystem units) const;
  /// The allowed range as text, with the unit.
  std::string range(UnitSystem units) const;
  /// The name as its reader knows it: the file's key, or the message's path.
  const char* name(UnitSystem units) const { return units == UnitSystem::kSi ? path : file_key; }
  /// "name = value" of a job, with the unit.
  std::string text(const GrindJob& job, UnitSystem units) const {
    return std::string(name(units)) + " = " + format(get(job), units);
  }
};

/// Every number of a job but the teeth and the count of spark-out passes.
const std::vector<JobField>& jobFields();

/// The tool for people, in shop units, e.g. "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth".
std::string toolText(const CutterGeometry& cutter, std::size_t teeth);

/// The one of a path, which must be there.
const JobField& jobField(const std::string& path);

constexpr int kMaxTeeth = 64;
constexpr int kMaxSparkOut = 100;
constexpr int kMaxPasses = 10000;         ///< of a tooth
constexpr int kMaxPassesOfAll = 20000;    ///< of all teeth together
constexpr double kMinFeed = 0.1e-3 / 60;  ///< slowest feed that is ground with [m/s]

/// Checks all figures of a job, each for itself and against the others.
/// @return one error for each figure that is not allowed; empty for a good job.
std::vector<JobError> validate(const GrindJob& job, UnitSystem units = UnitSystem::kSi);

/// The depth of every pass, first to last: infeed steps, the finishing pass, spark-out. [m]
std::vector<double> passDepths(const GrindProcess& process);

/// The passes of all teeth in the order in which they are ground.
std::vector<ToothPass> passOrder(const GrindJob& job);

}  // namespace flute_grinder
