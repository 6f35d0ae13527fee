#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/core/axes.h"
#include "flute_grinder/drive/robot_hw.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace flute_grinder {

/// Where a job is, by the setpoints written or got so far.
struct JobTrack {
  std::uint64_t job = 0;        ///< its number; 0 for none
  std::uint64_t setpoints = 0;  ///< so far
  std::uint32_t strokes_ended_at = 0;
  Place place;

  /// Takes the job's next setpoint.
  void add(const Setpoint& p) noexcept {
    ++setpoints;
    place = {p.move_index, p.tooth, p.pass, p.move, p.position[kX], p.move_fraction};
    if (p.move == MoveKind::kStroke && p.move_fraction >= 1)
      strokes_ended_at = std::max(strokes_ended_at, p.move_index + 1);
  }
};

/// The commands written in the last cycles, as many as a drive may buffer, each with where its job was. Real-time safe.
class CommandHistory {
 public:
  struct Entry {
    Axes command = Axes::Zero();  ///< [m], A [rad]
    JobTrack track;
  };

  /// Forgets all: what comes does not follow from what was.
  void clear() noexcept { count_ = 0; }

  bool empty() const noexcept { return count_ == 0; }

  void add(const Entry& entry) noexcept {
    entries_[next_] = entry;
    next_ = (next_ + 1) % entries_.size();
    count_ = std::min(count_ + 1, entries_.size());
  }

  /// The one that the axes have got, if `waiting` later ones wait in the drive. Not of an empty history.
  const Entry& inEffect(std::uint32_t waiting) const noexcept {
    const std::size_t back = 1 + std::min<std::size_t>(waiting, count_ - 1);
    return entries_[(next_ + entries_.size() - back) % entries_.size()];
  }

 private:
  std::array<Entry, kMaxCommandsWaiting + 1> entries_;  ///< a ring
  std::size_t next_ = 0;                                ///< where the next one goes
  std::size_t count_ = 0;
};

}  // namespace flute_grinder
