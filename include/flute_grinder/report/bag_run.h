#pragma once

#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/feed_schedule.h"
#include "flute_grinder/motion/setpoint.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rosbag {
class Bag;
class MessageInstance;
}  // namespace rosbag

namespace grinder {

/// Whether a file is a bag, by how it begins. @throw FileError if it cannot be read, JobFileError if it is no regular
/// file.
bool isBag(const std::string& path);

/// A setpoint as a bag has it.
struct RunRow {
  Setpoint setpoint;
  Axes actual = Axes::Zero();  ///< read one cycle before [m], A [rad]
  double time = 0;             ///< since the start of the job [s]
  double cycle_period = 0;     ///< as measured [s]
};
using RowVisitor = std::function<void(const RunRow&)>;

/// All rows of a file together.
struct RowSummary {
  std::uint64_t count = 0;
  std::uint64_t missing = 0;  ///< cycles between them
  std::uint64_t first_cycle = 0;
  Axes first = Axes::Zero();             ///< commanded first [m], A [rad]
  double begin = 0, end = 0;             ///< when the first and the last were [s]
  double odd_error = 0, even_error = 0;  ///< maximum at the points of the curve [rad]
  std::optional<ToothPass> worst;        ///< the stroke with the maximum error; nothing without a point of the curve
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x;  ///< of these points [m]
};

/// What `~state` says that a report shows.
struct StateChange {
  double time = 0;  ///< since the start of the job [s]
  std::string state;
  bool held = false;  ///< the job
  std::string reason;
  double feed_override = 1;  ///< fraction
  ToothPass pass;
};

/// The worst of a status in /diagnostics.
struct WorstStatus {
  int level = -1;
  std::string message;
  int count = 0;  ///< of messages with this level
};

/// A job in a bag that `roslaunch flute_grinder grinder.launch bag:=true` wrote.
class BagRun {
 public:
  /// @param job which one of the bag, from 1; 0 for the last.
  /// @throw FileError naming file or cycle, if it cannot be read, has fewer than three rows, or not this job.
  BagRun(std::string path, int job);

  /// The rows, in ascending order of their cycles; as often as called. @throw FileError
  void visit(const RowVisitor& visitor) const;

  /// Control cycle [s].
  double period() const noexcept { return period_; }
  const RowSummary& summary() const noexcept { return summary_; }
  /// The job, if the bag has its goal.
  const std::optional<ValidJob>& job() const noexcept { return job_; }
  /// Of a relief: for each operation ahead of it, the jobs of the bag that ground it on this cutter: the last that
  /// began before, and those that continued it. Empty if one of them is not there, and without a job.
  const std::vector<std::vector<int>>& before() const noexcept { return before_; }
  /// Which of the bag's jobs, for the reader.
  const std::string& place() const noexcept { return place_; }
  /// How the job ended: "done", "canceled", "fault" or "rejected"; empty if the bag does not have its end.
  const std::string& outcome() const noexcept { return outcome_; }
  /// What slows down the plan.
  const std::vector<FeedLimit>& feedLimits() const noexcept { return feed_limits_; }
  /// What else the bag has of the job, in the keys of a record.
  const Json& head() const noexcept { return head_; }
  /// From that which was in force when the job began to the first after its end in which it is not held.
  const std::vector<StateChange>& states() const noexcept { return states_; }
  /// Of the whole bag, by names.
  const std::vector<std::pair<std::string, WorstStatus>>& diagnostics() const noexcept { return diagnostics_; }

 private:
  /// What a goal and its result say.
  struct Goal {
    Json head = Json::object();
    std::string outcome;
    std::vector<FeedLimit> feed_limits;
  };

  void findTopics(const rosbag::Bag& bag);
  void take(const rosbag::MessageInstance& message);
  void takeBatch(const flute_grinder::SetpointBatch& batch);
  void takeHead(const rosbag::MessageInstance& message);
  void takeState(const rosbag::MessageInstance& message);
  void takeDiagnostics(const rosbag::MessageInstance& message);
  void selectStates();
  /// @param number of the job.
  void findBefore(int number);
  std::vector<int> partsOf(int operation, int number) const;
  bool isAsked() const { return asked_ == 0 || static_cast<std::size_t>(asked_) == goals_.size(); }
  void visitBatch(const flute_grinder::SetpointBatch& batch, const RowVisitor& visitor) const;
  /// Adds a row to the summary. @throw FileError if its cycle does not follow, or a number is not finite.
  void summarise(const RunRow& row);
  void setHead();
  [[noreturn]] void fail(const std::string& reason) const;

  const std::string path_;
  const int asked_;  ///< which of the jobs
  double period_ = 0;
  std::optional<ValidJob> job_;
  std::vector<std::vector<int>> before_;
  std::string place_, outcome_;
  std::vector<FeedLimit> feed_limits_;
  Json head_ = Json::object();
  std::vector<StateChange> states_;
  std::vector<std::pair<std::string, WorstStatus>> diagnostics_;
  std::int64_t last_cycle_ = -1;  ///< cycle 0 is the start position of a job
  RowSummary summary_;

  std::string node_;                      ///< the grinder's name, as in the topics, with a slash at its end
  std::vector<std::string> topics_;       ///< that are read; first that of the setpoints
  std::vector<std::string> goals_;        ///< of the jobs found so far
  std::string goal_;                      ///< of the job
  double start_ = 0, end_ = 0;            ///< cycle 0 and the last one, since the epoch [s]
  std::map<std::string, Goal> heads_;     ///< by goal
  std::map<std::string, GrindJob> jobs_;  ///< by goal
  std::set<std::string> continued_;       ///< goals that continue a job
  std::map<std::string, WorstStatus> worst_;
  std::vector<std::pair<double, Json>> offsets_;  ///< with the time from which they were in force, since the epoch [s]
  std::vector<StateChange> changes_;              ///< of the whole bag, since the epoch
};

}  // namespace grinder
