#pragma once

#include "flute_grinder/setup/setup_solver.h"
#include "setup/setup_trial.h"

#include <Eigen/Core>

#include <optional>

namespace grinder {

constexpr int kFitSteps = 40;     ///< maximum number of steps of a fit
constexpr double kWithin = 0.98;  ///< fraction of the tolerances for a set-up: figures are rounded, the wheel wears

/// The errors of a set-up's tool against the asked values; NaN where the wheel does not reach it.
struct SetupErrors {
  Eigen::ArrayXd rake;    ///< rake in equidistant sections, including the flute's ends [rad]
  Eigen::ArrayXd turn;    ///< turn of the edge from each section to the next, as a spiral angle [rad]
  Eigen::ArrayXd spiral;  ///< spiral angle of the edge in the sections; empty for the ends alone [rad]
  Eigen::ArrayXd chord;   ///< chordal rake in the sections; empty for the ends alone [rad]
  Eigen::ArrayXd core;    ///< core diameters, relative to the small end's; if both are asked, in the sections

  /// The maximum error per tolerance: up to 1 is within the tolerances; infinite if there is no tool.
  double worst(const SetupRequest& request) const;
};

/// @param trial trial of a right-hand cutter.
/// @param request request for the same cutter.
/// @param steps steps between sections; a cylinder, whose edge turns as asked in any set-up, has one section.
SetupErrors setupErrors(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point, int steps);

/// Whether to look for a shift along X: it has no effect on a cylinder or on straight flutes.
bool hasShift(const SetupTrial& trial, const SetupRequest& request);

/// Whether the height follows the swivel, so that the wheel's face passes the axis at the height R sin r. This is so on
/// a cylinder unless another figure is fixed or all are asked.
bool isHeightTied(const SetupTrial& trial, const SetupRequest& request);

/// The height at which the wheel's upper face passes the axis at the height R sin r [m].
double tiedHeight(const SetupTrial& trial, const SetupRequest& request, double swivel);

/// Whether to look for the depth.
bool findsDepth(const SetupTrial& trial, const SetupRequest& request);

/// The result of a fit to the flute's ends.
struct EndsFit {
  SetupPoint point;
  bool is_exact = false;  ///< whether it gives all asked values at the ends, rather than near them
};

/// Fits a set-up to the asked values at the ends: the rake at both ends, the angle of the edge between them, and the
/// cores. With the published law of Z the rake rises or falls between the ends, so an exact fit gives both ends an
/// error opposite to the one between them: the set-up with the minimum of the maximum error over the flute.
/// @param trial, request see setupErrors().
/// @param start start of the fit.
/// @return nothing if the start gives no tool.
std::optional<EndsFit> fitEnds(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start);

/// The set-up near a start with the minimum sum of squares of all errors over the flute, per tolerance.
/// @param most maximum number of steps of the fit.
/// @return nothing if the start gives no tool.
std::optional<SetupPoint> nearestSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                       int most = kFitSteps);

/// The set-up near another one with the minimum sums of ever higher powers of the errors, in which the maximum error
/// counts most, to bring the last error within its tolerance. Unchanged if all errors are within, or one is far beyond.
SetupPoint evenedSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& nearest);

/// The set-up near a start whose teeth have a land, with all errors within their tolerances, as far as possible.
SetupPoint setupWithLand(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start);

}  // namespace grinder
