/// @file
/// What a step, a setpoint, a planned job, a checked tool and a cycle of the control loop cost.
/// Figures per setpoint or per cycle are the item rates: 10M items/s are 100 ns each.

#include "drive/simulated_drive.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/tool/z_law.h"
#include "jobs.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace {

using namespace grinder;

Machine machine() {
  Machine m;
  m.period = 1e-3;
  m.limits.min_position << -0.1, -0.02, -0.05, -125.66;
  m.limits.max_position << 0.3, 0.15, 0.1, 125.66;
  m.limits.max_velocity << 0.2, 0.1, 0.1, 12.566;
  m.limits.max_acceleration << 0.5, 0.5, 0.5, 62.83;
  m.limits.max_jerk << 10, 10, 10, 1257;
  m.park << -0.05, 0.05, 0, 0;
  return m;
}

EvenStepRule ruleOf(const benchmark::State& state) { return static_cast<EvenStepRule>(state.range(0)); }

/// What no setpoint of the curve can do without: a logarithm, a square root and a division, each waiting for the one
/// before.
void setpointFloor(benchmark::State& state) {
  double x = 0.5;
  for (auto _ : state) {
    x = 1 / (1 + std::sqrt(std::log1p(x)));
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(setpointFloor);

/// One step (half of a pair) at the servo rate.
void step(benchmark::State& state) {
  const EvenStepRule rule = ruleOf(state);
  state.SetLabel(toString(rule));
  const LogCurve curve{ConicalCutter(paperJob(60).cutter)};
  OddEvenInterpolator interpolator(curve, 1e-3, rule, 0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(interpolator.next(1e-6));
    if (interpolator.position().x > 0.03) interpolator = OddEvenInterpolator(curve, 1e-3, rule, 0);
  }
  state.SetItemsProcessed(state.iterations() * 2);
}
BENCHMARK(step)->DenseRange(0, 2);

/// SetpointStream::next() over the whole paper job.
void next(benchmark::State& state) {
  const EvenStepRule rule = ruleOf(state);
  state.SetLabel(toString(rule));
  const GrindProgram program(ValidJob(paperJob(60, rule)), machine(), machine().park);
  std::int64_t setpoints = 0;
  for (auto _ : state) {
    SetpointStream stream(program);
    Setpoint setpoint;
    while (stream.next(setpoint)) ++setpoints;
    benchmark::DoNotOptimize(setpoint);
  }
  state.SetItemsProcessed(setpoints);
}
BENCHMARK(next)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

/// The whole paper job, every limit checked. It may use several cores; the time is that on the clock.
void plan(benchmark::State& state) {
  const EvenStepRule rule = ruleOf(state);
  state.SetLabel(toString(rule));
  const ValidJob job(paperJob(60, rule));
  std::int64_t setpoints = 0;
  for (auto _ : state) {
    const JobPlan plan = planJob(job, machine(), machine().park);
    if (!plan.good()) state.SkipWithError(text(plan.reasons).c_str());
    setpoints += static_cast<std::int64_t>(plan.statistics.setpoints);
  }
  state.SetItemsProcessed(setpoints);
}
BENCHMARK(plan)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A whole tool, ten teeth in twenty passes, in a memory that does not grow with its setpoints. Peak memory is that of
/// the whole program, in MB.
void planTool(benchmark::State& state) {
  const ValidJob job(wholeToolJob());
  std::int64_t setpoints = 0;
  for (auto _ : state) {
    const JobPlan plan = planJob(job, machine(), machine().park);
    if (!plan.good()) state.SkipWithError(text(plan.reasons).c_str());
    setpoints += static_cast<std::int64_t>(plan.statistics.setpoints);
  }
  state.SetItemsProcessed(setpoints);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["setpoints"] = static_cast<double>(setpoints) / static_cast<double>(state.iterations());
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
}
BENCHMARK(planTool)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Whether anything is hit in the whole paper job: the URDF read, and the closest place of all pairs of bodies found.
void collision(benchmark::State& state) {
  std::ostringstream urdf;
  urdf << std::ifstream("urdf/grinder.urdf").rdbuf();
  const ValidJob job(paperJob(600));
  Machine clear = machine();
  clear.collision_clearance = 1e-3;
  for (auto _ : state) {
    const ClosestPlace closest =
        checkCollision(GrindProgram(job, clear, clear.park), MachineShapes(MachineModel(urdf.str()))).closest.value();
    state.counters["closest_mm"] = closest.distance * 1e3;
    state.SetLabel(closest.first + " and " + closest.second);
  }
}
BENCHMARK(collision)->Unit(benchmark::kMillisecond);

/// What a plan measures of the ground cutter: for the paper's job, for one of four teeth with wear, and for a reamer of
/// six teeth with both reliefs.
void checkCutter(benchmark::State& state) {
  const GrindJob jobs[]{paperJob(600), readJobFile("jobs/unequal_d12_t4.yaml"),
                        readJobFile("jobs/taper_reamer_d6_t6.yaml", "secondary")};
  const ValidJob job = withLaws(ValidJob(jobs[state.range(0)]));
  for (auto _ : state) benchmark::DoNotOptimize(checkGroundCutter(job));
}
BENCHMARK(checkCutter)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

/// All that a plan does for an operation on the end of a whole tool: the edges of its flutes, the program, the check of
/// the end, and that for collisions.
void planEnd(benchmark::State& state) {
  const char* const operations[]{"gash", "end_primary", "end_secondary", "chamfer"};
  const char* operation = operations[state.range(0)];
  std::ostringstream urdf;
  urdf << std::ifstream("urdf/grinder.urdf").rdbuf();
  const MachineShapes shapes{MachineModel(urdf.str())};
  const ValidJob job(readJobFile("jobs/end_mill_d10_t4.yaml", operation));
  Machine clear = machine();
  clear.collision_clearance = 1e-3;
  for (auto _ : state) {
    const PlannedJob plan = planWholeJob(job, clear, shapes, clear.park);
    if (!plan.good()) state.SkipWithError(text(plan.reasons).c_str());
  }
  state.SetLabel(operation);
}
BENCHMARK(planEnd)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();

/// One cycle of the control loop: read, checks, next, check, write and sample, with the simulated drive.
void cycle(benchmark::State& state) {
  SimulatedDrive drive;
  SimulatedDrive::Model model;
  for (int i = 0; i < kAxisCount; ++i) model[static_cast<std::size_t>(i)] = {0.002, 1e7, machine().park[i]};
  drive.init(model, {});
  LoopConfig config;
  config.machine = machine();
  config.following_error << 1e-3, 1e-3, 1e-3, 0.05;
  config.feedback_timeout = 0.002;
  config.enable_timeout = 1;
  config.homing_timeout = 1;
  config.spindle_timeout = 1;
  const auto loop = std::make_unique<ControlLoop>(drive, config);
  loop->postSwivel(paperJob(60).process().setup_swivel);
  const ros::Time time(1000);
  const ros::Duration period(config.machine.period);
  const GrindProgram program(ValidJob(paperJob(60)), config.machine, config.machine.park);
  std::unique_ptr<SetpointStream> stream;
  CycleSample sample;

  const auto accepted = [&](const auto& reply) {
    for (int i = 0; i < 5; ++i) {
      loop->cycle(time, period);
      if (const auto answer = reply()) return answer->accepted;
    }
    return false;
  };
  loop->post(MachineEvent::kEnable);
  if (!accepted([&] { return loop->reply(); })) state.SkipWithError("the drive could not be enabled");
  bool moving = false;
  for (auto _ : state) {
    if (!moving) {
      state.PauseTiming();
      stream = std::make_unique<SetpointStream>(program);
      loop->startJob({stream.get(), wheelOf(stream->program())});
      moving = accepted([&] { return loop->startJobReply(); });
      if (!moving) state.SkipWithError("the job could not be started");
      state.ResumeTiming();
    }
    loop->cycle(time, period);
    loop->pop(sample);
    if (sample.job_ended) moving = false;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(cycle);

}  // namespace

int main(int argc, char** argv) {
  ros::Time::init();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return EXIT_SUCCESS;
}
