#pragma once

#include "flute_grinder/base/enum_table.h"

#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

namespace grinder {

/// The name of an element of a list, e.g. "points_mm[2]".
std::string element(const std::string& key, std::size_t i);

/// Reads a value. A whole number must be decimal: YAML would read 010 as 8.
/// @return what is wrong with the value, e.g. " is not a number"; empty if it was read.
std::string readValue(const YAML::Node& node, double& value);
std::string readValue(const YAML::Node& node, int& value);
std::string readValue(const YAML::Node& node, bool& value);
std::string readValue(const YAML::Node& node, std::string& value);

/// A YAML file of known keys, flattened: "process.wheel.diameter_mm" or "process.overtravel_mm[0]" to value. Known keys
/// are removed as they are read, so the remaining keys are unknown. Errors are collected, each with file and line.
class FlatFile {
 public:
  /// @param text YAML.
  /// @param name name of the file in messages.
  /// @param kind kind of file, e.g. "job file".
  /// @param content its sections or keys, in words.
  /// @throw FileError if it is not a map, or a key is duplicate or not a word.
  FlatFile(const std::string& text, std::string name, std::string kind, const std::string& content);

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
    const std::string wrong = readValue(node, value);
    if (wrong.empty()) return true;
    const std::string text = node.IsScalar() ? node.Scalar() : node.IsNull() ? "(nothing)" : "(not a value)";
    fail(line(key), key + " = " + text + wrong + "; allowed: " + allowed);
    return false;
  }

  /// Takes a value that must be a name of the enum.
  /// @return whether it is one.
  template <typename Enum>
  bool takeChoice(const std::string& key, Enum& value) {
    const std::string allowed = namesOf<Enum>();
    std::string word;
    if (!take(key, allowed, word)) return false;
    const auto choice = valueOf<Enum>(word);
    if (!choice) {
      fail(line(key), key + " = " + word + "; allowed: " + allowed);
      return false;
    }
    value = *choice;
    return true;
  }

  /// Like takeChoice(), for a key that the file may omit.
  template <typename Enum>
  void takeOptionalChoice(const std::string& key, Enum& value) {
    if (mayHave(key)) takeChoice(key, value);
  }

  /// Whether the file has a value for an optional key.
  bool mayHave(const std::string& key) {
    if (!has(key)) know(key);
    return has(key);
  }

  /// Records an allowed key, for the message about unknown keys.
  void know(const std::string& key) { known_.push_back(key); }

  /// Removes a value or a list.
  void drop(const std::string& key);

  /// Whether the file had a value, a list or a list of lists with this key, even if it has been taken.
  bool mentions(const std::string& key) const { return findLine(key) != lines_.end(); }

  /// Whether the file had a value with this key; for a list element, e.g. "corner_radius_mm[1]", any part of the list.
  bool mentionsPart(const std::string& key) const;

  /// Whether the file has any key of a section.
  /// @param section name without its trailing point.
  bool mentionsSection(const std::string& section) const;

  /// Removes all remaining keys of a section.
  /// @param section name with its trailing point.
  void dropSection(const std::string& section);

  bool has(const std::string& key) const { return entries_.count(key) != 0; }

  /// Whether the file has a value or a first list element with this key.
  bool hasAny(const std::string& key) const { return has(key) || has(element(key, 0)); }

  /// Takes a list of numbers into `values`, in SI units.
  void takeList(const std::string& key, const std::string& allowed, double scale, std::vector<double>& values);

  /// Refuses a key that stands beside an alternative to it.
  bool refuseBoth(const std::string& key, const std::string& other);

  /// Refuses all remaining keys of a section, because it stands beside `key`.
  void refuseBeside(const std::string& key, const std::string& section, const std::string& allowed);

  void refuseTheRest();

  /// The line of a key or of its first element; 1 if the file does not have it.
  int line(const std::string& key) const;

  /// Adds an error as one line that is safe for a terminal.
  void fail(int line, std::string what);

  /// Adds errors that already contain file and line.
  void add(const std::string& errors);

  /// @throw FileError with the first errors and the number of further ones, if there are any.
  void throwErrors() const;

 private:
  static constexpr int kDeepest = 6;              ///< maximum nesting: operations[0].wheel.points_mm[0][0]
  static constexpr int kMaxReported = 20;         ///< maximum number of errors reported
  static constexpr std::size_t kMaxError = 2000;  ///< maximum length of an error [characters]

  std::map<std::string, int>::const_iterator findLine(const std::string& key) const;
  void flatten(const YAML::Node& node, const std::string& path, int line, int depth);
  void flattenMap(const YAML::Node& map, const std::string& path, int depth);
  void refuseKey(int line, const std::string& key, const std::string& allowed);

  std::string name_;
  std::string kind_;
  std::map<std::string, YAML::Node> entries_;
  std::map<std::string, int> lines_;
  std::vector<std::string> known_;
  std::string errors_;  ///< the first errors
  int error_count_ = 0;
};

}  // namespace grinder
