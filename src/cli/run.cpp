#include "cli/answers.h"
#include "cli/history.h"
#include "cli/interrupt.h"
#include "cli/offline.h"
#include "cli/online.h"
#include "cli/progress_bar.h"
#include "cli/stop_keys.h"
#include "cli/stream_watch.h"
#include "cli/waiting.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/client/grinder_client.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/continue_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/tool/z_law.h"

#include <cstdio>
#include <optional>
#include <utility>

namespace grinder {

namespace {

bool succeeded(const flute_grinder::GrindActionResult& end) {
  return end.status.status == actionlib_msgs::GoalStatus::SUCCEEDED;
}

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

/// A goal that was sent.
struct Sent {
  std::string id;
  std::optional<flute_grinder::GrindActionResult> end;
};

/// Shows the progress of a goal to its end, or until the connection is lost.
void showProgress(const Sent& sent, GrinderClient& client, ProgressBar& bar) {
  RunMessages messages(bar);
  flute_grinder::GrindActionFeedback::ConstPtr shown;
  const auto show = [&] {
    const auto newest = client.view().feedback;
    if (newest && newest->status.goal_id.id == sent.id && newest != shown) bar.show(newest->feedback);
    shown = newest;
  };
  for (client.deliver(); !sent.end; client.deliver()) {
    if (isLost(client.states())) return;
    messages.update(*client.states().newest());
    show();
    ros::WallDuration(0.01).sleep();
  }
  messages.update(*client.states().newest());
  // The last feedback may come after the result, over another connection.
  if (succeeded(*sent.end)) {
    await(ros::WallDuration(1), [&] { return show(), bar.complete(); });
  }
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

/// Prints the outcome of a goal. @param end nothing if the connection was lost before. @return the exit status.
int printOutcome(const std::optional<flute_grinder::GrindActionResult>& end, const StreamWatch& stream) {
  if (end) {
    printPlan(end->result.plan);
    if (succeeded(*end)) {
      for (const flute_grinder::Need& need : end->result.plan.needs) {
        std::fprintf(stderr, "to start it: %s\n", escaped(need.text).c_str());
      }
    }
  }
  printStream(stream, end ? end->result.setpoints_written : 0);
  if (!end) return fail(kLinkLost);
  const flute_grinder::GrindResult& result = end->result;
  if (end->status.status == actionlib_msgs::GoalStatus::LOST) return fail(result.error_string);
  if (succeeded(*end) && result.error_code == 0) return 0;
  return fail(result.error_string + " (code " + std::to_string(result.error_code) + ")");
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
  return goal;
}

/// The number of passes of a tooth of a goal's job; 0 for a dry run, which grinds none.
int passesToGrind(const flute_grinder::GrindGoal& goal, const ValidJob& job) {
  if (goal.dry_run) return 0;
  return static_cast<int>((job.hasPasses() ? job : withLaws(job)).depths().size());
}

}  // namespace

int runJob(const std::string& node, const RunOptions& options) {
  flute_grinder::GrindGoal goal = goalFor(node, options);
  const ValidJob job(jobFromGoal(goal));
  const int passes = passesToGrind(goal, job);
  ros::NodeHandle nh(node);
  StreamWatch stream(nh, options.csv);
  Sent sent;
  GrinderClient client(node, [&sent](const flute_grinder::GrindActionResult& end) {
    if (end.status.goal_id.id == sent.id) sent.end = end;
  });
  StopKeys keys(client);
  if (!await(kPatience, [&] { return client.connected() && stream.connected(); })) return noGrinder(nh);
  if (options.go_on) {
    const std::string refusal = continueFrom(client.states().newest()->progress, *job, goal);
    if (!refusal.empty()) return fail(refusal);
  }

  catchInterrupts();
  catchHolds();
  keys.start([&] { client.cancelSent(); });
  for (;;) {
    ProgressBar bar(job.teeth(), passes);
    const std::optional<std::string> id = client.send(goal);
    if (!id) return fail(kLinkLost);
    sent = {*id, std::nullopt};
    showProgress(sent, client, bar);
    bar.end();
    if (sent.end && !goal.dry_run && addAnswers(sent.end->result.plan.needs, goal.answers)) continue;
    return closeStream(stream, options.csv, printOutcome(sent.end, stream));
  }
}

}  // namespace grinder
