#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/quantity.h"

#include <string>

namespace grinder {

/// One number of a job: its names, its unit and its range. The job file, the checks and the conversion to a goal all
/// use the table of these fields.
struct JobField {
  const char* path;      ///< name in messages, e.g. "process.wheel_diameter"
  const char* file_key;  ///< key in a job file, e.g. "process.wheel.diameter_mm"
  Unit unit;
  double min, max;        ///< allowed range in shop units, inclusive
  bool optional = false;  ///< whether a job file may omit it, together with the other element of a pair; it is then 0
  /// The operations that have the field; it is 0 in the others.
  enum class Of { kAll, kFlute, kRelief } of = Of::kAll;

  bool isOf(OperationKind kind) const { return of == Of::kAll || (of == Of::kRelief) == isRelief(kind); }
  Quantity low() const { return {min * shopScale(unit), unit}; }
  Quantity high() const { return {max * shopScale(unit), unit}; }
};

/// Visits every number of a job except the lists and the choices.
/// @param visit called with each JobField and a function that returns the field's number from a GrindJob or a
///        GrindGoal, whose members have the same names.
template <typename Visit>
void visitJobFields(const Visit& visit) {
  using F = JobField;
  constexpr Unit mm = Unit::kMetre, deg = Unit::kRadian, mm_min = Unit::kFeedMetrePerSecond;
  constexpr Unit um = Unit::kDeviationMetre, mm_rad = Unit::kRotaryMetrePerRadian;
  const double min_feed = kMinFeed / shopScale(mm_min);
  // clang-format off
  visit(F{"cutter.end_diameter", "cutter.end_diameter_mm", mm, 0.1, 100}, [](auto& j) -> auto& { return j.cutter.end_diameter; });
  visit(F{"cutter.cone_angle", "cutter.cone_angle_deg", deg, -3, 30}, [](auto& j) -> auto& { return j.cutter.cone_angle; });
  visit(F{"cutter.spiral_angle", "cutter.spiral_angle_deg", deg, -60, 60}, [](auto& j) -> auto& { return j.cutter.spiral_angle; });
  visit(F{"cutter.rake_angle", "cutter.rake_angle_deg", deg, -45, 45}, [](auto& j) -> auto& { return j.cutter.rake_angle; });
  visit(F{"cutter.flute_length", "cutter.flute_length_mm", mm, 0.1, 500}, [](auto& j) -> auto& { return j.cutter.flute_length; });
  visit(F{"cutter.rake_tolerance", "cutter.rake_tolerance_deg", deg, 0.001, 180}, [](auto& j) -> auto& { return j.cutter.rake_tolerance; });
  visit(F{"cutter.shank_diameter", "cutter.shank_diameter_mm", mm, 0.1, 100}, [](auto& j) -> auto& { return j.cutter.shank_diameter; });
  visit(F{"cutter.core_diameter", "cutter.core_diameter_mm", mm, 0.001, 100}, [](auto& j) -> auto& { return j.cutter.core_diameter; });
  visit(F{"cutter.neck_length", "cutter.neck_length_mm", mm, 0, 500, true}, [](auto& j) -> auto& { return j.cutter.neck_length; });
  visit(F{"cutter.core_diameter_end", "cutter.core_diameter_end_mm", mm, 0.001, 100}, [](auto& j) -> auto& { return j.cutter.core_diameter_end; });
  visit(F{"cutter.core_tolerance", "cutter.core_tolerance_mm", mm, 0.0001, 100}, [](auto& j) -> auto& { return j.cutter.core_tolerance; });
  visit(F{"cutter.spiral_tolerance", "cutter.spiral_tolerance_deg", deg, 0.001, 180}, [](auto& j) -> auto& { return j.cutter.spiral_tolerance; });
  visit(F{"cutter.chordal_rake_tolerance", "cutter.chordal_rake_tolerance_deg", deg, 0.001, 180}, [](auto& j) -> auto& { return j.cutter.chordal_rake_tolerance; });
  visit(F{"cutter.chordal_rake_depth", "cutter.chordal_rake_depth_mm", mm, 0, 50, true}, [](auto& j) -> auto& { return j.cutter.chordal_rake_depth; });
  visit(F{"cutter.clearance", "cutter.clearance_deg", deg, 0, 45, true}, [](auto& j) -> auto& { return j.cutter.clearance; });
  visit(F{"cutter.clearance_tolerance", "cutter.clearance_tolerance_deg", deg, 0, 45, true}, [](auto& j) -> auto& { return j.cutter.clearance_tolerance; });
  visit(F{"cutter.land", "cutter.land_mm", mm, 0, 50, true}, [](auto& j) -> auto& { return j.cutter.land; });
  visit(F{"cutter.second_clearance", "cutter.second_clearance_deg", deg, 0, 60, true}, [](auto& j) -> auto& { return j.cutter.second_clearance; });
  visit(F{"process.feed", "process.feed_mm_min", mm_min, min_feed, 10000}, [](auto& j) -> auto& { return processOf(j).feed; });
  visit(F{"process.depth", "process.depth_mm", mm, 0.001, 50, false, F::Of::kFlute}, [](auto& j) -> auto& { return processOf(j).depth; });
  visit(F{"process.depth_end", "process.depth_end_mm", mm, 0, 50, true, F::Of::kFlute}, [](auto& j) -> auto& { return processOf(j).depth_end; });
  visit(F{"process.infeed", "process.infeed_mm", mm, 0.0001, 50}, [](auto& j) -> auto& { return processOf(j).infeed; });
  visit(F{"process.finish_infeed", "process.finish_infeed_mm", mm, 0, 10}, [](auto& j) -> auto& { return processOf(j).finish_infeed; });
  visit(F{"process.clearance", "process.clearance_mm", mm, 0.1, 100}, [](auto& j) -> auto& { return processOf(j).clearance; });
  visit(F{"process.overtravel_end", "process.overtravel_mm[0]", mm, 0, 100, false, F::Of::kFlute}, [](auto& j) -> auto& { return processOf(j).overtravel_end; });
  visit(F{"process.overtravel_shank", "process.overtravel_mm[1]", mm, 0, 100, false, F::Of::kFlute}, [](auto& j) -> auto& { return processOf(j).overtravel_shank; });
  visit(F{"process.wheel_diameter", "process.wheel.diameter_mm", mm, 1, 500}, [](auto& j) -> auto& { return processOf(j).wheel_diameter; });
  visit(F{"process.wheel_width", "process.wheel.width_mm", mm, 0.1, 100}, [](auto& j) -> auto& { return processOf(j).wheel_width; });
  visit(F{"process.wheel_angle", "process.wheel.angle_deg", deg, 0, 80, true}, [](auto& j) -> auto& { return processOf(j).wheel_angle; });
  visit(F{"process.wheel_corner_radius_lower", "process.wheel.corner_radius_mm[0]", mm, 0, 50, true}, [](auto& j) -> auto& { return processOf(j).wheel_corner_radius_lower; });
  visit(F{"process.wheel_corner_radius_upper", "process.wheel.corner_radius_mm[1]", mm, 0, 50, true}, [](auto& j) -> auto& { return processOf(j).wheel_corner_radius_upper; });
  visit(F{"process.wheel_wear", "process.wheel.wear_mm", mm, 0, 100}, [](auto& j) -> auto& { return processOf(j).wheel_wear; });
  visit(F{"process.wheel_wear_per_pass", "process.wheel.wear_per_pass_mm", mm, 0, 1, true}, [](auto& j) -> auto& { return processOf(j).wheel_wear_per_pass; });
  visit(F{"process.setup_swivel", "process.setup.swivel_deg", deg, -80, 80}, [](auto& j) -> auto& { return processOf(j).setup_swivel; });
  visit(F{"process.setup_height", "process.setup.height_mm", mm, -100, 100}, [](auto& j) -> auto& { return processOf(j).setup_height; });
  visit(F{"process.setup_x_shift", "process.setup.x_shift_mm", mm, -100, 100, true, F::Of::kFlute}, [](auto& j) -> auto& { return processOf(j).setup_x_shift; });
  visit(F{"process.behind", "process.behind_mm", mm, 0, 50, true, F::Of::kRelief}, [](auto& j) -> auto& { return processOf(j).behind; });
  visit(F{"interpolation.tolerance", "interpolation.tolerance_um", um, 1e-9, 1000}, [](auto& j) -> auto& { return j.interpolation.tolerance; });
  visit(F{"interpolation.rotary_scale", "interpolation.rotary_scale_mm_per_rad", mm_rad, 1e-3, 1000}, [](auto& j) -> auto& { return j.interpolation.rotary_scale; });
  // clang-format on
}

/// Visits the choices and counts of a job, which have other types in a goal.
/// @param visit called with the path, the maximum allowed value, and a function like the one for visitJobFields().
template <typename Visit>
void visitJobChoices(const Visit& visit) {
  // clang-format off
  visit("cutter.cut", countOf<CutDirection>() - 1, [](auto& j) -> auto& { return j.cutter.cut; });
  visit("process.kind", countOf<OperationKind>() - 1, [](auto& j) -> auto& { return processOf(j).kind; });
  visit("process.spark_out", kMaxSparkOut, [](auto& j) -> auto& { return processOf(j).spark_out; });
  visit("process.order", countOf<GrindOrder>() - 1, [](auto& j) -> auto& { return processOf(j).order; });
  visit("process.direction", countOf<StrokeDirection>() - 1, [](auto& j) -> auto& { return processOf(j).direction; });
  visit("process.z_law", countOf<ZLaw>() - 1, [](auto& j) -> auto& { return processOf(j).z_law; });
  visit("process.incomplete_ok", 1, [](auto& j) -> auto& { return processOf(j).incomplete_ok; });
  visit("process.wheel_profile", countOf<WheelShape>() - 1, [](auto& j) -> auto& { return processOf(j).wheel_profile; });
  visit("process.wheel_side", countOf<WheelFace>() - 1, [](auto& j) -> auto& { return processOf(j).wheel_side; });
  visit("interpolation.even_step", countOf<EvenStepRule>() - 1, [](auto& j) -> auto& { return j.interpolation.even_step; });
  // clang-format on
}

/// The name of a field in texts: its key in a job file.
/// @param path its name in messages; returned if a job file has no other.
std::string fieldName(const std::string& path);

}  // namespace grinder
