#pragma once

#include "flute_grinder/job/escaped.h"

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace grinder {

/// A job, wheel or machine file that cannot be read; what() has one line per error: file, line, key, value and the
/// allowed values, and is escaped() but for the ends of its lines.
class JobFileError : public std::runtime_error {
 public:
  explicit JobFileError(const std::string& text) : std::runtime_error(escaped(text, "\n")) {}
};

constexpr std::size_t kMaxYamlFile = 65536;   ///< longest YAML file [bytes]
constexpr std::size_t kMaxUrdfFile = 262144;  ///< longest robot description [bytes]

/// The text of a file.
/// @param most bytes.
/// @throw JobFileError if it cannot be read, and why; if it is empty or longer.
std::string readTextFile(const std::string& path, std::size_t most = kMaxYamlFile);

/// Refuses what a job does not need and what would be misread: anchors and aliases, with which a short text is a huge
/// one, and a second document.
/// @param name of the file, in messages. @throw JobFileError with the line.
void checkYaml(const std::string& text, const std::string& name);

/// Parses a text that checkYaml() accepts. @throw JobFileError with the line.
YAML::Node parseYaml(const std::string& text, const std::string& name);

}  // namespace grinder
