#pragma once

#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/record/job_events.h"
#include "flute_grinder/record/machine_info.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/stroke_log.h"
#include "flute_grinder/record/verdict.h"
#include "flute_grinder/tool/run_strokes.h"

#include <cstdint>
#include <memory>
#include <string>

namespace grinder {

/// The names of a goal's files.
struct JobNames {
  std::string job;            ///< name of the job; may be empty
  std::string wheel;          ///< name of the wheel; may be empty
  std::string wheel_dressed;  ///< time of the last dressing; empty if unknown
};

/// How a job ended.
struct JobConclusion {
  const char* outcome = "fault";        ///< "done", "canceled" or "fault"
  std::string reason;                   ///< reason in the goal's result, for the operator; empty for "done"
  std::uint64_t setpoints_written = 0;  ///< setpoints written to the drive
};

/// Gathers, cycle by cycle, what happens in a job: its strokes as ground, holds, changes of the feed override, late
/// cycles. Not thread safe.
class JobRecord {
 public:
  /// @param plan valid plan of the job.
  /// @param offsets work offsets of the plan. @param said_right whether the goal skips the check of the offsets.
  JobRecord(const PlannedJob& plan, JobNames names, const WorkOffsets& offsets, bool said_right);

  /// Adds a cycle. To be called for every cycle from the job's start to its end, in order.
  void addCycle(const CycleSample& sample);
  /// Adds the setpoint that reaches the axes in a cycle, after that cycle.
  void addSetpoint(const Setpoint& setpoint, const CycleSample& sample);
  /// Adds setpoints that were written, but whose samples were lost.
  void addLost(std::uint64_t setpoints) { lost_ += setpoints; }
  void conclude(const JobConclusion& conclusion) { conclusion_ = conclusion; }

  /// Whether any axis was commanded to move.
  bool moved() const { return setpoints_ > 0; }
  /// The time of the first cycle since the epoch [s].
  double started() const { return started_; }

  /// The record, with the verdict on the run. The tool, which takes seconds to compute, is measured by the readers of
  /// the record.
  /// @param grinder name of the node.
  Record record(const std::string& grinder, const MachineInfo& machine, const Tolerances& tolerances) const;

 private:
  double since(const CycleSample& sample) const { return sample.time - started_; }
  void addGround(const Setpoint& setpoint, const CycleSample& sample);
  RecordHead head() const;
  std::vector<Criterion> judge(const Tolerances& tolerances) const;
  Json zeroPointsJson() const;

  std::shared_ptr<const GrindProgram> program_;
  PathStatistics planned_;
  std::string digest_;
  JobNames names_;
  WorkOffsets offsets_;
  bool offsets_said_right_;

  std::uint64_t cycles_ = 0;
  double started_ = 0, ended_ = 0;  ///< times since the epoch [s]
  std::uint64_t setpoints_ = 0, lost_ = 0;
  std::uint64_t late_ = 0;
  double longest_ = 0;  ///< longest period of a cycle [s]
  ToothPass pass_;      ///< pass of the last setpoint that reached the axes
  StrokeLog strokes_;
  RunStrokes ground_;       ///< path of the wheel
  std::string not_ground_;  ///< why that path is unknown; empty if it is known
  JobEvents events_;
  JobConclusion conclusion_;
};

/// A job's plan as written in records.
Json plannedJson(const PathStatistics& planned);

}  // namespace grinder
