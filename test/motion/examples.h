#pragma once

#include "any_tool.h"
#include "curve/examples.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/grind_program.h"

#include <ostream>

namespace grinder::test_support {

/// The paper's cutter at 600 mm/min in one pass.
inline GrindJob paperJob() {
  GrindJob j;
  j.cutter = anyToolOf(paperCone(), 16e-3);
  j.tooth_angles = {0};
  j.process().feed = 0.01;
  j.process().depth = 0.5e-3;
  j.process().infeed = 0.5e-3;
  j.process().clearance = 5e-3;
  j.process().overtravel_end = 1e-3;
  j.process().overtravel_shank = 1e-3;
  j.process().wheel_diameter = 100e-3;
  j.process().wheel_width = 8e-3;
  j.interpolation.tolerance = 1e-6;
  j.interpolation.rotary_scale = 1e-3;
  return j;
}

/// A middling tool grinder at 1 kHz.
inline Machine plainMachine() {
  Machine m;
  m.limits.min_position << -0.3, -0.2, -0.2, -200;
  m.limits.max_position << 0.3, 0.2, 0.2, 200;
  m.limits.max_velocity << 0.2, 0.1, 0.1, 20;
  m.limits.max_acceleration << 2, 2, 2, 200;
  m.limits.max_jerk << 50, 50, 50, 5000;
  m.period = 1e-3;
  m.park << 0, 0.05, 0, 0;
  return m;
}

/// A machine on which every shipped job can be planned.
inline Machine roomyMachine() {
  Machine machine = plainMachine();
  machine.park << -0.02, 0.08, 0, 0;
  return machine;
}

}  // namespace grinder::test_support

namespace grinder {

inline std::ostream& operator<<(std::ostream& out, StrokeDirection direction) { return out << toString(direction); }

inline std::ostream& operator<<(std::ostream& out, const Machine& m) {
  const auto row = [&](const char* name, const Axes& a) {
    out << ", " << name << " " << a[0] << " " << a[1] << " " << a[2] << " " << a[3];
  };
  out << "period " << m.period;
  row("velocity", m.limits.max_velocity);
  row("acceleration", m.limits.max_acceleration);
  row("jerk", m.limits.max_jerk);
  return out;
}

inline std::ostream& operator<<(std::ostream& out, const GrindJob& j) {
  return out << j.cutter << ", " << toString(j.interpolation.even_step) << ", " << toString(j.process().direction)
             << ", feed " << j.process().feed << " m/s, overtravel " << j.process().overtravel_end << " "
             << j.process().overtravel_shank << " m, shift in X " << j.process().setup_x_shift << " m, depth "
             << j.process().depth << " m, clearance " << j.process().clearance << " m, tolerance "
             << j.interpolation.tolerance << " m, scale " << j.interpolation.rotary_scale << " m/rad, spark out "
             << j.process().spark_out << ", " << j.tooth_angles.size() << " teeth, " << toString(j.process().order);
}

}  // namespace grinder
