#include "node/journal.h"

#include "flute_grinder/motion/feed_schedule.h"

#include <algorithm>

namespace grinder {

void StateForm<Progress>::visit(StateFields& field, Progress& progress) {
  field("job_digest", progress.job_digest);
  field("job_name", progress.job_name);
  field("operation", progress.operation);
  field("end_diameter_m", progress.cutter.end_diameter);
  field("cone_angle_rad", progress.cutter.cone_angle);
  field("spiral_angle_rad", progress.cutter.spiral_angle);
  field("rake_angle_rad", progress.cutter.rake_angle);
  field("flute_length_m", progress.cutter.flute_length);
  field("tooth_angles_rad", progress.tooth_angles);
  const std::size_t teeth = progress.tooth_angles.size();
  StateFields::require(teeth <= kMaxTeeth, "number of tooth_angles_rad", teeth, "0 to " + std::to_string(kMaxTeeth));
  field("finished", progress.finished);
  field("tooth", progress.next.tooth, {0, std::max(1.0, static_cast<double>(teeth)) - 1});
  field("pass", progress.next.pass, {0, kMaxPasses - 1});
  field("x_m", progress.x);
  field("end", progress.end);
  field("feed_override", progress.feed_override, {0, kMaxFeedOverride});
  field("wheel_in_work", progress.wheel.in_work);
  field("clear_y_m", progress.wheel.clear_y);
  field("lift_m", progress.wheel.lift);
  field("clear_x_m", progress.wheel.clear_x);
  field("back_m", progress.wheel.back);
  field("y_doubted", progress.wheel.y_doubted);
  field("offset_x_m", progress.offset[kX]);
  field("offset_y_m", progress.offset[kY]);
  field("offset_z_m", progress.offset[kZ]);
  field("offset_a_rad", progress.offset[kA]);
  field("mounting", progress.mounting);
  field("clamping", progress.clamping);
  field("tool_digest", progress.tool_digest);
  field("kind", progress.kind);
}

}  // namespace grinder
