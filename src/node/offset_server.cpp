#include "node/offset_server.h"

#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/messages/reasons.h"
#include "node/plain_name.h"

#include <array>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

namespace grinder {

namespace {

/// Time between attempts to save after an error [s].
constexpr double kSavePeriod = 1;

bool isDigest(const std::string& text) {
  constexpr std::size_t digits = 64;
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Why this cannot be the basis of an offset; empty if it can.
std::string basisRefusal(const flute_grinder::OffsetBasis& basis) {
  for (const auto& [name, value, last] : {std::tuple("method", basis.method, countOf<OffsetMethod>() - 1),
                                          std::tuple("kind", basis.kind, countOf<OperationKind>() - 1),
                                          std::tuple("before", basis.before, countOf<OperationKind>() - 1)}) {
    if (value > last) return format("basis.%s = %d; allowed: 0 to %d", name, value, last);
  }
  if (!isPlainName(basis.job_name)) return nameRefusal("basis.job_name", basis.job_name);
  if (!isPlainName(basis.wheel_name)) return nameRefusal("basis.wheel_name", basis.wheel_name);
  for (const auto& [name, digest] :
       {std::pair("wheel_digest", &basis.wheel_digest), std::pair("tool_digest", &basis.tool_digest)}) {
    if (!digest->empty() && !isDigest(*digest)) {
      return std::string("basis.") + name + "; allowed: 64 hexadecimal digits, or none";
    }
  }
  for (const double figure :
       {basis.end_diameter, basis.wheel_diameter, basis.wheel_width, basis.wheel_rim, basis.swivel, basis.height}) {
    if (!std::isfinite(figure)) return "basis has a figure that is not finite; allowed: those of a job";
  }
  return "";
}

/// Why the axes of a request are wrong; empty if they are right.
std::string axesRefusal(const flute_grinder::TouchOff::Request& request) {
  return request.axis < kAxisCount ? "" : axisRefusal(request.axis);
}
std::string axesRefusal(const flute_grinder::SetOffsets::Request& request) {
  const std::size_t axes = request.axes.size(), values = request.values.size();
  if (axes == 0 || axes != values) {
    return "axes has " + std::to_string(axes) + " entries, values " + std::to_string(values) +
           "; allowed: a value for each axis, of one axis at least";
  }
  std::array<bool, kAxisCount> named{};
  for (const std::uint8_t axis : request.axes) {
    if (axis >= kAxisCount) return axisRefusal(axis);
    if (std::exchange(named[axis], true)) return "axes has " + axisName(axis) + " twice; allowed: each axis once";
  }
  return "";
}

/// Why a request is wrong whatever the state; empty if it is right.
template <typename Request>
std::string requestRefusal(const Request& request) {
  std::string wrong = axesRefusal(request);
  if (!wrong.empty()) return wrong;
  if (!isPlainName(request.set_by)) return nameRefusal("set_by", request.set_by);
  const std::string refused = answersRefusal(request.answers);
  return refused.empty() ? basisRefusal(request.basis) : refused;
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

/// Why an offset cannot be set for a job; empty if it can.
std::string wheelRefusal(const WorkOffsets& offsets, int axis, const OffsetBasis& job) {
  if (axis == kA || !job.hasJob() || !offsets.wheel.isKnown() || isMounted(offsets.wheel, job)) return "";
  return "the wheel on the spindle is " + mountedText(offsets.wheel) + "; allowed: for " + wheelText(job) +
         " once it is mounted: grind confirm-wheel JOB";
}

/// Sets an offset and the state that depends on it. @param offset the offset, without its mounting and found_at.
void setIn(WorkOffsets& offsets, int axis, WorkOffset offset) {
  WorkOffset& was = offsets.axes[static_cast<std::size_t>(axis)];
  const OffsetBasis& basis = offset.basis;
  offset.mounting = offsets.wheel.mounting;
  offset.found_at = basis.method == OffsetMethod::kCorrection ? was.found_at : offset.set_at;
  if (axis == kA) {
    const bool probed = basis.method == OffsetMethod::kProbe && !basis.tool_digest.empty();
    const bool same = probed && basis.tool_digest == offsets.tool.digest;
    const std::uint32_t ground = same ? offsets.tool.ground : 0;
    if (probed) {
      offsets.tool = {basis.tool_digest, basis.job_name, ground, {}, offsets.tool.clamping};
    } else {
      offsets.tool.forget(TeethUnknown::kSet);
    }
  }
  was = std::move(offset);
}

/// The offset as set, for the log.
std::string saidOf(int axis, const WorkOffset& offset) {
  return std::string("work offset of ") + kJointNames[static_cast<std::size_t>(axis)] + " = " +
         text(Quantity{offset.value, unitOf(axis, 0)}, 9) + ", " + basisText(axis, offset) + ", by " + offset.set_by;
}

}  // namespace

OffsetServer::OffsetServer(const ros::NodeHandle& private_nh, const ControlLoop& loop, JobGate& gate,
                           OffsetStore& store, const OffsetLimits& limits)
    : loop_(loop), gate_(gate), store_(store), limits_(limits), thread_(kSavePeriod, [this] { saveNotes(); }) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  offsets_ = nh.advertise<flute_grinder::WorkOffsets>("offsets", 10, true);
  publish();
  services_.push_back(nh.advertiseService("set_offsets", &OffsetServer::onSet, this));
  services_.push_back(nh.advertiseService("touch_off", &OffsetServer::onTouchOff, this));
  services_.push_back(nh.advertiseService("confirm_wheel", &OffsetServer::onConfirmWheel, this));
  services_.push_back(nh.advertiseService("reclamped", &OffsetServer::onReclamped, this));
  thread_.start();
}

bool OffsetServer::onSet(flute_grinder::SetOffsets::Request& request, flute_grinder::SetOffsets::Response& response) {
  const auto offsets_at = [&](const Axes&) {
    OffsetValues values;
    for (std::size_t i = 0; i < request.axes.size(); ++i) values[request.axes[i]] = request.values[i];
    return values;
  };
  set(request, fromMessage(request.basis).method, offsets_at, response);
  return true;
}

bool OffsetServer::onTouchOff(flute_grinder::TouchOff::Request& request, flute_grinder::TouchOff::Response& response) {
  double value = 0;
  const auto offsets_at = [&](const Axes& position) {
    value = position[request.axis] - request.position;
    return OffsetValues{{request.axis, value}};
  };
  set(request, OffsetMethod::kTouchOff, offsets_at, response);
  if (response.success != 0) response.value = value;
  return true;
}

template <typename Request, typename Response>
void OffsetServer::set(const Request& request, OffsetMethod method, const OffsetsAt& offsets_at, Response& response) {
  std::vector<Need> needs;
  withoutJob(
      [&] {
        const std::string refused = requestRefusal(request);
        if (!refused.empty()) return refused;
        WorkOffset offset;
        offset.set_by = request.set_by;
        offset.basis = fromMessage(request.basis);
        offset.basis.method = method;
        return setWithoutJob(std::move(offset), offsets_at, request.answers, needs);
      },
      response);
  response.needs = toMessage(needs);
}

bool OffsetServer::onConfirmWheel(flute_grinder::ConfirmWheel::Request& request,
                                  flute_grinder::ConfirmWheel::Response& response) {
  withoutJob(
      [&]() -> std::string {
        if (!isPlainName(request.set_by)) return nameRefusal("set_by", request.set_by);
        const std::string refused = basisRefusal(request.job);
        if (!refused.empty()) return refused;
        const OffsetBasis job = fromMessage(request.job);
        if (!job.hasJob()) return "job.wheel_digest is empty; allowed: of the wheel of a job";
        if (isMounted(store_.offsets().wheel, job) && !request.again) return "";
        return mount(job, request.set_by);
      },
      response);
  return true;
}

bool OffsetServer::onReclamped(flute_grinder::Reclamped::Request& request,
                               flute_grinder::Reclamped::Response& response) {
  withoutJob(
      [&]() -> std::string {
        if (!isPlainName(request.set_by)) return nameRefusal("set_by", request.set_by);
        const auto clamp = [](WorkOffsets& offsets) {
          offsets.tool.forget(TeethUnknown::kClamped);
          ++offsets.tool.clamping;
        };
        return changed(clamp, "a tool was clamped, by " + request.set_by);
      },
      response);
  return true;
}

/// Acts while no job is planned or running. @param act action that returns why it failed; empty if it succeeded.
template <typename Response>
void OffsetServer::withoutJob(const std::function<std::string()>& act, Response& response) {
  std::string refused;
  if (gate_.lockOutJobs()) {
    refused = act();
    gate_.letJobsIn();
  } else {
    const LoopStatus status = loop_.status();
    refused = isInJob(status.state) ? refusal(status) : "a job is being planned, or ends; allowed: after its end";
  }
  if (!refused.empty()) ROS_WARN_STREAM("refused: " << refused);
  response.success = static_cast<std::uint8_t>(refused.empty());
  response.message = refused;
}

/// Changes the store. @param done text for the log. @return why it was not changed; empty if it was.
std::string OffsetServer::changed(const OffsetStore::Change& change, const std::string& done) {
  try {
    store_.change(change);
  } catch (const StateFileError& error) {
    return error.what();
  }
  ROS_INFO_STREAM(done);
  publish();
  return "";
}

void OffsetServer::note(const OffsetStore::Change& change) {
  store_.changeAtOnce(change);
  thread_.post([this] {
    unsaved_ = true;
    saveNotes();
    publish();
  });
}

void OffsetServer::saveNotes() {
  if (!unsaved_) return;
  try {
    store_.change([](WorkOffsets&) {});
    unsaved_ = said_ = false;
  } catch (const StateFileError& error) {
    if (said_) return;
    said_ = true;
    ROS_ERROR_STREAM(error.what() << "; what happened to the tool in the collet is lost if the node ends before it can "
                                     "be written");
  }
}

void OffsetServer::noteHoming() {
  if (store_.offsets().tool.digest.empty()) return;
  note([](WorkOffsets& offsets) { offsets.tool.forget(TeethUnknown::kHomed); });
}

void OffsetServer::noteGrinding(const OffsetBasis& job, bool whole) {
  if (job.kind != OperationKind::kFlute) return;
  note([=](WorkOffsets& offsets) {
    const bool goes_on = !whole && offsets.tool.digest == job.tool_digest;
    // The flutes ground before A was homed may have another reference than the rest.
    if (!whole && offsets.tool.unknown == TeethUnknown::kHomed) return;
    offsets.tool = {job.tool_digest, job.job_name, goes_on ? offsets.tool.ground : 0, {}, offsets.tool.clamping};
  });
}

void OffsetServer::noteFinished(const Progress& last) {
  if (!last.finished || last.tool_digest.empty()) return;
  const auto is_it = [=](const ClampedTool& tool) {
    return tool.digest == last.tool_digest && tool.clamping == last.clamping && !tool.isGround(last.kind);
  };
  if (!is_it(store_.offsets().tool)) return;
  note([=](WorkOffsets& offsets) {
    if (is_it(offsets.tool)) offsets.tool.ground |= ClampedTool::bitOf(last.kind);
  });
}

std::future<std::string> OffsetServer::carryOut(NeedAnswer answer, const OffsetBasis& job, const std::string& by) {
  const auto done = std::make_shared<std::promise<std::string>>();
  thread_.post([=] { done->set_value(answer == NeedAnswer::kConfirmWheel ? mount(job, by) : fit(job, by)); });
  return done->get_future();
}

std::string OffsetServer::mount(const OffsetBasis& job, const std::string& by) {
  return changed(
      [&job](WorkOffsets& offsets) {
        MountedWheel& wheel = offsets.wheel;
        // Offsets set before any wheel was confirmed carry their own wheel.
        const std::uint32_t mounting = wheel.mounting + (wheel.isKnown() ? 1 : 0);
        wheel = {job.wheel_name, job.wheel_digest, job.wheel_diameter, job.wheel_rim, mounting};
      },
      "wheel on the spindle: " + wheelText(job) + ", by " + by);
}

/// Sets all offsets that can be computed for a job, or none.
std::string OffsetServer::fit(const OffsetBasis& job, const std::string& by) {
  const std::string refused = refusal(loop_.status());
  if (!refused.empty()) return refused;
  const WorkOffsets now = store_.offsets();
  NewOffsets fitted;
  for (const OffsetMismatch& mismatch : mismatches(now, job)) {
    if (!mismatch.change) continue;
    WorkOffset offset{now.axes[static_cast<std::size_t>(mismatch.axis)].value + *mismatch.change, by,
                      ros::WallTime::now().toSec(), job};
    offset.basis.method = OffsetMethod::kComputed;
    const std::string beyond = travelRefusal(limits_, mismatch.axis, offset.value);
    if (!beyond.empty()) return beyond;
    fitted.emplace(mismatch.axis, std::move(offset));
  }
  return setAll(fitted);
}

/// Sets offsets, all of them or none. @return why none was set; empty if they were.
std::string OffsetServer::setAll(const NewOffsets& fresh) {
  std::string done;
  for (const auto& [axis, offset] : fresh) done += (done.empty() ? "" : "; ") + saidOf(axis, offset);
  return changed(
      [&fresh](WorkOffsets& offsets) {
        for (const auto& [axis, offset] : fresh) setIn(offsets, axis, offset);
      },
      done);
}

std::string OffsetServer::setProbed(int axis, double value, const WorkOffsets& before,
                                    const flute_grinder::ProbeGoal& goal, std::vector<Need>& needs) {
  WorkOffset offset;
  offset.set_by = goal.set_by;
  offset.basis = basisOf(goal.job, OffsetMethod::kProbe);
  const auto answer = std::make_shared<std::promise<std::string>>();
  std::future<std::string> answered = answer->get_future();
  thread_.post([=, &needs, answers = goal.answers, x = before.axes[kX].value] {
    if (axis == kA && store_.offsets().axes[kX].value != x) {
      return answer->set_value("the work offset of X was changed meanwhile; probe again");
    }
    answer->set_value(setWithoutJob(
        offset,
        [=](const Axes&) {
          return OffsetValues{{axis, value}};
        },
        answers, needs));
  });
  return answered.get();
}

/// Sets offsets, all of them or none. @param offset an offset without its value and time, the same for all axes.
/// @param needs what must be answered first. @return why none was set; empty if they were.
std::string OffsetServer::setWithoutJob(WorkOffset offset, const OffsetsAt& offsets_at,
                                        const std::vector<std::string>& answers, std::vector<Need>& needs) {
  const LoopStatus status = loop_.status();
  std::string refused = refusal(status);
  if (!refused.empty()) return refused;
  const WorkOffsets now = store_.offsets();
  offset.set_at = ros::WallTime::now().toSec();
  const OffsetValues values = offsets_at(Axes(status.position.data()));
  NewOffsets fresh;
  for (const auto& [axis, value] : values) {
    refused = wheelRefusal(now, axis, offset.basis);
    if (!refused.empty()) return refused;
    if (offset.basis.method == OffsetMethod::kCorrection) {
      refused = correctionRefusal(now, axis, offset.basis);
      if (!refused.empty()) return refused;
    }
    refused = travelRefusal(limits_, axis, value);
    if (!refused.empty()) return refused;
    offset.value = value;
    fresh.emplace(axis, offset);
  }
  const auto need = needOfChange(limits_, now, values);
  if (need && !isAnswered(*need, answers)) {
    needs = {*need};
    return need->text;
  }
  return setAll(fresh);
}

void OffsetServer::publish() {
  flute_grinder::WorkOffsets message = toMessage(store_.offsets());
  message.header.stamp = ros::Time::now();
  message.error = store_.unknown();
  offsets_.publish(message);
}

}  // namespace grinder
