#include "flute_grinder/operator/online.h"

#include "flute_grinder/GrindAction.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/node/conversions.h"
#include "flute_grinder/operator/continue_job.h"
#include "flute_grinder/operator/csv.h"
#include "flute_grinder/operator/offline.h"

#include <actionlib/client/simple_action_client.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <optional>

namespace flute_grinder {

namespace {

const ros::Duration kPatience(10);  ///< with a node that is only just coming up

std::atomic<bool> interrupted{false};

int fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  return 1;
}

/// Waits for a condition. @return whether it came true in time.
template <typename Condition>
bool await(const ros::Duration& timeout, Condition condition) {
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(timeout.toSec());
  while (ros::ok() && !condition()) {
    if (ros::SteadyTime::now() > end) return false;
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

/// Takes the setpoints as they are streamed, counts them and writes them to a file.
class Recorder {
 public:
  Recorder(ros::NodeHandle& nh, std::string csv) : path_(std::move(csv)) {
    subscriber_ = nh.subscribe("setpoints", 1000, &Recorder::onBatch, this);
  }

  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  std::uint64_t received() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return received_;
  }
  std::uint64_t missed() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return missed_;
  }
  /// From the first setpoint to the last, by the clock of the grinder [s].
  double duration() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return (end_ - begin_).toSec();
  }
  /// Ends the record. @throw FileError
  void close() {
    subscriber_.shutdown();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_.empty()) throw FileError(error_);
    if (csv_) csv_->close();
  }

 private:
  void onBatch(const SetpointBatch::ConstPtr& batch) {
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      if (!csv_ && !path_.empty()) csv_.emplace(path_, batch->period);
      if (received_ == 0) begin_ = batch->header.stamp;
      end_ = batch->end_stamp;
      for (const WrittenSetpoint& setpoint : batch->setpoints) {
        missed_ += setpoint.cycle - next_cycle_;
        next_cycle_ = setpoint.cycle + 1;
        ++received_;
        if (csv_) csv_->write(fromMessage(setpoint));
      }
    } catch (const FileError& error) {
      error_ = error.what();
    }
  }

  std::string path_;
  ros::Subscriber subscriber_;
  mutable std::mutex mutex_;
  std::optional<SetpointCsv> csv_;
  std::string error_;
  std::uint64_t received_ = 0;
  std::uint64_t missed_ = 0;
  std::uint64_t next_cycle_ = 0;
  ros::Time begin_, end_;
};

std::optional<GrinderState> stateOf(ros::NodeHandle& nh) {
  const auto state = ros::topic::waitForMessage<GrinderState>("state", nh, kPatience);
  if (!state) return std::nullopt;
  return *state;
}

int noGrinder(const ros::NodeHandle& nh) { return fail("no grinder answers as " + nh.getNamespace()); }

/// Shows the feedback: a bar that grows on a terminal, a line for each tenth and each state in a file.
void showProgress(const GrindFeedback::ConstPtr& f) {
  static const bool terminal = isatty(STDERR_FILENO) != 0;
  static int tenths = -1;
  static std::string state;
  const int now = static_cast<int>(f->job_fraction * 10);
  if (!terminal && now == tenths && f->state == state) return;
  tenths = now;
  state = f->state;
  std::string bar(30, '.');
  bar.replace(0, static_cast<std::size_t>(f->job_fraction * 30), static_cast<std::size_t>(f->job_fraction * 30), '#');
  std::fprintf(stderr, "%s[%s] %3.0f %%  %s  tooth %d  pass %d  X %7.3f mm  %.0f mm/min  %.1f s left%s",
               terminal ? "\r" : "", bar.c_str(), f->job_fraction * 100, f->state.c_str(), f->tooth + 1, f->pass + 1,
               f->x / units::kMillimetre, f->feed / units::kMillimetrePerMinute, f->remaining_time,
               terminal ? "\x1b[K" : "\n");
  std::fflush(stderr);
}

void printProgress(const JobProgress& progress) {
  if (progress.job_digest.empty()) return;
  std::printf("last job        %.12s, ", progress.job_digest.c_str());
  if (progress.finished) {
    std::printf("finished\n");
  } else {
    std::printf("tooth %d, pass %d not finished, X %.3f mm\n", progress.tooth + 1, progress.pass + 1,
                progress.x / units::kMillimetre);
  }
}

}  // namespace

bool awaitMaster() {
  if (await(kPatience, [] { return ros::master::check(); })) return true;
  fail("no ROS master answers at " + ros::master::getURI());
  return false;
}

int runJob(const RunOptions& options) {
  const GrindJob job = readJobFile(options.job);
  ros::NodeHandle nh(options.node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  using Client = actionlib::SimpleActionClient<GrindAction>;
  Client client(nh, "grind", false);
  Recorder recorder(nh, options.csv);
  if (!client.waitForServer(kPatience) || !await(kPatience, [&] { return recorder.connected(); })) {
    return noGrinder(nh);
  }
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });

  GrindGoal goal = goalFromJob(job);
  goal.dry_run = options.dry_run;
  if (options.go_on) {
    const auto state = stateOf(nh);
    if (!state) return noGrinder(nh);
    const std::string refusal = continueFrom(state->progress, job, goal);
    if (!refusal.empty()) return fail(refusal);
  }
  client.sendGoal(goal, Client::SimpleDoneCallback(), Client::SimpleActiveCallback(), &showProgress);
  bool canceling = false;
  while (!client.waitForResult(ros::Duration(0.05)) && ros::ok()) {
    if (!interrupted || canceling) continue;
    canceling = true;
    std::fprintf(stderr, "\ncanceling: waiting for the stop\n");
    client.cancelGoal();
  }
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\n");
  if (!client.getState().isDone()) return fail("the link to the grinder is lost");

  const auto result = client.getResult();
  const bool good = client.getState() == actionlib::SimpleClientGoalState::SUCCEEDED && result->error_code == 0;
  // The last setpoints may come after the result, by another connection.
  const std::uint64_t expected = result->setpoints_written;
  await(ros::Duration(2), [&] { return recorder.received() + recorder.missed() >= expected; });
  const std::uint64_t received = recorder.received();
  recorder.close();

  if (result->statistics.setpoints > 0) printStatistics(fromMessage(result->statistics));
  if (received > 0) {
    std::printf("streamed             %llu setpoints in %.3f s, %llu missed\n",
                static_cast<unsigned long long>(received), recorder.duration(),
                static_cast<unsigned long long>(expected - received));
    if (!options.csv.empty()) std::printf("setpoints written to %s\n", options.csv.c_str());
  }
  if (!good) return fail(result->error_string + " (code " + std::to_string(result->error_code) + ")");
  return 0;
}

int printStatus(const std::string& node) {
  ros::NodeHandle nh(node);
  const auto state = stateOf(nh);
  if (!state) return noGrinder(nh);
  std::printf("state           %s\n", state->state_name.c_str());
  std::printf("enabled         %s\n", state->enabled ? "yes" : "no");
  std::printf("homed           %s\n", state->homed ? "yes" : "no");
  std::printf("spindle         %s\n", state->spindle_at_speed ? "at speed" : "not at speed");
  std::printf("coolant         %s\n", state->coolant_on ? "on" : "off");
  std::printf("emergency stop  %s\n", state->emergency_stop ? "pressed" : "released");
  std::printf("feed            %.1f mm/min, override %.0f %%\n", state->feed / units::kMillimetrePerMinute,
              state->override * 100);
  if (state->state >= GrinderState::STARTING && state->state <= GrinderState::CANCELING) {
    std::printf("tooth, pass     %d, %d\n", state->tooth + 1, state->pass + 1);
  }
  if (!state->hold_reason.empty()) std::printf("held because    %s\n", state->hold_reason.c_str());
  if (!state->fault.empty()) std::printf("fault           %s\n", state->fault.c_str());
  printProgress(state->progress);
  return 0;
}

int callTrigger(const std::string& node, const std::string& service) {
  ros::NodeHandle nh(node);
  ros::ServiceClient client = nh.serviceClient<std_srvs::Trigger>(service);
  std_srvs::Trigger call;
  if (!await(kPatience, [&] { return client.exists(); }) || !client.call(call)) return noGrinder(nh);
  return call.response.success ? 0 : fail(call.response.message);
}

int home(const std::string& node) {
  if (const int status = callTrigger(node, "home")) return status;
  ros::NodeHandle nh(node);
  // A state that was published before the call does not count.
  const ros::Time called = ros::Time::now();
  while (ros::ok()) {
    const auto state = stateOf(nh);
    if (!state) return noGrinder(nh);
    if (state->header.stamp < called || state->state == GrinderState::HOMING) continue;
    if (state->homed) return 0;
    return fail(state->fault.empty() ? "homing was broken off" : state->fault);
  }
  return 1;
}

int setFeedOverride(const std::string& node, double percent) {
  ros::NodeHandle nh(node);
  ros::ServiceClient client = nh.serviceClient<SetFeedOverride>("set_feed_override");
  SetFeedOverride call;
  call.request.fraction = percent / 100;
  if (!await(kPatience, [&] { return client.exists(); }) || !client.call(call)) return noGrinder(nh);
  return call.response.success ? 0 : fail(call.response.message);
}

}  // namespace flute_grinder
