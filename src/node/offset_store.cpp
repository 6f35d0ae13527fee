#include "node/offset_store.h"

#include <cmath>
#include <limits>
#include <utility>

namespace grinder {

namespace {

constexpr double kLatest = 4e9;  ///< latest time that a ROS message can hold [s]

}  // namespace

void StateForm<WorkOffsets>::visit(StateFields& field, WorkOffsets& offsets) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    WorkOffset& offset = offsets.axes[static_cast<std::size_t>(axis)];
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    field(joint + "_" + axisUnit(axis), offset.value, {-kMaxOffset, kMaxOffset, true});
    field(joint + "_set_by", offset.set_by);
    field(joint + "_set_at", offset.set_at, {0, kLatest});
    field(joint + "_found_at", offset.found_at, {0, kLatest});
    field(joint + "_mounting", offset.mounting);
    field(joint + "_method", offset.basis.method);
    field(joint + "_job", offset.basis.job_name);
    field(joint + "_wheel", offset.basis.wheel_name);
    field(joint + "_wheel_digest", offset.basis.wheel_digest);
    field(joint + "_end_diameter_m", offset.basis.end_diameter);
    field(joint + "_wheel_diameter_m", offset.basis.wheel_diameter);
    field(joint + "_wheel_width_m", offset.basis.wheel_width);
    field(joint + "_wheel_rim_m", offset.basis.wheel_rim);
    field(joint + "_swivel_rad", offset.basis.swivel);
    field(joint + "_height_m", offset.basis.height);
    field(joint + "_tool_digest", offset.basis.tool_digest);
    field(joint + "_kind", offset.basis.kind);
    field(joint + "_before", offset.basis.before);
  }
  field("wheel", offsets.wheel.name);
  field("wheel_digest", offsets.wheel.digest);
  field("wheel_diameter_m", offsets.wheel.diameter);
  field("wheel_rim_m", offsets.wheel.rim);
  field("wheel_mounting", offsets.wheel.mounting);
  field("tool_digest", offsets.tool.digest);
  field("tool_job", offsets.tool.job_name);
  field("tool_ground", offsets.tool.ground);
  field("tool_unknown", offsets.tool.unknown);
  field("tool_clamping", offsets.tool.clamping);
}

OffsetStore::OffsetStore(std::string path, const std::string& owner)
    : file_(std::move(path), owner), error_(file_.status().error), offsets_(file_.status().on_disk) {
  if (error_.empty()) return;
  for (WorkOffset& offset : offsets_.axes) offset.value = std::numeric_limits<double>::quiet_NaN();
}

WorkOffsets OffsetStore::offsets() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return offsets_;
}

std::string OffsetStore::unknown() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string names;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (std::isnan(offsets_.axes[i].value)) names += (names.empty() ? "" : ", ") + std::string(kJointNames[i]);
  }
  if (names.empty()) return "";
  return "unknown work offsets of " + names + (error_.empty() ? "" : ": " + error_) +
         "; set each of them, or touch off";
}

void OffsetStore::change(const Change& change) {
  WorkOffsets changed = offsets();
  change(changed);
  file_.change(changed);
  changeAtOnce(change);
}

void OffsetStore::changeAtOnce(const Change& change) {
  const std::lock_guard<std::mutex> lock(mutex_);
  change(offsets_);
}

}  // namespace grinder
