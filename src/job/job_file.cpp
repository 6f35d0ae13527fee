#include "flute_grinder/job/job_file.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/wheel_file.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

namespace grinder {

namespace {

void takeTeeth(FlatFile& file, GrindJob& job) {
  const std::string counted = "cutter.teeth";
  const std::string listed = "cutter.tooth_angles_deg";
  const std::string angles_allowed = "angles in deg, 0 first, ascending, below 360";
  const std::string teeth_allowed = "1 to " + std::to_string(kMaxTeeth);
  int teeth = 0;
  if (file.hasAny(listed)) {
    if (file.refuseBoth(listed, counted)) return file.drop(listed);
    return file.takeList(listed, angles_allowed, units::kDegree, job.tooth_angles);
  }
  if (!file.take(counted, teeth_allowed, teeth)) return;
  if (teeth < 1 || teeth > kMaxTeeth) {
    return file.fail(file.line(counted), counted + " = " + std::to_string(teeth) + "; allowed: " + teeth_allowed);
  }
  for (int i = 0; i < teeth; ++i) job.tooth_angles.push_back(i * 360.0 / teeth * units::kDegree);
}

void takeSpirals(FlatFile& file, GrindJob& job) {
  const std::string listed = "cutter.spiral_angles_deg";
  if (!file.hasAny(listed)) return;
  if (file.refuseBoth(listed, "cutter.spiral_angle_deg")) return file.drop(listed);
  file.takeList(listed, "angles in deg, one per tooth", units::kDegree, job.spiral_angles);
  if (!job.spiral_angles.empty()) job.cutter.spiral_angle = job.spiral_angles.front();
}

constexpr const char* kKind = "job file";
constexpr const char* kContent = "cutter, process and interpolation";
constexpr const char* kWheel = "process.wheel.";

/// Whether a wheel's own file has the number, or it follows from it; the wear per pass is the process's.
bool isOfWheelFile(const JobField& field) {
  return std::string_view(field.file_key).substr(0, std::string_view(kWheel).size()) == kWheel &&
         std::string_view(field.path) != "process.wheel_wear_per_pass";
}

constexpr const char* kWheelFile = "process.wheel.file";

/// @param job the path of the job file.
std::string wheelPath(const std::string& job, const std::string& wheel) {
  return (std::filesystem::path(job).parent_path() / wheel).string();
}

/// Refuses a text where the wheel's keys belong, which is most likely the path of a wheel file. @return whether it is
/// so.
bool refuseWheelPath(FlatFile& file) {
  const std::string key = "process.wheel";
  const std::string allowed = "keys of a wheel below it, as file: PATH for a wheel file";
  std::string path;
  if (!file.has(key)) return false;
  if (file.take(key, allowed, path)) file.fail(file.line(key), key + " = " + path + "; allowed: " + allowed);
  return true;
}

/// @param path_of_job as its messages name it.
void takeWheelFile(FlatFile& file, const std::string& path_of_job, GrindJob& job) {
  const std::string key = kWheelFile;
  const std::string allowed = "the path of a wheel file";
  std::string name;
  const bool named = file.has(key) && file.take(key, allowed, name);
  if (!named) {
    file.fail(file.line(key), key + " is a list; allowed: " + allowed);
    file.drop(key);
  }
  file.refuseBeside(key, kWheel, "process.wheel.wear_per_pass_mm");
  if (!named) return;
  const std::string path = wheelPath(path_of_job, name);
  std::string text;
  try {
    text = readTextFile(path);
  } catch (const JobFileError& error) {
    const std::filesystem::path folder = std::filesystem::absolute(path_of_job).parent_path();
    return file.fail(file.line(key), key + " = " + name + ": " + error.what() +
                                         "; allowed: a path from the job file's folder, " +
                                         folder.lexically_normal().string());
  }
  try {
    mountWheel(parseWheel(text, path), job);
  } catch (const JobFileError& error) {
    file.add(error.what());
  }
}

constexpr const char* kDepth = "process.depth";

/// Whether a file omits a figure that is yet to be found.
bool isToBeFound(const FlatFile& file, const JobField& field, const std::vector<std::string>& unsolved) {
  return !file.has(field.file_key) && std::find(unsolved.begin(), unsolved.end(), field.path) != unsolved.end();
}

/// How a missing figure is found; nothing for most.
std::string remedy(std::string_view path) {
  return path == kDepth || path.substr(0, path.find('_')) == "process.setup" ? "; 'grind setup --write' finds it" : "";
}

/// Whether a file omits a number that it may omit. The elements of a pair are omitted together.
bool omits(const FlatFile& file, const JobField& field) {
  const std::string key = field.file_key;
  if (key == "cutter.spiral_angle_deg" && file.mentions("cutter.spiral_angles_deg")) return !file.has(key);
  return field.optional && !file.mentionsPart(key);
}

}  // namespace

GrindJob parseJob(const std::string& text, const std::string& name, const std::vector<std::string>& unsolved) {
  FlatFile file(text, name, kKind, kContent);
  GrindJob job;
  takeSpirals(file, job);
  const bool has_wheel_path = refuseWheelPath(file);
  const bool has_wheel_file = has_wheel_path || file.mentions(kWheelFile);
  visitJobFields([&](const JobField& field, auto of) {
    double value = 0;
    if (has_wheel_file && isOfWheelFile(field)) return;
    if (omits(file, field)) return file.know(field.file_key);
    if (isToBeFound(file, field, unsolved)) {
      if (field.path == std::string_view(kDepth)) of(job) = (job.cutter.end_diameter - job.cutter.core_diameter) / 2;
      return file.know(field.file_key);
    }
    std::string allowed = grinder::text(field.low(), field.high());
    if (!file.has(field.file_key)) allowed += remedy(field.path);
    file.take(field.file_key, allowed, value);
    of(job) = value * shopScale(field.unit);
  });
  takeTeeth(file, job);
  if (has_wheel_file) {
    if (!has_wheel_path) takeWheelFile(file, name, job);
  } else {
    file.know(kWheelFile);
    takeWheelShape(file, kWheel, job);
  }
  file.takeChoice("cutter.cut", job.cutter.cut);
  file.takeOptionalChoice("process.z_law", job.process.z_law);
  const std::string incomplete_ok = "process.incomplete_ok";
  if (file.has(incomplete_ok)) {
    file.take(incomplete_ok, "true, false", job.process.incomplete_ok);
  } else {
    file.know(incomplete_ok);
  }
  file.take("process.spark_out", "0 to " + std::to_string(kMaxSparkOut), job.process.spark_out);
  file.takeChoice("process.order", job.process.order);
  file.takeChoice("process.direction", job.process.direction);
  file.takeChoice("interpolation.even_step", job.interpolation.even_step);
  file.refuseTheRest();
  file.throwErrors();

  for (const Reason& reason : validate(job)) {
    file.fail(file.line(fieldName(reason.field)), grinder::text(reason));
  }
  file.throwErrors();
  return job;
}

GrindJob readJobFile(const std::string& path, const std::vector<std::string>& unsolved) {
  return parseJob(readTextFile(path), path, unsolved);
}

std::string wheelFileOf(const std::string& path) {
  FlatFile file(readTextFile(path), path, kKind, kContent);
  std::string name;
  if (!file.has(kWheelFile) || !file.take(kWheelFile, "", name)) return "";
  return wheelPath(path, name);
}

}  // namespace grinder
