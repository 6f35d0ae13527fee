#include "flute_grinder/core/job_file.h"

#include "flute_grinder/core/job_fields.h"
#include "flute_grinder/core/units.h"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace flute_grinder {

namespace {

/// A flattened file: "process.wheel.diameter_mm" or "process.overtravel_mm[0]" to value. Known keys are removed as they
/// are read; the remaining ones are unknown.
class FlatFile {
 public:
  FlatFile(const YAML::Node& root, std::string name) : name_(std::move(name)) {
    if (root.IsMap()) {
      flatten(root, "", 1, 0);
    } else {
      fail(1, "not a map of cutter, process and interpolation");
    }
  }

  /// @return whether a value of the right type was found.
  template <typename T>
  bool take(const std::string& key, const std::string& allowed, T& value) {
    known_.push_back(key);
    const auto entry = entries_.extract(key);
    if (!entry) {
      fail(1, key + " is missing; allowed: " + allowed);
      return false;
    }
    const YAML::Node& node = entry.mapped();
    try {
      value = node.as<T>();
      return true;
    } catch (const YAML::Exception&) {
      const std::string text = node.IsScalar() ? node.Scalar() : node.IsNull() ? "(nothing)" : "(not a value)";
      fail(line(key), key + " = " + text + "; allowed: " + allowed);
      return false;
    }
  }

  /// Takes a value that must be one of an enum's names.
  template <typename Enum>
  void takeChoice(const std::string& key, Enum& value) {
    const std::string allowed = namesOf<Enum>();
    std::string word;
    if (!take(key, allowed, word)) return;
    const auto choice = valueOf<Enum>(word);
    if (!choice) return fail(line(key), key + " = " + word + "; allowed: " + allowed);
    value = *choice;
  }

  void drop(const std::string& key) { entries_.erase(key); }

  bool has(const std::string& key) const { return entries_.count(key) != 0; }

  void refuseTheRest() {
    for (const auto& entry : entries_) {
      const std::string& key = entry.first;
      const std::string section = key.substr(0, key.find('.') + 1);
      std::string allowed;
      for (const std::string& known : known_) {
        if (known.compare(0, section.size(), section) == 0) allowed += (allowed.empty() ? "" : ", ") + known;
      }
      refuseKey(line(key), key, allowed);
    }
  }

  /// The line of a key, or of its first element; 1 if it is not in the file.
  int line(const std::string& key) const {
    for (const std::string& name : {key, key + "[0]"}) {
      const auto it = lines_.find(name);
      if (it != lines_.end()) return it->second;
    }
    return 1;
  }

  void fail(int line, const std::string& what) {
    errors_ += (errors_.empty() ? "" : "\n") + name_ + ":" + std::to_string(line) + ": " + what;
  }

  void throwErrors() const {
    if (!errors_.empty()) throw JobFileError(errors_);
  }

 private:
  void flatten(const YAML::Node& node, const std::string& path, int line, int depth) {
    // A YAML alias may contain itself.
    if (depth > kDeepest) return fail(line, path + " goes too deep");
    if (node.IsMap() && node.size() > 0) {
      flattenMap(node, path, depth);
    } else if (node.IsSequence() && node.size() > 0) {
      for (std::size_t i = 0; i < node.size(); ++i) {
        flatten(node[i], path + "[" + std::to_string(i) + "]", node[i].Mark().line + 1, depth + 1);
      }
    } else {
      entries_.emplace(path, node);
      lines_.emplace(path, line);
    }
  }

  void flattenMap(const YAML::Node& map, const std::string& path, int depth) {
    std::set<std::string> keys;
    for (const auto& item : map) {
      const int line = item.first.Mark().line + 1;
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "(not a word)";
      std::string full = path;
      full.append(path.empty() ? "" : ".").append(key);
      if (key.find_first_of(".[(") != std::string::npos) {
        refuseKey(line, full, "words without dots and brackets");
      } else if (!keys.insert(key).second) {
        fail(line, full + " stands here a second time");
      } else {
        flatten(item.second, full, line, depth + 1);
      }
    }
  }

  void refuseKey(int line, const std::string& key, const std::string& allowed) {
    std::string text = key;
    fail(line, text.append(" is not a key of a job file; allowed: ").append(allowed));
  }

  static constexpr int kDeepest = 5;

  std::string name_;
  std::map<std::string, YAML::Node> entries_;
  std::map<std::string, int> lines_;
  std::vector<std::string> known_;
  std::string errors_;
};

void takeTeeth(FlatFile& file, GrindJob& job) {
  const std::string counted = "cutter.teeth";
  const std::string listed = "cutter.tooth_angles_deg";
  const auto angle = [&](std::size_t i) { return listed + "[" + std::to_string(i) + "]"; };
  const std::string angles_allowed = "angles in deg, 0 first, ascending, below 360";
  const std::string teeth_allowed = "1 to " + std::to_string(kMaxTeeth);
  int teeth = 0;
  if (file.has(listed) || file.has(angle(0))) {
    if (file.has(counted)) {
      file.fail(file.line(counted), counted + " stands beside " + listed + "; allowed: one of the two");
      file.drop(counted);
      file.drop(listed);
    }
    double degrees = 0;
    if (file.has(listed)) file.take(listed, angles_allowed, degrees);
    for (std::size_t i = 0; file.has(angle(i)); ++i) {
      file.take(angle(i), angles_allowed, degrees);
      job.tooth_angles.push_back(degrees * units::kDegree);
    }
    return;
  }
  if (!file.take(counted, teeth_allowed, teeth)) return;
  if (teeth < 1 || teeth > kMaxTeeth) {
    return file.fail(file.line(counted), counted + " = " + std::to_string(teeth) + "; allowed: " + teeth_allowed);
  }
  for (int i = 0; i < teeth; ++i) job.tooth_angles.push_back(i * 360.0 / teeth * units::kDegree);
}

}  // namespace

GrindJob parseJob(const std::string& text, const std::string& name) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw JobFileError(name + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  FlatFile file(root, name);
  file.throwErrors();

  GrindJob job;
  visitJobFields([&](const JobField& field, auto of) {
    double value = 0;
    if (field.optional && !file.has(field.file_key)) return;
    file.take(field.file_key, flute_grinder::text(field.low(), field.high(), UnitSystem::kShop), value);
    of(job) = value * shopScale(field.unit);
  });
  takeTeeth(file, job);
  file.take("process.spark_out", "0 to " + std::to_string(kMaxSparkOut), job.process.spark_out);
  file.takeChoice("process.order", job.process.order);
  file.takeChoice("process.direction", job.process.direction);
  file.takeChoice("interpolation.even_step", job.interpolation.even_step);
  file.refuseTheRest();
  file.throwErrors();

  for (const core::Reason& reason : validate(job)) {
    file.fail(file.line(fieldName(reason.field, UnitSystem::kShop)), core::text(reason, UnitSystem::kShop));
  }
  file.throwErrors();
  return job;
}

GrindJob readJobFile(const std::string& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream || !text) throw JobFileError(path + ": cannot be read");
  return parseJob(text.str(), path);
}

}  // namespace flute_grinder
