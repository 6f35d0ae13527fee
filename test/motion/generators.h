#pragma once

#include "curve/generators.h"
#include "flute_grinder/motion/grind_program.h"
#include "motion/examples.h"

#include <algorithm>
#include <cmath>
#include <ostream>

// What the property tests draw from: machines and jobs.
namespace grinder::test_support {

/// Limits as of machines from slow and stiff to fast; wide in position. Period of 500 to 4000 Hz.
inline rc::Gen<Machine> machine() {
  return rc::gen::exec([] {
    Machine m;
    m.limits.min_position << -10, -10, -10, -1e6;
    m.limits.max_position << 10, 10, 10, 1e6;
    for (int axis = 0; axis < kAxisCount; ++axis) {
      const bool rotary = axis == kA;
      m.limits.max_velocity[axis] = *logUniform(rotary ? 2 : 0.02, rotary ? 60 : 0.5);
      m.limits.max_acceleration[axis] = *logUniform(rotary ? 10 : 0.2, rotary ? 1000 : 10);
      m.limits.max_jerk[axis] = *logUniform(rotary ? 300 : 5, rotary ? 1e5 : 1000);
    }
    m.period = 1 / *uniform(500, 4000);
    m.park << 0, 0.1, 0, 0;
    return m;
  });
}

/// Now and then none; the edge stays where the radius is at least a fifth of that at X = 0. [m]
inline rc::Gen<double> x_shift(const GrindJob& j) {
  const double shank = j.cutter.flute_length + j.process().overtravel_shank, longest = 3 * j.cutter.end_diameter;
  const auto room = [&](int side, double reached) { return openLength(j.cutter, side, reached + longest) - reached; };
  return rc::gen::weightedOneOf<double>(
      {{1, rc::gen::just(0.0)}, {2, uniform(-room(1, shank), room(-1, j.process().overtravel_end))}});
}

/// One tooth, one or two passes, feeds of 60 to 6000 mm/min, all rules, both directions; its figures pass validate().
inline rc::Gen<GrindJob> job() {
  return rc::gen::exec([] {
    GrindJob j;
    j.cutter = anyToolOf(*cone(), 10e-3);
    // Some turns at the most, or else the way back takes most of the time.
    const double turns = 8 * j.cutter.end_diameter / 2 / std::max(0.01, std::abs(std::tan(j.cutter.spiral_angle)));
    j.cutter.flute_length = std::min(j.cutter.flute_length, std::max(0.2e-3, turns));
    j.process().overtravel_end = openLength(j.cutter, -1, *uniform(0, 2e-3));
    j.process().overtravel_shank = std::min(j.cutter.flute_length / 4, *uniform(0, 2e-3));
    j.cutter.flute_length -= j.process().overtravel_shank;  // so that the cone stays open beyond the flute
    j.tooth_angles = {0};
    j.process().feed = *logUniform(60e-3 / 60, 6000e-3 / 60);
    j.process().depth = j.cutter.end_diameter / 2 * *uniform(0.05, 0.15);
    j.process().infeed = j.process().depth;
    j.process().finish_infeed = 0;
    j.process().spark_out = *whole(0, 1);
    j.process().clearance = *uniform(0.1e-3, 2e-3);
    j.process().direction = *rc::gen::element(StrokeDirection::kFromEnd, StrokeDirection::kToEnd);
    j.process().wheel_diameter = 100e-3;
    j.process().wheel_width = 8e-3;
    j.process().wheel_wear = 0;
    j.interpolation.even_step =
        *rc::gen::element(EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact);
    j.interpolation.tolerance = *logUniform(0.1e-6, 100e-6);
    j.interpolation.rotary_scale = *logUniform(0.1e-3, 10e-3);
    j.process().setup_x_shift = *x_shift(j);
    return j;
  });
}

/// Over the whole stroke of a job, from hardly any to one that takes much of the limits of Z.
inline rc::Gen<ZCorrection> zCorrection(const GrindJob& job) {
  return rc::gen::exec([=] {
    ZCorrection c;
    const double length = job.process().overtravel_end + job.cutter.flute_length + job.process().overtravel_shank;
    c.from = -job.process().overtravel_end;
    c.pieces = *whole(1, ZCorrection::kMaxPieces);
    c.piece = length / c.pieces;
    const double size = length * *logUniform(1e-5, 3e-2);
    for (int i = 0; i < c.coefficientCount(); ++i) c.coefficients[static_cast<std::size_t>(i)] = size * *uniform(-1, 1);
    return c;
  });
}

/// A job, and a machine and a start that suit it.
struct Work {
  GrindJob job;
  Machine machine;
  Axes start = Axes::Zero();
  ZCorrection z_correction{};  ///< of all teeth, for kConstantRake

  ValidJob valid() const {
    const ValidJob valid(job);
    if (job.process().z_law == ZLaw::kPublished) return valid;
    return valid.withZCorrections(std::vector<ZCorrection>(job.tooth_angles.size(), z_correction));
  }
  GrindProgram program() const { return GrindProgram(valid(), machine, start); }
};

/// Work whose stroke takes at most `cycles` control cycles, or not many more.
inline rc::Gen<Work> work(double cycles) {
  return rc::gen::exec([=] {
    Work w{*job(), *machine(), Axes::Zero()};
    CutterGeometry& g = w.job.cutter;
    GrindProcess& p = w.job.process();
    const double growth = std::tan(g.cone_angle);
    for (int i = 0; i < 6; ++i) {
      const double highest = std::max(-p.overtravel_end * growth, (g.flute_length + p.overtravel_shank) * growth);
      w.machine.park << g.flute_length / 2, highest + p.clearance + *uniform(0, 2e-3), 1e-3, 0.1;
      w.start << *uniform(-2e-3, 2e-3), highest + p.clearance * *uniform(-0.5, 1.5), -1e-3, *uniform(-1, 1);
      const FeedSchedule schedule = w.program().schedule();
      const double excess = schedule.length() / schedule.feedSpeed() / w.machine.period / cycles;
      if (excess <= 1.2) return w;
      g.flute_length = std::max(0.1e-3, g.flute_length / excess);
      p.overtravel_end /= excess;
      p.overtravel_shank /= excess;
    }
    RC_DISCARD("too slow");
    return w;
  });
}

/// The same with two or three teeth, not evenly spaced, in either order.
inline rc::Gen<Work> toothedWork(double cycles) {
  return rc::gen::exec([=] {
    Work w = *work(cycles);
    const int teeth = *whole(2, 3);
    for (int i = 1; i < teeth; ++i) w.job.tooth_angles.push_back(w.job.tooth_angles.back() + *uniform(0.2, 3));
    w.job.process().order = *rc::gen::element(GrindOrder::kToothMajor, GrindOrder::kPassMajor);
    return w;
  });
}

inline std::ostream& operator<<(std::ostream& out, const Work& w) {
  return out << w.job << "; " << w.machine << "; start " << w.start[0] << " " << w.start[1] << " " << w.start[2] << " "
             << w.start[3];
}

}  // namespace grinder::test_support
