#include "flute_grinder/messages/conversions.h"

#include "flute_grinder/messages/sha256.h"

#include <ros/serialization.h>

#include <algorithm>
#include <vector>

namespace flute_grinder {

namespace {

template <typename Array>
void copy(const Axes& axes, Array& array) {
  std::copy(axes.data(), axes.data() + kAxisCount, array.begin());
}

template <typename Array>
Axes axesOf(const Array& array) {
  return Eigen::Map<const Axes>(array.data());
}

}  // namespace

GrindJob jobFromGoal(const GrindGoal& goal) {
  const Process& p = goal.process;
  const Interpolation& i = goal.interpolation;
  GrindJob job;
  job.cutter = fromMessage(goal.cutter);
  job.tooth_angles = goal.cutter.tooth_angles;
  job.process.feed = p.feed;
  job.process.depth = p.depth;
  job.process.infeed = p.infeed;
  job.process.finish_infeed = p.finish_infeed;
  job.process.spark_out = p.spark_out;
  job.process.clearance = p.clearance;
  job.process.overtravel_end = p.overtravel_end;
  job.process.overtravel_shank = p.overtravel_shank;
  job.process.order = static_cast<GrindOrder>(p.order);
  job.process.direction = static_cast<StrokeDirection>(p.direction);
  job.process.wheel_diameter = p.wheel_diameter;
  job.process.wheel_width = p.wheel_width;
  job.process.wheel_wear = p.wheel_wear;
  job.process.wheel_wear_per_pass = p.wheel_wear_per_pass;
  job.interpolation.even_step = static_cast<EvenStepRule>(i.even_step);
  job.interpolation.tolerance = i.tolerance;
  job.interpolation.rotary_scale = i.rotary_scale;
  return job;
}

GrindGoal goalFromJob(const GrindJob& job) {
  GrindGoal goal;
  goal.cutter = toMessage(job.cutter, job.tooth_angles);
  goal.process.feed = job.process.feed;
  goal.process.depth = job.process.depth;
  goal.process.infeed = job.process.infeed;
  goal.process.finish_infeed = job.process.finish_infeed;
  goal.process.spark_out = static_cast<std::uint16_t>(job.process.spark_out);
  goal.process.clearance = job.process.clearance;
  goal.process.overtravel_end = job.process.overtravel_end;
  goal.process.overtravel_shank = job.process.overtravel_shank;
  goal.process.order = static_cast<std::uint8_t>(job.process.order);
  goal.process.direction = static_cast<std::uint8_t>(job.process.direction);
  goal.process.wheel_diameter = job.process.wheel_diameter;
  goal.process.wheel_width = job.process.wheel_width;
  goal.process.wheel_wear = job.process.wheel_wear;
  goal.process.wheel_wear_per_pass = job.process.wheel_wear_per_pass;
  goal.interpolation.even_step = static_cast<std::uint8_t>(job.interpolation.even_step);
  goal.interpolation.tolerance = job.interpolation.tolerance;
  goal.interpolation.rotary_scale = job.interpolation.rotary_scale;
  return goal;
}

Cutter toMessage(const CutterGeometry& cutter, const std::vector<double>& tooth_angles) {
  Cutter m;
  m.end_diameter = cutter.end_diameter;
  m.cone_angle = cutter.cone_angle;
  m.spiral_angle = cutter.spiral_angle;
  m.rake_angle = cutter.rake_angle;
  m.flute_length = cutter.flute_length;
  m.tooth_angles = tooth_angles;
  return m;
}

CutterGeometry fromMessage(const Cutter& m) {
  return {m.end_diameter, m.cone_angle, m.spiral_angle, m.rake_angle, m.flute_length};
}

std::string jobDigest(const GrindJob& job) {
  const GrindGoal goal = goalFromJob(job);
  std::vector<std::uint8_t> bytes;
  const auto append = [&](const auto& part) {
    std::vector<std::uint8_t> of_part(ros::serialization::serializationLength(part));
    ros::serialization::OStream stream(of_part.data(), static_cast<std::uint32_t>(of_part.size()));
    ros::serialization::serialize(stream, part);
    bytes.insert(bytes.end(), of_part.begin(), of_part.end());
  };
  append(goal.cutter);
  append(goal.process);
  append(goal.interpolation);
  return sha256Hex(bytes.data(), bytes.size());
}

PathStatistics toMessage(const PlanStatistics& s) {
  PathStatistics m;
  m.setpoints = s.setpoints;
  m.duration = s.duration;
  std::copy(s.move_duration.begin(), s.move_duration.end(), m.move_duration.begin());
  m.max_odd_error = s.max_odd_error;
  m.max_even_error = s.max_even_error;
  m.max_deviation = s.max_deviation;
  m.min_feed = s.min_feed;
  m.max_feed = s.max_feed;
  copy(s.max_velocity, m.max_velocity);
  copy(s.max_acceleration, m.max_acceleration);
  copy(s.max_jerk, m.max_jerk);
  copy(s.ripple_acceleration, m.ripple_acceleration);
  for (const FeedCut& cut : s.feed_cuts) {
    FeedLimit limit;
    limit.cause = cut.cause;
    limit.from_x = cut.from;
    limit.to_x = cut.to;
    m.feed_limits.push_back(limit);
  }
  return m;
}

PlanStatistics fromMessage(const PathStatistics& m) {
  PlanStatistics s;
  s.setpoints = m.setpoints;
  s.duration = m.duration;
  std::copy(m.move_duration.begin(), m.move_duration.end(), s.move_duration.begin());
  s.max_odd_error = m.max_odd_error;
  s.max_even_error = m.max_even_error;
  s.max_deviation = m.max_deviation;
  s.min_feed = m.min_feed;
  s.max_feed = m.max_feed;
  s.max_velocity = axesOf(m.max_velocity);
  s.max_acceleration = axesOf(m.max_acceleration);
  s.max_jerk = axesOf(m.max_jerk);
  s.ripple_acceleration = axesOf(m.ripple_acceleration);
  for (const FeedLimit& limit : m.feed_limits) s.feed_cuts.push_back({limit.cause, limit.from_x, limit.to_x});
  return s;
}

WrittenSetpoint toMessage(const Setpoint& p, const Axes& actual, double cycle_period) {
  WrittenSetpoint m;
  m.cycle = p.cycle;
  copy(p.position, m.position);
  copy(p.velocity, m.velocity);
  copy(actual, m.actual);
  m.cycle_period = cycle_period;
  m.path_error = p.path_error;
  m.feed = p.feed;
  m.move = static_cast<std::uint8_t>(p.move);
  m.step = static_cast<std::uint8_t>(p.step);
  m.tooth = p.tooth;
  m.pass = p.pass;
  return m;
}

Setpoint fromMessage(const WrittenSetpoint& m) {
  Setpoint p;
  p.cycle = m.cycle;
  p.position = axesOf(m.position);
  p.velocity = axesOf(m.velocity);
  p.path_error = m.path_error;
  p.feed = m.feed;
  p.move = static_cast<MoveKind>(m.move);
  p.step = static_cast<StepKind>(m.step);
  p.tooth = m.tooth;
  p.pass = m.pass;
  return p;
}

}  // namespace flute_grinder
