#include "node/journal.h"

#include "flute_grinder/job/format.h"
#include "flute_grinder/motion/feed_schedule.h"
#include "node/yaml_fields.h"

#include <cmath>
#include <utility>

namespace grinder {

namespace {

/// Calls visit(key, value) for every field of the file.
template <typename AnyProgress, typename Visit>
void visitFields(AnyProgress& progress, const Visit& visit) {
  visit("job_digest", progress.job_digest);
  visit("job_name", progress.job_name);
  visit("operation", progress.operation);
  visit("end_diameter_m", progress.cutter.end_diameter);
  visit("cone_angle_rad", progress.cutter.cone_angle);
  visit("spiral_angle_rad", progress.cutter.spiral_angle);
  visit("rake_angle_rad", progress.cutter.rake_angle);
  visit("flute_length_m", progress.cutter.flute_length);
  visit("tooth_angles_rad", progress.tooth_angles);
  visit("finished", progress.finished);
  visit("tooth", progress.next.tooth);
  visit("pass", progress.next.pass);
  visit("x_m", progress.x);
  visit("end", progress.end);
  visit("feed_override", progress.feed_override);
  visit("wheel_in_work", progress.wheel.in_work);
  visit("clear_y_m", progress.wheel.clear_y);
  visit("lift_m", progress.wheel.lift);
  visit("y_doubted", progress.wheel.y_doubted);
  visit("offset_x_m", progress.offset[kX]);
  visit("offset_y_m", progress.offset[kY]);
  visit("offset_z_m", progress.offset[kZ]);
  visit("offset_a_rad", progress.offset[kA]);
  visit("mounting", progress.mounting);
  visit("clamping", progress.clamping);
  visit("tool_digest", progress.tool_digest);
  visit("tool_operation", progress.tool_operation);
}

void requireFinite(const std::string& key, double value) {
  requireAllowed(std::isfinite(value), key, value, "a finite number");
}

void requireSound(const Progress& progress) {
  visitFields(progress, [](const char* key, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, double>) requireFinite(key, value);
    if constexpr (std::is_same_v<Value, std::vector<double>>) {
      for (const double element : value) requireFinite(key, element);
    }
  });
  const std::size_t teeth = progress.tooth_angles.size();
  requireAllowed(teeth <= kMaxTeeth, "number of tooth_angles_rad", teeth, "0 to " + std::to_string(kMaxTeeth));
  const int last_tooth = teeth == 0 ? 0 : static_cast<int>(teeth) - 1;
  const ToothPass& next = progress.next;
  requireAllowed(next.tooth >= 0 && next.tooth <= last_tooth, "tooth", next.tooth,
                 "0 to " + std::to_string(last_tooth));
  requireAllowed(next.pass >= 0 && next.pass < kMaxPasses, "pass", next.pass, "0 to " + std::to_string(kMaxPasses - 1));
  requireAllowed(progress.tool_operation >= 0 && progress.tool_operation < countOf<OperationKind>(), "tool_operation",
                 progress.tool_operation, "0 to " + std::to_string(countOf<OperationKind>() - 1));
  const double feed_override = progress.feed_override;
  requireAllowed(feed_override >= 0 && feed_override <= kMaxFeedOverride, "feed_override", feed_override,
                 format("0 to %g", kMaxFeedOverride));
}

std::string toText(const Progress& progress) {
  requireSound(progress);
  return toYaml("The grinder's progress; tooth and pass, from 0, are the first that is not finished.",
                [&](const auto& visit) { visitFields(progress, visit); });
}

Progress fromText(const std::string& text) {
  Progress progress;
  fromYaml(text, [&](const auto& visit) { visitFields(progress, visit); });
  requireSound(progress);
  return progress;
}

}  // namespace

Journal::Journal(std::string path, std::string owner) : file_("journal", std::move(path), std::move(owner)) {}

std::optional<Progress> Journal::read() const {
  const std::optional<std::string> text = file_.read();
  if (!text) return std::nullopt;
  return file_.named<JournalDamaged>([&] { return fromText(*text); });
}

void Journal::write(const Progress& progress) const {
  file_.named([&] { file_.write(toText(progress)); });
  file_.settle();
}

}  // namespace grinder
