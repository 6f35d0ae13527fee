#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace grinder {

/// Type names of arguments that select how they are completed; a choice such as "{a|b|c}" completes itself.
constexpr const char* kAnyFile = "FILE";
constexpr const char* kYamlFile = "FILE.yaml";
constexpr const char* kUrdfFile = "FILE.urdf";
constexpr const char* kFolder = "FOLDER";

/// A script for bash that completes a program's sub-commands, options and their arguments, for `grind` and for
/// `rosrun flute_grinder grind`. Other uses of rosrun keep the existing completion.
std::string bashCompletion(const CLI::App& app);

}  // namespace grinder
