#include "flute_grinder/job/setup_file.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/yaml_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace grinder {

namespace {

constexpr const char* kJob = "job";
constexpr const char* kSolvedFor = "solved_for";
constexpr const char* kHead = "# Written by 'grind setup --write'. Change the job instead, and solve it again.\n";

/// The key of a figure in a set-up file, e.g. "swivel_deg" or "overtravel_mm[0]".
std::string keyOf(const JobField& field) {
  const std::string_view key = field.file_key;
  const std::string_view last = key.substr(key.rfind('.') + 1);
  return std::string(last);
}

/// A number in shop units, with the fewest digits from which it is read back to the last bit.
std::string number(double si, Unit unit) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.begin(), text.end(), shopNumber(si, unit)).ptr};
}

/// A number of the job for a comparison, to the digits of a drawing.
std::string asked(double si, Unit unit) { return format("%.9g", si / shopScale(unit)); }

std::string asked(const std::vector<double>& angles) {
  std::string text;
  for (const double angle : angles) text += (text.empty() ? "" : ", ") + asked(angle, Unit::kRadian);
  return "[" + text + "]";
}

/// Whether a set-up of an operation depends on the number. A tolerance says how good it must be, and the teeth what is
/// left of a land, which a plan checks; the wear of the wheel is compensated by Y.
bool isSolvedFor(const JobField& field, OperationKind kind) {
  const std::string_view path = field.path;
  for (const char* of_relief : {"cutter.clearance", "cutter.land", "cutter.second_clearance"}) {
    if (path == of_relief) return isRelief(kind);
  }
  if (path == "cutter.end_short_from") return isEndFlank(kind);
  if ((begins(path, "cutter.end_") && path != "cutter.end_diameter") || begins(path, "cutter.chamfer_")) {
    return isStraight(kind) && path.find("tolerance") == std::string_view::npos && path != "cutter.end_uncut_diameter";
  }
  if (path == "process.wheel_rim") return isEndFlank(kind);
  if (begins(path, "process.wheel_")) return path.find("wear") == std::string_view::npos;
  if (path == "process.behind" || begins(path, "process.gash_")) return field.isOf(kind);
  // A plane of the end has nothing to do with the flutes; the edge of a chamfer is on their rake face.
  if (isStraight(kind)) {
    const bool of_rake_face = path == "cutter.spiral_angle" || path == "cutter.rake_angle";
    return path == "cutter.end_diameter" || (of_rake_face && kind == OperationKind::kChamfer);
  }
  return begins(path, "cutter.") && path.find("tolerance") == std::string_view::npos;
}

/// What a set-up is solved for: a line for each number and choice, named by its key in a job file.
std::vector<std::string> solvedFor(const GrindJob& job) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& key, const std::string& value) { lines.push_back(key + " = " + value); };
  visitJobFields([&](const JobField& field, auto of) {
    if (isSolvedFor(field, job.process().kind)) add(field.file_key, asked(of(job), field.unit));
  });
  if (!job.spiral_angles.empty()) add("cutter.spiral_angles_deg", asked(job.spiral_angles));
  add("cutter.cut", toString(job.cutter.cut));
  add("process.wheel.profile", toString(job.process().wheel_profile));
  add("process.wheel.side", toString(job.process().wheel_side));
  for (std::size_t i = 0; i < job.process().wheel_points.size(); ++i) {
    const auto& [w, radius] = job.process().wheel_points[i];
    add(element("process.wheel.points_mm", i), asked(w, Unit::kMetre) + ", " + asked(radius, Unit::kMetre));
  }
  if (job.process().kind == OperationKind::kFlute) add("process.z_law", toString(job.process().z_law));
  if (isStraight(job.process().kind)) {
    add(fieldName("cutter.end_center_teeth"), std::to_string(job.cutter.end_center_teeth));
  }
  return lines;
}

/// Refuses a set-up that was solved for something else.
/// @param section name of the operation, with its trailing point.
void checkSolvedFor(FlatFile& file, const std::string& section, const GrindJob& job) {
  const std::string key = section + kSolvedFor;
  std::vector<std::string> was;
  while (file.has(element(key, was.size()))) {
    was.emplace_back();
    file.take(element(key, was.size() - 1), "KEY = VALUE", was.back());
  }
  if (was.empty()) return file.fail(file.line(section), key + " is missing");
  const std::vector<std::string> is = solvedFor(job);
  for (std::size_t i = 0; i < std::max(is.size(), was.size()); ++i) {
    const std::string before = i < was.size() ? was[i] : "nothing";
    const std::string now = i < is.size() ? is[i] : "nothing";
    if (before != now) {
      return file.fail(file.line(element(key, i)), "solved for " + before + "; the job now has " + now);
    }
  }
}

}  // namespace

bool isOfSetup(const JobField& field) {
  const std::string_view path = field.path;
  return begins(path, "process.setup_") || begins(path, "process.depth") || begins(path, "process.overtravel_");
}

void clearSetup(GrindJob& job) {
  visitJobFields([&](const JobField& field, auto of) {
    if (isOfSetup(field)) of(job) = 0;
  });
  if (job.process().kind != OperationKind::kFlute) return;
  const CutterGeometry& c = job.cutter;
  job.process().depth = (c.end_diameter - c.core_diameter) / 2;
  constexpr double run_in = 1e-3;
  const double growth = std::tan(c.cone_angle);
  // Not far toward the apex of a cone that closes soon.
  job.process().overtravel_end = growth > 0 ? std::min(run_in, c.end_diameter / 2 / growth / 10) : run_in;
}

void takeSetup(const std::string& content, const std::string& name, GrindJob& job) {
  FlatFile file(content, name, "set-up file", "the job's name and its operations");
  const std::string section = std::string(toString(job.process().kind)) + ".";
  if (!file.mentionsSection(section)) file.fail(1, "no set-up of the " + std::string(rowOf(job.process().kind).words));
  file.throwErrors();
  checkSolvedFor(file, section, job);
  file.throwErrors();
  visitJobFields([&](const JobField& field, auto of) {
    if (!isOfSetup(field) || !field.isOf(job.process().kind)) return;
    double value = 0;
    file.take(section + keyOf(field), text(field.low(), field.high()), value);
    of(job) = value * shopScale(field.unit);
  });
  for (const auto& row : kOperationKinds) {
    if (row.value != job.process().kind) file.dropSection(std::string(row.name) + ".");
  }
  file.drop(kJob);
  file.refuseTheRest();
  file.throwErrors();
}

std::string withSetup(const std::string& before, const std::string& name, const std::string& job_name,
                      const GrindJob& job) {
  YAML::Node root = before.empty() ? YAML::Node(YAML::NodeType::Map) : parseYaml(before, name);
  if (before.empty()) root[kJob] = job_name;
  const std::string of = root.IsMap() && root[kJob] && root[kJob].IsScalar() ? root[kJob].Scalar() : "";
  if (of != job_name) {
    throw FileError(name + ": " + (of.empty() ? "not a set-up file" : "the set-up file of " + of) +
                    ", and not written over; name a file of its own in " + job_name);
  }
  YAML::Node setup;
  visitJobFields([&](const JobField& field, auto value) {
    if (!isOfSetup(field) || !field.isOf(job.process().kind)) return;
    const std::string key = keyOf(field);
    const std::string text = number(value(job), field.unit);
    if (key.back() == ']') {
      YAML::Node pair = setup[key.substr(0, key.rfind('['))];
      pair.SetStyle(YAML::EmitterStyle::Flow);
      pair.push_back(text);
    } else {
      setup[key] = text;
    }
  });
  for (const std::string& line : solvedFor(job)) setup[kSolvedFor].push_back(line);
  root[toString(job.process().kind)] = setup;
  return kHead + YAML::Dump(root) + "\n";
}

}  // namespace grinder
