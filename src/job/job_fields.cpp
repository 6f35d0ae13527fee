#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <stdexcept>

namespace grinder {

namespace {

std::string upTo(int max, int min) { return std::to_string(min) + " to " + std::to_string(max); }

}  // namespace

const std::vector<OtherKey>& otherJobKeys() {
  // clang-format off
  static const std::vector<OtherKey> keys{
      {"cutter.cut", "cutter.cut", namesOf<CutDirection>(), "which way the cutter turns, and so which wall of a flute is the rake face and which way Z goes"},
      {"cutter.end_center_teeth", "cutter.end.center_teeth", upTo(kMaxCenterTeeth, 0), "number of end teeth whose edges go to the axis: 1, the first, of 2 or more; 2, also the tooth half of their number further, as the third of four, of an even number from 4", "0, all edges end at `cutter.end.uncut_diameter_mm`"},
      {"cutter.teeth", "cutter.teeth", upTo(kMaxTeeth, 1), "evenly spaced"},
      {"cutter.tooth_angles", "cutter.tooth_angles_deg", "angles in deg, 0 first, ascending, below 360", "instead of `cutter.teeth`, for unequal spacing"},
      {"cutter.spiral_angles", "cutter.spiral_angles_deg", "angles in deg, one per tooth", "instead of `cutter.spiral_angle_deg`, for a helix per tooth; each within the range of that key"},
      {"process.roughing_passes", "process.roughing_passes", upTo(kMaxRoughingPasses, 0), "in place of `process.infeed_mm`: number of roughing passes that remove equal amounts", "0"},
      {"process.spark_out", "process.spark_out", upTo(kMaxSparkOut, 0), "passes without infeed at the end"},
      {"process.order", "process.order", namesOf<GrindOrder>(), "all passes of a tooth first; or all teeth of a pass; or roughing tooth by tooth, and then finishing and spark-out of all teeth"},
      {"process.direction", "process.direction", namesOf<StrokeDirection>(), "direction of the strokes"},
      {"process.z_law", "process.z_law", namesOf<ZLaw>(), "how Z follows X along a stroke: as in the paper, or with a correction that keeps the rake the same over the whole flute", toString(ZLaw::kPublished)},
      {"process.incomplete_ok", "process.incomplete_ok", "true, false", "whether the stroke may be too short for a complete flute over `cutter.flute_length_mm`", "false"},
      {"process.wheel_file", "process.wheel.file", "the path of a wheel file", "a [wheel file](#the-wheel-file), absolute or relative to the job file, in place of the wheel's keys but `process.wheel.wear_per_pass_mm`", "the wheel's own keys"},
      {"process.wheel_profile", "process.wheel.profile", namesOf<WheelShape>(), "shape of the wheel, as FEPA 1A1, 1V1, 1F1, and 11V9 or 6A2, or by its points"},
      {"process.wheel_side", "process.wheel.side", namesOf<WheelFace>(), "the larger face of the wheel, as the machine carries it; for the profiles `angled` and `cup` only"},
      {"process.wheel_points", "process.wheel.points_mm", "[w, radius] in mm, w ascending from the lower face to the upper, 0 in the middle", "points of the profile along the wheel's axis, 2 to 100 of them; for the profile `points` only"},
      {"process.setup_file", "process.setup.file", "the path of a set-up file", "a [set-up file](write-a-job.md#the-set-up-file), absolute or relative to the job file, written by `grind setup --write`", "the figures of the set-up, depth and overtravel by hand"},
      {"interpolation.even_step", "interpolation.even_step", namesOf<EvenStepRule>(), "rule of the even step; see [algorithm](algorithm.md)"},
  };
  // clang-format on
  return keys;
}

const OtherKey& otherJobKey(const std::string& path) {
  const auto& keys = otherJobKeys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const OtherKey& key) { return key.path == path; });
  return found != keys.end() ? *found : throw std::out_of_range(path);
}

const std::vector<JobNumber>& jobNumbers() {
  static const std::vector<JobNumber> numbers = [] {
    std::vector<JobNumber> all;
    visitJobTable([&](const JobField& field, auto of) { all.push_back({field, JobNumber::Of(of)}); });
    return all;
  }();
  return numbers;
}

std::string fieldName(const std::string& path) {
  std::string name = path;
  visitJobFields([&](const JobField& field, auto) {
    if (field.path == path) name = field.file_key;
  });
  for (const OtherKey& key : otherJobKeys()) {
    if (key.path == path) name = key.file_key;
  }
  return name;
}

}  // namespace grinder
