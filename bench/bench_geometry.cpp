/// @file
/// What the geometry of the ground cutter costs.

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/cutter_solid.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

namespace {

using namespace grinder;
using units::kDegree;
using units::kMillimetre;

/// The paper's cutter with four teeth.
GroundCutter paperTool() {
  CutterGeometry g;
  g.end_diameter = 10 * kMillimetre;
  g.cone_angle = 5 * kDegree;
  g.spiral_angle = 30 * kDegree;
  g.rake_angle = 8 * kDegree;
  g.flute_length = 30 * kMillimetre;
  const ConicalCutter cutter(g);
  const WheelSetup setup{31.769 * kDegree, 2.788 * kMillimetre};
  const GrindStroke stroke{-20 * kMillimetre, 31 * kMillimetre, -1.6 * kMillimetre, 0, 0};
  const WheelProfile wheel = WheelProfile::straight(100 * kMillimetre, 3 * kMillimetre);
  std::vector<GroundTooth> teeth;
  teeth.reserve(4);
  for (int i = 0; i < 4; ++i) teeth.push_back({i * 90 * kDegree, 0});
  return {cutter, {{WheelSweep(cutter, wheel, 50 * kMillimetre, setup, stroke)}}, teeth};
}

/// The whole tool of four teeth as a solid, through 60 sections of 64 rings. Peak memory is that of the whole program,
/// in MB.
void solid(benchmark::State& state) {
  const GroundCutter tool = paperTool();
  for (auto _ : state) benchmark::DoNotOptimize(cutterSolid(tool, {0, 30 * kMillimetre}).volume());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
}
BENCHMARK(solid)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
