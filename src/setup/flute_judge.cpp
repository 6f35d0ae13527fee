#include "setup/flute_judge.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grinder {

namespace {

constexpr double kBelowEdge = 0.998;  ///< fraction of the radius at which the rake face still has the edge's rake
constexpr double kSameFace = 2 * units::kDegree;
constexpr double kSameError = 0.2;  ///< difference of equal errors, per tolerance
constexpr double kSameChord = 0.25;
constexpr double kNearApex = 0.8;  ///< fraction of the way to the apex beyond which a stroke is long
constexpr double kBeyond = 1e-5;   ///< addition to the overtravel, for the precision of an extremum's position [m]

/// Measures the stroke that the flute needs, and whether it is then complete by the plan's check.
void measureReach(const FluteTrial& trial, const WheelSweep& longest, JudgedFlute& judged) {
  const double length = trial.cutter().cone().flute_length, tan_cone = trial.cutter().tanCone();
  auto& [end, shank] = judged.overtravel;
  for (const double x : {0.0, length}) {
    const Range reach = trial.reach(longest, x);
    end = std::max(end, -reach.from);
    shank = std::max(shank, reach.to - length);
  }
  for (double* beyond : {&end, &shank}) {
    if (*beyond > 0) *beyond += kBeyond;
  }
  const auto complete = trial.ground(trial.sweep(judged.point, {-end, length + shank})).completeRange(0, length);
  judged.complete = complete && complete->from <= 0 && complete->to >= length;
  const double toward_apex = tan_cone >= 0 ? end : shank;
  judged.cut_short = !judged.complete || toward_apex * std::abs(tan_cone) > kNearApex * trial.cutter().radius(0);
}

bool isFacet(const WheelSweep& sweep, double x, double r) {
  const auto edge = sweep.wall(x, r, true), below = sweep.wall(x, kBelowEdge * r, true);
  if (!edge || !below) return true;
  const double turn = std::atan(-kBelowEdge * r * below->slope) - std::atan(-r * edge->slope);
  return !(std::abs(turn) < kSameFace);
}

}  // namespace

JudgedFlute judge(const FluteTrial& trial, const SetupPoint& point) {
  const CutterGeometry& c = trial.request().cutter;
  const WheelSweep sweep = trial.sweep(point);
  const FluteErrors errors = trial.errors(point, kFluteSections);
  JudgedFlute judged;
  judged.point = point;
  judged.error = errors.asked.abs().maxCoeff();
  judged.land = errors.land.minCoeff();
  judged.chord = errors.chord.abs().maxCoeff();
  judged.away = std::abs(point.swivel - c.spiral_angle) + point.depth / trial.cutter().radius(0);
  for (int i = 0; i <= kFluteSections; ++i) {
    const double x = c.flute_length * i / kFluteSections;
    judged.is_facet = judged.is_facet || isFacet(sweep, x, trial.cutter().radius(x));
  }
  measureReach(trial, sweep, judged);
  return judged;
}

bool isBetter(const JudgedFlute& a, const JudgedFlute& b) {
  const auto order = [](const JudgedFlute& j) {
    return std::tuple(!(j.land > 0), j.cut_short, j.is_facet, std::floor(j.error / kSameError),
                      std::floor(j.chord / kSameChord), j.away);
  };
  return order(a) < order(b);
}

}  // namespace grinder
