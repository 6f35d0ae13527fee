#include "cli/probe.h"

#include "cli/answers.h"
#include "cli/interrupt.h"
#include "cli/offsets.h"
#include "cli/online.h"
#include "cli/waiting.h"
#include "cli/zeros.h"
#include "flute_grinder/ProbeAction.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/user_at_host.h"

#include <actionlib/client/action_client.h>
#include <ros/callback_queue.h>
#include <std_msgs/Header.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace grinder {

namespace {

// An action of its own, which GrinderClient does not have. SimpleActionClient loses an answer that comes before its
// sendGoal() returns.
using ProbeClient = actionlib::ActionClient<flute_grinder::ProbeAction>;

const ros::WallDuration kAgain(0.05);  ///< time between messages that this program is alive

/// A figure in mm to 0.1 um or in deg to 0.0001, the resolution of a probe.
std::string shown(double si, bool angle) {
  const Unit unit = angle ? Unit::kRadian : Unit::kMetre;
  return fixed(si / shopScale(unit), 4) + " " + shopUnit(unit);
}

/// @throw std::invalid_argument for contradictory arguments. @throw FileError
flute_grinder::ProbeGoal goalOf(const ProbingCycleRow& row, const ProbeOptions& options) {
  flute_grinder::ProbeGoal goal;
  goal.cycle = static_cast<std::uint8_t>(row.value);
  goal.within = options.within * shopScale(unitOf(row.axis, 0));
  if (!row.always_for_job && options.at_mm.has_value() == options.job.empty()) {
    throw std::invalid_argument("--at, the diameter of the blank, and --job; allowed: both or none");
  }
  if (options.job.empty()) return goal;
  goal.set_offset = 1;
  goal.answers = options.answers;
  goal.set_by = userAtHost();
  const JobFile job = openJobFile(options.job, options.operation);
  goal.job = goalFromFile(job);
  if (row.always_for_job) {
    goal.flange = flangeOf(job, options.flange_mm);
  } else {
    goal.diameter = *options.at_mm * units::kMillimetre;
  }
  return goal;
}

/// Waits for the end of a cycle. Ctrl-C and Ctrl-Z cancel it. @return whether the connection lasted.
bool awaitCycle(ProbeClient::GoalHandle& cycle, const States& states) {
  bool canceled = false;
  while (cycle.getCommState() != actionlib::CommState::DONE) {
    if (isLost(states)) return false;
    if (!canceled && interrupts() + holds() > 0) {
      cycle.cancel();
      canceled = true;
    }
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

void printFigures(const flute_grinder::ProbeResult& result) {
  for (const flute_grinder::ProbedFigure& figure : result.figures) {
    const bool angle = figure.angle != 0;
    std::printf("%-15s %s", escaped(figure.name).c_str(), shown(figure.value, angle).c_str());
    if (!std::isnan(figure.spread)) std::printf(", spread %s", shown(figure.spread, angle).c_str());
    std::printf("\n");
  }
}

/// Prints the offset that the grinder has set, or sets it now if what it needs is answered. @return the exit status.
int settleOffset(ros::NodeHandle& nh, int axis, flute_grinder::ProbeGoal goal,
                 const flute_grinder::ProbeResult& result) {
  int status = result.message.empty() ? 0 : fail(result.message);
  // Not by another cycle: what was probed counts.
  if (addAnswers(result.needs, goal.answers)) {
    status = setWorkOffsets(nh, {{axis, result.offset}}, basisOf(goal.job, OffsetMethod::kProbe), goal.answers);
  }
  if (status == 0 && goal.set_offset)
    std::printf("%-15s %c %s\n", "work offset", axisLetter(axis), shown(result.offset, axis == kA).c_str());
  return status;
}

}  // namespace

int runProbe(const std::string& node, ProbingCycle cycle, const ProbeOptions& options) {
  const ProbingCycleRow& row = rowOf(cycle);
  const flute_grinder::ProbeGoal goal = goalOf(row, options);
  ros::NodeHandle nh(node);
  const States states(nh, "state");
  ros::CallbackQueue queue;
  ros::NodeHandle own(nh);
  own.setCallbackQueue(&queue);
  ProbeClient client(own, "probe");
  ros::Publisher publisher = own.advertise<std_msgs::Header>("probe_alive", 1);
  // Ends before all that its callbacks use, which roscpp would destroy while they run.
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  if (!await(kPatience,
             [&] { return states.newest() && client.isServerConnected() && publisher.getNumSubscribers() > 0; })) {
    return noGrinder(nh);
  }
  catchInterrupts();
  catchHolds();
  const ros::WallTimer alive = own.createWallTimer(kAgain, [&publisher](const ros::WallTimerEvent&) {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    publisher.publish(header);
  });
  ProbeClient::GoalHandle running = client.sendGoal(goal);
  if (!awaitCycle(running, states)) return fail(kLinkLost);
  const flute_grinder::ProbeResultConstPtr result = running.getResult();
  if (!result) return fail("probing: no result from the grinder " + nh.getNamespace());
  printFigures(*result);
  return settleOffset(nh, row.axis, goal, *result);
}

}  // namespace grinder
