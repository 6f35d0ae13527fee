#pragma once

#include "flute_grinder/job/tooth_pass.h"
#include "flute_grinder/messages/json.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace grinder {

/// The holds and the changes of the feed override of a job, up to 10,000 of each. Not thread safe.
class JobEvents {
 public:
  /// Adds a cycle, or a message of the state, in the order of time.
  /// @param time time since the start [s]. @param held whether the job is held.
  /// @param reason why it is held; empty if the operator has held it. @param feed_override fraction.
  void add(double time, bool held, std::string_view reason, double feed_override, const ToothPass& pass);

  /// The events as written in records, see docs/ros-interface.md.
  Json holds() const;
  Json overrides() const;
  /// The number of events beyond the limit.
  std::uint64_t omitted() const noexcept { return omitted_; }

 private:
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

  template <typename Entry>
  bool hasRoom(const std::vector<Entry>& list);

  std::vector<Hold> holds_;
  std::vector<Override> overrides_;
  bool held_ = false, hold_listed_ = false;
  double override_ = 1;
  std::uint64_t omitted_ = 0;
};

}  // namespace grinder
