#include "flute_grinder/GrindAction.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/node/conversions.h"
#include "flute_grinder/operator/continue_job.h"
#include "flute_grinder/operator/csv.h"
#include "flute_grinder/operator/interrupt.h"
#include "flute_grinder/operator/offline.h"
#include "flute_grinder/operator/online.h"
#include "flute_grinder/operator/progress_bar.h"
#include "flute_grinder/operator/state_watch.h"

#include <actionlib/client/simple_action_client.h>

#include <cstdio>
#include <mutex>
#include <optional>

namespace flute_grinder {

namespace {

using Client = actionlib::SimpleActionClient<GrindAction>;

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

/// Follows a goal to its end. Each interrupt cancels it; what then counts is when the machine has stopped.
/// @return false if the link is lost.
bool follow(Client& client, const StateWatch& watch, ProgressBar& bar) {
  int interrupts_seen = 0;
  std::string hold_reason;
  while (!client.waitForResult(ros::Duration(0.05))) {
    if (watch.lost()) return false;
    const GrinderState state = watch.newest();
    if (state.hold_reason != hold_reason && !state.hold_reason.empty()) {
      bar.say("held: " + state.hold_reason + "; when it is well again, 'grind resume' goes on");
    }
    hold_reason = state.hold_reason;
    const int asked = interrupts();
    if (asked == interrupts_seen) continue;
    bar.say(interrupts_seen == 0 ? "canceling: waiting for the stop"
                                 : "canceling: still waiting for the stop; the machine is " + state.state_name);
    interrupts_seen = asked;
    client.cancelGoal();
  }
  return true;
}

/// Prints what has become of a goal. @return the exit status.
int conclude(const GrindResult& result, bool succeeded, Recorder& recorder, const std::string& csv) {
  // The last setpoints may come after the result, by another connection.
  const std::uint64_t expected = result.setpoints_written;
  await(ros::WallDuration(2), [&] { return recorder.received() + recorder.missed() >= expected; });
  const std::uint64_t received = recorder.received();
  recorder.close();

  if (result.statistics.setpoints > 0) printStatistics(fromMessage(result.statistics));
  if (received > 0) {
    std::printf("streamed             %llu setpoints in %.3f s, %llu missed\n",
                static_cast<unsigned long long>(received), recorder.duration(),
                static_cast<unsigned long long>(expected - received));
    if (!csv.empty()) std::printf("setpoints written to %s\n", csv.c_str());
  }
  if (succeeded && result.error_code == 0) return 0;
  return fail(result.error_string + " (code " + std::to_string(result.error_code) + ")");
}

}  // namespace

int runJob(const RunOptions& options) {
  const GrindJob job = readJobFile(options.job);
  ProgressBar bar(static_cast<int>(job.tooth_angles.size()), static_cast<int>(passDepths(job.process).size()));
  ros::NodeHandle nh(options.node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  Client client(nh, "grind", false);
  Recorder recorder(nh, options.csv);
  StateWatch watch(nh);
  if (!client.waitForServer(ros::Duration(kPatience.toSec())) || !watch.begin() ||
      !await(kPatience, [&] { return recorder.connected(); })) {
    return noGrinder(nh);
  }
  GrindGoal goal = goalFromJob(job);
  goal.dry_run = options.dry_run;
  if (options.go_on) {
    const std::string refusal = continueFrom(watch.newest().progress, job, goal);
    if (!refusal.empty()) return fail(refusal);
  }

  catchInterrupts();
  client.sendGoal(goal, Client::SimpleDoneCallback(), Client::SimpleActiveCallback(),
                  [&](const GrindFeedbackConstPtr& feedback) { bar.show(*feedback); });
  const bool heard = follow(client, watch, bar);
  const bool succeeded = client.getState() == actionlib::SimpleClientGoalState::SUCCEEDED;
  // The last feedback may come after the result, by another connection.
  if (succeeded) await(ros::WallDuration(1), [&] { return bar.complete(); });
  bar.end();
  if (!heard) return fail(kLinkLost);
  const auto result = client.getResult();
  if (!result) return fail("the grinder knows nothing of the job any more: it has been started anew");
  return conclude(*result, succeeded, recorder, options.csv);
}

}  // namespace flute_grinder
