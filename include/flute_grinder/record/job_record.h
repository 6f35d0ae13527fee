#pragma once

#include "flute_grinder/control/cycle_record.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/plan/planned_job.h"
#include "flute_grinder/record/machine_info.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace flute_grinder {

/// How a job ended.
struct JobConclusion {
  const char* outcome = "fault";        ///< "done", "canceled" or "fault"
  std::string reason;                   ///< of the goal's result, for the operator; empty for "done"
  std::uint64_t setpoints_written = 0;  ///< to the drive
};

/// What happened to a job, gathered cycle by cycle: its strokes as they were ground, holds, changes of the feed
/// override, late cycles. Not thread safe.
class JobRecord {
 public:
  /// @param plan of the job, which is good.
  /// @param name of the job as its goal gives it.
  JobRecord(const PlannedJob& plan, std::string name);

  /// Adds a cycle. To be called for every cycle from the job's start to its end, in order.
  void addCycle(const CycleRecord& record);
  /// Adds the setpoint that reaches the axes in a cycle, after that cycle.
  void addSetpoint(const Setpoint& setpoint, const CycleRecord& record);
  /// Adds setpoints that were written, but are not known.
  void addLost(std::uint64_t setpoints) { lost_ += setpoints; }
  /// For what, and by whom, the work offsets were set. @param said_right the goal says that they are right.
  void setZeroPoints(const core::WorkOffsets& offsets, bool said_right);
  void conclude(const JobConclusion& conclusion) { conclusion_ = conclusion; }

  /// Whether anything moved.
  bool moved() const { return setpoints_ > 0; }
  /// Of the first cycle, since the epoch [s].
  double started() const { return started_; }

  /// The record as it is kept, see docs/ros-interface.md.
  /// @param grinder the node's name.
  Json json(const std::string& grinder, const core::MachineInfo& machine) const;

 private:
  /// Times are since the start [s].
  struct Stroke {
    ToothPass pass;
    double from = 0, to = 0;
    bool complete = false;
    bool has_feed = false;
    double min_feed = 0, max_feed = 0;  ///< within the flute [m/s]
    double deviation = 0;               ///< largest [m]
    Axes following_error = Axes::Zero();
  };
  struct Hold {
    double from = 0, to = 0;
    std::string reason;
    ToothPass pass;
  };
  struct Override {
    double at = 0;
    double fraction = 1;
    ToothPass pass;
  };

  double since(const CycleRecord& record) const { return record.time - started_; }
  void addToHold(const CycleRecord& record);
  template <typename Entry>
  bool hasRoom(const std::vector<Entry>& list);
  void addToStroke(const Setpoint& setpoint, const CycleRecord& record);
  Json jobJson() const;
  Json strokesJson() const;
  Json zeroPointsJson() const;

  std::shared_ptr<const GrindProgram> program_;
  core::PathStatistics planned_;
  std::string digest_;
  ToothPass first_;
  std::string name_;
  core::WorkOffsets offsets_;
  bool offsets_said_right_ = false;
  std::vector<double> depths_;  ///< of every pass, where the flute is deepest [m]

  std::uint64_t cycles_ = 0;
  double started_ = 0, ended_ = 0;  ///< since the epoch [s]
  std::uint64_t setpoints_ = 0, lost_ = 0;
  std::uint64_t late_ = 0;
  double longest_ = 0;  ///< period of a cycle [s]
  ToothPass pass_;      ///< of the setpoint that reached the axes last
  bool held_ = false, hold_listed_ = false;
  double override_ = 1;
  std::vector<Stroke> strokes_;
  std::vector<Hold> holds_;
  std::vector<Override> overrides_;
  std::uint64_t omitted_ = 0;  ///< holds and changes of the override that are too many
  JobConclusion conclusion_;
};

}  // namespace flute_grinder
