#include "flute_grinder/geometry/z_law.h"

#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/job/valid_job.h"
#include "geometry/rake_correction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grinder {

namespace {

constexpr int kEdgeSections = 9;  ///< of the flute

/// @param job with the published law.
ZCorrection correctionOf(const ValidJob& job, int tooth, const PlanWatch& watch) {
  const GrindProcess& p = job->process;
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

}  // namespace

std::vector<double> edgesOf(const ValidJob& flutes) {
  const GroundCutter cutter = groundCutterOf(flutes);
  std::vector<Range> off(cutter.teeth().size());
  for (int i = 0; i < kEdgeSections; ++i) {
    const GroundSection section = cutter.section(flutes->cutter.flute_length * i / (kEdgeSections - 1));
    for (std::size_t tooth = 0; tooth < off.size(); ++tooth) {
      if (!section.teeth[tooth].edge) {
        throw ReasonError(otherReason("tooth " + std::to_string(tooth + 1) + " has no edge at X = " +
                                      text(Quantity{section.x, Unit::kMetre}) + ": a relief has nothing to follow"));
      }
      const LogCurve asked(ConicalCutter(flutes.cutterOf(static_cast<int>(tooth))));
      const double here = *section.teeth[tooth].edge - cutter.teeth()[tooth].angle - asked.a(section.x);
      off[tooth] = i == 0 ? Range{here, here} : Range{std::min(off[tooth].from, here), std::max(off[tooth].to, here)};
    }
  }
  std::vector<double> edges;
  for (const Range& range : off) edges.push_back((range.from + range.to) / 2);
  return edges;
}

ValidJob withLaws(const ValidJob& job, const PlanWatch& watch) {
  if (job.relief(0) != nullptr) {
    const ValidJob flutes = withLaws(ValidJob(job->ofOperation(0)), watch);
    return job.withEdges(flutes, edgesOf(flutes));
  }
  if (job->process.z_law == ZLaw::kPublished) return job;
  const ValidJob published = job.withZCorrections(std::vector<ZCorrection>(job->tooth_angles.size()));
  std::map<double, ZCorrection> by_spiral;
  std::vector<ZCorrection> corrections;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) {
    const auto [place, is_new] = by_spiral.try_emplace(job.cutterOf(tooth).spiral_angle);
    if (is_new) place->second = correctionOf(published, tooth, watch);
    corrections.push_back(place->second);
  }
  return job.withZCorrections(std::move(corrections));
}

}  // namespace grinder
