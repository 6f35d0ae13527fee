#include "flute_grinder/geometry/z_law.h"

#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/rake_correction.h"
#include "flute_grinder/job/valid_job.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace grinder {

namespace {

/// @param job with the published law.
ZCorrection correctionOf(const ValidJob& job, int tooth, const PlanWatch& watch) {
  const GrindProcess& p = job->process;
  const double rake = job->cutter.rake_angle;
  const auto found =
      correctRake(ConicalCutter(job.cutterOf(tooth)), wheelOf(*job).worn(p.wheel_wear), p.wheel_diameter / 2,
                  setupOf(*job), strokeOf(job, tooth, p.deepest(), p.wheel_wear), rake, watch);
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

ValidJob withZLaw(const ValidJob& job, const PlanWatch& watch) {
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
