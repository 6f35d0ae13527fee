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

/// Whether a file begins like a bag. @throw FileError if it cannot be read or is not a regular file.
bool isBag(const std::string& path);

/// A setpoint in a bag.
struct RunRow {
  Setpoint setpoint;
  Axes actual = Axes::Zero();  ///< position read one cycle before [m], A [rad]
  double time = 0;             ///< time since the start of the job [s]
  double cycle_period = 0;     ///< measured period of the cycle [s]
};
using RowVisitor = std::function<void(const RunRow&)>;

/// A summary of all rows of a file.
struct RowSummary {
  std::uint64_t count = 0;
  std::uint64_t missing = 0;  ///< cycles missing between the rows
  std::uint64_t first_cycle = 0;
  Axes first = Axes::Zero();             ///< first command [m], A [rad]
  double begin = 0, end = 0;             ///< times of the first and last row [s]
  double odd_error = 0, even_error = 0;  ///< maximum errors at the points of the curve [rad]
  std::optional<ToothPass> worst;        ///< the stroke with the maximum error; nothing without a point of the curve
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x;  ///< range of X of these points [m]
};

/// The parts of a `~state` message that a report shows.
struct StateChange {
  double time = 0;  ///< time since the start of the job [s]
  std::string state;
  bool held = false;  ///< the job is held
  std::string reason;
  double feed_override = 1;  ///< fraction
  ToothPass pass;
};

/// The worst level of a status in /diagnostics.
struct WorstStatus {
  int level = -1;
  std::string message;
  int count = 0;  ///< number of messages with this level
};

/// A job in a bag that `roslaunch flute_grinder grinder.launch bag:=true` wrote.
class BagRun {
 public:
  /// @param job number of the job in the bag, from 1; 0 for the last.
  /// @throw FileError naming file or cycle, if the bag cannot be read, lacks this job, or has fewer than three rows of
  /// it.
  BagRun(std::string path, int job);

  /// Visits the rows in ascending order of their cycles; may be called repeatedly. @throw FileError
  void visit(const RowVisitor& visitor) const;

  /// Control cycle [s].
  double period() const noexcept { return period_; }
  const RowSummary& summary() const noexcept { return summary_; }
  /// The job, if the bag has its goal.
  const std::optional<ValidJob>& job() const noexcept { return job_; }
  /// For a relief, the earlier jobs of the bag on this cutter. For each operation ahead: the last job that began it,
  /// and the jobs that continued it. Empty if an operation is missing, and without a job.
  const std::vector<std::vector<int>>& before() const noexcept { return before_; }
  /// The job's place in the bag, for the reader.
  const std::string& place() const noexcept { return place_; }
  /// How the job ended: "done", "canceled", "fault" or "rejected"; empty if the bag does not have its end.
  const std::string& outcome() const noexcept { return outcome_; }
  /// The limits that slow down the plan.
  const std::vector<FeedLimit>& feedLimits() const noexcept { return feed_limits_; }
  /// The other data of the job in the bag, with the keys of a record.
  const Json& head() const noexcept { return head_; }
  /// The states from the one in force when the job began to the first one after its end in which it is not held.
  const std::vector<StateChange>& states() const noexcept { return states_; }
  /// The worst statuses of the whole bag, by names.
  const std::vector<std::pair<std::string, WorstStatus>>& diagnostics() const noexcept { return diagnostics_; }

 private:
  /// The data of a goal and its result.
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
  /// @param number number of the job.
  void findBefore(int number);
  std::vector<int> partsOf(OperationKind kind, int number) const;
  bool isAsked() const { return asked_ == 0 || static_cast<std::size_t>(asked_) == goals_.size(); }
  void visitBatch(const flute_grinder::SetpointBatch& batch, const RowVisitor& visitor) const;
  /// Adds a row to the summary. @throw FileError if its cycle does not follow, or a number is not finite.
  void summarise(const RunRow& row);
  void setHead();
  [[noreturn]] void fail(const std::string& reason) const;

  const std::string path_;
  const int asked_;  ///< number of the job asked for
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
  std::vector<std::string> topics_;       ///< topics to read; the setpoints' topic first
  std::vector<std::string> goals_;        ///< goals of the jobs found so far
  std::string goal_;                      ///< goal of the job
  double start_ = 0, end_ = 0;            ///< times of cycle 0 and the last cycle since the epoch [s]
  std::map<std::string, Goal> heads_;     ///< data of the goals, by goal
  std::map<std::string, GrindJob> jobs_;  ///< jobs, by goal
  std::set<std::string> continued_;       ///< goals that continue a job
  std::map<std::string, WorstStatus> worst_;
  std::vector<std::pair<double, Json>> offsets_;  ///< offsets, with the start of their validity since the epoch [s]
  std::vector<StateChange> changes_;              ///< changes in the whole bag, with times since the epoch
};

}  // namespace grinder
