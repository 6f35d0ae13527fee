#include "flute_grinder/tool/pass_removal.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grinder {

namespace {

constexpr std::array<double, 3> kSectionsOfArea{0, 0.5, 1};  ///< sections whose area counts, per length of the flute
constexpr int kSectionsOfVolume = 12;                        ///< as many as a simulated tool has

/// What an operation finds on the tool.
GroundCutter before(const ValidJob& job) {
  return isRelief(job->process().kind) ? groundBefore(job) : GroundCutter(ConicalCutter(job->cutter), {}, {});
}

/// Teeth from which every pass removes the same.
struct AlikeTeeth {
  int first = 0, count = 1;
};

std::vector<AlikeTeeth> alikeTeeth(const ValidJob& job, const GroundCutter& before) {
  const auto are_alike = [&](int a, int b) {
    return before.teeth().empty() ? job.cutterOf(a).spiral_angle == job.cutterOf(b).spiral_angle
                                  : before.landsAreAlike(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  };
  std::vector<AlikeTeeth> all;
  for (int tooth = 0; tooth < job.teeth(); ++tooth) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return are_alike(one.first, tooth); });
    if (same == all.end()) {
      all.push_back({tooth});
    } else {
      ++same->count;
    }
  }
  return all;
}

}  // namespace

std::vector<PassRemoval> removalOfPasses(const ValidJob& job) {
  if (job.isStraight() || job.depths().size() > kMaxMeasuredPasses) return {};
  const GroundCutter ground = before(job);
  const std::vector<AlikeTeeth> teeth = alikeTeeth(job, ground);
  const std::vector<double>& depths = job.depths();
  const std::vector<double> wear = job.wearOfTeeth();
  const double length = job->cutter.flute_length;
  std::vector<double> sections;
  for (const double part : kSectionsOfArea) sections.push_back(part * length);
  for (int i = 0; i < kSectionsOfVolume; ++i) sections.push_back((i + 0.5) / kSectionsOfVolume * length);

  // Areas removed by the passes up to each, by pass, then by teeth, then by section. Spark-out is not measured again.
  const std::size_t per_pass = teeth.size() * sections.size();
  const auto infeeds =
      static_cast<std::size_t>(std::find(depths.begin(), depths.end(), job.deepest()) - depths.begin()) + 1;
  std::vector<double> areas(infeeds * per_pass);
  onAllCores(infeeds * teeth.size(), [&](std::size_t i) {
    const std::size_t pass = i / teeth.size(), one = i % teeth.size();
    const int tooth = teeth[one].first;
    const auto number = static_cast<std::size_t>(tooth);
    const WheelSweep sweep = sweepOf(job, tooth, wear[number], strokeOf(job, tooth, depths[pass], wear[number]));
    for (std::size_t s = 0; s < sections.size(); ++s) {
      areas[i * sections.size() + s] = ground.areaRemovedBy(sweep, job->tooth_angles[number], sections[s]);
    }
  });

  std::vector<PassRemoval> removals;
  for (std::size_t pass = 0; pass < depths.size(); ++pass) {
    PassRemoval& removal = removals.emplace_back(PassRemoval{depths[pass]});
    if (pass >= infeeds) continue;
    for (std::size_t i = 0; i < per_pass; ++i) {
      const AlikeTeeth& alike = teeth[i / sections.size()];
      const double up_to = areas[pass * per_pass + i], last = pass > 0 ? areas[(pass - 1) * per_pass + i] : 0;
      const double area = std::max(0.0, up_to - last);
      if (i % sections.size() >= kSectionsOfArea.size()) {
        removal.volume += alike.count * area * length / kSectionsOfVolume;
      } else {
        const double speed = job->process().feed / ConicalCutter(job.cutterOf(alike.first)).edgePerTravel();
        removal.area = std::max(removal.area, area);
        removal.rate = std::max(removal.rate, area * speed);
      }
    }
  }
  return removals;
}

}  // namespace grinder
