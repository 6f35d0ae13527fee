#include "cli/answers.h"
#include "cli/history.h"
#include "cli/interrupt.h"
#include "cli/offline.h"
#include "cli/online.h"
#include "cli/progress_bar.h"
#include "cli/state_watch.h"
#include "cli/stop_keys.h"
#include "cli/stream_watch.h"
#include "flute_grinder/GrindAction.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/continue_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/user_at_host.h"

#include <actionlib/client/action_client.h>

#include <cstdio>
#include <mutex>
#include <optional>
#include <utility>

namespace grinder {

namespace {

// SimpleActionClient loses an answer that comes before its sendGoal() returns, and logs that into the progress bar.
using Client = actionlib::ActionClient<flute_grinder::GrindAction>;

/// The state of a goal. It is received by one thread and shown by another, so that a blocked terminal cannot stop
/// reception. Thread safe.
class GoalWatch {
 public:
  void onFeedback(const flute_grinder::GrindFeedbackConstPtr& feedback) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = feedback;
  }
  void onDone(bool succeeded, const flute_grinder::GrindResultConstPtr& result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
    succeeded_ = succeeded;
    result_ = result;
  }
  /// The feedback since the last call; null if there is none.
  flute_grinder::GrindFeedbackConstPtr takeFeedback() {
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
  /// The result; null before it arrives, and if the grinder no longer knows the goal.
  flute_grinder::GrindResultConstPtr result() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return result_;
  }

 private:
  mutable std::mutex mutex_;
  flute_grinder::GrindFeedbackConstPtr newest_;
  bool done_ = false, succeeded_ = false;
  flute_grinder::GrindResultConstPtr result_;
};

/// Prints a line when a job begins with a feed override, when the operator presses a stop key, and when the grinder
/// holds by itself.
class RunMessages {
 public:
  explicit RunMessages(ProgressBar& bar) : bar_(bar) {}

  void update(const flute_grinder::GrinderState& state) {
    if (!std::exchange(begun_, begun_ || inJob(state)) && begun_ && state.override != 1) {
      bar_.printLine(format("the feed override is %.0f %%", state.override * 100));
    }
    if (state.hold_reason != hold_reason_ && !state.hold_reason.empty()) {
      bar_.printLine("held: " + state.hold_reason + "; once cleared, 'grind resume' continues");
    }
    hold_reason_ = state.hold_reason;
    if (std::exchange(holds_seen_, holds()) != holds_seen_) {
      bar_.printLine("holding: 'grind resume' goes on, Ctrl-C cancels");
    }
    const int seen = std::exchange(interrupts_seen_, interrupts());
    if (seen == interrupts_seen_) return;
    bar_.printLine(seen == 0 ? "canceling: waiting for the stop"
                             : "canceling: still waiting for the stop; the machine is " + state.state_name);
  }

 private:
  ProgressBar& bar_;
  bool begun_ = false;
  std::string hold_reason_;
  int interrupts_seen_ = 0, holds_seen_ = 0;
};

/// Shows the progress of a goal to its end. @return false if the connection is lost.
bool showProgress(GoalWatch& goal, const StateWatch& watch, ProgressBar& bar) {
  RunMessages messages(bar);
  const auto show = [&] {
    if (const auto newest = goal.takeFeedback()) bar.show(*newest);
  };
  while (!goal.done()) {
    if (watch.lost()) return false;
    messages.update(watch.newest());
    show();
    ros::WallDuration(0.01).sleep();
  }
  messages.update(watch.newest());
  // The last feedback may come after the result, over another connection.
  if (goal.succeeded()) {
    await(ros::WallDuration(1), [&] { return show(), bar.complete(); });
  }
  return true;
}

/// @param written number of setpoints written to the drive, from the goal's result; 0 if unknown.
void printStream(const StreamWatch& stream, std::uint64_t written) {
  stream.awaitAll(written);
  if (stream.received() == 0 && stream.lost() == 0) return;
  std::printf("streamed             %llu setpoints in %.3f s, %llu missed",
              static_cast<unsigned long long>(stream.received()), stream.duration(),
              static_cast<unsigned long long>(stream.missed(written)));
  if (stream.lost() > 0) {
    std::printf(", %llu written but not published", static_cast<unsigned long long>(stream.lost()));
  }
  std::printf("\n");
}

/// Prints the outcome of a goal. @param connected whether the connection lasted to its end. @return the exit status.
int printOutcome(const GoalWatch& goal, bool connected, const StreamWatch& stream) {
  const flute_grinder::GrindResultConstPtr result = goal.result();
  if (result) {
    printPlan(result->plan);
    if (goal.succeeded()) {
      for (const flute_grinder::Need& need : result->plan.needs) {
        std::fprintf(stderr, "to start it: %s\n", escaped(need.text).c_str());
      }
    }
  }
  printStream(stream, result ? result->setpoints_written : 0);
  if (!connected) return fail(kLinkLost);
  if (!result) return fail("the grinder no longer knows the job: it has been restarted");
  if (goal.succeeded() && result->error_code == 0) return 0;
  return fail(result->error_string + " (code " + std::to_string(result->error_code) + ")");
}

/// Closes the CSV file, after everything about the job has been printed. @param status exit status so far. @return the
/// exit status.
int closeStream(StreamWatch& stream, const std::string& csv, int status) {
  try {
    stream.close();
  } catch (const FileError& error) {
    return fail(error.what());
  }
  if (!csv.empty() && stream.received() > 0) std::printf("setpoints written to %s\n", csv.c_str());
  return status;
}

flute_grinder::GrindGoal goalFor(const std::string& node, const RunOptions& options) {
  flute_grinder::GrindGoal goal;
  try {
    goal = goalFromFile(options.job, options.operation);
  } catch (const FileError& error) {
    const std::string done = options.operation.empty() ? doneOperations(node, options.job) : "";
    throw FileError(error.what() + (done.empty() ? "" : "; " + done));
  }
  goal.dry_run = options.dry_run;
  goal.answers = options.answers;
  goal.sent_by = userAtHost();
  return goal;
}

/// Sends a goal. @param watched must outlive the goal's handle.
Client::GoalHandle send(Client& client, const flute_grinder::GrindGoal& goal, GoalWatch& watched) {
  return client.sendGoal(
      goal,
      [&watched](Client::GoalHandle handle) {
        if (handle.getCommState() != actionlib::CommState::DONE) return;
        watched.onDone(handle.getTerminalState() == actionlib::TerminalState::SUCCEEDED, handle.getResult());
      },
      [&watched](const Client::GoalHandle&, const flute_grinder::GrindFeedbackConstPtr& feedback) {
        watched.onFeedback(feedback);
      });
}

}  // namespace

int runJob(const std::string& node, const RunOptions& options) {
  flute_grinder::GrindGoal goal = goalFor(node, options);
  const ValidJob job(jobFromGoal(goal));
  ros::NodeHandle nh(node);
  StreamWatch stream(nh, options.csv);
  const StateWatch watch(nh);
  Client client(nh, "grind");
  StopKeys keys(nh, watch);
  if (!await(kPatience,
             [&] { return watch.begun() && client.isServerConnected() && stream.connected() && keys.connected(); })) {
    return noGrinder(nh);
  }
  if (options.go_on) {
    const std::string refusal = continueFrom(watch.newest().progress, *job, goal);
    if (!refusal.empty()) return fail(refusal);
  }

  catchInterrupts();
  catchHolds();
  std::mutex mutex;  // guards `running`
  Client::GoalHandle running;
  keys.start([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    running.cancel();
  });
  for (;;) {
    GoalWatch watched;
    ProgressBar bar(job.teeth(), static_cast<int>(job.depths().size()));
    {
      const std::lock_guard<std::mutex> lock(mutex);
      running = send(client, goal, watched);
    }
    const bool connected = showProgress(watched, watch, bar);
    bar.end();
    const flute_grinder::GrindResultConstPtr result = watched.result();
    if (result && !goal.dry_run && addAnswers(result->plan.needs, goal.answers)) continue;
    return closeStream(stream, options.csv, printOutcome(watched, connected, stream));
  }
}

}  // namespace grinder
