#include "flute_grinder/control/control_loop.h"

#include "flute_grinder/control/realtime.h"

#include <algorithm>
#include <chrono>
#include <string>

// What other threads call, and the loop's own thread; the cycle is in control_loop.cpp.
namespace flute_grinder {

namespace {

using Clock = std::chrono::steady_clock;

/// How long a request waits for the loop beyond what it may take by itself [s].
constexpr double kAnswerTimeout = 2;
/// How long a stop waits for its answer [s].
constexpr double kStopTimeout = 0.1;

template <typename Interface>
Interface& require(RobotHW& hw, const char* name) {
  auto* interface = hw.get<Interface>();
  if (!interface) throw HardwareInterfaceException(std::string("the drive offers no ") + name);
  return *interface;
}

/// Looks for an answer until there is one.
/// @param poll gives the answer, or nothing yet.
/// @param timeout [s].
template <typename Poll>
RequestReply await(MachineEvent event, double timeout, const Poll& poll) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(timeout);
  while (Clock::now() < deadline) {
    if (const std::optional<RequestReply> answer = poll()) return *answer;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return {false, std::string(toString(event)) + ": the control loop does not answer", false};
}

}  // namespace

ControlLoop::ControlLoop(RobotHW& hw, const LoopConfig& config, const Wheel& wheel)
    : hw_(hw), config_(config), lift_(config.machine), limit_check_(config.machine.limits, config.machine.period) {
  require<JointStateInterface>(hw, "JointStateInterface");
  auto& joints = require<PositionJointInterface>(hw, "PositionJointInterface");
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = joints.getHandle(kJointNames[i]);
  drive_ = require<DriveInterface>(hw, "DriveInterface").getHandle("drive");
  now_.wheel = wheel;
  status_.store(now_);
}

ControlLoop::~ControlLoop() { stopThread(); }

void ControlLoop::startThread() {
  running_ = true;
  memory_locked_ = lockMemory();
  thread_ = std::thread([this] { run(); });
}

void ControlLoop::stopThread() {
  if (!thread_.joinable()) return;
  running_ = false;
  thread_.join();
}

void ControlLoop::run() {
  realtime_scheduling_ = becomeRealtime();
  const ros::Duration nominal(config_.machine.period);
  // The computer's clock, since that of ROS may stand at 0 until a simulation tells the time.
  const ros::WallTime wall = ros::WallTime::now();
  const ros::Time start_time(wall.sec, wall.nsec);
  const Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  const auto nanoseconds = [](Clock::duration d) {
    return ros::Duration().fromNSec(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count());
  };
  while (running_) {
    hw_.wait(nominal);
    const Clock::time_point now = Clock::now();
    cycle(start_time + nanoseconds(now - start), nanoseconds(now - last));
    last = now;
  }
  drive_command_ = DriveCommand{};
  drive_.setCommand(drive_command_);
  hw_.write(start_time + nanoseconds(last - start), nominal);
}

RequestReply ControlLoop::request(MachineEvent event) {
  if (!isTrigger(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: " + namesOf<MachineEvent>(isTrigger), true};
  }
  bool posted = false;
  return await(event, kAnswerTimeout + config_.enable_timeout, [&]() -> std::optional<RequestReply> {
    // The slot may still hold a request that was given up.
    if (posted) return reply();
    posted = post(event);
    return std::nullopt;
  });
}

RequestReply ControlLoop::stop(MachineEvent event) {
  if (!isStop(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: hold, cancel, disable", true};
  }
  const std::uint32_t ticket = postAskedStop(event);
  return await(event, kStopTimeout, [&] { return stopReply(event, ticket); });
}

bool ControlLoop::postStart(SetpointStream* stream) noexcept {
  return starts_.post(Start{stream, wheelOf(stream->program())});
}

std::optional<RequestReply> ControlLoop::startReply() {
  if (const auto answer = starts_.reply()) return answer->reply();
  return std::nullopt;
}

std::optional<RequestReply> ControlLoop::reply() {
  if (const auto answer = requests_.reply()) return answer->reply();
  return std::nullopt;
}

std::optional<RequestReply> ControlLoop::stopReply(MachineEvent event, std::uint32_t ticket) const {
  if (const auto answer = stops_.reply(event, ticket)) return answer->reply();
  return std::nullopt;
}

bool ControlLoop::setFeedOverride(double fraction) {
  if (!(fraction >= 0 && fraction <= kMaxFeedOverride)) return false;
  feed_override_ = fraction;
  return true;
}

}  // namespace flute_grinder
