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
  const std::string& teeth_allowed = otherJobKey(counted).allowed;
  int teeth = 0;
  if (file.hasAny(listed)) {
    if (file.refuseBoth(listed, counted)) return file.drop(listed);
    return file.takeList(listed, otherJobKey("cutter.tooth_angles").allowed, units::kDegree, job.tooth_angles);
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
  file.takeList(listed, otherJobKey("cutter.spiral_angles").allowed, units::kDegree, job.spiral_angles);
  if (!job.spiral_angles.empty()) job.cutter.spiral_angle = job.spiral_angles.front();
}

constexpr const char* kKind = "job file";
constexpr const char* kContent = "cutter, process or operations, and interpolation";
constexpr const char* kProcess = "process.";
constexpr const char* kOperations = "operations";
constexpr const char* kOperation = "operation";
constexpr const char* kDepth = "process.depth";

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// The keys of one process in a file: of the only operation, or of an element of the list.
class ProcessKeys {
 public:
  /// @param section name with its trailing point, e.g. "process." or "operations[1].".
  explicit ProcessKeys(std::string section) : section_(std::move(section)) {}

  bool single() const { return section_ == kProcess; }
  /// @param key key in a file with a single operation.
  std::string operator()(std::string_view key) const {
    return begins(key, kProcess) ? section_ + std::string(key.substr(std::string_view(kProcess).size()))
                                 : std::string(key);
  }
  /// A text in which the keys of a single operation are replaced by this operation's keys.
  std::string in(std::string text) const {
    for (std::size_t at = 0; (at = text.find(kProcess, at)) != std::string::npos; at += section_.size()) {
      text.replace(at, std::string_view(kProcess).size(), section_);
    }
    return text;
  }

 private:
  std::string section_;
};

/// Whether the number comes from the wheel's own file or is derived from it; the wear per pass belongs to the process.
bool isOfWheelFile(const JobField& field) {
  return begins(field.file_key, "process.wheel.") && std::string_view(field.path) != "process.wheel_wear_per_pass";
}

/// @param job the path of the job file.
std::string wheelPath(const std::string& job, const std::string& wheel) {
  return (std::filesystem::path(job).parent_path() / wheel).string();
}

/// Refuses a text in place of the wheel's keys, which is most likely the path of a wheel file.
/// @return whether it is a text.
bool refuseWheelPath(FlatFile& file, const ProcessKeys& keys) {
  const std::string key = keys("process.wheel");
  const std::string allowed = "keys of a wheel below it, as file: PATH for a wheel file";
  std::string path;
  if (!file.has(key)) return false;
  if (file.take(key, allowed, path)) file.fail(file.line(key), key + " = " + path + "; allowed: " + allowed);
  return true;
}

/// @param path_of_job path of the job file in messages.
void takeWheelFile(FlatFile& file, const ProcessKeys& keys, const std::string& path_of_job, GrindJob& job) {
  const std::string key = keys("process.wheel.file");
  const std::string& allowed = otherJobKey("process.wheel_file").allowed;
  std::string name;
  const bool named = file.has(key) && file.take(key, allowed, name);
  if (!named) {
    file.fail(file.line(key), key + " is a list; allowed: " + allowed);
    file.drop(key);
  }
  file.refuseBeside(key, keys("process.wheel."), keys("process.wheel.wear_per_pass_mm"));
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

/// Whether a file omits a number that is yet to be found.
bool isToBeFound(const FlatFile& file, const std::string& key, const JobField& field,
                 const std::vector<std::string>& unsolved) {
  return !file.has(key) && std::find(unsolved.begin(), unsolved.end(), field.path) != unsolved.end();
}

/// How a missing number can be found; empty for most numbers.
std::string remedy(std::string_view path) {
  return path == kDepth || path.substr(0, path.find('_')) == "process.setup" ? "; 'grind setup --write' finds it" : "";
}

/// Whether a file omits a number that is optional. The elements of a pair are omitted together.
bool omits(const FlatFile& file, const std::string& key, const JobField& field) {
  if (key == "cutter.spiral_angle_deg" && file.mentions("cutter.spiral_angles_deg")) return !file.has(key);
  return field.omitted != nullptr && !file.mentionsPart(key);
}

/// Reads one operation, and the rest of the file except the other operations.
class OperationReader {
 public:
  /// @param before the preceding operation, from which a relief takes omitted values; null for the first.
  OperationReader(FlatFile& file, ProcessKeys keys, const GrindProcess* before)
      : file_(file), keys_(std::move(keys)), before_(before) {}

  GrindJob read(const std::string& name, const std::vector<std::string>& unsolved) {
    if (!keys_.single()) takeKind();
    takeSpirals(file_, job_);
    const bool has_wheel_path = refuseWheelPath(file_, keys_);
    const bool has_wheel_file = has_wheel_path || file_.mentions(keys_("process.wheel.file"));
    visitJobFields([&](const JobField& field, auto of) {
      if (!(has_wheel_file && isOfWheelFile(field))) takeNumber(field, of, unsolved);
    });
    takeTeeth(file_, job_);
    if (has_wheel_file) {
      if (!has_wheel_path) takeWheelFile(file_, keys_, name, job_);
    } else {
      file_.know(keys_("process.wheel.file"));
      takeWheelShape(file_, keys_("process.wheel."), job_);
    }
    takeChoices();
    return std::move(job_);
  }

 private:
  void takeKind() {
    const std::string kind = keys_("process.kind"), relief = keys_("process.relief");
    std::string word;
    if (!file_.take(kind, "flute, relief", word)) return;
    if (word == "flute") return;
    if (word != "relief") return file_.fail(file_.line(kind), kind + " = " + word + "; allowed: flute, relief");
    if (!file_.take(relief, "primary, secondary", word)) return;
    const auto which = valueOf<OperationKind>(word);
    if (!which || !isRelief(*which)) {
      return file_.fail(file_.line(relief), relief + " = " + word + "; allowed: primary, secondary");
    }
    job_.process.kind = *which;
  }

  /// Whether a relief takes a key from the preceding operation.
  /// @param key key of a single operation.
  bool inherits(const char* key) const { return before_ != nullptr && !file_.has(keys_(key)); }

  template <typename Of>
  void takeNumber(const JobField& field, const Of& of, const std::vector<std::string>& unsolved) {
    const std::string key = keys_(field.file_key);
    double value = 0;
    if (!field.isOf(job_.process.kind)) return;
    if (std::string_view(field.path) == "process.clearance" && inherits(field.file_key)) {
      job_.process.clearance = before_->clearance;
      return file_.know(key);
    }
    if (omits(file_, key, field)) return file_.know(key);
    if (isToBeFound(file_, key, field, unsolved)) {
      if (field.path == std::string_view(kDepth)) of(job_) = (job_.cutter.end_diameter - job_.cutter.core_diameter) / 2;
      return file_.know(key);
    }
    std::string allowed = grinder::text(field.low(), field.high());
    if (!file_.has(key)) allowed += remedy(field.path);
    file_.take(key, allowed, value);
    of(job_) = value * shopScale(field.unit);
  }

  void takeChoices() {
    GrindProcess& p = job_.process;
    file_.takeChoice("cutter.cut", job_.cutter.cut);
    file_.takeChoice("interpolation.even_step", job_.interpolation.even_step);
    const auto choice = [&](const std::string& key, auto& value) { file_.takeChoice(key, value); };
    takeOrInherit("process.order", &GrindProcess::order, choice);
    takeOrInherit("process.direction", &GrindProcess::direction, choice);
    takeOrInherit("process.spark_out", &GrindProcess::spark_out, [&](const std::string& key, int& value) {
      file_.take(key, otherJobKey("process.spark_out").allowed, value);
    });
    if (isRelief(p.kind)) return;
    file_.takeOptionalChoice(keys_("process.z_law"), p.z_law);
    const std::string incomplete_ok = keys_("process.incomplete_ok");
    if (file_.mayHave(incomplete_ok)) file_.take(incomplete_ok, otherJobKey("process.incomplete_ok").allowed, p.incomplete_ok);
  }

  template <typename Value, typename Take>
  void takeOrInherit(const char* key, Value GrindProcess::*value, const Take& take) {
    if (!inherits(key)) return take(keys_(key), job_.process.*value);
    job_.process.*value = before_->*value;
    file_.know(keys_(key));
  }

  FlatFile& file_;
  ProcessKeys keys_;
  const GrindProcess* before_;
  GrindJob job_;
};

std::string sectionOf(std::size_t operation) { return element(kOperations, operation) + "."; }

/// The number of operations that a file lists; 0 for a single process.
std::size_t operationsIn(const FlatFile& file) {
  std::size_t count = 0;
  while (count < kMaxOperations && file.mentionsSection(element(kOperations, count))) ++count;
  return count;
}

void failInvalid(FlatFile& file, const ProcessKeys& keys, const GrindJob& job) {
  for (const Reason& reason : validate(job)) {
    file.fail(file.line(keys(fieldName(reason.field))), keys.in(grinder::text(reason)));
  }
  file.throwErrors();
}

/// The index of an operation.
/// @param named its number, from 1, or its kind; may be empty for a single operation.
std::size_t operationNamed(const std::string& named, const std::vector<GrindOperation>& operations,
                           const std::string& name) {
  std::string all;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const std::string kind = toString(operations[i].process.kind);
    if (named == kind || named == std::to_string(i + 1) || (named.empty() && operations.size() == 1)) return i;
    all += (all.empty() ? "" : ", ") + std::to_string(i + 1) + " or " + kind;
  }
  throw JobFileError(name + ": operation " + (named.empty() ? "is missing" : "= " + named) + "; allowed: " + all);
}

/// Reads one operation, and the rest of the file except the other operations.
/// @param file file from which nothing was taken.
GrindJob readOperation(FlatFile file, const std::string& name, const std::vector<std::string>& unsolved,
                       const std::string& section, const GrindProcess* before) {
  const ProcessKeys keys(section);
  if (!keys.single()) {
    for (std::size_t i = 0; i < kMaxOperations; ++i) {
      if (sectionOf(i) != section) file.dropSection(sectionOf(i));
    }
    // A record names its operation, and also repeats its values.
    if (file.has(kOperation)) file.dropSection(kProcess);
    file.drop(kOperation);
  }
  GrindJob job = OperationReader(file, keys, before).read(name, unsolved);
  file.refuseTheRest();
  file.throwErrors();
  if (keys.single()) failInvalid(file, keys, job);
  return job;
}

}  // namespace

GrindJob parseJob(const std::string& text, const std::string& name, const std::vector<std::string>& unsolved,
                  const std::string& operation) {
  const FlatFile whole(text, name, kKind, kContent);
  const std::size_t count = operationsIn(whole);
  if (count == 0) {
    if (!operation.empty() && operation != "1" && operation != toString(OperationKind::kFlute)) {
      throw JobFileError(name + ": operation = " + operation + "; allowed: 1 or flute, its only one");
    }
    return readOperation(whole, name, unsolved, kProcess, nullptr);
  }
  GrindJob job;
  std::vector<GrindOperation> all;
  for (std::size_t i = 0; i < count; ++i) {
    job = readOperation(whole, name, unsolved, sectionOf(i), i == 0 ? nullptr : &all.back().process);
    all.push_back({job.process, job.wheel_points});
  }
  job.operations = std::move(all);
  FlatFile file = whole;
  for (std::size_t i = 0; i < count; ++i) {
    failInvalid(file, ProcessKeys(sectionOf(i)), job.ofOperation(static_cast<int>(i)));
  }
  std::string named = operation;
  if (named.empty() && file.has(kOperation)) file.take(kOperation, "a kind of operation", named);
  const std::size_t index = operationNamed(named, job.operations, name);
  // The operations before this one must be solved already.
  for (std::size_t i = 0; i < index && !unsolved.empty(); ++i) {
    readOperation(whole, name, {}, sectionOf(i), i == 0 ? nullptr : &job.operations[i - 1].process);
  }
  return job.ofOperation(static_cast<int>(index));
}

GrindJob readJobFile(const std::string& path, const std::vector<std::string>& unsolved, const std::string& operation) {
  return parseJob(readTextFile(path), path, unsolved, operation);
}

std::string wheelFileOf(const std::string& path, int operation) {
  FlatFile file(readTextFile(path), path, kKind, kContent);
  const ProcessKeys keys(operationsIn(file) == 0 ? kProcess : sectionOf(static_cast<std::size_t>(operation)));
  const std::string key = keys("process.wheel.file");
  std::string name;
  if (!file.has(key) || !file.take(key, "", name)) return "";
  return wheelPath(path, name);
}

}  // namespace grinder
