#include "flute_grinder/GrindAction.h"
#include "flute_grinder/cli/interrupt.h"
#include "flute_grinder/cli/offline.h"
#include "flute_grinder/cli/online.h"
#include "flute_grinder/cli/progress_bar.h"
#include "flute_grinder/cli/recorder.h"
#include "flute_grinder/cli/state_watch.h"
#include "flute_grinder/cli/stop_keys.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/messages/continue_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/reasons.h"

#include <actionlib/client/simple_action_client.h>

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

namespace flute_grinder {

namespace {

using Client = actionlib::SimpleActionClient<GrindAction>;

/// What a goal has told of itself. It is shown by another thread than the one that hears it, which a terminal that
/// stands still must not keep from hearing the grinder. Thread safe.
class GoalWatch {
 public:
  void onFeedback(const GrindFeedbackConstPtr& feedback) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = feedback;
  }
  void onDone(bool succeeded, const GrindResultConstPtr& result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
    succeeded_ = succeeded;
    result_ = result;
  }
  /// Null if there is none that was not taken yet.
  GrindFeedbackConstPtr takeFeedback() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(newest_, nullptr);
  }
  bool done() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return done_;
  }
  bool succeeded() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return succeeded_;
  }
  /// Null while there is none, and where the grinder knows nothing of the goal any more.
  GrindResultConstPtr result() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return result_;
  }

 private:
  mutable std::mutex mutex_;
  GrindFeedbackConstPtr newest_;
  bool done_ = false, succeeded_ = false;
  GrindResultConstPtr result_;
};

/// Tells what the operator has asked for by keys, and why the grinder holds.
class Remarks {
 public:
  explicit Remarks(ProgressBar& bar) : bar_(bar) {}

  void make(const GrinderState& state) {
    if (state.hold_reason != hold_reason_ && !state.hold_reason.empty()) {
      bar_.say("held: " + state.hold_reason + "; when it is well again, 'grind resume' goes on");
    }
    hold_reason_ = state.hold_reason;
    if (std::exchange(holds_seen_, holds()) != holds_seen_) {
      bar_.say("holding: 'grind resume' goes on, Ctrl-C cancels");
    }
    const int seen = std::exchange(interrupts_seen_, interrupts());
    if (seen == interrupts_seen_) return;
    bar_.say(seen == 0 ? "canceling: waiting for the stop"
                       : "canceling: still waiting for the stop; the machine is " + state.state_name);
  }

 private:
  ProgressBar& bar_;
  std::string hold_reason_;
  int interrupts_seen_ = 0, holds_seen_ = 0;
};

/// Shows how a goal goes, to its end. @return false if the link is lost.
bool follow(GoalWatch& goal, const StateWatch& watch, ProgressBar& bar) {
  Remarks remarks(bar);
  const auto show = [&] {
    if (const auto newest = goal.takeFeedback()) bar.show(*newest);
  };
  while (!goal.done()) {
    if (watch.lost()) return false;
    remarks.make(watch.newest());
    show();
    ros::WallDuration(0.01).sleep();
  }
  remarks.make(watch.newest());
  // The last feedback may come after the result, by another connection.
  if (goal.succeeded()) {
    await(ros::WallDuration(1), [&] { return show(), bar.complete(); });
  }
  return true;
}

/// @param written to the drive, by the goal's result; 0 where that is not known.
void printStream(const Recorder& recorder, std::uint64_t written) {
  recorder.awaitAll(written);
  if (recorder.received() == 0 && recorder.lost() == 0) return;
  std::printf("streamed             %llu setpoints in %.3f s, %llu missed",
              static_cast<unsigned long long>(recorder.received()), recorder.duration(),
              static_cast<unsigned long long>(recorder.missed(written)));
  if (recorder.lost() > 0) {
    std::printf(", %llu written but not told", static_cast<unsigned long long>(recorder.lost()));
  }
  std::printf("\n");
}

/// Prints what has become of a goal. @param heard whether the link held to its end. @return the exit status.
int conclude(const GoalWatch& goal, bool heard, const Recorder& recorder) {
  const GrindResultConstPtr result = goal.result();
  if (result && result->statistics.setpoints > 0) printStatistics(fromMessage(result->statistics));
  printStream(recorder, result ? result->setpoints_written : 0);
  if (!heard) return fail(kLinkLost);
  if (!result) return fail("the grinder knows nothing of the job any more: it has been started anew");
  if (goal.succeeded() && result->error_code == 0) return 0;
  return fail(resultText(*result) + " (code " + std::to_string(result->error_code) + ")");
}

/// Ends the record, after all that is to be said of the job. @param status so far. @return the exit status.
int closeRecord(Recorder& recorder, const std::string& csv, int status) {
  try {
    recorder.close();
  } catch (const FileError& error) {
    return fail(error.what());
  }
  if (!csv.empty() && recorder.received() > 0) std::printf("setpoints written to %s\n", csv.c_str());
  return status;
}

GrindGoal goalFor(const GrindJob& job, const RunOptions& options) {
  GrindGoal goal = goalFromJob(job);
  goal.dry_run = options.dry_run;
  goal.discard = options.discard;
  goal.job_name = std::filesystem::path(options.job).filename();
  return goal;
}

}  // namespace

int runJob(const RunOptions& options) {
  const GrindJob job = readJobFile(options.job);
  ros::NodeHandle nh(options.node);
  ros::AsyncSpinner spinner(1);
  Recorder recorder(nh, options.csv);
  const StateWatch watch(nh);
  // An action's client waits for a clock for ever.
  if (!await(kPatience, [] { return ros::Time::isValid(); })) return noGrinder(nh);
  GoalWatch watched;
  Client client(nh, "grind", false);
  StopKeys keys(nh, watch);
  spinner.start();
  if (!await(kPatience,
             [&] { return watch.begun() && client.isServerConnected() && recorder.connected() && keys.connected(); })) {
    return noGrinder(nh);
  }
  GrindGoal goal = goalFor(job, options);
  if (options.go_on) {
    const std::string refusal = continueFrom(watch.newest().progress, job, goal);
    if (!refusal.empty()) return fail(refusal);
  }

  ProgressBar bar(static_cast<int>(job.tooth_angles.size()), static_cast<int>(passDepths(job.process).size()));
  catchInterrupts();
  catchHolds();
  client.sendGoal(
      goal,
      [&](const actionlib::SimpleClientGoalState& state, const GrindResultConstPtr& result) {
        watched.onDone(state == actionlib::SimpleClientGoalState::SUCCEEDED, result);
      },
      Client::SimpleActiveCallback(), [&](const GrindFeedbackConstPtr& feedback) { watched.onFeedback(feedback); });
  keys.start([&] { client.cancelGoal(); });
  const bool heard = follow(watched, watch, bar);
  bar.end();
  return closeRecord(recorder, options.csv, conclude(watched, heard, recorder));
}

}  // namespace flute_grinder
