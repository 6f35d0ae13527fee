#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/job/yaml_text.h"

#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

namespace grinder {

/// The name of an element of a list, e.g. "points_mm[2]".
std::string element(const std::string& key, std::size_t i);

/// Reads a value. @return what is wrong with it, e.g. " is not a number"; empty if it was read. A whole number must be
/// decimal: YAML would take 010 for 8.
std::string readValue(const YAML::Node& node, double& value);
std::string readValue(const YAML::Node& node, int& value);
std::string readValue(const YAML::Node& node, bool& value);
std::string readValue(const YAML::Node& node, std::string& value);

/// A YAML file of known keys, flattened: "process.wheel.diameter_mm" or "process.overtravel_mm[0]" to value. Known keys
/// are removed as they are read; the remaining ones are unknown. Errors are collected, each with file and line.
class FlatFile {
 public:
  /// @param text YAML. @param name of the file, in messages.
  /// @param kind of file, e.g. "job file". @param content its sections or keys, in words.
  /// @throw JobFileError if it is not a map, or a key is duplicate or not a word.
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

  /// Takes a value that must be one of an enum's names.
  /// @return whether it is.
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

  /// The same for a key that the file may omit.
  template <typename Enum>
  void takeOptionalChoice(const std::string& key, Enum& value) {
    if (mayHave(key)) takeChoice(key, value);
  }

  /// Whether there is a value to take of a key that the file may omit.
  bool mayHave(const std::string& key) {
    if (!has(key)) know(key);
    return has(key);
  }

  /// Notes a key that the file may have, for the message about those it may not have.
  void know(const std::string& key) { known_.push_back(key); }

  /// Removes a value, or a list.
  void drop(const std::string& key);

  /// Whether the file had a value, a list or a list of lists of this name, taken by now or not.
  bool mentions(const std::string& key) const { return findLine(key) != lines_.end(); }

  /// Whether it had a value, or for an element of a list, e.g. "corner_radius_mm[1]", any part of the list.
  bool mentionsPart(const std::string& key) const;

  /// Whether the file has any key of a section. @param section without its point.
  bool mentionsSection(const std::string& section) const;

  /// Removes every key of a section that has not been taken. @param section with its point.
  void dropSection(const std::string& section);

  bool has(const std::string& key) const { return entries_.count(key) != 0; }

  /// Whether there is a value, or the first of a list.
  bool hasAny(const std::string& key) const { return has(key) || has(element(key, 0)); }

  /// Takes a list of numbers into `values`, in SI.
  void takeList(const std::string& key, const std::string& allowed, double scale, std::vector<double>& values);

  /// Refuses a key if it stands beside another one that it could replace.
  bool refuseBoth(const std::string& key, const std::string& other);

  /// Refuses every key of a section that has not been taken, because it stands beside `key`.
  void refuseBeside(const std::string& key, const std::string& section, const std::string& allowed);

  void refuseTheRest();

  /// The line of a key, or of its first element; 1 if it is not in the file.
  int line(const std::string& key) const;

  /// Adds an error, in one line that a terminal can show, whatever the file has.
  void fail(int line, std::string what);

  /// Adds errors that name their file and line themselves.
  void add(const std::string& errors);

  /// @throw JobFileError with the errors so far, if there are any: the first of them, and how many more.
  void throwErrors() const;

 private:
  static constexpr int kDeepest = 6;              ///< operations[0].wheel.points_mm[0][0]
  static constexpr int kMaxReported = 20;         ///< errors
  static constexpr std::size_t kMaxError = 2000;  ///< characters

  std::map<std::string, int>::const_iterator findLine(const std::string& key) const;
  void flatten(const YAML::Node& node, const std::string& path, int line, int depth);
  void flattenMap(const YAML::Node& map, const std::string& path, int depth);
  void refuseKey(int line, const std::string& key, const std::string& allowed);

  std::string name_;
  std::string kind_;
  std::map<std::string, YAML::Node> entries_;
  std::map<std::string, int> lines_;
  std::vector<std::string> known_;
  std::string errors_;  ///< the first ones
  int error_count_ = 0;
};

}  // namespace grinder
