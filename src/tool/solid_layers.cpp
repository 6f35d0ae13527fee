#include "tool/solid_layers.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

constexpr double kNoStep = 1e-9;    ///< [m]
constexpr double kForetold = 1e-4;  ///< distance, per radius, within which a section is as foretold
constexpr double kSameStep = 1e-6;  ///< of a step
constexpr std::size_t kStride = 8;  ///< places from one section that is always computed to the next

using Outline = std::vector<PolarPoint>;

/// The places from one X to another at a step, the last of which may be nearer [m].
std::vector<double> evenly(double from, double to, double step) {
  std::vector<double> all;
  const double steps = std::ceil((to - from) / step - kSameStep);
  for (double i = 0; i < steps; ++i) all.push_back(from + i * step);
  all.push_back(to);
  return all;
}

/// Whether an outline is as another one foretells it.
bool isForetold(const Outline& outline, const Outline& by) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double turn = units::kTurn * (outline[i].turns - by[i].turns);
    if (!(std::hypot((outline[i].radius - by[i].radius) / outline[i].radius, turn) <= kForetold)) return false;
  }
  return true;
}

/// The maximum turns of a point on the outer circle from one outline to another: a straight line between them would cut
/// into the circle.
double twist(const Outline& from, const Outline& to) {
  const auto closer = [](const PolarPoint& a, const PolarPoint& b) { return a.radius < b.radius; };
  const double outer = std::max_element(from.begin(), from.end(), closer)->radius;
  double turns = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i].radius == outer) turns = std::max(turns, std::abs(to[i].turns - from[i].turns));
  }
  return turns;
}

/// The layer at an X between two others.
/// @param helix_at angle of the tool's helix at an X, along which the outlines turn [rad].
template <typename HelixAt>
SolidLayer layerBetween(const SolidLayer& from, const SolidLayer& to, double x, const HelixAt& helix_at) {
  const double part = (x - from.x) / (to.x - from.x);
  const double bend = helix_at(x) - helix_at(from.x) - part * (helix_at(to.x) - helix_at(from.x));
  SolidLayer layer{x, from.outline};
  for (std::size_t i = 0; i < layer.outline.size(); ++i) {
    layer.outline[i] = between(from.outline[i], to.outline[i], part, bend / units::kTurn);
  }
  return layer;
}

/// Whether a wheel has been elsewhere than a job says, by what was recorded.
bool hasDeviations(const GroundCutter& cutter) {
  const auto deviates = [](const std::vector<WheelSweep>& sweeps) {
    return std::any_of(sweeps.begin(), sweeps.end(),
                       [](const WheelSweep& sweep) { return !sweep.stroke().deviations.empty(); });
  };
  for (std::size_t i = 0; i < cutter.teeth().size(); ++i) {
    const Reliefs& reliefs = cutter.reliefs(i);
    if (deviates(cutter.flutes()[cutter.teeth()[i].flute]) || std::any_of(reliefs.begin(), reliefs.end(), deviates))
      return true;
  }
  return false;
}

/// Sections at many places. They are computed a stride apart, and wherever those beside one do not foretell it; the
/// others are as foretold.
/// @param x ascending [m].
/// @param outline_at makes the section at an X; on all cores at once.
/// @param helix_at see layerBetween().
template <typename OutlineAt, typename HelixAt>
std::vector<SolidLayer> sectionsAt(const std::vector<double>& x, std::size_t stride, const OutlineAt& outline_at,
                                   const HelixAt& helix_at) {
  std::vector<SolidLayer> layers(x.size());
  const auto compute = [&](const std::vector<std::size_t>& places) {
    onAllCores(places.size(), [&](std::size_t i) { layers[places[i]] = {x[places[i]], outline_at(x[places[i]])}; });
  };
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i + 1 < x.size(); i += stride) places.push_back(i);
  places.push_back(x.size() - 1);
  compute(places);

  using Gap = std::pair<std::size_t, std::size_t>;
  std::vector<Gap> gaps;
  const auto addGap = [](std::size_t from, std::size_t to, std::vector<Gap>& all) {
    if (to - from > 1) all.emplace_back(from, to);
  };
  for (std::size_t i = 1; i < places.size(); ++i) addGap(places[i - 1], places[i], gaps);
  while (!gaps.empty()) {
    places.clear();
    for (const auto& [from, to] : gaps) places.push_back((from + to) / 2);
    compute(places);
    std::vector<Gap> narrower;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      const auto [from, to] = gaps[i];
      const std::size_t middle = places[i];
      const SolidLayer foretold = layerBetween(layers[from], layers[to], x[middle], helix_at);
      const bool fill = isForetold(layers[middle].outline, foretold.outline);
      for (const auto& [a, b] : {Gap{from, middle}, Gap{middle, to}}) {
        if (!fill) addGap(a, b, narrower);
        for (std::size_t k = a + 1; fill && k < b; ++k) layers[k] = layerBetween(layers[a], layers[b], x[k], helix_at);
      }
    }
    gaps = std::move(narrower);
  }
  return layers;
}

}  // namespace

std::vector<SolidLayer> solidLayers(const GroundCutter& cutter, const SolidExtent& extent,
                                    const SolidResolution& resolution, const OutlineGrid& grid) {
  std::vector<SolidLayer> layers;
  // What was recorded may differ anywhere.
  const std::size_t stride = hasDeviations(cutter) ? 1 : kStride;
  const LogCurve curve(cutter.cutter());
  const auto add = [&](SolidLayer next, const auto& helix_at) {
    if (!layers.empty() && next.x > layers.back().x) {
      const SolidLayer last = layers.back();
      const double parts = std::ceil(twist(last.outline, next.outline) * static_cast<double>(resolution.around));
      for (double part = 1; part < parts; ++part) {
        layers.push_back(layerBetween(last, next, last.x + part / parts * (next.x - last.x), helix_at));
      }
    }
    layers.push_back(std::move(next));
  };
  const double step = (extent.to - extent.from) / static_cast<double>(resolution.sections - 1);
  const auto cone = [&](double x) { return sectionOutline(cutter, x, cutter.cutter().radius(x), grid); };
  const auto helix = [&](double x) { return curve.a(x); };
  for (SolidLayer& section : sectionsAt(evenly(extent.from, extent.to, step), stride, cone, helix)) {
    add(std::move(section), helix);
  }
  if (!(extent.shank_to > extent.to)) return layers;

  const double radius = extent.shank_diameter / 2;
  const auto is_whole = [&] {
    const auto& outline = layers.back().outline;
    return std::all_of(outline.begin(), outline.end(), [&](const PolarPoint& p) { return p.radius == radius; });
  };
  const auto shank = [&](double x) { return sectionOutline(cutter, x, radius, grid); };
  // Of no cone, and a flute that runs out turns on only up to its stroke's end.
  const auto straight = [](double) { return 0.0; };
  std::vector<SolidLayer> of_shank = sectionsAt(evenly(extent.to, extent.shank_to, step), stride, shank, straight);
  // Without a step there must be no ring between cone and shank: it would appear as a line of slivers.
  const bool is_step = std::abs(radius - cutter.cutter().radius(extent.to)) > kNoStep;
  for (std::size_t i = is_step ? 0 : 1; i + 1 < of_shank.size() && (i == 0 || !is_whole()); ++i) {
    add(std::move(of_shank[i]), straight);
  }
  add(std::move(of_shank.back()), straight);
  return layers;
}

}  // namespace grinder
