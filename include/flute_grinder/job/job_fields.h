#pragma once

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"

#include <string>
#include <vector>

namespace grinder {

/// One number of a job: its names, its unit, its range and its meaning. The job file, the checks, the conversion to a
/// goal and docs/reference.md all use the table of these fields.
struct JobField {
  const char* path;      ///< name in messages, e.g. "process.wheel_diameter"
  const char* file_key;  ///< key in a job file, e.g. "process.wheel.diameter_mm"
  Unit unit;
  double min, max;      ///< allowed range in shop units, inclusive
  const char* meaning;  ///< for people, in Markdown
  /// What it means if a file omits the key, together with the other element of a pair; the number is then 0. Null if
  /// the key is required.
  const char* omitted = nullptr;
  /// The operations that have the field; it is 0 in the others.
  enum class Of { kAll, kFlute, kRelief, kStraight, kGash } of = Of::kAll;

  bool isOf(OperationKind kind) const {
    switch (of) {
      case Of::kAll: return true;
      case Of::kFlute: return kind == OperationKind::kFlute;
      case Of::kRelief: return isRelief(kind);
      case Of::kStraight: return isStraight(kind);
      case Of::kGash: return kind == OperationKind::kGash;
    }
    return false;
  }
  Quantity low() const { return {min * shopScale(unit), unit}; }
  Quantity high() const { return {max * shopScale(unit), unit}; }
};

/// The table of a job's numbers, all but the lists and the choices, for a job and for what has members of the same
/// names: a GrindGoal.
/// @param visit called with each JobField and a function that returns the field's number from either.
template <typename Visit>
void visitJobTable(const Visit& visit) {
  using F = JobField;
  constexpr Unit mm = Unit::kMetre, deg = Unit::kRadian, mm_min = Unit::kFeedMetrePerSecond;
  constexpr Unit mm3_s = Unit::kCubicMetrePerSecond, um = Unit::kDeviationMetre, mm_rad = Unit::kRotaryMetrePerRadian;
  const double min_feed = kMinFeed / shopScale(mm_min);
  // clang-format off
  visit(F{"cutter.end_diameter", "cutter.end_diameter_mm", mm, 0.1, 100, "diameter at the small end, X = 0"},
        [](auto& j) -> auto& { return j.cutter.end_diameter; });
  visit(F{"cutter.cone_angle", "cutter.cone_angle_deg", deg, -3, 30, "half angle from the axis to the generatrix; 0 is a cylinder, negative a back taper"},
        [](auto& j) -> auto& { return j.cutter.cone_angle; });
  visit(F{"cutter.spiral_angle", "cutter.spiral_angle_deg", deg, -60, 60, "against axial travel, tan S = R dA/dX; negative is a left-hand helix"},
        [](auto& j) -> auto& { return j.cutter.spiral_angle; });
  visit(F{"cutter.rake_angle", "cutter.rake_angle_deg", deg, -45, 45, "rake angle"},
        [](auto& j) -> auto& { return j.cutter.rake_angle; });
  visit(F{"cutter.flute_length", "cutter.flute_length_mm", mm, 0.1, 500, "along the axis; the cone must stay open"},
        [](auto& j) -> auto& { return j.cutter.flute_length; });
  visit(F{"cutter.rake_tolerance", "cutter.rake_tolerance_deg", deg, 0.001, 180, "maximum difference of the ground rake angle from `cutter.rake_angle_deg`"},
        [](auto& j) -> auto& { return j.cutter.rake_tolerance; });
  visit(F{"cutter.shank_diameter", "cutter.shank_diameter_mm", mm, 0.1, 100, "diameter of the shank"},
        [](auto& j) -> auto& { return j.cutter.shank_diameter; });
  visit(F{"cutter.core_diameter", "cutter.core_diameter_mm", mm, 0.001, 100, "diameter of the core at the small end; less than `cutter.end_diameter_mm`"},
        [](auto& j) -> auto& { return j.cutter.core_diameter; });
  visit(F{"cutter.neck_length", "cutter.neck_length_mm", mm, 0, 500, "from the flute's end to the shank; 0: not known, and the shank may then stand out from the cutter by the flute's depth", "0"},
        [](auto& j) -> auto& { return j.cutter.neck_length; });
  visit(F{"cutter.core_diameter_end", "cutter.core_diameter_end_mm", mm, 0.001, 100, "diameter of the core at the flute's end; less than the cutter's diameter there"},
        [](auto& j) -> auto& { return j.cutter.core_diameter_end; });
  visit(F{"cutter.core_tolerance", "cutter.core_tolerance_mm", mm, 0.0001, 100, "maximum allowed difference of the ground core from the asked one, at the flute's ends and from the straight line between; a plan refuses more"},
        [](auto& j) -> auto& { return j.cutter.core_tolerance; });
  visit(F{"cutter.spiral_tolerance", "cutter.spiral_tolerance_deg", deg, 0.001, 180, "maximum allowed difference of the edge's spiral angle from the asked one; a plan refuses more"},
        [](auto& j) -> auto& { return j.cutter.spiral_tolerance; });
  visit(F{"cutter.chordal_rake_tolerance", "cutter.chordal_rake_tolerance_deg", deg, 0.001, 180, "maximum difference of the ground chordal rake, of the chord from the edge into the rake face, from `cutter.rake_angle_deg`; a plan refuses more"},
        [](auto& j) -> auto& { return j.cutter.chordal_rake_tolerance; });
  visit(F{"cutter.chordal_rake_depth", "cutter.chordal_rake_depth_mm", mm, 0, 50, "depth below the edge at which the chord ends on the rake face", "0, a tenth of the flute's depth"},
        [](auto& j) -> auto& { return j.cutter.chordal_rake_depth; });
  visit(F{"cutter.clearance", "cutter.clearance_deg", deg, 0, 45, "radial clearance of the primary relief at the edge; more than 0 with a [relief](write-a-job.md#reliefs)", "0, without reliefs"},
        [](auto& j) -> auto& { return j.cutter.clearance; });
  visit(F{"cutter.clearance_tolerance", "cutter.clearance_tolerance_deg", deg, 0, 45, "maximum difference of the ground clearance from `cutter.clearance_deg`; a plan refuses more", "0, without reliefs"},
        [](auto& j) -> auto& { return j.cutter.clearance_tolerance; });
  visit(F{"cutter.land", "cutter.land_mm", mm, 0, 50, "width of the primary relief at the small end; more than 0 with a secondary relief, which begins there", "0, up to the heel"},
        [](auto& j) -> auto& { return j.cutter.land; });
  visit(F{"cutter.second_clearance", "cutter.second_clearance_deg", deg, 0, 60, "radial clearance of the secondary relief where it begins", "0, without a secondary relief"},
        [](auto& j) -> auto& { return j.cutter.second_clearance; });
  visit(F{"cutter.end_clearance", "cutter.end.clearance_deg", deg, 0, 45, "axial clearance of the end teeth at their edges; more than 0 with end teeth", "0, without end teeth"},
        [](auto& j) -> auto& { return j.cutter.end_clearance; });
  visit(F{"cutter.end_second_clearance", "cutter.end.second_clearance_deg", deg, 0, 60, "axial clearance of the secondary flanks of the end where they begin", "0, without secondary flanks"},
        [](auto& j) -> auto& { return j.cutter.end_second_clearance; });
  visit(F{"cutter.end_land", "cutter.end.land_mm", mm, 0, 50, "width of the primary flanks of the end, seen along the axis; more than 0 with secondary flanks, which begin there", "0, up to the heel"},
        [](auto& j) -> auto& { return j.cutter.end_land; });
  visit(F{"cutter.end_dish", "cutter.end.dish_deg", deg, 0, 20, "angle by which the end is hollow toward the axis", "0, a flat end"},
        [](auto& j) -> auto& { return j.cutter.end_dish; });
  visit(F{"cutter.end_rake", "cutter.end.rake_deg", deg, -30, 45, "axial rake of the end teeth, as the gashes give it", "0"},
        [](auto& j) -> auto& { return j.cutter.end_rake; });
  visit(F{"cutter.end_clearance_tolerance", "cutter.end.clearance_tolerance_deg", deg, 0, 45, "maximum difference of the ground clearances of the end from the asked ones; a plan refuses more", "0, without end teeth"},
        [](auto& j) -> auto& { return j.cutter.end_clearance_tolerance; });
  visit(F{"cutter.end_rake_tolerance", "cutter.end.rake_tolerance_deg", deg, 0, 45, "maximum difference of the ground rake of the gashes from `cutter.end.rake_deg`; a plan refuses more", "0, without gashes"},
        [](auto& j) -> auto& { return j.cutter.end_rake_tolerance; });
  visit(F{"cutter.end_uncut_diameter", "cutter.end.uncut_diameter_mm", mm, 0, 100, "diameter about the axis in which edges of end teeth may be missing", "0"},
        [](auto& j) -> auto& { return j.cutter.end_uncut_diameter; });
  visit(F{"cutter.end_short_from", "cutter.end.short_from_mm", mm, 0, 50, "with `cutter.end.center_teeth`: radius outside which the edges of the other, short teeth are whole", "0, without teeth to the centre"},
        [](auto& j) -> auto& { return j.cutter.end_short_from; });
  visit(F{"cutter.chamfer_width", "cutter.chamfer.width_mm", mm, 0, 50, "width of the chamfer at the corner, seen along the axis", "0, without a chamfer"},
        [](auto& j) -> auto& { return j.cutter.chamfer_width; });
  visit(F{"cutter.chamfer_angle", "cutter.chamfer.angle_deg", deg, 0, 89, "angle between the chamfer and the axis", "0, without a chamfer"},
        [](auto& j) -> auto& { return j.cutter.chamfer_angle; });
  visit(F{"cutter.chamfer_clearance", "cutter.chamfer.clearance_deg", deg, 0, 45, "clearance of the chamfer, normal to its edge", "0, without a chamfer"},
        [](auto& j) -> auto& { return j.cutter.chamfer_clearance; });
  visit(F{"process.feed", "process.feed_mm_min", mm_min, min_feed, 10000, "along the cutting edge; also of the infeed"},
        [](auto& j) -> auto& { return processOf(j).feed; });
  visit(F{"process.depth", "process.depth_mm", mm, 0.001, 50, "radial depth of the flute at the small end; less than the cutter's radius there", nullptr, F::Of::kFlute},
        [](auto& j) -> auto& { return processOf(j).depth; });
  visit(F{"process.depth_end", "process.depth_end_mm", mm, 0, 50, "radial depth at the flute's end, linear in between: a core taper; less than the cutter's radius there", "0, as `process.depth_mm`", F::Of::kFlute},
        [](auto& j) -> auto& { return processOf(j).depth_end; });
  visit(F{"process.infeed", "process.infeed_mm", mm, 0, 50, "radial infeed per pass where the flute is deepest, 0.0001 or more; the last may be smaller. Exactly one of this, `process.roughing_passes` and `process.removal_mm3_s` is more than 0", "0"},
        [](auto& j) -> auto& { return processOf(j).infeed; });
  visit(F{"process.removal", "process.removal_mm3_s", mm3_s, 0, 10000, "maximum removal rate of a roughing pass at the feed, in place of `process.infeed_mm`; the fewest passes that keep within it are used, with equal removal", "0"},
        [](auto& j) -> auto& { return processOf(j).removal; });
  visit(F{"process.finish_infeed", "process.finish_infeed_mm", mm, 0, 10, "infeed of a final finishing pass; 0 for none"},
        [](auto& j) -> auto& { return processOf(j).finish_infeed; });
  visit(F{"process.clearance", "process.clearance_mm", mm, 0.1, 100, "between wheel and work outside the cut"},
        [](auto& j) -> auto& { return processOf(j).clearance; });
  visit(F{"process.overtravel_end", "process.overtravel_mm[0]", mm, 0, 100, "extension of the stroke beyond the small end", nullptr, F::Of::kFlute},
        [](auto& j) -> auto& { return processOf(j).overtravel_end; });
  visit(F{"process.overtravel_shank", "process.overtravel_mm[1]", mm, 0, 100, "extension of the stroke beyond the shank end of the flute", nullptr, F::Of::kFlute},
        [](auto& j) -> auto& { return processOf(j).overtravel_shank; });
  visit(F{"process.wheel_diameter", "process.wheel.diameter_mm", mm, 1, 500, "maximum diameter, with its corners rounded, to which Y = 0 is set"},
        [](auto& j) -> auto& { return processOf(j).wheel_diameter; });
  visit(F{"process.wheel_width", "process.wheel.width_mm", mm, 0.1, 100, "width of the wheel"},
        [](auto& j) -> auto& { return processOf(j).wheel_width; });
  visit(F{"process.wheel_angle", "process.wheel.angle_deg", deg, 0, 80, "of the surface of an angled wheel or a cup against the wheel's axis", "0"},
        [](auto& j) -> auto& { return processOf(j).wheel_angle; });
  visit(F{"process.wheel_corner_radius_lower", "process.wheel.corner_radius_mm[0]", mm, 0, 50, "between surface and lower face", "0, sharp"},
        [](auto& j) -> auto& { return processOf(j).wheel_corner_radius_lower; });
  visit(F{"process.wheel_corner_radius_upper", "process.wheel.corner_radius_mm[1]", mm, 0, 50, "between surface and upper face", "0, sharp"},
        [](auto& j) -> auto& { return processOf(j).wheel_corner_radius_upper; });
  visit(F{"process.wheel_rim", "process.wheel.rim_mm", mm, 0, 100, "width of a cup's rim, from the largest diameter inward, on its larger face; the flanks of a left-hand end need it", "0: the cup's recess does not matter"},
        [](auto& j) -> auto& { return processOf(j).wheel_rim; });
  visit(F{"process.wheel_wear", "process.wheel.wear_mm", mm, 0, 100, "by which the radius is below half of `process.wheel.diameter_mm`; compensated by Y"},
        [](auto& j) -> auto& { return processOf(j).wheel_wear; });
  visit(F{"process.wheel_wear_per_pass", "process.wheel.wear_per_pass_mm", mm, 0, 1, "wear of the radius by each pass of any tooth, added to `process.wheel.wear_mm` and compensated by Y at the next infeed; for a flank of the end or a chamfer, wear of the face that grinds, compensated by X and Z", "0"},
        [](auto& j) -> auto& { return processOf(j).wheel_wear_per_pass; });
  visit(F{"process.setup_swivel", "process.setup.swivel_deg", deg, -89, 89, "of the wheel's plane against the cutter's axis; positive for right-hand flutes; within the limits of the joint `wheel_swivel`"},
        [](auto& j) -> auto& { return processOf(j).setup_swivel; });
  visit(F{"process.setup_height", "process.setup.height_mm", mm, -100, 100, "of the wheel's centre above the cutter's axis at Z = 0"},
        [](auto& j) -> auto& { return processOf(j).setup_height; });
  visit(F{"process.setup_x_shift", "process.setup.x_shift_mm", mm, -100, 100, "shift of A's curve along X: A follows the curve at X - shift. On a cone it makes the ground edge the asked helix; it is not simply the distance from the wheel's centre to the edge.", "0, the paper's motion", F::Of::kFlute},
        [](auto& j) -> auto& { return processOf(j).setup_x_shift; });
  visit(F{"process.behind", "process.behind_mm", mm, 0, 50, "of a primary relief: width of the round margin between edge and relief, at the small end, along the circle", "0", F::Of::kRelief},
        [](auto& j) -> auto& { return processOf(j).behind; });
  visit(F{"process.stock", "process.stock_mm", mm, 0, 50, "of an operation on the end: by which the blank is longer than the tool", "0", F::Of::kStraight},
        [](auto& j) -> auto& { return processOf(j).stock; });
  visit(F{"process.gash_angle", "process.angle_deg", deg, 5, 85, "of a gash: angle of its bottom to the axis", nullptr, F::Of::kGash},
        [](auto& j) -> auto& { return processOf(j).gash_angle; });
  visit(F{"process.gash_past", "process.past_mm", mm, -50, 50, "of a gash: distance of its bottom past the axis at the end; negative before it", nullptr, F::Of::kGash},
        [](auto& j) -> auto& { return processOf(j).gash_past; });
  visit(F{"process.gash_short_angle", "process.short.angle_deg", deg, 0, 85, "`process.angle_deg` of the gashes of short teeth, 5 or more", "0, as `process.angle_deg`", F::Of::kGash},
        [](auto& j) -> auto& { return processOf(j).gash_short_angle; });
  visit(F{"process.gash_short_past", "process.short.past_mm", mm, -50, 50, "`process.past_mm` of the gashes of short teeth", "0", F::Of::kGash},
        [](auto& j) -> auto& { return processOf(j).gash_short_past; });
  visit(F{"interpolation.tolerance", "interpolation.tolerance_um", um, 1e-9, 1000, "maximum deviation at the cutter's surface; the feed is reduced to keep it"},
        [](auto& j) -> auto& { return j.interpolation.tolerance; });
  visit(F{"interpolation.rotary_scale", "interpolation.rotary_scale_mm_per_rad", mm_rad, 1e-3, 1000, "weight of A in the step length; 1 in the paper"},
        [](auto& j) -> auto& { return j.interpolation.rotary_scale; });
  // clang-format on
}

/// A field, and its number in a job.
struct JobNumber {
  /// The number of a field in a job, to read or to set.
  class Of {
   public:
    template <typename Number>
    explicit Of(Number number) : number_(number) {}
    double& operator()(GrindJob& job) const { return number_(job); }
    double operator()(const GrindJob& job) const { return number_(const_cast<GrindJob&>(job)); }  // only looked up

   private:
    double& (*number_)(GrindJob&);
  };
  JobField field;
  Of of;
};

/// The numbers of a job in the table's order.
const std::vector<JobNumber>& jobNumbers();

/// Visits every number of a job except the lists and the choices.
/// @param visit called with each JobField and its JobNumber::Of.
template <typename Visit>
void visitJobFields(const Visit& visit) {
  for (const JobNumber& number : jobNumbers()) visit(number.field, number.of);
}

/// Visits the choices and counts of a job, which have other types in a goal.
/// @param visit called with the path, the maximum allowed value, and a function like the one for visitJobTable().
template <typename Visit>
void visitJobChoices(const Visit& visit) {
  // clang-format off
  visit("cutter.cut", countOf<CutDirection>() - 1, [](auto& j) -> auto& { return j.cutter.cut; });
  visit("cutter.end_center_teeth", kMaxCenterTeeth, [](auto& j) -> auto& { return j.cutter.end_center_teeth; });
  visit("process.kind", countOf<OperationKind>() - 1, [](auto& j) -> auto& { return processOf(j).kind; });
  visit("process.roughing_passes", kMaxRoughingPasses, [](auto& j) -> auto& { return processOf(j).roughing_passes; });
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

/// A key of a job file or a wheel file that is no number of one field: a choice, a count, a list or a text.
struct OtherKey {
  const char* path;  ///< name in messages; as in visitJobChoices()
  const char* file_key;
  std::string allowed;  ///< choices separated by commas, or a description
  const char* meaning;
  const char* omitted = nullptr;  ///< as in JobField
};

/// The keys of a job file that are not in visitJobFields().
const std::vector<OtherKey>& otherJobKeys();

/// The one of these with a path. @throw std::out_of_range
const OtherKey& otherJobKey(const std::string& path);

/// The name of a field in texts: its key in a job file.
/// @param path its name in messages; returned if a job file has no other.
std::string fieldName(const std::string& path);

}  // namespace grinder
