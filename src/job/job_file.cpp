#include "flute_grinder/job/job_file.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
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
constexpr const char* kSetupFile = "process.setup.file";

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

 private:
  std::string section_;
};

/// Whether the number comes from the wheel's own file or is derived from it; the wear per pass belongs to the process.
bool isOfWheelFile(const JobField& field) {
  return begins(field.file_key, "process.wheel.") && std::string_view(field.path) != "process.wheel_wear_per_pass";
}

/// An operation of a job file beside its numbers.
struct OperationFiles {
  std::string wheel_path;  ///< path of the wheel file; empty if the job file states the wheel itself
  std::optional<WheelFile> wheel;
  std::string setup_path;             ///< path of the set-up file; empty if the job file states the set-up itself
  std::optional<SetupFigure> wanted;  ///< figure that the job file asks for beside the set-up file
  int line = 1;                       ///< line of the set-up file's name
  std::string unsolved;               ///< why the set-up file has no set-up for this operation; empty if it has
};

/// The path of a file that a job file names.
/// @param job the path of the job file.
std::string besideJob(const std::string& job, const std::string& file) {
  return (std::filesystem::path(job).parent_path() / file).string();
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

/// Mounts the wheel of a wheel file.
/// @param path_of_job path of the job file in messages.
void takeWheelFile(FlatFile& file, const ProcessKeys& keys, const std::string& path_of_job, OperationFiles& files,
                   GrindJob& job) {
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
  files.wheel_path = besideJob(path_of_job, name);
  std::string text;
  try {
    text = readTextFile(files.wheel_path);
  } catch (const FileError& error) {
    const std::filesystem::path folder = std::filesystem::absolute(path_of_job).parent_path();
    return file.fail(file.line(key), key + " = " + name + ": " + error.what() +
                                         "; allowed: a path from the job file's folder, " +
                                         folder.lexically_normal().string());
  }
  try {
    files.wheel = parseWheel(text, files.wheel_path);
    mountWheel(*files.wheel, job);
  } catch (const FileError& error) {
    file.add(error.what());
  }
}

/// The figure of a set-up that an operation may ask for beside a set-up file; nothing for any other number.
std::optional<SetupFigure> figureOf(const JobField& field, OperationKind kind) {
  for (const SetupFigureRow& row : kSetupFigures) {
    const bool is_allowed = kind == OperationKind::kFlute || (isRelief(kind) && row.value == SetupFigure::kSwivel);
    if (is_allowed && std::string_view(row.path) == field.path) return row.value;
  }
  return std::nullopt;
}

/// The keys that figureOf() allows beside a set-up file.
std::string figureKeys(OperationKind kind, const ProcessKeys& keys) {
  std::string names;
  visitJobFields([&](const JobField& field, auto) {
    if (figureOf(field, kind)) names += (names.empty() ? "" : ", ") + keys(field.file_key);
  });
  if (names.empty()) return "none";
  return isRelief(kind) ? names : "one of " + names;
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

  GrindJob read(const std::string& name) {
    if (!keys_.single()) takeKind();
    takeSpirals(file_, job_);
    takeSetupFile(name);
    const bool has_wheel_path = refuseWheelPath(file_, keys_);
    const bool has_wheel_file = has_wheel_path || file_.mentions(keys_("process.wheel.file"));
    visitJobFields([&](const JobField& field, auto of) {
      if (!(has_wheel_file && isOfWheelFile(field))) takeNumber(field, of);
    });
    takeTeeth(file_, job_);
    if (has_wheel_file) {
      if (!has_wheel_path) takeWheelFile(file_, keys_, name, files_, job_);
    } else {
      file_.know(keys_("process.wheel.file"));
      takeWheelShape(file_, keys_("process.wheel."), job_);
    }
    takeChoices();
    return std::move(job_);
  }

  const OperationFiles& files() const { return files_; }

 private:
  void takeSetupFile(const std::string& name) {
    const std::string key = keys_(kSetupFile);
    std::string file;
    files_.line = file_.line(key);
    if (file_.mayHave(key) && file_.take(key, otherJobKey("process.setup_file").allowed, file))
      files_.setup_path = besideJob(name, file);
  }

  /// Takes a figure of the set-up beside a set-up file, in which the others stand.
  /// @return whether it is there.
  bool takeWanted(const JobField& field, const std::string& key) {
    if (!file_.has(key)) {
      file_.know(key);
      return false;
    }
    const auto figure = figureOf(field, job_.process().kind);
    if (!figure || files_.wanted) {
      file_.fail(file_.line(key), key + " stands beside " + keys_(kSetupFile) +
                                      "; allowed beside it: " + figureKeys(job_.process().kind, keys_));
      file_.drop(key);
      return false;
    }
    files_.wanted = figure;
    return true;
  }

  /// Takes a word that a column of the operations' table has.
  /// @param fits whether a row counts.
  template <typename Fits>
  std::string takeWord(const std::string& key, const char* OperationRow::*column, const Fits& fits) {
    std::vector<std::string> words;
    for (const OperationRow& row : kOperationKinds) {
      if (fits(row) && std::find(words.begin(), words.end(), row.*column) == words.end()) words.push_back(row.*column);
    }
    std::string allowed, word;
    for (const std::string& one : words) allowed += (allowed.empty() ? "" : ", ") + one;
    if (!file_.take(key, allowed, word)) return "";
    if (std::find(words.begin(), words.end(), word) != words.end()) return word;
    file_.fail(file_.line(key), key + " = " + word + "; allowed: " + allowed);
    return "";
  }

  void takeKind() {
    const std::string kind =
        takeWord(keys_("process.kind"), &OperationRow::kind, [](const OperationRow&) { return true; });
    const auto is_kind = [&kind](const OperationRow& row) { return row.kind == kind; };
    const auto first = std::find_if(std::begin(kOperationKinds), std::end(kOperationKinds), is_kind);
    if (first == std::end(kOperationKinds)) return;
    job_.process().kind = first->value;
    if (*first->relief == '\0') return;
    const std::string relief = takeWord(keys_("process.relief"), &OperationRow::relief, is_kind);
    for (const OperationRow& row : kOperationKinds) {
      if (is_kind(row) && row.relief == relief) job_.process().kind = row.value;
    }
  }

  /// Whether a relief takes a key from the preceding operation.
  /// @param key key of a single operation.
  bool inherits(const char* key) const { return before_ != nullptr && !file_.has(keys_(key)); }

  template <typename Of>
  void takeNumber(const JobField& field, const Of& of) {
    const std::string key = keys_(field.file_key);
    double value = 0;
    if (!field.isOf(job_.process().kind)) return;
    if (std::string_view(field.path) == "process.clearance" && inherits(field.file_key)) {
      job_.process().clearance = before_->clearance;
      return file_.know(key);
    }
    const bool of_file = !files_.setup_path.empty() && isOfSetup(field);
    if (of_file ? !takeWanted(field, key) : omits(file_, key, field)) return file_.know(key);
    std::string allowed = grinder::text(field.low(), field.high());
    if (!file_.has(key) && isOfSetup(field)) {
      allowed += "; or " + keys_(kSetupFile) + ", a file that 'grind setup --write' writes";
    }
    file_.take(key, allowed, value);
    of(job_) = value * shopScale(field.unit);
  }

  void takeChoices() {
    GrindProcess& p = job_.process();
    file_.takeChoice("cutter.cut", job_.cutter.cut);
    file_.takeChoice("interpolation.even_step", job_.interpolation.even_step);
    const OtherKey& center_teeth = otherJobKey("cutter.end_center_teeth");
    if (file_.mayHave(center_teeth.file_key)) {
      file_.take(center_teeth.file_key, center_teeth.allowed, job_.cutter.end_center_teeth);
    }
    const auto choice = [&](const std::string& key, auto& value) { file_.takeChoice(key, value); };
    takeOrInherit("process.order", &GrindProcess::order, choice);
    takeOrInherit("process.direction", &GrindProcess::direction, choice);
    takeOrInherit("process.spark_out", &GrindProcess::spark_out, [&](const std::string& key, int& value) {
      file_.take(key, otherJobKey("process.spark_out").allowed, value);
    });
    const std::string roughing = keys_("process.roughing_passes");
    if (file_.mayHave(roughing))
      file_.take(roughing, otherJobKey("process.roughing_passes").allowed, p.roughing_passes);
    if (p.kind != OperationKind::kFlute) return;
    file_.takeOptionalChoice(keys_("process.z_law"), p.z_law);
    const std::string incomplete_ok = keys_("process.incomplete_ok");
    if (file_.mayHave(incomplete_ok))
      file_.take(incomplete_ok, otherJobKey("process.incomplete_ok").allowed, p.incomplete_ok);
  }

  template <typename Value, typename Take>
  void takeOrInherit(const char* key, Value GrindProcess::*value, const Take& take) {
    if (!inherits(key)) return take(keys_(key), job_.process().*value);
    job_.process().*value = before_->*value;
    file_.know(keys_(key));
  }

  FlatFile& file_;
  ProcessKeys keys_;
  const GrindProcess* before_;
  GrindJob job_;
  OperationFiles files_;
};

std::string sectionOf(int operation) { return element(kOperations, static_cast<std::size_t>(operation)) + "."; }

/// The number of operations that a file lists; 0 for a single process.
int operationsIn(const FlatFile& file) {
  int count = 0;
  while (count < kMaxOperations && file.mentionsSection(element(kOperations, static_cast<std::size_t>(count)))) ++count;
  return count;
}

void failInvalid(FlatFile& file, const ProcessKeys& keys, const GrindJob& job) {
  for (Reason reason : validate(job)) {
    reason.field = keys(fieldName(reason.field));
    file.fail(file.line(reason.field), grinder::text(reason));
  }
  file.throwErrors();
}

/// The index of an operation.
/// @param named its number, from 1, or its kind; may be empty for a single operation.
std::size_t operationNamed(const std::string& named, const std::vector<GrindProcess>& operations,
                           const std::string& name) {
  std::string all;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const std::string kind = toString(operations[i].kind);
    if (named == kind || named == std::to_string(i + 1) || (named.empty() && operations.size() == 1)) return i;
    all += (all.empty() ? "" : ", ") + std::to_string(i + 1) + " or " + kind;
  }
  throw FileError(name + ": operation " + (named.empty() ? "is missing" : "= " + named) + "; allowed: " + all);
}

bool isWanted(const JobField& field, const OperationFiles& files) {
  return files.wanted && std::string_view(field.path) == rowOf(*files.wanted).path;
}

/// The job with the set-up of clearSetup(), except the wanted figure.
GrindJob withoutSetup(const GrindJob& job, const OperationFiles& files) {
  GrindJob cleared = job;
  clearSetup(cleared);
  visitJobFields([&](const JobField& field, auto of) {
    if (isWanted(field, files)) of(cleared) = of(job);
  });
  return cleared;
}

/// Takes the set-up of an operation from its set-up file, or says in `files` why there is none that fits.
void takeSolved(OperationFiles& files, GrindJob& job) {
  const GrindJob asked = withoutSetup(job, files);
  try {
    takeSetup(readTextFile(files.setup_path), files.setup_path, job);
    visitJobFields([&](const JobField& field, auto of) {
      constexpr int digits = 9;
      const std::string is = text({of(job), field.unit}, digits), wanted = text({of(asked), field.unit}, digits);
      if (!isWanted(field, files) || is == wanted) return;
      throw FileError(files.setup_path + ": solved with " + field.file_key + " = " + is + "; the job now asks for " +
                      wanted);
    });
  } catch (const FileError& error) {
    job = asked;
    files.unsolved = error.what();
  }
}

/// Reads one operation, and the rest of the file except the other operations.
/// @param file file from which nothing was taken.
GrindJob readOperation(FlatFile file, const std::string& name, const ProcessKeys& keys, const GrindProcess* before,
                       OperationFiles& files) {
  if (!keys.single()) {
    for (int i = 0; i < kMaxOperations; ++i) {
      if (sectionOf(i) != keys(kProcess)) file.dropSection(sectionOf(i));
    }
    file.drop(kOperation);  // a record names its operation
  }
  OperationReader reader(file, keys, before);
  GrindJob job = reader.read(name);
  file.refuseTheRest();
  file.throwErrors();
  files = reader.files();
  if (!files.setup_path.empty()) takeSolved(files, job);
  return job;
}

/// A job file with all its operations.
struct ParsedJob {
  FlatFile file;
  GrindJob job{};                       ///< the first operation's
  std::vector<ProcessKeys> keys{};      ///< of each operation
  std::vector<OperationFiles> files{};  ///< of each operation

  /// @throw FileError unless the first operations are set up.
  void requireSetups(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (files[i].unsolved.empty()) continue;
      const std::string which =
          keys[i].single() ? "" : std::string("--operation ") + toString(job.operations[i].kind) + " ";
      file.fail(files[i].line,
                keys[i](kSetupFile) + " = " + files[i].unsolved + "; 'grind setup " + which + "--write' solves it");
    }
    file.throwErrors();
  }

  /// @param named as in operationNamed().
  std::size_t indexOf(std::string named, const std::string& name) {
    if (named.empty() && file.has(kOperation)) file.take(kOperation, "a kind of operation", named);
    return operationNamed(named, job.operations, name);
  }
};

ParsedJob parseAll(const std::string& text, const std::string& name) {
  ParsedJob parsed{FlatFile(text, name, kKind, kContent)};
  for (int i = 0; i < operationsIn(parsed.file); ++i) parsed.keys.emplace_back(sectionOf(i));
  if (parsed.keys.empty()) parsed.keys.emplace_back(kProcess);
  std::vector<GrindProcess> all;
  for (const ProcessKeys& keys : parsed.keys) {
    OperationFiles& files = parsed.files.emplace_back();
    parsed.job = readOperation(parsed.file, name, keys, all.empty() ? nullptr : &all.back(), files);
    all.push_back(parsed.job.process());
  }
  parsed.job.operations = std::move(all);
  for (const GrindJob& job : parsed.job.ofAllOperations()) {
    failInvalid(parsed.file, parsed.keys[static_cast<std::size_t>(job.operation)], job);
  }
  return parsed;
}

JobFile jobFileOf(const ParsedJob& parsed, std::size_t operation, const std::string& path) {
  const OperationFiles& files = parsed.files[operation];
  return {path, parsed.job.ofOperation(static_cast<int>(operation)), files.wheel_path, files.wheel, files.setup_path};
}

JobFile open(const std::string& text, const std::string& name, const std::string& operation) {
  ParsedJob parsed = parseAll(text, name);
  parsed.requireSetups(parsed.files.size());
  return jobFileOf(parsed, parsed.indexOf(operation, name), name);
}

}  // namespace

GrindJob parseJob(const std::string& text, const std::string& name, const std::string& operation) {
  return open(text, name, operation).job;
}

JobFile openJobFile(const std::string& path, const std::string& operation) {
  return open(readTextFile(path), path, operation);
}

GrindJob readJobFile(const std::string& path, const std::string& operation) { return openJobFile(path, operation).job; }

JobToSetUp readJobToSetUp(const std::string& path, const std::string& operation) {
  ParsedJob parsed = parseAll(readTextFile(path), path);
  const std::size_t index = parsed.indexOf(operation, path);
  parsed.requireSetups(index);
  const OperationFiles& files = parsed.files[index];
  JobToSetUp asked{jobFileOf(parsed, index, path), {}, files.wanted};
  if (files.unsolved.empty()) asked.before = asked.job.process();
  if (!files.setup_path.empty()) asked.job = withoutSetup(asked.job, files);
  return asked;
}

}  // namespace grinder
