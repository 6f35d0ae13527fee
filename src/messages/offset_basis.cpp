#include "flute_grinder/messages/offset_basis.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"

#include <algorithm>
#include <filesystem>

namespace grinder {

namespace {

std::string nameOf(const std::string& path) { return std::filesystem::path(path).filename(); }

/// A description that distinguishes a wheel without a file from others of the same diameter.
std::string described(const GrindProcess& wheel) {
  return std::string(toString(wheel.wheel_profile)) + ", " + text(Quantity{wheel.wheel_width, Unit::kMetre}) + " wide";
}

/// Copies between core and message; the members have the same names.
template <typename From, typename To>
To convertedBasis(const From& from) {
  To to;
  to.job_name = from.job_name;
  to.wheel_name = from.wheel_name;
  to.wheel_digest = from.wheel_digest;
  to.end_diameter = from.end_diameter;
  to.wheel_diameter = from.wheel_diameter;
  to.wheel_width = from.wheel_width;
  to.wheel_rim = from.wheel_rim;
  to.swivel = from.swivel;
  to.height = from.height;
  to.tool_digest = from.tool_digest;
  to.kind = static_cast<decltype(to.kind)>(from.kind);
  to.before = static_cast<decltype(to.before)>(from.before);
  return to;
}

}  // namespace

flute_grinder::GrindGoal goalFromFile(const std::string& path, const std::string& operation) {
  return goalFromFile(openJobFile(path, operation));
}

flute_grinder::GrindGoal goalFromFile(const JobFile& file) {
  flute_grinder::GrindGoal goal = goalFromJob(file.job);
  goal.job_name = nameOf(file.path);
  if (!file.wheel) return goal;
  goal.wheel_name = nameOf(file.wheel_path);
  goal.wheel_dressed = file.wheel->dressed;
  return goal;
}

OffsetBasis basisOf(const flute_grinder::GrindGoal& goal, OffsetMethod method) {
  OffsetBasis basis;
  basis.method = method;
  basis.job_name = goal.job_name;
  const GrindJob job = jobFromGoal(goal);
  basis.wheel_name = goal.wheel_name.empty() ? described(job.process()) : goal.wheel_name;
  basis.wheel_digest = wheelDigest(job);
  basis.tool_digest = toolDigest(job);
  basis.kind = job.process().kind;
  basis.before = job.operations[static_cast<std::size_t>(std::max(job.operation - 1, 0))].kind;
  basis.end_diameter = goal.cutter.end_diameter;
  basis.wheel_diameter = processOf(goal).wheel_diameter;
  basis.wheel_width = processOf(goal).wheel_width;
  basis.wheel_rim = processOf(goal).wheel_rim;
  basis.swivel = processOf(goal).setup_swivel;
  basis.height = processOf(goal).setup_height;
  return basis;
}

Json toJson(const OffsetBasis& basis) {
  const auto figure = [&](double si, double unit) { return basis.hasJob() ? Json(si / unit) : Json(nullptr); };
  return {{"method", toString(basis.method)},
          {"job", basis.job_name},
          {"wheel", basis.wheel_name},
          {"wheel_digest", basis.wheel_digest},
          {"end_diameter_mm", figure(basis.end_diameter, units::kMillimetre)},
          {"wheel_diameter_mm", figure(basis.wheel_diameter, units::kMillimetre)},
          {"wheel_width_mm", figure(basis.wheel_width, units::kMillimetre)},
          {"swivel_deg", figure(basis.swivel, units::kDegree)},
          {"height_mm", figure(basis.height, units::kMillimetre)}};
}

flute_grinder::OffsetBasis toMessage(const OffsetBasis& basis) {
  auto message = convertedBasis<OffsetBasis, flute_grinder::OffsetBasis>(basis);
  message.method = static_cast<std::uint8_t>(basis.method);
  return message;
}

OffsetBasis fromMessage(const flute_grinder::OffsetBasis& message) {
  auto basis = convertedBasis<flute_grinder::OffsetBasis, OffsetBasis>(message);
  if (message.method < countOf<OffsetMethod>()) basis.method = static_cast<OffsetMethod>(message.method);
  return basis;
}

WorkOffsets fromMessage(const flute_grinder::WorkOffsets& message) {
  WorkOffsets offsets;
  for (std::size_t i = 0; i < offsets.axes.size(); ++i) {
    offsets.axes[i] = {message.values[i],         message.set_by[i],
                       message.set_at[i].toSec(), fromMessage(message.basis[i]),
                       message.mounting[i],       message.found_at[i].toSec()};
  }
  const flute_grinder::MountedWheel& wheel = message.wheel;
  offsets.wheel = {wheel.name, wheel.digest, wheel.diameter, wheel.rim, wheel.mounting};
  const flute_grinder::ClampedTool& tool = message.tool;
  offsets.tool = {tool.digest, tool.job_name, tool.ground, static_cast<TeethUnknown>(tool.unknown), tool.clamping};
  return offsets;
}

flute_grinder::WorkOffsets toMessage(const WorkOffsets& offsets) {
  flute_grinder::WorkOffsets message;
  for (std::size_t i = 0; i < offsets.axes.size(); ++i) {
    message.values[i] = offsets.axes[i].value;
    message.set_by[i] = offsets.axes[i].set_by;
    message.set_at[i] = ros::Time(offsets.axes[i].set_at);
    message.basis[i] = toMessage(offsets.axes[i].basis);
    message.mounting[i] = offsets.axes[i].mounting;
    message.found_at[i] = ros::Time(offsets.axes[i].found_at);
  }
  message.wheel.name = offsets.wheel.name;
  message.wheel.digest = offsets.wheel.digest;
  message.wheel.diameter = offsets.wheel.diameter;
  message.wheel.rim = offsets.wheel.rim;
  message.wheel.mounting = offsets.wheel.mounting;
  message.tool.digest = offsets.tool.digest;
  message.tool.job_name = offsets.tool.job_name;
  message.tool.ground = offsets.tool.ground;
  message.tool.unknown = static_cast<std::uint8_t>(offsets.tool.unknown);
  message.tool.clamping = offsets.tool.clamping;
  return message;
}

std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const flute_grinder::GrindGoal& goal) {
  return mismatches(offsets, basisOf(goal, OffsetMethod::kUnknown));
}

}  // namespace grinder
