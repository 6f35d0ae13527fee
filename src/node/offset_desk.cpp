#include "flute_grinder/node/offset_desk.h"

#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/core/quantity.h"
#include "flute_grinder/node/plain_name.h"

#include <algorithm>

namespace flute_grinder {

namespace {

/// @return kAxisCount if there is no such axis.
int axisOf(const std::string& name) {
  return static_cast<int>(std::find(kJointNames.begin(), kJointNames.end(), name) - kJointNames.begin());
}

/// Why the offsets must not change now; empty if they may.
std::string refusal(const LoopStatus& status) {
  if (status.state != MachineState::kReady && status.state != MachineState::kDisabled) {
    return std::string("the machine is in state ") + toString(status.state) + "; allowed: ready, disabled";
  }
  if (!status.homed) return "the axes are not homed; home them first";
  if (!status.position_valid) return "the drive gives no valid, fresh positions";
  return "";
}

}  // namespace

OffsetDesk::OffsetDesk(const ros::NodeHandle& private_nh, const ControlLoop& loop, JobGate& gate, OffsetStore& store)
    : loop_(loop), gate_(gate), store_(store) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  offsets_ = nh.advertise<WorkOffsets>("offsets", 10, true);
  publish();
  services_.push_back(nh.advertiseService("set_offset", &OffsetDesk::onSet, this));
  services_.push_back(nh.advertiseService("touch_off", &OffsetDesk::onTouchOff, this));
  thread_.start();
}

bool OffsetDesk::onSet(SetOffset::Request& request, SetOffset::Response& response) {
  response.message = set(request.axis, request.set_by, [&](double) { return request.value; });
  response.success = static_cast<std::uint8_t>(response.message.empty());
  return true;
}

bool OffsetDesk::onTouchOff(TouchOff::Request& request, TouchOff::Response& response) {
  response.message =
      set(request.axis, request.set_by, [&](double position) { return response.value = position - request.position; });
  response.success = static_cast<std::uint8_t>(response.message.empty());
  return true;
}

/// @return why the offset was not set; empty if it was.
std::string OffsetDesk::set(const std::string& axis, const std::string& set_by, const OffsetAt& offset_at) {
  const int index = axisOf(axis);
  std::string refused;
  if (index == kAxisCount) {
    refused = "axis = " + (isPlainName(axis) ? axis : "(not printable)") + "; allowed: axis_x, axis_y, axis_z, axis_a";
  } else if (!isPlainName(set_by)) {
    refused = nameRefusal("set_by", set_by);
  } else if (!gate_.shutOutJobs()) {
    const LoopStatus status = loop_.status();
    refused = isInJob(status.state) ? refusal(status) : "a job is being planned, or ends; allowed: after its end";
  } else {
    refused = setWithoutJob(index, set_by, offset_at);
    gate_.letJobsIn();
  }
  if (!refused.empty()) ROS_WARN_STREAM("work offset not set: " << refused);
  return refused;
}

std::string OffsetDesk::setWithoutJob(int axis, const std::string& set_by, const OffsetAt& offset_at) {
  const LoopStatus status = loop_.status();
  std::string refused = refusal(status);
  if (!refused.empty()) return refused;
  const auto i = static_cast<std::size_t>(axis);
  core::WorkOffset offset;
  offset.value = offset_at(status.position[i]);
  offset.set_by = set_by;
  offset.set_at = ros::WallTime::now().toSec();
  const Unit unit = unitOf(axis, 0);
  if (!(std::abs(offset.value) <= kLargestOffset)) {
    return std::string("work offset of ") + kJointNames[i] + " = " +
           text(Quantity{offset.value, unit}, UnitSystem::kSi) +
           "; allowed: " + text(Quantity{-kLargestOffset, unit}, Quantity{kLargestOffset, unit}, UnitSystem::kSi);
  }
  try {
    store_.set(axis, offset);
  } catch (const KeptFileError& error) {
    return error.what();
  }
  ROS_INFO_STREAM("work offset of " << kJointNames[i] << " = " << text(Quantity{offset.value, unit}, UnitSystem::kSi, 9)
                                    << ", set by " << set_by);
  publish();
  return "";
}

void OffsetDesk::publish() {
  WorkOffsets message;
  const core::WorkOffsets offsets = store_.offsets();
  message.header.stamp = ros::Time::now();
  for (std::size_t i = 0; i < offsets.axes.size(); ++i) {
    message.values[i] = offsets.axes[i].value;
    message.set_by[i] = offsets.axes[i].set_by;
    message.set_at[i] = ros::Time(offsets.axes[i].set_at);
  }
  message.error = store_.unknown();
  offsets_.publish(message);
}

}  // namespace flute_grinder
