#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/base/format.h"

#include <yaml-cpp/yaml.h>

#include <cfloat>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace grinder {

/// The fields of a state in its file, a map in YAML. A table is a function that calls an object of this class with key,
/// member and allowed range of every field, both to read and to write. All errors are std::exception.
class StateFields {
 public:
  /// @throw if a value is not allowed.
  template <typename State, typename Table>
  static std::string write(const char* comment, State state, const Table& table) {
    StateFields fields;
    fields.text_.SetDoublePrecision(17);
    fields.text_ << YAML::Comment(comment) << YAML::BeginMap;
    table(fields, state);
    fields.text_ << YAML::EndMap;
    return std::string(fields.text_.c_str()) + "\n";
  }

  /// @throw unless every field is there exactly once, with an allowed value, and nothing else.
  template <typename State, typename Table>
  static State read(const std::string& text, const Table& table) {
    StateFields fields;
    fields.reads_ = true;
    fields.file_ = YAML::Load(text);
    State state;
    table(fields, state);
    for (const auto& entry : fields.file_) {
      const auto key = entry.first.as<std::string>();
      if (fields.known_.erase(key) == 0) throw std::runtime_error("key " + key + " is unknown or duplicate");
    }
    return state;
  }

  /// The allowed range of a number, or of each number in a list.
  struct Allowed {
    double min = -DBL_MAX, max = DBL_MAX;
    bool nan = false;  ///< NaN is allowed too

    std::string text() const { return max == DBL_MAX ? "a finite number" : format("%.10g to %.10g", min, max); }
  };

  template <typename Value>
  void operator()(const std::string& key, Value& value, const Allowed& allowed = {}) {
    if constexpr (std::is_enum_v<Value>) {
      std::string name = toString(value);
      (*this)(key, name);
      const auto named = valueOf<Value>(name);
      require(named.has_value(), key, name, namesOf<Value>());
      value = *named;
    } else if (reads_) {
      known_.insert(key);
      if (!file_[key]) throw std::runtime_error(key + " is missing");
      value = file_[key].as<Value>();
    } else {
      text_ << YAML::Key << key << YAML::Value << YAML::Flow << YAML::DoubleQuoted << value;
    }
    check(key, value, allowed);
  }

  /// @throw unless `good`, naming key, value and the allowed values.
  template <typename Value>
  static void require(bool good, const std::string& key, const Value& value, const std::string& allowed) {
    if (good) return;
    std::ostringstream text;
    text << key << " = " << value << "; allowed: " << allowed;
    throw std::runtime_error(text.str());
  }

 private:
  template <typename Value>
  static void check(const std::string& key, const Value& value, const Allowed& allowed) {
    if constexpr (std::is_same_v<Value, std::vector<double>>) {
      for (const double element : value) check(key, element, allowed);
    } else if constexpr (std::is_arithmetic_v<Value>) {
      const auto number = static_cast<double>(value);
      const bool good = (number >= allowed.min && number <= allowed.max) || (allowed.nan && std::isnan(number));
      require(good, key, value, allowed.text());
    }
  }

  bool reads_ = false;
  YAML::Emitter text_;           ///< text being written
  YAML::Node file_;              ///< map being read
  std::set<std::string> known_;  ///< keys that were read
};

}  // namespace grinder
