#include "setup/setup_judge.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace grinder {

namespace {

constexpr double kFormedByFace = 0.2;  ///< fraction of the rake face's depth that the wheel's face or edge must form
constexpr double kBelowEdge = 0.998;   ///< fraction of the radius at which the rake face still has the edge's rake
constexpr double kSameFace = 2 * units::kDegree;
constexpr double kNotThere = std::numeric_limits<double>::infinity();
constexpr double kSameChord = 2 * units::kDegree;
constexpr double kSameError = 0.5;  ///< fraction of the tolerances below which errors are equal
constexpr double kSameRake = 0.1 * units::kDegree;
constexpr double kNearApex = 0.8;  ///< fraction of the way to the apex beyond which a stroke is long
constexpr double kBeyond = 1e-5;   ///< addition to the overtravel, for the precision of an extremum's position [m]

/// Measures the stroke that the flute needs, and where it is then complete by the plan's check.
void measureReach(const SetupTrial& trial, const SetupPoint& point, SolvedSetup& solved) {
  const double length = trial.cutter().cone().flute_length;
  const WheelSweep longest = trial.sweep(point);
  for (const double x : {0.0, length / 2, length}) {
    const auto reach = trial.reach(longest, x);
    solved.overtravel[0] = std::max(solved.overtravel[0], -reach.from);
    solved.overtravel[1] = std::max(solved.overtravel[1], reach.to - length);
  }
  // Covers the precision of an extremum's position.
  for (double& beyond : solved.overtravel) {
    if (beyond > 0) beyond += kBeyond;
  }
  const WheelSweep stroke = trial.sweep(point, {-solved.overtravel[0], length + solved.overtravel[1]});
  const auto complete = GroundCutter(trial.cutter(), {{stroke}}, {{0, 0}}).completeRange(0, length);
  solved.complete_from = complete ? complete->from : length / 2;
  solved.complete_to = complete ? complete->to : length / 2;
}

void findLimit(const SetupRequest& request, double pitch, SolvedSetup& s) {
  const double swivel = std::min(s.setup.swivel - request.min_swivel, request.max_swivel - s.setup.swivel);
  const double radius = request.cutter.end_diameter / 2;
  const std::pair<SetupLimit, double> margins[] = {
      {SetupLimit::kSwivel, swivel / (request.max_swivel - request.min_swivel)},
      {SetupLimit::kLand, s.land / (pitch * radius)},
      {SetupLimit::kCore, s.core_diameter / 2 / radius}};
  std::tie(s.limit, s.margin) = *std::min_element(std::begin(margins), std::end(margins),
                                                  [](const auto& a, const auto& b) { return a.second < b.second; });
}

}  // namespace

double minPitch(const std::vector<double>& angles) {
  double min = angles.front() + 2 * units::kPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) min = std::min(min, angles[i] - angles[i - 1]);
  return min;
}

Judged judge(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point) {
  const double pitch = minPitch(request.tooth_angles);
  const WheelSweep sweep = trial.sweep(point);
  Judged judged;
  SolvedSetup& s = judged.solved;
  judged.point = point;
  judged.away = std::abs(point.swivel - request.cutter.spiral_angle) + point.depth / trial.cutter().radius(0);
  s.setup = {point.swivel, point.height, point.x_shift};
  s.depth = point.depth;
  s.depth_end = point.depth - (request.y_per_x + point.taper) * request.cutter.flute_length;
  s.min_rake = s.land = std::numeric_limits<double>::infinity();
  s.max_rake = -s.min_rake;
  for (int i = 0; i <= SetupTrial::kSections; ++i) {
    const double x = trial.section(i);
    const double r = trial.cutter().radius(x);
    const auto high = sweep.wall(x, r, true), low = sweep.wall(x, r, false);
    if (!high || !low) {
      judged.problem = SetupProblem::kWall;
      return judged;
    }
    const double rake = std::atan(-r * high->slope);
    const auto below = sweep.wall(x, kBelowEdge * r, true);
    if (!below || !(std::abs(std::atan(-kBelowEdge * r * below->slope) - rake) < kSameFace)) judged.is_facet = true;
    const double chord_off =
        std::abs(trial.chordalRake(sweep, x, high->angle, trial.coreRadius(sweep, x)) - request.rake);
    judged.chord_off = std::max(judged.chord_off, std::isnan(chord_off) ? kNotThere : chord_off);
    s.min_rake = std::min(s.min_rake, rake);
    s.max_rake = std::max(s.max_rake, rake);
    s.land = std::min(s.land, r * (pitch - (high->angle - low->angle)));
    judged.formed_by_face = std::min(judged.formed_by_face, trial.formedByFace(sweep, x));
  }
  s.core_diameter = 2 * trial.coreRadius(sweep, 0);
  s.core_diameter_end = 2 * trial.coreRadius(sweep, request.cutter.flute_length);
  measureReach(trial, point, s);
  const double tan_cone = trial.cutter().tanCone(), toward_apex = s.overtravel[tan_cone >= 0 ? 0 : 1];
  const bool is_complete = s.complete_from <= 0 && s.complete_to >= request.cutter.flute_length;
  judged.cut_short = !is_complete || toward_apex * std::abs(tan_cone) > kNearApex * trial.cutter().radius(0);
  findLimit(request, pitch, s);
  if (!(judged.formed_by_face >= kFormedByFace)) {
    judged.problem = SetupProblem::kWall;
  } else if (!(s.core_diameter > 0)) {
    judged.problem = SetupProblem::kCore;
  } else if (!(s.land > 0)) {
    judged.problem = SetupProblem::kLand;
  } else if (!is_complete && !request.incomplete_ok) {
    judged.problem = SetupProblem::kIncomplete;
  }
  return judged;
}

bool isBetter(const Judged& a, const Judged& b) {
  const auto order = [](const Judged& j) {
    const SolvedSetup& s = j.solved;
    const double spread = s.max_rake - s.min_rake;
    return std::tuple(j.problem ? -static_cast<int>(*j.problem) : -countOf<SetupProblem>(), j.cut_short, j.is_facet,
                      std::floor(j.error / kSameError), std::floor(spread / kSameRake),
                      std::floor(j.chord_off / kSameChord), -j.formed_by_face, j.away);
  };
  return order(a) < order(b);
}

}  // namespace grinder
