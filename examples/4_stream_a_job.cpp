// Plans a job and streams it: held in the middle of the stroke, then continued at half the feed.

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/job_plan.h"

#include <cinttypes>
#include <cstdio>

using namespace grinder;

int main() {
  Machine machine;  // as in config/grinder.yaml and urdf/grinder.urdf
  machine.period = 0.001;
  machine.limits.min_position = Axes(-0.1, -0.02, -0.05, -125.663706);
  machine.limits.max_position = Axes(0.3, 0.15, 0.1, 125.663706);
  machine.limits.max_velocity = Axes(0.2, 0.1, 0.1, 12.566);
  machine.limits.max_acceleration = Axes(0.5, 0.5, 0.5, 62.83);
  machine.limits.max_jerk = Axes(10, 10, 10, 1257);
  machine.park = Axes(-0.05, 0.05, 0, 0);

  const JobPlan plan = planJob(ValidJob(readJobFile("jobs/paper.yaml")), machine, machine.park);
  if (!plan.good()) {
    for (const Reason& reason : plan.reasons) std::printf("%s\n", text(reason).c_str());
    return 1;
  }
  std::printf("planned: %" PRIu64 " setpoints\n", plan.statistics.setpoints);

  SetpointStream stream(plan.program);
  Setpoint setpoint;
  // Until the stroke has come so far, or the axes are at rest: at the job's end, or held.
  const auto ride = [&](double until) {
    while (stream.next(setpoint) && !(setpoint.step == StepKind::kEven && setpoint.position[kX] >= until)) {
    }
    std::printf("cycle %" PRIu64 ": %s at X = %.3f mm, %.0f mm/min\n", setpoint.cycle, toString(setpoint.move),
                setpoint.position[kX] / units::kMillimetre, setpoint.feed / units::kMillimetrePerMinute);
  };

  ride(15 * units::kMillimetre);
  stream.hold();
  ride(1);
  stream.setFeedOverride(0.5);
  stream.resume();
  ride(30 * units::kMillimetre);
  ride(1);
}
