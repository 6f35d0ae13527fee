#include "node/offset_store.h"

#include "node/yaml_fields.h"

#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

namespace grinder {

namespace {

constexpr double kLatest = 4e9;  ///< time that a ROS message can hold [s]

/// Calls visit(key, name) for a field that is one of a list.
template <typename Enum, typename Visit>
void visitChoice(Enum& value, const std::string& key, const Visit& visit) {
  std::string name = toString(value);
  visit(key, name);
  if constexpr (!std::is_const_v<Enum>) {
    const auto read = valueOf<Enum>(name);
    requireAllowed(read.has_value(), key, name, namesOf<Enum>());
    value = *read;
  }
}

/// Calls visit(key, value) for every field of what an offset was set for.
template <typename AnyBasis, typename Visit>
void visitBasis(AnyBasis& basis, const std::string& joint, const Visit& visit) {
  visitChoice(basis.method, joint + "_method", visit);
  visit(joint + "_job", basis.job_name);
  visit(joint + "_wheel", basis.wheel_name);
  visit(joint + "_wheel_digest", basis.wheel_digest);
  visit(joint + "_end_diameter_m", basis.end_diameter);
  visit(joint + "_wheel_diameter_m", basis.wheel_diameter);
  visit(joint + "_wheel_width_m", basis.wheel_width);
  visit(joint + "_swivel_rad", basis.swivel);
  visit(joint + "_height_m", basis.height);
  visit(joint + "_tool_digest", basis.tool_digest);
  visit(joint + "_operation", basis.operation);
}

/// Calls visit(key, value) for every field of the file.
template <typename AnyOffsets, typename Visit>
void visitOffsets(AnyOffsets& offsets, const Visit& visit) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    auto& offset = offsets.axes[static_cast<std::size_t>(axis)];
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    visit(joint + "_" + axisUnit(axis), offset.value);
    visit(joint + "_set_by", offset.set_by);
    visit(joint + "_set_at", offset.set_at);
    visit(joint + "_mounting", offset.mounting);
    visitBasis(offset.basis, joint, visit);
  }
  visit("wheel", offsets.wheel.name);
  visit("wheel_digest", offsets.wheel.digest);
  visit("wheel_diameter_m", offsets.wheel.diameter);
  visit("wheel_mounting", offsets.wheel.mounting);
  visit("tool_digest", offsets.tool.digest);
  visit("tool_job", offsets.tool.job_name);
  visit("tool_ground", offsets.tool.ground);
  visitChoice(offsets.tool.unknown, "tool_unknown", visit);
  visit("tool_clamping", offsets.tool.clamping);
}

bool isKnown(const WorkOffset& offset) { return !std::isnan(offset.value); }

void requireSound(const WorkOffsets& offsets) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const WorkOffset& offset = offsets.axes[static_cast<std::size_t>(axis)];
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    requireAllowed(!isKnown(offset) || std::abs(offset.value) <= kMaxOffset, joint + "_" + axisUnit(axis), offset.value,
                   "-1000 to 1000");
    requireAllowed(offset.set_at >= 0 && offset.set_at <= kLatest, joint + "_set_at", offset.set_at, "0 to 4e9");
    visitBasis(offset.basis, joint, [](const std::string& key, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
        requireAllowed(std::isfinite(value), key, value, "a finite number");
      }
    });
  }
  requireAllowed(std::isfinite(offsets.wheel.diameter), "wheel_diameter_m", offsets.wheel.diameter, "a finite number");
}

std::string offsetsText(const WorkOffsets& offsets) {
  requireSound(offsets);
  return toYaml("The grinder's work offsets: machine position - work position; .nan is unknown.",
                [&](const auto& visit) { visitOffsets(offsets, visit); });
}

WorkOffsets offsetsFromText(const std::string& text) {
  WorkOffsets offsets;
  fromYaml(text, [&](const auto& visit) { visitOffsets(offsets, visit); });
  requireSound(offsets);
  return offsets;
}

}  // namespace

OffsetStore::OffsetStore(std::string path, std::string owner)
    : file_("file of work offsets", std::move(path), std::move(owner)) {
  try {
    const std::optional<std::string> text = file_.read();
    if (text) offsets_ = file_.named([&] { return offsetsFromText(*text); });
  } catch (const AtomicFileOwned&) {
    throw;
  } catch (const AtomicFileError& error) {
    error_ = error.what();
    for (WorkOffset& offset : offsets_.axes) offset.value = std::numeric_limits<double>::quiet_NaN();
  }
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
    if (!isKnown(offsets_.axes[i])) names += (names.empty() ? "" : ", ") + std::string(kJointNames[i]);
  }
  if (names.empty()) return "";
  return "unknown work offsets of " + names + (error_.empty() ? "" : ": " + error_) +
         "; set each of them, or touch off";
}

void OffsetStore::change(const Change& change) {
  const WorkOffsets before = offsets();
  WorkOffsets changed = before;
  change(changed);
  const auto write = [this](const WorkOffsets& all) { file_.named([&] { file_.write(offsetsText(all)); }); };
  write(changed);
  try {
    file_.settle();
  } catch (const AtomicFileError& unsettled) {
    try {
      write(before);
    } catch (const AtomicFileError& error) {
      throw AtomicFileError(unsettled.what() + std::string("; the file has the change all the same: ") + error.what());
    }
    throw;
  }
  changeAtOnce(change);
}

void OffsetStore::changeAtOnce(const Change& change) {
  const std::lock_guard<std::mutex> lock(mutex_);
  change(offsets_);
}

}  // namespace grinder
