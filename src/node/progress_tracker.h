#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/machine/need.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/work_offsets.h"
#include "node/journal.h"

#include <ros/steady_timer.h>

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Turns the control loop's status into journal entries: at once when a pass ends or the wheel enters or leaves the
/// work, and at most once a second within a stroke or with the feed override. Not thread safe; never waits for the
/// disk.
class ProgressTracker {
 public:
  /// @param journal must outlive this object.
  explicit ProgressTracker(Journal& journal);

  /// Why a job cannot begin, whatever is answered; empty if it can. The journal could not be read, or does not list the
  /// passes that the job leaves out as ground.
  /// @param first first pass to grind.
  std::string refusal(const std::string& digest, const ToothPass& first) const;
  /// What must be said before a job overwrites the journal: it is damaged, or holds another, unfinished job.
  std::optional<Need> need(const std::string& digest, const ToothPass& first) const;
  /// What must be said before the unfinished job is ground with work offsets that have changed since it began, by more
  /// than the rounding of a display (0.1 um, A 1e-6 rad), with another mounting of the wheel, or another clamping.
  std::optional<Need> offsetNeed(const std::string& digest, const ToothPass& first, const WorkOffsets& offsets) const;

  /// Whether a job is the unfinished one, with unchanged work offsets as compared by offsetNeed().
  bool continues(const std::string& digest, const WorkOffsets& offsets) const;

  /// Enters a job before it starts.
  /// @param job name, tool and operation of the job.
  /// @param number the loop's number for this job; status reports of other jobs are ignored.
  /// @param offsets work offsets, wheel and tool with which the job begins.
  void begin(const GrindProgram& program, const std::string& digest, const OffsetBasis& job, std::uint64_t number,
             const WorkOffsets& offsets);
  /// Restores the previous entry, because the job was not started.
  void revert();
  /// Enters the end of the job. @param how text for display, not empty.
  void end(const LoopStatus& status, const std::string& how);
  /// Records the job's progress or, without a job, the wheel's position. To be called often.
  void update(const LoopStatus& status);

  /// The last entry.
  const Progress& progress() const { return progress_; }
  /// Whether the write of every entry has succeeded or failed.
  bool upToDate() const { return journal_.status().number >= request_; }
  /// Why the last entry is not on disk; empty if it is.
  std::string error() const { return journal_.status().error; }

 private:
  std::string sinceItBegan(const WorkOffsets& offsets) const;
  std::string offsetChanges(const WorkOffsets& offsets) const;
  void write();
  void updatePlace(const LoopStatus& status);

  Journal& journal_;
  Progress progress_;            ///< last entry
  Progress before_;              ///< last entry of the previous job
  std::vector<Move> moves_;      ///< moves of the job's program
  std::vector<JobPass> passes_;  ///< passes of the job, in order
  std::uint64_t number_ = 0;     ///< the loop's number for the job
  std::uint32_t strokes_ended_at_ = 0;
  bool running_ = false;
  std::uint64_t request_ = 0;
  bool changed_ = false;  ///< the progress has changed since the last entry
  ros::SteadyTime last_entry_;
};

}  // namespace grinder
