#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace flute_grinder {

/// The type names by which an argument says what completes it, beside a choice such as "{a|b|c}".
constexpr const char* kAnyFile = "FILE";
constexpr const char* kYamlFile = "FILE.yaml";
constexpr const char* kUrdfFile = "FILE.urdf";

/// A script for bash that completes a program's sub-commands, options and their arguments, for `grind` and for
/// `rosrun flute_grinder grind`; what else rosrun is given stays with the completion that was there.
std::string bashCompletion(const CLI::App& app);

}  // namespace flute_grinder
