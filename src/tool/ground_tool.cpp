#include "flute_grinder/tool/ground_tool.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/units.h"
#include "tool/end_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace grinder {

namespace {

using units::kMillimetre;

constexpr int kVolumeSections = 12;
constexpr double kMinGouge = 1e-6;  ///< depth up to which a gouge may come from averaging positions [m]

/// The reason for the deepest gouge, if it is deep enough.
std::optional<Reason> reasonOf(const ValidJob& job, const std::vector<Gouge>& gouges) {
  const auto shallower = [](const Gouge& a, const Gouge& b) { return a.depth < b.depth; };
  const auto deepest = std::max_element(gouges.begin(), gouges.end(), shallower);
  if (deepest == gouges.end() || !(deepest->depth > kBadGouge)) return std::nullopt;
  const std::string beyond = job.isStraight()
                                 ? "face that the job asks for"
                                 : format("flute that the job asks for, at X = %.3f mm", deepest->x / kMillimetre);
  return otherReason(format("tooth %d, pass %d, %s: the wheel went %.3f mm beyond the ", deepest->place.tooth + 1,
                            deepest->place.pass + 1, toString(deepest->move), deepest->depth / kMillimetre) +
                     beyond + format("; allowed: up to %.3f mm", kBadGouge / kMillimetre));
}

/// A cutter with its sections, not checked.
GroundTool withSections(const ValidJob& job, const std::string& source, GroundCutter cutter,
                        const std::vector<double>& at) {
  GroundTool tool{job, source, std::move(cutter), {}, {}, {}, 0, false, false, {}, {}};
  tool.sections.resize(at.size());
  onAllCores(at.size(), [&](std::size_t i) {
    const GroundSection section = tool.cutter.section(at[i]);
    tool.sections[i] = {section, tool.cutter.areaRemoved(section)};
  });
  tool.volume_removed = tool.cutter.volumeRemoved(0, job->cutter.flute_length, kVolumeSections);
  return tool;
}

}  // namespace

bool GroundTool::allTeethGround() const {
  std::set<int> teeth;
  for (const RunStroke& stroke : strokes) {
    if (stroke.move == MoveKind::kStroke) teeth.insert(stroke.place.tooth);
  }
  return teeth.size() == job->tooth_angles.size();
}

double groundTo(const GrindJob& job) {
  double end = 0;
  for (int i = 0; i <= job.operation; ++i) {
    const GrindProcess& p = job.operations[static_cast<std::size_t>(i)];
    if (isStraight(p.kind)) continue;
    const double run_out = std::sqrt(p.wheel_diameter * (p.deepest() + shankCut(job.cutter)));
    end = std::max(end, job.cutter.flute_length + p.overtravel_shank + run_out);
  }
  return end;
}

std::vector<double> evenSections(const GrindJob& job, int count) {
  std::vector<double> at;
  for (int i = 0; i < count; ++i) at.push_back(job.cutter.flute_length * i / (count - 1));
  return at;
}

GroundTool measure(const ValidJob& job, const std::string& source, GroundCutter cutter, const std::vector<double>& at) {
  GroundTool tool = withSections(job, source, std::move(cutter), at);
  tool.check = checkGroundCutter(job, tool.cutter);
  tool.end = endVolumesOf(job);
  return tool;
}

GroundTool measure(const std::string& source, const RunStrokes& strokes, const std::vector<double>& at) {
  GroundTool tool = withSections(strokes.job(), source, strokes.cutter(), at);
  tool.check = strokes.job().isStraight() ? checkGroundEnd(strokes) : checkGroundCutter(tool.job, tool.cutter);
  tool.end = endVolumesOf(strokes.job(), strokes.straightStrokes());
  tool.of_run = true;
  tool.on_planned = strokes.isOnPlanned();
  tool.strokes = strokes.strokes();
  tool.gouges = gougesOf(strokes, kMinGouge);
  if (auto reason = reasonOf(strokes.job(), tool.gouges)) tool.check.reasons.push_back(*std::move(reason));
  return tool;
}

}  // namespace grinder
