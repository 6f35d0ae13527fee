#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/core/grind_program.h"
#include "flute_grinder/node/journal_keeper.h"

#include <ros/steady_timer.h>

#include <optional>
#include <string>
#include <vector>

namespace flute_grinder {

/// Turns what the control loop says of its job into the journal's progress: at once where a pass ends or the wheel goes
/// into the work or out of it, and once a second within a stroke. For one thread; waits for no disk.
class Bookkeeper {
 public:
  /// @param keeper must outlive this object.
  explicit Bookkeeper(JournalKeeper& keeper);

  /// Why a job must not take the journal's place: it keeps another one that is not finished. Empty for nothing.
  /// @param first pass from which the job is to be ground.
  std::string objection(const std::string& digest, const ToothPass& first) const;

  /// Enters a job ahead of its start.
  /// @param number of the job, as the loop will count it; what the loop says of another one is not taken.
  void begin(const GrindProgram& program, const std::string& digest, const std::string& name, const ToothPass& first,
             std::uint64_t number);
  /// The job has not been started: restores the entry of the job before.
  void revert();
  /// The job has ended.
  void end(const LoopStatus& status);
  /// Takes where the job, and without one the wheel, has come to; to be called often.
  void follow(const LoopStatus& status);

  /// Whether all that was entered has gone to the disk, or has failed to.
  bool settled() const { return keeper_.told().number >= order_; }
  /// Why the last entry is not on the disk; empty for nothing.
  std::string error() const { return keeper_.told().error; }

 private:
  void write();
  void takePlace(const LoopStatus& status);

  JournalKeeper& keeper_;
  Progress progress_;              ///< as entered last
  Progress before_;                ///< as of the job before
  std::vector<Move> moves_;        ///< of the job's program
  std::vector<ToothPass> passes_;  ///< in order
  std::uint64_t number_ = 0;       ///< of the job
  std::uint32_t strokes_ended_at_ = 0;
  bool running_ = false;
  std::uint64_t order_ = 0;
  bool place_changed_ = false;  ///< since the last entry
  ros::SteadyTime last_entry_;
};

}  // namespace flute_grinder
