#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/job/cutter_geometry.h"
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
enum class GrindOrder { kToothMajor, kPassMajor, kFinishTogether };
/// The direction of the strokes.
enum class StrokeDirection { kFromEnd, kToEnd };

/// Each order with its name in job files.
inline constexpr EnumRow<GrindOrder> kGrindOrders[]{
    {GrindOrder::kToothMajor, "tooth_major"},
    {GrindOrder::kPassMajor, "pass_major"},
    {GrindOrder::kFinishTogether, "finish_together"},
};
inline constexpr EnumRow<StrokeDirection> kStrokeDirections[]{
    {StrokeDirection::kFromEnd, "from_end"},
    {StrokeDirection::kToEnd, "to_end"},
};
constexpr auto& rowsOf(GrindOrder) noexcept { return kGrindOrders; }
constexpr auto& rowsOf(StrokeDirection) noexcept { return kStrokeDirections; }

/// What an operation grinds.
enum class OperationKind { kFlute, kPrimaryRelief, kSecondaryRelief, kGash, kPrimaryEnd, kSecondaryEnd, kChamfer };
/// How an operation's strokes run: along the flutes, behind their edges, or straight at constant A.
enum class StrokeForm { kFlute, kRelief, kStraight };
struct OperationRow : EnumRow<OperationKind> {
  const char* words = "";  ///< name for people
  StrokeForm form = StrokeForm::kFlute;
  const char* kind = "";    ///< its `kind` in job files
  const char* relief = "";  ///< and which of the two; empty for a kind that has but one
};
/// Each kind with its name on the command line and in set-up files.
inline constexpr OperationRow kOperationKinds[]{
    {{OperationKind::kFlute, "flute"}, "flute", StrokeForm::kFlute, "flute"},
    {{OperationKind::kPrimaryRelief, "primary"}, "primary relief", StrokeForm::kRelief, "relief", "primary"},
    {{OperationKind::kSecondaryRelief, "secondary"}, "secondary relief", StrokeForm::kRelief, "relief", "secondary"},
    {{OperationKind::kGash, "gash"}, "gash", StrokeForm::kStraight, "gash"},
    {{OperationKind::kPrimaryEnd, "end_primary"}, "primary flank of the end", StrokeForm::kStraight, "end", "primary"},
    {{OperationKind::kSecondaryEnd, "end_secondary"},
     "secondary flank of the end",
     StrokeForm::kStraight,
     "end",
     "secondary"},
    {{OperationKind::kChamfer, "chamfer"}, "chamfer", StrokeForm::kStraight, "chamfer"},
};
constexpr auto& rowsOf(OperationKind) noexcept { return kOperationKinds; }
constexpr bool isRelief(OperationKind kind) noexcept { return rowOf(kind).form == StrokeForm::kRelief; }
constexpr bool isEndFlank(OperationKind kind) noexcept {
  return kind == OperationKind::kPrimaryEnd || kind == OperationKind::kSecondaryEnd;
}
constexpr bool isStraight(OperationKind kind) noexcept { return rowOf(kind).form == StrokeForm::kStraight; }
/// Whether the wheel's lower face grinds, and so wears, rather than its rim. A gash is fed in along the wheel's radius,
/// so its rim does the work.
constexpr bool isByFace(OperationKind kind) noexcept { return isEndFlank(kind) || kind == OperationKind::kChamfer; }

/// How the flutes, or a relief behind the edge of every tooth, are ground. For a relief, `depth`, `depth_end`, the
/// overtravels, `setup_x_shift` and the law of Z follow from the other members, and are 0 here.
struct GrindProcess {
  OperationKind kind = OperationKind::kFlute;
  double feed = 0;       ///< feed along the cutting edge, and during infeed [m/s]
  double depth = 0;      ///< flute depth at the small end, radial [m]
  double depth_end = 0;  ///< radial flute depth at the flute's end, linear in between; 0: as `depth` [m]
  /// Infeed per pass where the flute is deepest; the last may be smaller. Exactly one of this and the next two is not 0
  /// [m].
  double infeed = 0;
  int roughing_passes = 0;      ///< number of roughing passes that remove equal amounts
  double removal = 0;           ///< the most that a roughing pass removes per second at the feed [m^3/s]
  double finish_infeed = 0;     ///< infeed of a single finishing pass at the end; 0: none [m]
  int spark_out = 0;            ///< number of passes without infeed at the end
  double clearance = 0;         ///< distance between wheel and workpiece, for moves outside the cut [m]
  double overtravel_end = 0;    ///< travel of the stroke beyond the small end, X < 0 [m]
  double overtravel_shank = 0;  ///< travel of the stroke beyond the flute on the shank side [m]
  GrindOrder order = GrindOrder::kToothMajor;
  StrokeDirection direction = StrokeDirection::kFromEnd;
  ZLaw z_law = ZLaw::kPublished;
  bool incomplete_ok = false;  ///< the stroke may be too short for a complete flute
  WheelShape wheel_profile = WheelShape::kStraight;
  double wheel_diameter = 0;  ///< largest diameter, to which Y = 0 is set [m]
  double wheel_width = 0;     ///< width of the wheel [m]
  double wheel_angle = 0;  ///< angle of a tapered wheel's surface to its axis, 0 for a straight cup; otherwise 0 [rad]
  WheelFace wheel_side = WheelFace::kUpper;  ///< the larger face of a tapered wheel
  double wheel_corner_radius_lower = 0;      ///< corner radius between surface and lower face; 0 for a sharp edge [m]
  double wheel_corner_radius_upper = 0;      ///< corner radius between surface and upper face; 0 for a sharp edge [m]
  double wheel_rim = 0;                      ///< width of a cup's rim on its larger face; 0: it does not matter [m]
  double wheel_wear = 0;                     ///< wear of the radius, from wheel_diameter / 2, compensated in Y [m]
  /// Wear of the radius, or of the face that grinds, by each pass of any tooth; compensated before the next pass [m].
  double wheel_wear_per_pass = 0;
  double setup_swivel = 0;  ///< angle of the wheel's plane to the cutter's axis; positive for right-hand flutes [rad]
  double setup_height = 0;  ///< height of the wheel's centre above the cutter's axis at Z = 0 [m]
  double behind = 0;        ///< distance of a primary relief behind the edge at the small end [m]
  double stock = 0;         ///< by which the blank is longer than the tool, for an operation on its end [m]
  double gash_angle = 0;    ///< angle of a gash's bottom to the axis [rad]
  double gash_past = 0;     ///< distance of a gash's bottom past the axis at the end; negative before it [m]
  double gash_short_angle = 0;  ///< `gash_angle` of a short tooth; 0: as of the others [rad]
  double gash_short_past = 0;   ///< `gash_past` of a short tooth [m]
  double setup_x_shift =
      0;  ///< shift of A's curve along X that makes the ground edge the asked helix; see LogCurve [m]
  std::vector<ProfilePoint> wheel_points;  ///< the profile of a wheel of shape kPoints, else empty

  double depthEnd() const noexcept { return depth_end > 0 ? depth_end : depth; }  ///< depth at the flute's end [m]
  double deepest() const noexcept { return std::max(depth, depthEnd()); }         ///< the larger of the two depths [m]
  /// Whether the depths of roughing passes follow from what they remove.
  bool roughsByRemoval() const noexcept { return roughing_passes > 0 || removal > 0; }
};

/// How the flutes are interpolated.
struct GrindInterpolation {
  EvenStepRule even_step = EvenStepRule::kPublished;
  double tolerance = 0;     ///< maximum allowed deviation at the cutter's surface [m]
  double rotary_scale = 0;  ///< step length equivalent to one radian of A [m/rad]
};

/// The operation of a job or of a goal, whose members have the same names.
/// @throw std::out_of_range if there is none with the job's index.
template <typename Job>
auto& processOf(Job&& job) {
  return job.operations.at(static_cast<std::size_t>(job.operation));
}

/// The complete data of a job in SI units, whether it comes from a file or a goal.
struct GrindJob {
  CutterGeometry cutter;
  std::vector<double> tooth_angles;  ///< angle of every tooth, from 0, ascending, below one full turn [rad]
  /// Spiral angle of every tooth, the first as in `cutter`; empty if all teeth have the cutter's [rad].
  std::vector<double> spiral_angles;
  GrindInterpolation interpolation;
  /// All operations on the cutter, in the order of their kinds, of which only the flutes are required.
  std::vector<GrindProcess> operations{GrindProcess{}};
  int operation = 0;  ///< index of this job's operation, from 0

  GrindProcess& process() { return processOf(*this); }              ///< the job's operation
  const GrindProcess& process() const { return processOf(*this); }  ///< the job's operation
  /// Whether the tool has an operation of a kind after the job's: it is the job's, or before it.
  bool hasGround(OperationKind kind) const;
  /// The next tooth behind a tooth's edge.
  int behind(int tooth) const;
  /// Whether a tooth's edge at the end does not go to the axis, beside others' that do: those of the first tooth, and
  /// that half of the teeth further if there are two.
  bool isShort(int tooth) const;
  /// Whether the wheel comes along X, and has to go back along it before it is lifted: a cup, whose rim goes round the
  /// next tooth of a left-hand end.
  bool comesAlongX() const;
  /// The operation after the job's; null after the last.
  const GrindProcess* next() const;
  /// The operation for people, e.g. "primary relief"; empty for the only operation of a cutter.
  std::string operationText() const { return operations.size() < 2 ? "" : rowOf(process().kind).words; }
  /// The job of another operation on the same cutter.
  /// @param index from 0. @throw std::out_of_range for another one.
  GrindJob ofOperation(int index) const;
  /// The jobs of all operations.
  std::vector<GrindJob> ofAllOperations() const;
};

/// The minimum and maximum spiral angle of the teeth [rad].
Range askedSpiral(const GrindJob& job);

constexpr double kEvenRake = 0.005 * units::kDegree;  ///< maximum variation of the rake with kConstantRake [rad]
/// Distance of the rim from the next tooth at a stroke's end on the end; also by which it passes the axis, beyond which
/// it cuts other edges to the axis [m].
constexpr double kEndGap = 0.05e-3;
constexpr int kMaxCenterTeeth = 2;    ///< maximum number of end teeth whose edges go to the axis
constexpr int kMaxWheelPoints = 100;  ///< maximum number of points of a wheel's profile
constexpr int kMaxSparkOut = 100;
constexpr int kMaxRoughingPasses =
    200;  ///< maximum number of roughing passes whose depths follow from what they remove
constexpr int kMaxOperations = countOf<OperationKind>();
constexpr int kMaxPassesOfAll = 20000;    ///< maximum number of passes of all teeth together
constexpr double kMinFeed = 0.1e-3 / 60;  ///< slowest allowed feed [m/s]

/// Checks all numbers of a job, individually and against each other.
/// @return one reason for each number that is not allowed; empty if the job is valid.
std::vector<Reason> validate(const GrindJob& job);

/// Checks the numbers of the wheel alone: the members of its operation that begin with wheel_. Profile and side are
/// taken as they are.
std::vector<Reason> validateWheel(const GrindJob& job);

/// The depths of the passes, see ValidJob::depths(), for numbers that are each within their range.
std::vector<double> passDepths(const GrindProcess& process);
/// The depths of the passes if the last pass is `deepest` deep [m].
std::vector<double> passDepths(const GrindProcess& process, double deepest);
/// The depths of the passes after roughing passes: these, the finishing pass and spark-out [m].
std::vector<double> passDepths(const GrindProcess& process, double deepest, std::vector<double> roughing);

/// The asked diameter of the core at `x`, linear between the flute's ends [m].
/// @param x from the small end [m].
double askedCore(const CutterGeometry& cutter, double x) noexcept;

/// The asked radial depth of the flute at `x` [m]. At each end it follows from the asked core diameter there, if there
/// is one, or else from the asked depth.
double askedDepth(const GrindJob& job, double x);

/// How much deeper than its infeed the first pass of a flute cuts into the shank: the height of the shank above the
/// cone at the flute's end. 0 if the shank is not higher, and with a neck, where no wheel reaches the shank [m].
double shankCut(const CutterGeometry& cutter);

}  // namespace grinder
