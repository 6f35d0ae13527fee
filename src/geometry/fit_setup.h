#pragma once

#include "flute_grinder/geometry/setup_solver.h"
#include "geometry/setup_trial.h"

#include <Eigen/Core>

#include <optional>

namespace grinder {

constexpr int kFitSteps = 40;     ///< at most
constexpr double kWithin = 0.98;  ///< of the tolerances, for a set-up to be taken: figures are rounded, the wheel wears

/// What a set-up makes of the tool, less what is asked; NaN where the wheel does not reach it.
struct SetupErrors {
  Eigen::ArrayXd rake;    ///< in sections at equal distances, the flute's ends among them [rad]
  Eigen::ArrayXd turn;    ///< of the edge from each section to the next, as a spiral angle [rad]
  Eigen::ArrayXd spiral;  ///< of the edge in the sections; none if they are the ends alone [rad]
  Eigen::ArrayXd chord;   ///< the chordal rake in the sections; none if they are the ends alone [rad]
  Eigen::ArrayXd core;    ///< of the asked diameters, by that of the small end; if both are asked, in the sections

  /// The maximum error by its tolerance: 1 or less is within them; infinite if there is none.
  double worst(const SetupRequest& request) const;
};

/// @param trial of a right-hand cutter. @param request of the same. @param steps between sections; a cylinder, whose
///        edge turns as asked in any set-up, has one section.
SetupErrors setupErrors(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point, int steps);

/// Whether a shift is looked for: it has no effect on a cylinder, nor on straight flutes.
bool hasShift(const SetupTrial& trial, const SetupRequest& request);

/// Whether the height follows the swivel, so that the wheel's face passes the axis at the height R sin r: on a cylinder
/// of which neither another figure is kept nor all are asked.
bool isHeightTied(const SetupTrial& trial, const SetupRequest& request);

/// The height of the wheel for its upper face to pass the axis at the height R sin r [m].
double tiedHeight(const SetupTrial& trial, const SetupRequest& request, double swivel);

/// Whether the depth is looked for.
bool findsDepth(const SetupTrial& trial, const SetupRequest& request);

/// What a fit to the flute's ends has come to.
struct EndsFit {
  SetupPoint point;
  bool is_exact = false;  ///< gives all that is asked at the ends; else it comes near it
};

/// Fits a set-up to what is asked at the ends: the rake at both, the angle of the edge between them, and the cores. By
/// the published law of Z the rake rises or falls between the ends, so an exact one gives both the same error of the
/// other sign: the set-up with the minimum of the maximum error over the flute.
/// @param trial, request as of setupErrors(). @param start from which it is looked for.
/// @return nothing if the start gives no tool.
std::optional<EndsFit> fitEnds(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start);

/// The set-up near a start with the least sum of squares of all errors over the flute, each by its tolerance.
/// @param most steps of the fit. @return nothing if the start gives no tool.
std::optional<SetupPoint> nearestSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                       int most = kFitSteps);

/// The same with the least sums of ever higher powers, in which the maximum error counts most: what it takes to bring
/// the last error within its tolerance. As it is where all are, or one is far beyond.
SetupPoint evenedSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& nearest);

/// The set-up near a start whose teeth have a land, with all errors within their tolerances, as far as there is one.
SetupPoint setupWithLand(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start);

}  // namespace grinder
