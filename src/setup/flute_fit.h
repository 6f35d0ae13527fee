#pragma once

#include "setup/flute_trial.h"

#include <optional>
#include <vector>

namespace grinder {

/// A figure that a fit may change.
struct FreeFigure {
  double SetupPoint::*figure;
  double unit;       ///< change that counts as much as a radian of the swivel
  double low, high;  ///< allowed range
};

/// The figures of a request's set-up that are free.
std::vector<FreeFigure> freeFigures(const FluteTrial& trial);

/// Fits a set-up to the asked tool: the smallest sum of squares of all errors over the flute, each per its tolerance,
/// by Levenberg and Marquardt. An error beyond nine tenths of its tolerance counts ten times, and so does a missing
/// land.
/// @param figures the figures that may change.
/// @param sections intervals between the sections that are measured.
/// @param most maximum number of steps.
/// @return nothing if the start gives no tool.
std::optional<SetupPoint> fitFlute(const FluteTrial& trial, const std::vector<FreeFigure>& figures, SetupPoint start,
                                   int sections, int most);

}  // namespace grinder
