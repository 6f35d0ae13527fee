#include "flute_grinder/geometry/z_law.h"

#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/rake_correction.h"
#include "flute_grinder/job/grind_job.h"

#include <cmath>
#include <map>
#include <utility>

namespace grinder {

namespace {

/// @param job with the published law.
ZCorrection correctionOf(const GrindJob& job, int tooth, const PlanWatch& watch) {
  const GrindProcess& p = job.process;
  const double rake = job.cutter.rake_angle;
  const auto found =
      correctRake(ConicalCutter(cutterOf(job, tooth)), wheelOf(job).worn(p.wheel_wear), p.wheel_diameter / 2,
                  setupOf(job), strokeOf(job, tooth, p.deepest(), p.wheel_wear), rake, watch);
  if (found && std::abs(found->min_rake - rake) <= kEvenRake && std::abs(found->max_rake - rake) <= kEvenRake) {
    return found->z;
  }
  Reason reason;
  reason.kind = ReasonKind::kUnevenRake;
  reason.field = "process.z_law";
  reason.unit = Unit::kRadian;
  reason.tooth = tooth;
  reason.low = found ? found->min_rake : 1;
  reason.value = found ? found->max_rake : 0;
  reason.limit = rake;
  throw ReasonError(reason);
}

}  // namespace

GrindJob withZLaw(GrindJob job, const PlanWatch& watch) {
  job.z_corrections.clear();
  if (job.process.z_law == ZLaw::kPublished) return job;
  GrindJob published = job;
  published.process.z_law = ZLaw::kPublished;
  std::map<double, ZCorrection> by_spiral;
  for (int tooth = 0; tooth < static_cast<int>(job.tooth_angles.size()); ++tooth) {
    const auto [place, is_new] = by_spiral.try_emplace(cutterOf(job, tooth).spiral_angle);
    if (is_new) place->second = correctionOf(published, tooth, watch);
    job.z_corrections.push_back(place->second);
  }
  return job;
}

}  // namespace grinder
