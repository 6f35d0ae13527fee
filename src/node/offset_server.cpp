#include "node/offset_server.h"

#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/job/quantity.h"
#include "flute_grinder/messages/offset_basis.h"
#include "node/plain_name.h"

#include <cmath>
#include <future>
#include <memory>
#include <utility>

namespace grinder {

namespace {

bool isDigest(const std::string& text) {
  constexpr std::size_t digits = 64;
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Why this cannot be the basis of an offset; empty if it can.
std::string basisRefusal(const flute_grinder::OffsetBasis& basis) {
  if (basis.method >= countOf<OffsetMethod>()) {
    return "basis.method = " + std::to_string(basis.method) + "; allowed: 0 to " +
           std::to_string(countOf<OffsetMethod>() - 1);
  }
  if (!isPlainName(basis.job_name)) return nameRefusal("basis.job_name", basis.job_name);
  if (!isPlainName(basis.wheel_name)) return nameRefusal("basis.wheel_name", basis.wheel_name);
  if (!basis.wheel_digest.empty() && !isDigest(basis.wheel_digest)) {
    return "basis.wheel_digest; allowed: 64 hexadecimal digits, or none";
  }
  for (const double figure :
       {basis.end_diameter, basis.wheel_diameter, basis.wheel_width, basis.swivel, basis.height}) {
    if (!std::isfinite(figure)) return "basis has a figure that is not finite; allowed: those of a job";
  }
  return "";
}

/// Why a request is wrong at any time; empty if it is not.
template <typename Request>
std::string requestRefusal(const Request& request) {
  if (request.axis >= kAxisCount) return axisRefusal(request.axis);
  if (!isPlainName(request.set_by)) return nameRefusal("set_by", request.set_by);
  return basisRefusal(request.basis);
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

OffsetServer::OffsetServer(const ros::NodeHandle& private_nh, const ControlLoop& loop, JobGate& gate,
                           OffsetStore& store, const OffsetLimits& limits)
    : loop_(loop), gate_(gate), store_(store), limits_(limits) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  offsets_ = nh.advertise<flute_grinder::WorkOffsets>("offsets", 10, true);
  publish();
  services_.push_back(nh.advertiseService("set_offset", &OffsetServer::onSet, this));
  services_.push_back(nh.advertiseService("touch_off", &OffsetServer::onTouchOff, this));
  thread_.start();
}

bool OffsetServer::onSet(flute_grinder::SetOffset::Request& request, flute_grinder::SetOffset::Response& response) {
  const auto offset_at = [&](double) { return request.value; };
  set(request, fromMessage(request.basis).method, offset_at, response);
  return true;
}

bool OffsetServer::onTouchOff(flute_grinder::TouchOff::Request& request, flute_grinder::TouchOff::Response& response) {
  const auto offset_at = [&](double position) { return response.value = position - request.position; };
  set(request, OffsetMethod::kTouchOff, offset_at, response);
  return true;
}

template <typename Request, typename Response>
void OffsetServer::set(const Request& request, OffsetMethod method, const OffsetAt& offset_at, Response& response) {
  std::string refused = requestRefusal(request);
  bool large_change = false;
  if (refused.empty() && !gate_.lockOutJobs()) {
    const LoopStatus status = loop_.status();
    refused = isInJob(status.state) ? refusal(status) : "a job is being planned, or ends; allowed: after its end";
  } else if (refused.empty()) {
    WorkOffset offset;
    offset.set_by = request.set_by;
    offset.basis = fromMessage(request.basis);
    offset.basis.method = method;
    refused = setWithoutJob(request.axis, std::move(offset), offset_at, request.large_change_ok != 0, large_change);
    gate_.letJobsIn();
  }
  if (!refused.empty()) ROS_WARN_STREAM("work offset not set: " << refused);
  response.success = static_cast<std::uint8_t>(refused.empty());
  response.message = refused;
  response.large_change = static_cast<std::uint8_t>(large_change);
}

std::string OffsetServer::setProbed(int axis, double value, const WorkOffsets& before,
                                    const flute_grinder::ProbeGoal& goal, bool& large_change) {
  WorkOffset offset;
  offset.set_by = goal.set_by;
  offset.basis = basisOf(goal.job, OffsetMethod::kProbe);
  const auto answer = std::make_shared<std::promise<std::string>>();
  std::future<std::string> answered = answer->get_future();
  thread_.post([=, &large_change, large_change_ok = goal.large_change_ok != 0, x = before.axes[kX].value] {
    if (axis == kA && store_.offsets().axes[kX].value != x) {
      return answer->set_value("the work offset of X was changed meanwhile; probe again");
    }
    answer->set_value(setWithoutJob(
        axis, offset, [=](double) { return value; }, large_change_ok, large_change));
  });
  return answered.get();
}

/// @param offset all but its value and its time. @param large_change whether it is refused because it would change by
/// too much.
/// @return why the offset was not set; empty if it was.
std::string OffsetServer::setWithoutJob(int axis, WorkOffset offset, const OffsetAt& offset_at, bool large_change_ok,
                                        bool& large_change) {
  const LoopStatus status = loop_.status();
  std::string refused = refusal(status);
  if (!refused.empty()) return refused;
  const auto i = static_cast<std::size_t>(axis);
  offset.set_at = ros::WallTime::now().toSec();
  offset.value = offset_at(status.position[i]);
  refused = travelRefusal(limits_, axis, offset.value);
  if (!refused.empty()) return refused;
  if (!large_change_ok) refused = changeRefusal(limits_, axis, store_.offsets().axes[i], offset.value);
  large_change = !refused.empty();
  if (large_change) return refused;
  try {
    store_.set(axis, offset);
  } catch (const AtomicFileError& error) {
    return error.what();
  }
  ROS_INFO_STREAM("work offset of " << kJointNames[i] << " = " << text(Quantity{offset.value, unitOf(axis, 0)}, 9)
                                    << ", " << basisText(axis, offset) << ", by " << offset.set_by);
  publish();
  return "";
}

void OffsetServer::publish() {
  flute_grinder::WorkOffsets message;
  const WorkOffsets offsets = store_.offsets();
  message.header.stamp = ros::Time::now();
  for (std::size_t i = 0; i < offsets.axes.size(); ++i) {
    message.values[i] = offsets.axes[i].value;
    message.set_by[i] = offsets.axes[i].set_by;
    message.set_at[i] = ros::Time(offsets.axes[i].set_at);
    message.basis[i] = toMessage(offsets.axes[i].basis);
  }
  message.error = store_.unknown();
  offsets_.publish(message);
}

}  // namespace grinder
