#pragma once

#include "flute_grinder/core/axes.h"
#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/grind_job.h"
#include "flute_grinder/core/log_curve.h"
#include "flute_grinder/core/setpoint.h"
#include "flute_grinder/geometry/ground_cutter.h"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace flute_grinder {

/// Of a stroke in a record, what was ground.
struct RecordedStroke {
  ToothPass place;
  Range range;                            ///< of X [m]
  std::vector<PathDeviation> deviations;  ///< as GrindStroke has them
};

/// The strokes of a run from the positions that the drive read, and the cutter as they ground it. What is not in the
/// record is not removed. Setpoints that are missing within a stroke are taken to lie between their neighbours.
class RecordedStrokes {
 public:
  /// @param job a job that validate() accepts, from withZLaw().
  explicit RecordedStrokes(const GrindJob& job);

  /// Takes the setpoints of a job in order. Those that do not belong to a stroke are needed as well.
  /// @param actual position that was read one cycle before [m], A [rad].
  /// @throw std::invalid_argument for a tooth or a pass that the job does not have, and for a position that is not
  ///        finite.
  void add(const Setpoint& setpoint, const Axes& actual);

  /// To be called after the last setpoint.
  void finish();

  /// Those that formed the cutter: of every tooth each stroke that no deeper one covers.
  const std::vector<RecordedStroke>& strokes() const noexcept { return strokes_; }

  /// The cutter as ground; a tooth without a stroke removes nothing.
  GroundCutter cutter() const;

 private:
  /// The mean of some positions that are near one another.
  struct Sample {
    int count = 0;
    double x = 0;
    PathDeviation off;
  };
  /// The stroke that is being read, with its path.
  struct Reading {
    Reading(const GrindJob& job, const ToothPass& tooth_pass, double wear);

    ToothPass place;
    ConicalCutter cutter;
    LogCurve curve;
    GrindStroke path;
    double angle;
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  };

  std::size_t placeInOrder(const ToothPass& place) const;
  void sample(const Axes& actual);
  std::vector<PathDeviation> deviations(const Range& range) const;
  void endStroke();
  bool covers(const RecordedStroke& deep, const RecordedStroke& shallow) const;

  const GrindJob job_;
  const std::vector<ToothPass> order_;
  const std::vector<double> wear_;    ///< in that order [m]
  const std::vector<double> depths_;  ///< of the passes [m]
  std::optional<Reading> reading_;
  std::map<long, Sample> samples_;  ///< of that stroke, by its place on X
  std::uint64_t cycle_ = 0;         ///< of the last setpoint
  bool in_stroke_ = false;          ///< whether that belongs to a stroke
  std::vector<RecordedStroke> strokes_;
};

}  // namespace flute_grinder
