#include "flute_grinder/report/bag_run.h"

#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/record/job_record.h"
#include "flute_grinder/record/machine_info.h"
#include "flute_grinder/record/record_file.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

namespace grinder {

namespace {

constexpr std::uint64_t kMinRows = 3;
constexpr char kBagHead[] = "#ROSBAG ";

/// The message types to read, with the digests of their definitions.
template <typename... Messages>
std::map<std::string, std::string> digestsOf() {
  return {{ros::message_traits::datatype<Messages>(), ros::message_traits::md5sum<Messages>()}...};
}

const char* outcomeOf(std::uint8_t status) {
  switch (status) {
    case actionlib_msgs::GoalStatus::SUCCEEDED: return "done";
    case actionlib_msgs::GoalStatus::PREEMPTED: return "canceled";
    case actionlib_msgs::GoalStatus::ABORTED: return "fault";
    default: return "rejected";
  }
}

MachineInfo fromMessage(const flute_grinder::MachineInfo& m) {
  return {m.name,
          m.version,
          m.drive,
          m.period,
          Axes(m.max_velocity.data()),
          Axes(m.max_acceleration.data()),
          Axes(m.max_following_error.data())};
}

/// Reads a bag. @throw FileError if reading fails.
template <typename Read>
void readBag(const std::string& path, const Read& read) {
  const std::string not_whole =
      path + ": the bag was not closed, or is cut off; \"rosbag reindex\" saves what is in it";
  try {
    const rosbag::Bag bag(path);
    read(bag);
  } catch (const rosbag::BagUnindexedException&) {
    throw FileError(not_whole);
  } catch (const rosbag::BagIOException&) {
    throw FileError(not_whole);
  } catch (const rosbag::BagException& error) {
    throw FileError(path + ": cannot be read: " + error.what());
  } catch (const ros::serialization::StreamOverrunException& error) {
    throw FileError(path + ": cannot be read: " + error.what());
  }
}

}  // namespace

bool isBag(const std::string& path) {
  requireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  std::string head(sizeof kBagHead - 1, '\0');
  if (!file || file.read(head.data(), static_cast<std::streamsize>(head.size())).bad()) {
    throw FileError(path + ": cannot be read: " + std::strerror(errno));
  }
  return head == kBagHead;
}

BagRun::BagRun(std::string path, int job) : path_(std::move(path)), asked_(job) {
  readBag(path_, [this](const rosbag::Bag& bag) {
    findTopics(bag);
    rosbag::View view(bag, rosbag::TopicQuery(topics_));
    for (const rosbag::MessageInstance& message : view) take(message);
  });
  if (goals_.empty()) fail("the bag has no setpoints: no job ran while it was recorded");
  if (asked_ > static_cast<int>(goals_.size())) {
    fail("job " + std::to_string(asked_) + ": the bag has " + std::to_string(goals_.size()) + " job(s)");
  }
  if (summary_.count < kMinRows) {
    fail("has " + (summary_.count == 0 ? "no points" : std::to_string(summary_.count) + " point(s)") +
         "; allowed: 3 or more");
  }
  const std::size_t number = asked_ == 0 ? goals_.size() : static_cast<std::size_t>(asked_);
  place_ = "job " + std::to_string(number) + " of " + std::to_string(goals_.size());
  try {
    if (const auto job = jobs_.find(goal_); job != jobs_.end()) job_.emplace(job->second);
  } catch (const InvalidJob&) {
    // A goal of another version: reported as if the bag did not have it.
  }
  findBefore(static_cast<int>(number));
  selectStates();
  for (const auto& [name, status] : worst_) diagnostics_.emplace_back(name, status);
  setHead();
}

void BagRun::setHead() {
  Json head{{"grinder", (node_.front() == '/' ? "" : "/") + node_.substr(0, node_.size() - 1)},
            {"in_bag", place_.substr(4) + ", goal " + goal_},
            {"started", utcText(start_)},
            {"ended", utcText(end_)}};
  head.update(head_);
  for (const auto& [time, offsets] : offsets_) {
    if (time <= start_) head["work_offsets"] = offsets;
  }
  const Goal& goal = heads_[goal_];
  head.update(goal.head);
  outcome_ = goal.outcome;
  feed_limits_ = goal.feed_limits;
  head_ = std::move(head);
}

void BagRun::fail(const std::string& reason) const { throw FileError(path_ + ": " + reason); }

void BagRun::summarise(const RunRow& row) {
  const Setpoint& s = row.setpoint;
  const auto cycle = static_cast<std::int64_t>(s.cycle);
  const std::string named = "cycle " + std::to_string(s.cycle);
  if (cycle <= last_cycle_)
    fail(named + " follows cycle " + std::to_string(last_cycle_) + "; allowed: ascending cycles");
  // A faulty drive may have read NaN as position: a report on such a job is wanted most.
  const auto require = [&](bool finite, const char* name) {
    if (!finite) fail(named + ": " + name + " is not a finite number");
  };
  require(s.position.allFinite(), "position");
  require(std::isfinite(s.path_error), "error");
  require(std::isfinite(s.feed), "feed");
  require(std::isfinite(row.cycle_period), "cycle_period");
  RowSummary& all = summary_;
  if (all.count++ == 0) {
    all.first_cycle = s.cycle;
    all.first = s.position;
    all.begin = row.time;
  }
  all.end = row.time;
  all.missing += static_cast<std::uint64_t>(cycle - last_cycle_ - 1);
  last_cycle_ = cycle;
  if (s.step == StepKind::kNone) return;
  const double error = std::abs(s.path_error), x = s.position[kX];
  if (!all.worst || error > std::max(all.odd_error, all.even_error)) all.worst = ToothPass{s.tooth, s.pass};
  double& max_error = s.step == StepKind::kOdd ? all.odd_error : all.even_error;
  max_error = std::max(max_error, error);
  all.min_x = std::min(all.min_x, x);
  all.max_x = std::max(all.max_x, x);
}

void BagRun::findTopics(const rosbag::Bag& bag) {
  static const auto digests =
      digestsOf<flute_grinder::SetpointBatch, flute_grinder::GrinderState, flute_grinder::GrindActionGoal,
                flute_grinder::GrindActionResult, flute_grinder::MachineInfo, flute_grinder::WorkOffsets,
                diagnostic_msgs::DiagnosticArray>();
  rosbag::View view(bag);
  const std::string batch = ros::message_traits::datatype<flute_grinder::SetpointBatch>();
  std::string found;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto known = std::find(topics_.begin(), topics_.end(), connection->topic);
    if (connection->datatype != batch || known != topics_.end()) continue;
    topics_.push_back(connection->topic);
    found += (found.empty() ? "" : ", ") + connection->topic;
  }
  if (topics_.size() != 1) {
    fail("the bag has setpoints (" + batch + ") on " + (found.empty() ? "no topic" : found) + "; allowed: one topic");
  }
  node_ = found.substr(0, found.rfind('/') + 1);
  if (node_.empty()) fail("the setpoints' topic " + found + " has no namespace");
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const std::string& topic = connection->topic;
    const auto digest = digests.find(connection->datatype);
    const bool is_diagnostics =
        connection->datatype == ros::message_traits::datatype<diagnostic_msgs::DiagnosticArray>();
    if (digest == digests.end() || (!is_diagnostics && topic.compare(0, node_.size(), node_) != 0)) continue;
    if (digest->second != connection->md5sum) {
      fail(topic + " has another definition of " + connection->datatype + " than this program");
    }
    if (std::find(topics_.begin(), topics_.end(), topic) == topics_.end()) topics_.push_back(topic);
  }
}

void BagRun::take(const rosbag::MessageInstance& message) {
  if (const auto batch = message.instantiate<flute_grinder::SetpointBatch>()) {
    takeBatch(*batch);
  } else if (message.isType<flute_grinder::GrinderState>()) {
    takeState(message);
  } else if (message.isType<diagnostic_msgs::DiagnosticArray>()) {
    takeDiagnostics(message);
  } else {
    takeHead(message);
  }
}

void BagRun::takeBatch(const flute_grinder::SetpointBatch& batch) {
  if (goals_.empty() || batch.goal_id != goals_.back()) {
    goals_.push_back(batch.goal_id);
    if (isAsked()) {
      summary_ = RowSummary();
      last_cycle_ = -1;
      goal_ = batch.goal_id;
      period_ = batch.period;
      const std::uint64_t first = batch.setpoints.empty() ? 0 : batch.setpoints.front().cycle;
      start_ = batch.header.stamp.toSec() - static_cast<double>(first) * period_;
    }
  }
  if (!isAsked()) return;
  end_ = batch.end_stamp.toSec();
  visitBatch(batch, [this](const RunRow& row) { summarise(row); });
}

void BagRun::visitBatch(const flute_grinder::SetpointBatch& batch, const RowVisitor& visitor) const {
  const std::size_t count = batch.setpoints.size();
  const double begin = batch.header.stamp.toSec();
  // A batch lasts a few hundredths of a second: its cycles count as evenly spaced.
  const double step = (batch.end_stamp.toSec() - begin) / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  RunRow row;
  for (std::size_t i = 0; i < count; ++i) {
    const flute_grinder::WrittenSetpoint& s = batch.setpoints[i];
    row.setpoint = grinder::fromMessage(s);
    row.actual = Axes(s.actual.data());
    row.time = begin - start_ + static_cast<double>(i) * step;
    row.cycle_period = s.cycle_period;
    visitor(row);
  }
}

void BagRun::takeHead(const rosbag::MessageInstance& message) {
  if (const auto goal = message.instantiate<flute_grinder::GrindActionGoal>()) {
    heads_[goal->goal_id.id].head["job_name"] = goal->goal.job_name;
    jobs_[goal->goal_id.id] = jobFromGoal(goal->goal);
    if (goal->goal.first_tooth != 0 || goal->goal.first_pass != 0) continued_.insert(goal->goal_id.id);
  } else if (const auto result = message.instantiate<flute_grinder::GrindActionResult>()) {
    Goal& goal = heads_[result->status.goal_id.id];
    const PathStatistics planned = grinder::fromMessage(result->result.plan.statistics);
    goal.outcome = outcomeOf(result->status.status);
    goal.feed_limits = planned.feed_limits;
    goal.head["outcome"] = goal.outcome;
    goal.head["reason"] = result->result.error_string;
    goal.head["planned"] = plannedJson(planned);
  } else if (const auto machine = message.instantiate<flute_grinder::MachineInfo>()) {
    head_["machine"] = toJson(fromMessage(*machine));
  } else if (const auto offsets = message.instantiate<flute_grinder::WorkOffsets>()) {
    offsets_.emplace_back(offsets->header.stamp.toSec(), toJson(Axes(offsets->values.data()), ""));
  }
}

void BagRun::takeState(const rosbag::MessageInstance& message) {
  const auto state = message.instantiate<flute_grinder::GrinderState>();
  const auto known = valueOf<MachineState>(state->state_name);
  StateChange change{state->header.stamp.toSec(),
                     state->state_name,
                     known && rowOf(*known).holds_job,
                     state->fault.empty() ? state->hold_reason : state->fault,
                     state->override,
                     {state->tooth, state->pass}};
  const StateChange* last = changes_.empty() ? nullptr : &changes_.back();
  if (last && last->state == change.state && last->reason == change.reason &&
      last->feed_override == change.feed_override)
    return;
  changes_.push_back(std::move(change));
}

void BagRun::takeDiagnostics(const rosbag::MessageInstance& message) {
  const auto array = message.instantiate<diagnostic_msgs::DiagnosticArray>();
  for (const auto& status : array->status) {
    WorstStatus& worst = worst_[status.name];
    if (status.level > worst.level) worst = {status.level, status.message, 0};
    if (status.level == worst.level) ++worst.count;
  }
}

void BagRun::selectStates() {
  auto begin = std::find_if(changes_.begin(), changes_.end(), [this](const auto& c) { return c.time > start_; });
  if (begin != changes_.begin()) --begin;
  const auto is_last = [this](const StateChange& change) { return change.time >= end_ && !change.held; };
  auto end = std::find_if(begin, changes_.end(), is_last);
  if (end != changes_.end()) ++end;
  for (auto change = begin; change != end; ++change) {
    states_.push_back(*change);
    states_.back().time -= start_;
  }
}

std::vector<int> BagRun::partsOf(OperationKind kind, int number) const {
  const Json cutter = toJson(**job_)["cutter"];
  std::vector<int> parts;
  while (--number > 0) {
    const std::string& goal = goals_[static_cast<std::size_t>(number - 1)];
    const auto job = jobs_.find(goal);
    if (job == jobs_.end() || job->second.process().kind != kind || toJson(job->second)["cutter"] != cutter) continue;
    parts.insert(parts.begin(), number);
    if (continued_.count(goal) == 0) return parts;
  }
  return {};
}

void BagRun::findBefore(int number) {
  for (int i = 0; job_ && i < (*job_)->operation; ++i) {
    before_.push_back(partsOf((*job_)->operations[static_cast<std::size_t>(i)].kind, number));
    if (!before_.back().empty()) continue;
    before_.clear();
    return;
  }
}

void BagRun::visit(const RowVisitor& visitor) const {
  readBag(path_, [&](const rosbag::Bag& bag) {
    rosbag::View view(bag, rosbag::TopicQuery(topics_.front()));
    for (const rosbag::MessageInstance& message : view) {
      const auto batch = message.instantiate<flute_grinder::SetpointBatch>();
      if (batch && batch->goal_id == goal_) visitBatch(*batch, visitor);
    }
  });
}

}  // namespace grinder
