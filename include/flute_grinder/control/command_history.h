#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/drive/drive.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grinder {

/// The progress of a job: the setpoints that were written, or that reached the axes.
struct JobTrack {
  std::uint64_t job = 0;        ///< number of the job; 0 for none
  std::uint64_t setpoints = 0;  ///< setpoints counted so far
  std::uint32_t strokes_ended_at = 0;
  Place place;

  /// Counts the job's next setpoint.
  void add(const Setpoint& p) noexcept {
    ++setpoints;
    place = {p.move_index, p.tooth, p.pass, p.move, p.position[kX], p.move_fraction};
    if (p.move == MoveKind::kStroke && p.move_fraction >= 1)
      strokes_ended_at = std::max(strokes_ended_at, p.move_index + 1);
  }
};

/// The commands of the most recent cycles, as many as a drive may buffer, each with the job's progress. Real-time safe.
class CommandHistory {
 public:
  struct Entry {
    Axes command = Axes::Zero();  ///< command to the axes [m], A [rad]
    JobTrack track;
  };

  /// Discards all commands, because the next commands do not continue from them.
  void clear() noexcept { count_ = 0; }

  bool empty() const noexcept { return count_ == 0; }

  void add(const Entry& entry) noexcept {
    entries_[next_] = entry;
    next_ = (next_ + 1) % entries_.size();
    count_ = std::min(count_ + 1, entries_.size());
  }

  /// The command in effect: the last one that reached the axes, given that `waiting` later ones are in the drive's
  /// buffer. The history must not be empty.
  const Entry& inEffect(std::uint32_t waiting) const noexcept {
    const std::size_t back = 1 + std::min<std::size_t>(waiting, count_ - 1);
    return entries_[(next_ + entries_.size() - back) % entries_.size()];
  }

 private:
  std::array<Entry, kMaxCommandsWaiting + 1> entries_;  ///< ring buffer
  std::size_t next_ = 0;                                ///< position of the next entry
  std::size_t count_ = 0;
};

}  // namespace grinder
