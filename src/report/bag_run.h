#pragma once

#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/report/run_file.h"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rosbag {
class Bag;
class MessageInstance;
}  // namespace rosbag

namespace grinder {

/// A job in a bag that `roslaunch flute_grinder grinder.launch bag:=true` wrote.
class BagRun : public RunFile {
 public:
  BagRun(std::string path, int job);
  void visit(const RowVisitor& visitor) const override;

 private:
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

  const int asked_;                       ///< which of the jobs
  std::string node_;                      ///< the grinder's name, as in the topics, with a slash at its end
  std::vector<std::string> topics_;       ///< that are read; first that of the setpoints
  std::vector<std::string> goals_;        ///< of the jobs found so far
  std::string goal_;                      ///< of the job
  double start_ = 0, end_ = 0;            ///< cycle 0 and the last one, since the epoch [s]
  std::map<std::string, Json> heads_;     ///< what goals and results say, by goal
  std::map<std::string, GrindJob> jobs_;  ///< by goal
  std::set<std::string> continued_;       ///< goals that continue a job
  std::map<std::string, WorstStatus> worst_;
  std::vector<std::pair<double, Json>> offsets_;  ///< with the time from which they were in force, since the epoch [s]
  std::vector<StateChange> changes_;              ///< of the whole bag, since the epoch
};

}  // namespace grinder
