#pragma once

#include "flute_grinder/motion/setpoint_stream.h"

#include "curve/reference.h"
#include "flute_grinder/job/grind_job.h"
#include "generators.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

// Streams gone through, and what their setpoints must keep to: the axes' limits, the paper's construction, the
// tolerance.
namespace grinder::test_support {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kCycles = 1500;  ///< of a stroke: long enough for all phases, short enough for a hundred jobs

inline std::vector<Setpoint> all(SetpointStream& stream, Setpoint& p) {
  std::vector<Setpoint> setpoints;
  while (stream.next(p)) setpoints.push_back(p);
  return setpoints;
}

inline std::vector<Setpoint> all(SetpointStream& stream) {
  Setpoint p;
  return all(stream, p);
}

inline std::vector<Setpoint> all(const Work& work) {
  SetpointStream stream(work.program());
  return all(stream);
}

/// A step of a stroke seen from the even point before its pair.
struct SeenPair {
  Setpoint start, odd, even;
};

/// All pairs of all strokes.
inline std::vector<SeenPair> pairsOf(const std::vector<Setpoint>& setpoints) {
  std::vector<SeenPair> pairs;
  for (std::size_t i = 2; i < setpoints.size(); i += 2) {
    if (setpoints[i].move == MoveKind::kStroke) pairs.push_back({setpoints[i - 2], setpoints[i - 1], setpoints[i]});
  }
  return pairs;
}

/// What rounding makes of an axis: some sums of numbers as large as those seen.
inline Axes roundingOf(const std::vector<Setpoint>& setpoints) {
  Axes max = Axes::Zero();
  for (const Setpoint& p : setpoints) max = max.max(p.position.abs());
  return 2 * kEps * max;
}

/// How far the setpoints go beyond a limit, as text; empty where they do not. Position and speed at every one,
/// acceleration and jerk by differences of the pair ends, with rest before the first and after the last.
inline std::string beyondLimits(std::vector<Setpoint> setpoints, const Machine& machine) {
  const Axes noise = roundingOf(setpoints);
  const AxisLimits& l = machine.limits;
  const double t = machine.period;
  for (int i = 0; i < 8; ++i) {
    setpoints.push_back(setpoints.back());
    ++setpoints.back().cycle;
  }
  setpoints.insert(setpoints.begin(), 6, setpoints.front());
  const auto text = [&](const char* what, std::size_t i, const Axes& value, const Axes& limit) {
    std::string axes;
    for (int axis = 0; axis < kAxisCount; ++axis) {
      axes += " " + ::testing::PrintToString(value[axis]) + "/" + ::testing::PrintToString(limit[axis]);
    }
    return std::string(what) + axes + " at cycle " + std::to_string(setpoints[i].cycle) + " " +
           toString(setpoints[i].move);
  };
  const auto within = [&](const Axes& value, const Axes& limit, double noise_factor) {
    return (value.abs() <= limit * (1 + 1e-9) + noise * noise_factor).all();
  };
  for (std::size_t i = 6; i < setpoints.size(); ++i) {
    const auto p = [&](std::size_t back) { return setpoints[i - back].position; };
    if (!((p(0) >= l.min_position).all() && (p(0) <= l.max_position).all()))
      return text("position", i, p(0), l.max_position);
    const Axes velocity = (p(0) - p(1)) / t;
    if (!within(velocity, l.max_velocity, 2 / t)) return text("velocity", i, velocity, l.max_velocity);
    if (i % 2 != 0) continue;
    const double pair = 2 * t;
    const Axes acceleration = (p(0) - 2 * p(2) + p(4)) / (pair * pair);
    if (!within(acceleration, l.max_acceleration, 4 / (pair * pair)))
      return text("acceleration", i, acceleration, l.max_acceleration);
    const Axes jerk = (p(0) - 3 * p(2) + 3 * p(4) - p(6)) / (pair * pair * pair);
    if (!within(jerk, l.max_jerk, 8 / (pair * pair * pair))) return text("jerk", i, jerk, l.max_jerk);
  }
  return "";
}

/// How far the strokes' points are off what the paper's construction gives, as text; empty where they are not.
inline std::string offTheConstruction(const std::vector<Setpoint>& setpoints, const GrindJob& job, std::size_t every) {
  const ReferenceCurve curve(job.cutter, job.process().setup_x_shift);
  const Real scale = job.interpolation.rotary_scale;
  const Axes noise = 4 * roundingOf(setpoints);
  const Real x_noise = noise[kX];
  const Real a_noise = noise[kA] + x_noise * std::abs(curve.k) / 0.2L;
  const auto pairs = pairsOf(setpoints);
  for (std::size_t i = 0; i < pairs.size(); i += every) {
    const SeenPair& s = pairs[i];
    const Real x = s.start.position[kX];
    const Real slope = scale * curve.slope(x);
    const Real l = (s.odd.position[kX] - x) * std::sqrt(1 + slope * slope);
    if (l == 0) continue;
    const ReferencePair expected = referencePair(job.interpolation.even_step, curve, scale, x, l);
    const Real x2 = s.even.position[kX] - x;
    const Real a1 = Real(s.odd.position[kA]) - s.start.position[kA];
    const Real a2 = Real(s.even.position[kA]) - s.start.position[kA];
    const bool good = std::abs(x2 - expected.x2) <= 4 * x_noise + 1e-12L * std::abs(x2) &&
                      std::abs(a1 - expected.a1) <= 1e-11L + a_noise && std::abs(a2 - expected.a2) <= 1e-11L + a_noise;
    if (!good) {
      return "cycle " + std::to_string(s.odd.cycle) + ": x2 off by " +
             std::to_string(static_cast<double>((x2 - expected.x2) * 1e15L)) + "e-15, a by " +
             std::to_string(static_cast<double>((a1 - expected.a1) * 1e12L)) + "e-12, " +
             std::to_string(static_cast<double>((a2 - expected.a2) * 1e12L)) + "e-12";
    }
  }
  return "";
}

/// How far a point of a stroke is off the theoretical curve, at the cutter's surface and normal to the helix. [m]
class Deviation {
 public:
  explicit Deviation(const GrindJob& job)
      : curve_(job.cutter, job.process().setup_x_shift),
        teeth_(job.tooth_angles),
        end_radius_(Real(job.cutter.end_diameter) / 2),
        growth_(std::tan(Real(job.cutter.cone_angle))),
        normal_(std::cos(std::atan(std::tan(Real(job.cutter.spiral_angle)) * std::cos(Real(job.cutter.cone_angle))))) {}

  double of(const Setpoint& p) const {
    const Real x = p.position[kX];
    const Real error = curve_.a(x) - (Real(p.position[kA]) - teeth_[p.tooth]);
    return static_cast<double>(std::abs(error) * (end_radius_ + (x - curve_.x_shift) * growth_) * normal_);
  }

 private:
  ReferenceCurve curve_;
  std::vector<double> teeth_;
  Real end_radius_, growth_, normal_;
};

/// The maximum deviation of the strokes' points. [m]
inline double maxDeviation(const std::vector<Setpoint>& setpoints, const GrindJob& job) {
  const Deviation deviation(job);
  double max = 0;
  for (const Setpoint& p : setpoints) {
    if (p.step != StepKind::kNone) max = std::max(max, deviation.of(p));
  }
  return max;
}

/// The paper's job, gone through up to a place in its stroke.
class PaperStroke {
 public:
  explicit PaperStroke(double x) : stream_(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park)) {
    while (p_.move != MoveKind::kStroke || p_.position[kX] < x || p_.cycle % 2 == 1) next();
  }

  SetpointStream& stream() { return stream_; }
  const Setpoint& last() const { return p_; }
  bool next() { return stream_.next(p_); }
  void runToRest() {
    while (next()) {
    }
  }

 private:
  SetpointStream stream_;
  Setpoint p_;
};

}  // namespace grinder::test_support
