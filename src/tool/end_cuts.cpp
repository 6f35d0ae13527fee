#include "tool/end_cuts.h"

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <utility>

namespace grinder {

namespace {

constexpr double kFacets = 1.5e-6;  ///< largest distance between a rim and its facets [m]

SurfaceKind surfaceOf(OperationKind kind) {
  switch (kind) {
    case OperationKind::kPrimaryEnd: return SurfaceKind::kEndPrimary;
    case OperationKind::kSecondaryEnd: return SurfaceKind::kEndSecondary;
    case OperationKind::kChamfer: return SurfaceKind::kChamfer;
    default: return SurfaceKind::kGash;
  }
}

}  // namespace

EndStrokes plannedStrokes(const ValidJob& job) {
  const std::vector<double> wear = job.wearOfTeeth();
  EndStrokes strokes;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) {
    strokes.emplace(tooth, job.faceStroke(tooth, job.deepest(), wear[static_cast<std::size_t>(tooth)]));
  }
  return strokes;
}

void addCuts(const ValidJob& job, const EndStrokes& strokes, std::vector<EndCut>& cuts) {
  const std::vector<double> wear = job.wearOfTeeth();
  for (const auto& [tooth, stroke] : strokes) {
    const auto i = static_cast<std::size_t>(tooth);
    const FaceWheel wheel = job.faceWheel(wear[i]);
    GrindJob worn = *job;
    worn.process().wheel_width -= wheel.face_wear;
    cuts.push_back({i, job->process().kind,
                    FaceSweep(stroke, wheel, wheelOf(worn).worn(wheel.nominal_radius - wheel.radius),
                              job->cutter.end_diameter / 2, 0)});
  }
}

EndCuts endCutsOf(const ValidJob& job, const EndStrokes& own) {
  EndCuts end;
  double stock = 0;
  for (int i = 1; i <= job->operation; ++i) {
    const GrindProcess& process = job->operations[static_cast<std::size_t>(i)];
    if (!isStraight(process.kind)) continue;
    stock = std::max(stock, process.stock);
    if (i == job->operation) {
      addCuts(job, own, end.cuts);
      continue;
    }
    const ValidJob before = job.ofOperation(i);
    addCuts(before, plannedStrokes(before), end.cuts);
  }
  end.blank_x = -stock;
  return end;
}

EndVolumes endVolumesOf(const ValidJob& job, const EndStrokes& own) {
  const EndCuts end = endCutsOf(job, own);
  EndVolumes volumes{end.blank_x, {}};
  for (const EndCut& cut : end.cuts) {
    RemovedVolume& volume = volumes.removed.emplace_back(cut.sweep.volume(kFacets));
    volume.kind = surfaceOf(cut.kind);
    volume.tooth = static_cast<std::uint16_t>(cut.tooth);
  }
  return volumes;
}

EndVolumes endVolumesOf(const ValidJob& job) {
  return endVolumesOf(job, job.isStraight() ? plannedStrokes(job) : EndStrokes());
}

}  // namespace grinder
