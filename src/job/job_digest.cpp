#include "flute_grinder/job/job_digest.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/sha256.h"

#include <string_view>

namespace grinder {

namespace {

bool isOfWheel(std::string_view path) {
  return begins(path, "process.wheel_") && !begins(path, "process.wheel_wear") && path != "process.wheel_width";
}

bool isOfProcess(std::string_view path) { return begins(path, "process."); }

/// The numbers and choices that are not 0, one per line.
/// @param wanted whether a path counts.
template <typename Wanted>
std::string figuresOf(const GrindJob& job, const Wanted& wanted) {
  std::string figures;
  const auto add = [&](const char* path, double value) {
    if (value != 0 && wanted(path)) figures += format("%s %a\n", path, value);
  };
  visitJobFields([&](const JobField& field, auto of) { add(field.path, of(job)); });
  visitJobChoices([&](const char* path, int, auto of) { add(path, static_cast<double>(of(job))); });
  for (const ProfilePoint& point : job.process().wheel_points)
    figures += format("point %a %a\n", point.w, point.radius);
  return figures;
}

bool placesTeeth(std::string_view path) {
  const bool of_relief = path == "cutter.clearance" || path == "cutter.land" || path == "cutter.second_clearance";
  if (begins(path, "cutter.")) return !of_relief && path.find("tolerance") == std::string_view::npos;
  return begins(path, "process.setup_") || begins(path, "process.depth") || path == "process.z_law" || isOfWheel(path);
}

std::string teethOf(const GrindJob& job) {
  std::string figures;
  for (const double angle : job.tooth_angles) figures += format("tooth %a\n", angle);
  for (const double angle : job.spiral_angles) figures += format("spiral %a\n", angle);
  return figures;
}

std::string digestOf(const std::string& figures) { return sha256Hex(figures.data(), figures.size()); }

}  // namespace

std::string jobDigest(const GrindJob& job) {
  std::string figures = figuresOf(job, [](const char*) { return true; });
  for (int i = 0; i < job.operation; ++i) figures += figuresOf(job.ofOperation(i), isOfProcess);
  return digestOf(figures + teethOf(job));
}

std::string toolDigest(const GrindJob& job) {
  return digestOf(figuresOf(job.ofOperation(0), placesTeeth) + teethOf(job));
}

std::string wheelDigest(const GrindJob& job) { return digestOf(figuresOf(job, isOfWheel)); }

}  // namespace grinder
