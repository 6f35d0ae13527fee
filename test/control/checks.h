#pragma once

#include "control/fixtures.h"
#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <array>
#include <optional>
#include <vector>

// Checks of setpoints and logs.
namespace grinder::test_support {

/// All setpoints of a stream until it rests; held before the setpoint of a cycle, if one is given.
inline std::vector<Setpoint> allSetpoints(SetpointStream stream, std::optional<std::uint64_t> hold_at = {}) {
  std::vector<Setpoint> all;
  Setpoint setpoint;
  do {
    if (hold_at && all.size() == *hold_at) stream.hold();
    if (!stream.next(setpoint)) return all;
    all.push_back(setpoint);
  } while (all.size() < 1000000);
  ADD_FAILURE() << "the stream does not end";
  return all;
}

/// The first setpoint in which two rows differ, if there is one.
inline testing::AssertionResult sameSetpoints(const std::vector<Setpoint>& a, const std::vector<Setpoint>& b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << a.size() << " and " << b.size() << " setpoints";
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same = a[i].cycle == b[i].cycle && sameBits(a[i].position, b[i].position) &&
                      sameBits(a[i].velocity, b[i].velocity) && a[i].path_error == b[i].path_error &&
                      a[i].feed == b[i].feed && a[i].tooth == b[i].tooth && a[i].pass == b[i].pass &&
                      a[i].move == b[i].move && a[i].step == b[i].step && a[i].at_feed == b[i].at_feed &&
                      a[i].move_index == b[i].move_index && a[i].move_fraction == b[i].move_fraction;
    if (!same) {
      return testing::AssertionFailure() << "setpoint " << i << ": " << a[i].position.transpose() << " in "
                                         << toString(a[i].move) << " and " << b[i].position.transpose() << " in "
                                         << toString(b[i].move);
    }
  }
  return testing::AssertionSuccess();
}

/// Whether a log shows only motion within the axes' limits, and every setpoint of a job once and in order: no step
/// beyond the velocity limit; no acceleration or jerk beyond its limit, over pairs, since the odd and even steps within
/// a pair differ from the path's; cycle numbers without a gap; and constant commands where there is no setpoint.
inline testing::AssertionResult smooth(const std::vector<CycleSample>& log,
                                       const AxisLimits& limits = machineConfig().machine.limits) {
  constexpr double kPeriod = 0.001;
  constexpr double kRounding = 1e-6;  // relative; far above that of positions, far below any fault
  const Axes step_limit = limits.max_velocity * kPeriod * (1 + kRounding);
  const Axes bend_limit = limits.max_acceleration * (4 * kPeriod * kPeriod) * (1 + kRounding);
  const Axes jerk_limit = limits.max_jerk * (8 * kPeriod * kPeriod * kPeriod) * (1 + kRounding) + 1e-14;
  std::uint64_t next = 0;
  std::array<Axes, 4> ends;  // of the last pairs, newest first
  ends.fill(Axes::Zero());
  for (std::size_t i = 1; i < log.size(); ++i) {
    const CycleSample& sample = log[i];
    const auto failure = [&] {
      return testing::AssertionFailure() << "sample " << i << ", " << toString(sample.state) << ", cycle "
                                         << sample.setpoint.cycle << " in " << toString(sample.setpoint.move) << ": ";
    };
    const bool follows = [&] {
      const auto off = [](MachineState s) { return s == MachineState::kDisabled || s == MachineState::kHoming; };
      return off(sample.state) || off(log[i - 1].state);
    }();
    if (follows) continue;
    if (!sample.has_setpoint) {
      if (!sameBits(sample.command, log[i - 1].command)) return failure() << "the command moves without a setpoint";
      continue;
    }
    const Axes& p = sample.setpoint.position;
    if (!sameBits(sample.command, p)) return failure() << "the command is not the setpoint";
    const Axes step = p - log[i - 1].command;
    if (!(step.abs() <= step_limit).all()) return failure() << "a step of " << step.transpose();
    if (sample.setpoint.cycle == 0) {
      next = 0;
      ends.fill(p);
    }
    if (sample.setpoint.cycle != next) return failure() << "expected cycle " << next;
    if (next++ % 2 == 1) continue;
    ends = {p, ends[0], ends[1], ends[2]};
    const Axes bend = ends[0] - 2 * ends[1] + ends[2];
    const Axes jerk = ends[0] - 3 * ends[1] + 3 * ends[2] - ends[3];
    if (!(bend.abs() <= bend_limit).all()) return failure() << "a bend of " << bend.transpose();
    if (!(jerk.abs() <= jerk_limit).all()) return failure() << "a jerk of " << jerk.transpose();
  }
  return testing::AssertionSuccess();
}

/// Whether all samples of a log from an index on show the axes at rest.
inline testing::AssertionResult atRestFrom(const std::vector<CycleSample>& log, std::size_t from) {
  for (std::size_t i = from; i < log.size(); ++i) {
    if (log[i].has_setpoint) return testing::AssertionFailure() << "a setpoint in sample " << i;
    if (!sameBits(log[i].command, log[from].command)) {
      return testing::AssertionFailure() << "the command moves in sample " << i;
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace grinder::test_support
