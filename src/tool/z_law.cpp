#include "flute_grinder/tool/z_law.h"

#include "flute_grinder/job/rounded_job.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/pass_removal.h"
#include "tool/rake_correction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grinder {

namespace {

constexpr std::size_t kEdgeSections = 9;  ///< number of sections of the flute
using EdgeAngles = std::array<double, kEdgeSections>;

double sectionOf(const ValidJob& flutes, std::size_t i) {
  return flutes->cutter.flute_length * static_cast<double>(i) / (kEdgeSections - 1);
}

/// See EdgeHelix::ahead.
/// @param cutter cutter with the helix.
/// @param edge angle of the edge in the sections, less the tooth's angle [rad].
double aheadOf(const ConicalCutter& cutter, const ValidJob& flutes, EdgeAngles edge) {
  const LogCurve helix(cutter);
  for (std::size_t i = 0; i < edge.size(); ++i) edge[i] -= helix.a(sectionOf(flutes, i));
  const auto [least, most] = std::minmax_element(edge.begin(), edge.end());
  return (*least + *most) / 2;
}

/// @param job job with the published law.
ZCorrection correctionOf(const ValidJob& job, int tooth, const PlanWatch& watch) {
  const GrindProcess& p = job->process();
  const double rake = job->cutter.rake_angle;
  const auto found =
      correctRake(ConicalCutter(job.cutterOf(tooth)), wheelOf(*job).worn(p.wheel_wear), p.wheel_diameter / 2,
                  setupOf(job, tooth), strokeOf(job, tooth, job.deepest(), p.wheel_wear), rake, watch);
  if (found && std::abs(found->min_rake - rake) <= kEvenRake && std::abs(found->max_rake - rake) <= kEvenRake) {
    return found->z;
  }
  Reason reason{ReasonKind::kUnevenRake, 0, "process.z_law", "", Unit::kRadian, 0, 1, rake};
  reason.tooth = tooth;
  if (found) reason.low = found->min_rake, reason.value = found->max_rake;
  throw ReasonError(reason);
}

/// The job of flutes with its law of Z.
ValidJob withLawOfZ(const ValidJob& job, const PlanWatch& watch) {
  if (job->process().z_law == ZLaw::kPublished) return job;
  const ValidJob published =
      ValidJob(roundedOff(*job)).withZCorrections(std::vector<ZCorrection>(job->tooth_angles.size()));
  std::map<double, ZCorrection> by_spiral;
  std::vector<ZCorrection> corrections;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) {
    const auto [place, is_new] = by_spiral.try_emplace(published.cutterOf(tooth).spiral_angle);
    if (is_new) place->second = correctionOf(published, tooth, watch);
    corrections.push_back(place->second);
  }
  return job.withZCorrections(std::move(corrections));
}

/// The flutes under another operation. Only the wheel's wear in them depends on their passes.
ValidJob flutesUnder(const ValidJob& job, const PlanWatch& watch) {
  const ValidJob flutes = withLawOfZ(ValidJob(job->ofOperation(0)), watch);
  return flutes->process().wheel_wear_per_pass > 0 ? withPasses(flutes, watch) : flutes;
}

}  // namespace

std::vector<EdgeHelix> edgesOf(const ValidJob& flutes) {
  const GroundCutter cutter = groundCutterOf(flutes);
  std::vector<EdgeAngles> angles(cutter.teeth().size());
  for (std::size_t i = 0; i < kEdgeSections; ++i) {
    const GroundSection section = cutter.section(sectionOf(flutes, i));
    for (std::size_t tooth = 0; tooth < angles.size(); ++tooth) {
      const auto& edge = section.teeth[tooth].edge;
      if (!edge) {
        throw ReasonError(otherReason("tooth " + std::to_string(tooth + 1) +
                                      " has no edge at X = " + text(Quantity{section.x, Unit::kMetre}) +
                                      ": other operations have nothing to follow"));
      }
      angles[tooth][i] = *edge - cutter.teeth()[tooth].angle;
    }
  }
  std::map<std::size_t, double> spirals;  // by flute: teeth that share one have the same spiral to the last bit
  std::vector<EdgeHelix> edges;
  for (std::size_t tooth = 0; tooth < angles.size(); ++tooth) {
    CutterGeometry own = flutes.cutterOf(static_cast<int>(tooth));
    const auto [place, is_new] = spirals.try_emplace(cutter.teeth()[tooth].flute);
    if (is_new) {
      const double turn = angles[tooth].back() - angles[tooth].front();
      place->second = meanSpiral(ConicalCutter(own), 0, own.flute_length, turn);
    }
    own.spiral_angle = place->second;
    edges.push_back({own.spiral_angle, angles[tooth].front(), aheadOf(ConicalCutter(own), flutes, angles[tooth])});
  }
  return edges;
}

ValidJob withLaws(const ValidJob& job, const PlanWatch& watch) {
  if (job->process().kind == OperationKind::kFlute) return withPasses(withLawOfZ(job, watch), watch);
  const ValidJob flutes = flutesUnder(job, watch);
  return withPasses(job.withEdges(flutes, edgesOf(flutes)), watch);
}

}  // namespace grinder
