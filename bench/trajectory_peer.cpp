// The setpoints that a peer makes of a trajectory, for scripts/bench_peers, which compiles this: with RUCKIG by Ruckig,
// or else by the segments of ros_control's joint trajectory controller. It reads the axes' limits (velocity,
// acceleration, jerk, one line each) and the states to pass (time, positions, velocities, accelerations), and prints
// the processor time of a setpoint [s], then the positions in each cycle of 1 ms. SI units.

#ifdef RUCKIG
#include <ruckig/ruckig.hpp>
#else
#include <trajectory_interface/quintic_spline_segment.h>
#endif

#include <array>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Row = std::array<double, 4>;

constexpr double kPeriod = 1e-3;

struct Limits {
  Row velocity, acceleration, jerk;
};

struct State {
  double time;
  Row position, velocity, acceleration;
};

bool read(Row& row) {
  for (double& value : row) std::cin >> value;
  return static_cast<bool>(std::cin);
}

#ifdef RUCKIG

/// From each state to the next, no faster than the trajectory says.
std::vector<Row> setpointsOf(const std::vector<State>& states, const Limits& limits) {
  ruckig::Ruckig<4> generator;
  ruckig::InputParameter<4> input;
  input.max_velocity = limits.velocity;
  input.max_acceleration = limits.acceleration;
  input.max_jerk = limits.jerk;
  input.current_position = states.front().position;
  std::vector<Row> rows;
  double begin = 0;  // of the segment
  for (std::size_t i = 1; i < states.size(); ++i) {
    input.target_position = states[i].position;
    input.target_velocity = states[i].velocity;
    input.target_acceleration = states[i].acceleration;
    input.minimum_duration = states[i].time - states[i - 1].time;
    ruckig::Trajectory<4> segment;
    const ruckig::Result result = generator.calculate(input, segment);
    if (result < 0)
      throw std::runtime_error("Ruckig: no way to point " + std::to_string(i) + ": " + std::to_string(result));
    for (double t; (t = static_cast<double>(rows.size()) * kPeriod - begin) < segment.get_duration();) {
      segment.at_time(t, rows.emplace_back());
    }
    begin += segment.get_duration();
    segment.at_time(segment.get_duration(), input.current_position, input.current_velocity, input.current_acceleration);
  }
  rows.push_back(states.back().position);
  return rows;
}

#else

using Segment = trajectory_interface::QuinticSplineSegment<double>;

Segment::State stateOf(const State& state) {
  Segment::State result(4);
  result.position.assign(state.position.begin(), state.position.end());
  result.velocity.assign(state.velocity.begin(), state.velocity.end());
  result.acceleration.assign(state.acceleration.begin(), state.acceleration.end());
  return result;
}

/// By a quintic spline through the states; the controller knows no limits.
std::vector<Row> setpointsOf(const std::vector<State>& states, const Limits& /*limits*/) {
  std::vector<Row> rows;
  Segment::State at;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const Segment segment(states[i - 1].time, stateOf(states[i - 1]), states[i].time, stateOf(states[i]));
    for (double t; (t = static_cast<double>(rows.size()) * kPeriod) < states[i].time;) {
      segment.sample(t, at);
      rows.push_back({at.position[0], at.position[1], at.position[2], at.position[3]});
    }
  }
  rows.push_back(states.back().position);
  return rows;
}

#endif

}  // namespace

int main() {
  Limits limits;
  if (!read(limits.velocity) || !read(limits.acceleration) || !read(limits.jerk)) return 2;
  std::vector<State> states;
  for (State state;
       std::cin >> state.time && read(state.position) && read(state.velocity) && read(state.acceleration);) {
    states.push_back(state);
  }
  try {
    const std::clock_t begin = std::clock();
    const std::vector<Row> rows = setpointsOf(states, limits);
    const double used = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%.3g\n", used / static_cast<double>(rows.size()));
    for (const Row& row : rows) std::printf("%.17g %.17g %.17g %.17g\n", row[0], row[1], row[2], row[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
