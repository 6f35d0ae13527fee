#pragma once

#include "flute_grinder/curve/formed_edge.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/setpoint.h"

#include <vector>

namespace grinder {

/// Figures of a stroke as ground, with the feed within the flute or along the relief's edge; of a straight stroke,
/// between its ramps. A stroke that was held and
/// resumed counts once.
struct StrokeFigures {
  ToothPass place;
  double from = 0, to = 0;  ///< begin and end since the start [s]
  bool complete = false;    ///< the stroke was ground to its end
  bool has_feed = false;
  double min_feed = 0, max_feed = 0;    ///< lowest and highest feed [m/s]
  double min_feed_x = 0;                ///< X of the lowest feed [m]
  double deviation = 0;                 ///< maximum deviation [m]
  double deviation_x = 0;               ///< X of the maximum deviation [m]
  Axes following_error = Axes::Zero();  ///< maximum following error of each axis [m], A [rad]
};

/// Gathers the figures of a job's strokes, setpoint by setpoint. Not thread safe.
class StrokeLog {
 public:
  /// Makes a log for an unknown job: without depth and deviation, and with the overtravel counted as flute.
  StrokeLog() = default;
  /// The straight strokes of an operation on the end have no deviation.
  explicit StrokeLog(const ValidJob& job);

  /// Adds a setpoint of a stroke. @param time time since the start [s].
  void add(const Setpoint& setpoint, double time);
  /// Adds the following errors of that cycle, from 0; NaN stays [m], A [rad].
  void addFollowingError(const Axes& error);

  const std::vector<StrokeFigures>& strokes() const noexcept { return strokes_; }
  /// The strokes as written in records, see docs/ros-interface.md.
  Json json() const;

 private:
  std::vector<FormedEdge> edges_;  ///< edges of the teeth
  /// For each tooth, the X from which the feed counts: the small end, or the wheel's X at the start of a relief [m].
  std::vector<double> starts_;
  std::vector<double> depths_;  ///< depths of the passes at the small end [m]
  std::vector<StrokeFigures> strokes_;
};

}  // namespace grinder
