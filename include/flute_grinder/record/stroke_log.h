#pragma once

#include "flute_grinder/curve/formed_edge.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/setpoint.h"

#include <vector>

namespace grinder {

/// Figures of a stroke as it was ground; the feed is that within the flute, or along the relief's edge. A stroke that
/// was held, and resumed, is one.
struct StrokeFigures {
  ToothPass place;
  double from = 0, to = 0;  ///< since the start [s]
  bool complete = false;    ///< ground to its end
  bool has_feed = false;
  double min_feed = 0, max_feed = 0;    ///< [m/s]
  double min_feed_x = 0;                ///< where the feed was lowest [m]
  double deviation = 0;                 ///< maximum [m]
  double deviation_x = 0;               ///< where [m]
  Axes following_error = Axes::Zero();  ///< maximum of each axis [m], A [rad]
};

/// The strokes of a job, setpoint by setpoint. Not thread safe.
class StrokeLog {
 public:
  /// Of a job that is not known: depth and deviation are missing, and the overtravel counts as flute.
  StrokeLog() = default;
  explicit StrokeLog(const ValidJob& job);

  /// Adds a setpoint of a stroke. @param time since the start [s].
  void add(const Setpoint& setpoint, double time);
  /// Adds how far the axes were from their command in that cycle, from 0; NaN stays [m], A [rad].
  void addFollowingError(const Axes& error);

  const std::vector<StrokeFigures>& strokes() const noexcept { return strokes_; }
  /// The strokes as records have them, see docs/ros-interface.md.
  Json json() const;

 private:
  std::vector<FormedEdge> edges_;  ///< of the teeth
  /// Where the part of the strokes begins whose feed counts, of the teeth: X of the small end, or of the wheel there as
  /// a relief begins [m].
  std::vector<double> starts_;
  std::vector<double> depths_;  ///< of the passes at the small end [m]
  std::vector<StrokeFigures> strokes_;
};

}  // namespace grinder
