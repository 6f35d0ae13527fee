#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/odd_even_interpolator.h"

#include <algorithm>
#include <vector>

namespace grinder {

/// A cutter's curve interpolated with a fixed step length, as in the paper's Table 1.
struct StepTable {
  struct Row {
    CurvePoint point;
    double theory = 0;  ///< A of the curve at the point's X [rad]
    double error() const { return theory - point.a; }
  };
  std::vector<Row> rows;      ///< the start at X = 0, then alternating odd and even points
  double max_odd_error = 0;   ///< [rad]
  double max_even_error = 0;  ///< [rad]
  bool complete = false;      ///< false if the steps are too long to continue on the curve after the last row

  double maxError() const { return std::max(max_odd_error, max_even_error); }
};

/// Interpolates a cutter's curve from X = 0 until a pair ends at or beyond the end of the flute.
/// @param rotary_scale length equivalent to one radian in the metric of OddEvenInterpolator [m/rad].
/// @param step_length length of a step in that metric, positive [m].
StepTable interpolateBySteps(const ConicalCutter& cutter, double rotary_scale, EvenStepRule rule, double step_length);

}  // namespace grinder
