#include "flute_grinder/tool/pass_removal.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace grinder {

namespace {

constexpr std::array<double, 3> kSectionsOfArea{0, 0.5, 1};  ///< sections whose area counts, per length of the flute
constexpr int kSectionsOfVolume = 12;                        ///< as many as a simulated tool has

/// What an operation finds on the tool.
GroundCutter before(const ValidJob& job, const PlanWatch& watch) {
  return isRelief(job->process().kind) ? groundBefore(job, watch) : GroundCutter(ConicalCutter(job->cutter), {}, {});
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

/// The speed along the axis at the job's feed [m/s].
double axialSpeed(const ValidJob& job, int tooth) {
  return job->process().feed / ConicalCutter(job.cutterOf(tooth)).edgePerTravel();
}

/// What a pass of a depth removes from a section of a whole blank, per second at the feed: a monotone cubic through
/// some depths, closer together toward where the wheel touches.
class RemovalCurve {
 public:
  /// @param deepest depth of the last place [m].
  /// @param touches whether a pass of a depth removes anything.
  /// @param removal what it removes [m^3/s].
  template <typename Touches, typename Removal>
  RemovalCurve(double deepest, const Touches& touches, const Removal& removal) {
    if (!touches(deepest)) return;
    double touch = 0, below = deepest;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (touch + below) / 2;
      (touches(middle) ? below : touch) = middle;
    }
    from_ = touch, length_ = deepest - touch;
    for (int i = 1; i <= kPlaces; ++i) {
      const double part = static_cast<double>(i) / kPlaces;
      values_[place(i)] = std::max(removal(from_ + length_ * part * part), values_[place(i - 1)]);
    }
    for (int i = 1; i < kPlaces; ++i) slopes_[place(i)] = slope(step(i), step(i + 1));
    slopes_[kPlaces] = std::clamp(1.5 * step(kPlaces) - slopes_[kPlaces - 1] / 2, 0.0, 3 * step(kPlaces));
  }

  double at(double depth) const noexcept {
    if (!(length_ > 0) || depth <= from_) return 0;
    const double all = std::min(std::sqrt((depth - from_) / length_), 1.0) * kPlaces;
    const int i = std::min(static_cast<int>(all), kPlaces - 1);
    const double t = all - i, left = 1 - t;
    return values_[place(i)] * left * left * (1 + 2 * t) + values_[place(i + 1)] * t * t * (3 - 2 * t) +
           t * left * (slopes_[place(i)] * left - slopes_[place(i + 1)] * t);
  }

 private:
  static constexpr int kPlaces = 12;
  static constexpr int kHalvings = 14;

  static std::size_t place(int i) { return static_cast<std::size_t>(i); }
  double step(int i) const { return values_[place(i)] - values_[place(i - 1)]; }
  /// Between two steps that rise, so that the curve never falls: their harmonic mean.
  static double slope(double a, double b) { return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0; }

  double from_ = 0, length_ = 0;
  std::array<double, kPlaces + 1> values_{}, slopes_{};
};

using RemovalCurves = std::vector<RemovalCurve>;

/// @param done see PlanWatch.
/// @throw ReasonError if the plan is no longer wanted.
void keepOn(const PlanWatch& watch, double done) {
  if (watch && !watch(done)) throw ReasonError(Reason{ReasonKind::kGivenUp});
}

/// The curves of all distinct teeth, in each of the sections that count.
RemovalCurves curvesOf(const ValidJob& job, double deepest, const PlanWatch& watch) {
  const GroundCutter ground = before(job, watch);
  const double wear = job->process().wheel_wear;
  RemovalCurves curves;
  for (const AlikeTeeth& alike : alikeTeeth(job, ground)) {
    const int tooth = alike.first;
    const double angle = job->tooth_angles[static_cast<std::size_t>(tooth)], speed = axialSpeed(job, tooth);
    const auto sweep = [&](double depth) {
      keepOn(watch, 0);
      return sweepOf(job, tooth, wear, strokeOf(job, tooth, depth, wear));
    };
    for (const double part : kSectionsOfArea) {
      const double x = part * job->cutter.flute_length, radius = ground.cutter().radius(x);
      curves.emplace_back(
          deepest, [&](double depth) { return sweep(depth).minRadius(x, radius) < radius; },
          [&](double depth) { return speed * ground.areaRemovedBy(sweep(depth), angle, x); });
    }
  }
  return curves;
}

/// The most that a pass removes [m^3/s].
double removalBetween(const RemovalCurves& curves, double from, double to) {
  double most = 0;
  for (const RemovalCurve& curve : curves) most = std::max(most, curve.at(to) - curve.at(from));
  return most;
}

/// The depths of passes that each remove as much.
/// @param removal what each removes; the last may remove less [m^3/s].
/// @param count maximum number of passes.
/// @return ascending; the last is `deepest` if the passes get there [m].
std::vector<double> passesOf(const RemovalCurves& curves, double deepest, double removal, std::size_t count,
                             const PlanWatch& watch) {
  constexpr int halvings = 40;
  constexpr double steps = 1e8;  // per metre: depths are multiples of 10 nm
  std::vector<double> depths;
  for (double last = 0; depths.size() < count && last < deepest;) {
    keepOn(watch, 0);
    double next = deepest;
    if (removalBetween(curves, last, deepest) > removal) {
      double within = last, beyond = deepest;
      for (int i = 0; i < halvings; ++i) {
        const double middle = (within + beyond) / 2;
        (removalBetween(curves, last, middle) > removal ? beyond : within) = middle;
      }
      next = std::floor(within * steps) / steps;
      if (!(next > last)) return depths;  // no pass is so shallow
    }
    depths.push_back(last = next);
  }
  return depths;
}

/// The depths of the roughing passes of a job by removal.
std::vector<double> roughingOf(const ValidJob& job, const PlanWatch& watch) {
  const GrindProcess& p = job->process();
  const double deepest = job.deepest() - p.finish_infeed;
  if (!(deepest > 0)) return {};
  const RemovalCurves curves = curvesOf(job, deepest, watch);
  const double all = removalBetween(curves, 0, deepest);
  if (!(all > 0)) return {};
  const auto arrives = [&](const std::vector<double>& depths) { return !depths.empty() && depths.back() == deepest; };
  auto count = static_cast<std::size_t>(p.roughing_passes);
  if (p.removal > 0) {
    const std::vector<double> depths = passesOf(curves, deepest, p.removal, kMaxRoughingPasses, watch);
    if (!arrives(depths)) {
      throw ReasonError({ReasonKind::kNotAllowed, 0, "process.removal",
                         "enough for " + std::to_string(kMaxRoughingPasses) + " roughing passes",
                         Unit::kCubicMetrePerSecond, p.removal});
    }
    count = depths.size();
  }
  // The least that each of so many passes may remove.
  constexpr int halvings = 50;
  double too_little = 0, enough = all;
  std::vector<double> found = passesOf(curves, deepest, enough, count, watch);
  for (int i = 0; i < halvings; ++i) {
    const double middle = (too_little + enough) / 2;
    std::vector<double> depths = passesOf(curves, deepest, middle, count, watch);
    if (arrives(depths)) {
      enough = middle;
      found = std::move(depths);
    } else {
      too_little = middle;
    }
  }
  return found;
}

}  // namespace

ValidJob withPasses(const ValidJob& job, const PlanWatch& watch) {
  return job.hasPasses() ? job : job.withRoughing(roughingOf(job, watch));
}

std::vector<PassRemoval> removalOfPasses(const ValidJob& job, const PlanWatch& watch) {
  if (job.isStraight() || job.depths().size() > kMaxMeasuredPasses) return {};
  const GroundCutter ground = before(job, watch);
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
    keepOn(watch, 1);
    const WheelSweep sweep = sweepOf(job, tooth, wear[number], strokeOf(job, tooth, depths[pass], wear[number]));
    for (std::size_t s = 0; s < sections.size(); ++s) {
      keepOn(watch, 1);
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
        removal.area = std::max(removal.area, area);
        removal.rate = std::max(removal.rate, area * axialSpeed(job, alike.first));
      }
    }
  }
  return removals;
}

}  // namespace grinder
