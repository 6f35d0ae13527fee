#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace grinder {

/// Refuses YAML features that a job does not need and that are risky: anchors and aliases, with which a short text can
/// expand to a huge one, and a second document.
/// @param name name of the file in messages.
/// @throw FileError with the line.
void checkYaml(const std::string& text, const std::string& name);

/// Parses a text that checkYaml() accepts.
/// @throw FileError with the line.
YAML::Node parseYaml(const std::string& text, const std::string& name);

}  // namespace grinder
