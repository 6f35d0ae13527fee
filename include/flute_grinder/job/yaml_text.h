#pragma once

#include "flute_grinder/job/escaped.h"

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace grinder {

/// A job, wheel or machine file that cannot be read; what() has one line per error: file, line, key, value and the
/// allowed values, and is escaped() except for line ends.
class JobFileError : public std::runtime_error {
 public:
  explicit JobFileError(const std::string& text) : std::runtime_error(escaped(text, "\n")) {}
};

constexpr std::size_t kMaxYamlFile = 65536;   ///< longest YAML file [bytes]
constexpr std::size_t kMaxUrdfFile = 262144;  ///< longest robot description [bytes]

/// The text of a file.
/// @param most maximum length [bytes].
/// @throw JobFileError with the cause if the file cannot be read, is empty or is longer.
std::string readTextFile(const std::string& path, std::size_t most = kMaxYamlFile);

/// Refuses YAML features that a job does not need and that are risky: anchors and aliases, with which a short text can
/// expand to a huge one, and a second document.
/// @param name name of the file in messages.
/// @throw JobFileError with the line.
void checkYaml(const std::string& text, const std::string& name);

/// Parses a text that checkYaml() accepts.
/// @throw JobFileError with the line.
YAML::Node parseYaml(const std::string& text, const std::string& name);

}  // namespace grinder
