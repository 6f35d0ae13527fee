#include "flute_grinder/messages/conversions.h"

#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

namespace grinder {

namespace {

template <typename Array>
void copy(const Axes& axes, Array& array) {
  std::copy(axes.data(), axes.data() + kAxisCount, array.begin());
}

template <typename Array>
Axes axesOf(const Array& array) {
  return Eigen::Map<const Axes>(array.data());
}

void copyPoints(const std::vector<double>& points, std::vector<ProfilePoint>& profile) {
  for (std::size_t i = 0; i < points.size(); i += 2) {
    // A position without a radius becomes a point that validate() refuses.
    profile.push_back({points[i], i + 1 < points.size() ? points[i + 1] : std::numeric_limits<double>::quiet_NaN()});
  }
}

void copyPoints(const std::vector<ProfilePoint>& profile, std::vector<double>& points) {
  for (const ProfilePoint& point : profile) points.insert(points.end(), {point.w, point.radius});
}

/// Converts between a job and a goal; their members have the same names.
template <typename To, typename From>
To converted(const From& asked) {
  From from = asked;
  To to;
  // The fields are an operation's, so that there is one even of a job that validate() refuses.
  const std::size_t count = asked.operations.size();
  from.operations.resize(std::max<std::size_t>(count, 1));
  to.operations.resize(from.operations.size());
  for (std::size_t i = 0; i < from.operations.size(); ++i) {
    from.operation = static_cast<decltype(from.operation)>(i);
    to.operation = static_cast<decltype(to.operation)>(i);
    visitJobTable([&](const JobField&, auto of) { of(to) = of(from); });
    visitJobChoices(
        [&](const char*, int, auto of) { of(to) = static_cast<std::remove_reference_t<decltype(of(to))>>(of(from)); });
    copyPoints(from.operations[i].wheel_points, to.operations[i].wheel_points);
  }
  to.operations.resize(count);
  to.operation = static_cast<decltype(to.operation)>(asked.operation);
  return to;
}

/// Copies statistics between core and message; their members have the same names.
template <typename From, typename To>
To convertedStatistics(const From& from) {
  To to;
  const auto copy_array = [](const auto& array, auto& copy) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(array.size()); ++i) copy[i] = array[i];
  };
  to.setpoints = from.setpoints;
  to.duration = from.duration;
  copy_array(from.move_duration, to.move_duration);
  to.max_odd_error = from.max_odd_error;
  to.max_even_error = from.max_even_error;
  to.max_deviation = from.max_deviation;
  to.min_feed = from.min_feed;
  to.max_feed = from.max_feed;
  copy_array(from.max_velocity, to.max_velocity);
  copy_array(from.max_acceleration, to.max_acceleration);
  copy_array(from.max_jerk, to.max_jerk);
  copy_array(from.ripple_acceleration, to.ripple_acceleration);
  for (const auto& limit : from.feed_limits) {
    auto& copy = to.feed_limits.emplace_back();
    copy.cause = limit.cause;
    copy.from_x = limit.from_x;
    copy.to_x = limit.to_x;
  }
  return to;
}

}  // namespace

GrindJob jobFromGoal(const flute_grinder::GrindGoal& goal) {
  GrindJob job = converted<GrindJob>(goal);
  job.tooth_angles = goal.cutter.tooth_angles;
  job.spiral_angles = goal.cutter.spiral_angles;
  return job;
}

flute_grinder::GrindGoal goalFromJob(const GrindJob& job) {
  flute_grinder::GrindGoal goal = converted<flute_grinder::GrindGoal>(job);
  goal.cutter.tooth_angles = job.tooth_angles;
  goal.cutter.spiral_angles = job.spiral_angles;
  return goal;
}

flute_grinder::Cutter toMessage(const CutterGeometry& cutter, const std::vector<double>& tooth_angles) {
  GrindJob job;
  job.cutter = cutter;
  job.tooth_angles = tooth_angles;
  return goalFromJob(job).cutter;
}

CutterGeometry fromMessage(const flute_grinder::Cutter& message) {
  flute_grinder::GrindGoal goal;
  goal.cutter = message;
  return jobFromGoal(goal).cutter;
}

flute_grinder::PathStatistics toMessage(const PathStatistics& statistics) {
  return convertedStatistics<PathStatistics, flute_grinder::PathStatistics>(statistics);
}

PathStatistics fromMessage(const flute_grinder::PathStatistics& message) {
  return convertedStatistics<flute_grinder::PathStatistics, PathStatistics>(message);
}

flute_grinder::WrittenSetpoint toMessage(const Setpoint& p, const Axes& actual, double cycle_period) {
  flute_grinder::WrittenSetpoint m;
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

Setpoint fromMessage(const flute_grinder::WrittenSetpoint& m) {
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

}  // namespace grinder
