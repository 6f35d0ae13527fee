#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/job/tooth_pass.h"
#include "flute_grinder/job/wheel_shape.h"
#include "flute_grinder/job/z_law.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace grinder {

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

/// What an operation grinds.
enum class OperationKind { kFlute, kPrimaryRelief, kSecondaryRelief };
struct OperationRow : EnumRow<OperationKind> {
  const char* words = "";  ///< for people
};
/// With the names used in job files and on the command line.
inline constexpr OperationRow kOperationKinds[]{
    {{OperationKind::kFlute, "flute"}, "flute"},
    {{OperationKind::kPrimaryRelief, "primary"}, "primary relief"},
    {{OperationKind::kSecondaryRelief, "secondary"}, "secondary relief"},
};
constexpr auto& rowsOf(OperationKind) noexcept { return kOperationKinds; }
constexpr bool isRelief(OperationKind kind) noexcept { return kind != OperationKind::kFlute; }

/// How the flutes, or a relief behind the edge of every tooth, are ground. Of a relief, `depth`, `depth_end`, the
/// overtravels, `setup_x_shift` and the law of Z follow from the rest, and are 0 here.
struct GrindProcess {
  OperationKind kind = OperationKind::kFlute;
  double feed = 0;              ///< along the cutting edge, and during infeed [m/s]
  double depth = 0;             ///< flute depth at the small end, radial [m]
  double depth_end = 0;         ///< the same at the flute's end, linear in between; 0: as `depth` [m]
  double infeed = 0;            ///< per pass where the flute is deepest; the last may be smaller [m]
  double finish_infeed = 0;     ///< of a single finishing pass at the end; 0 for none [m]
  int spark_out = 0;            ///< number of passes without infeed at the end
  double clearance = 0;         ///< between wheel and workpiece, for moves outside the cut [m]
  double overtravel_end = 0;    ///< of the stroke beyond the small end, X < 0 [m]
  double overtravel_shank = 0;  ///< of the stroke beyond the flute on the shank side [m]
  GrindOrder order = GrindOrder::kToothMajor;
  StrokeDirection direction = StrokeDirection::kFromEnd;
  ZLaw z_law = ZLaw::kPublished;
  bool incomplete_ok = false;  ///< the stroke may be too short for a complete flute
  WheelShape wheel_profile = WheelShape::kStraight;
  double wheel_diameter = 0;                 ///< the largest, to which Y = 0 is set [m]
  double wheel_width = 0;                    ///< [m]
  double wheel_angle = 0;                    ///< of a tapered wheel's surface against its axis; 0 for the others [rad]
  WheelFace wheel_side = WheelFace::kUpper;  ///< the larger face of a tapered wheel
  double wheel_corner_radius_lower = 0;      ///< between surface and lower face; 0 for a sharp edge [m]
  double wheel_corner_radius_upper = 0;      ///< the same at the upper face [m]
  double wheel_wear = 0;                     ///< of the radius below half of wheel_diameter; compensated in Y [m]
  double wheel_wear_per_pass = 0;  ///< added to that by each pass of any tooth; compensated before the next [m]
  double setup_swivel = 0;  ///< of the wheel's plane against the cutter's axis; positive for right-hand flutes [rad]
  double setup_height = 0;  ///< of the wheel's centre above the cutter's axis at Z = 0 [m]
  double behind = 0;        ///< of a primary relief: how far behind the edge it begins at the small end [m]
  double setup_x_shift =
      0;  ///< shift of A's curve along X that makes the ground edge the asked helix; see LogCurve [m]

  double depthEnd() const noexcept { return depth_end > 0 ? depth_end : depth; }  ///< at the flute's end [m]
  double deepest() const noexcept { return std::max(depth, depthEnd()); }         ///< where the flute is deepest [m]
};

/// How the flutes are interpolated.
struct GrindInterpolation {
  EvenStepRule even_step = EvenStepRule::kPublished;
  double tolerance = 0;     ///< maximum allowed deviation at the cutter's surface [m]
  double rotary_scale = 0;  ///< step length equivalent to one radian of A [m/rad]
};

/// One of several operations on a cutter.
struct GrindOperation {
  GrindProcess process;
  std::vector<ProfilePoint> wheel_points;  ///< the profile of a wheel of shape kPoints, else empty
};

/// The complete data of a job in SI units, the same for a job from a file or from a goal.
struct GrindJob {
  CutterGeometry cutter;
  std::vector<double> tooth_angles;  ///< of every tooth, from 0, ascending, below one full turn [rad]
  /// Of every tooth, the first as in `cutter`; empty if all teeth have the cutter's [rad]
  std::vector<double> spiral_angles;
  std::vector<ProfilePoint> wheel_points;  ///< the profile of a wheel of shape kPoints, else empty
  GrindProcess process;
  GrindInterpolation interpolation;
  /// All that is done to the cutter, in order: the flutes, a primary relief, a secondary one. Empty if the flutes are
  /// all; else `process` and `wheel_points` are those of the operation of this job.
  std::vector<GrindOperation> operations;
  int operation = 0;  ///< which one, from 0

  /// Which of several operations it is, for people, e.g. "primary relief"; empty for the only one.
  std::string operationText() const { return operations.empty() ? "" : rowOf(process.kind).words; }
  /// The job of another of its operations. @param index from 0; with a single one, 0.
  GrindJob ofOperation(int index) const;
};

/// The minimum and maximum spiral angle of the teeth [rad].
Range askedSpiral(const GrindJob& job);

constexpr double kEvenRake = 0.005 * units::kDegree;  ///< how well kConstantRake keeps the rake [rad]
constexpr int kMaxWheelPoints = 100;                  ///< of a wheel's profile
constexpr int kMaxSparkOut = 100;
constexpr std::size_t kMaxOperations = std::size(kOperationKinds);
constexpr int kMaxPassesOfAll = 20000;    ///< of all teeth together
constexpr double kMinFeed = 0.1e-3 / 60;  ///< slowest allowed feed [m/s]

/// Checks all numbers of a job, individually and against each other.
/// @return one reason for each number that is not allowed; empty if the job is valid.
std::vector<Reason> validate(const GrindJob& job);

/// Checks those of the wheel alone: `wheel_points`, and the members of `process` that begin with wheel_.
std::vector<Reason> validateWheel(const GrindJob& job);

/// As ValidJob::depths(), of numbers that are each within their range.
std::vector<double> passDepths(const GrindProcess& process);
/// The same for another depth of the last pass [m].
std::vector<double> passDepths(const GrindProcess& process, double deepest);

/// The diameter of the core that is asked at `x`: on a straight line between those at the flute's ends [m].
/// @param x from the small end [m].
double askedCore(const CutterGeometry& cutter, double x) noexcept;

/// The depth of the flute that a job asks for at `x`, radial: at each end that of the core it asks for there, or else
/// by its depths [m]. @param x from the small end [m].
double askedDepth(const GrindJob& job, double x);

/// How much more than its infeed the first pass of a flute cuts out of the shank: by how much the shank stands out from
/// the cone into whose flutes it is ground. 0 if it does not, and behind a neck, where no wheel reaches it [m].
double shankCut(const CutterGeometry& cutter);

}  // namespace grinder
