#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace grinder {

/// The first word of a parsed command line that is no command, option or argument, with the nearest one that is.
/// @return empty if there is no such word.
std::string unknownWord(const CLI::App& app);

/// The message for an argument that should be a number and is not; empty for any other error.
std::string wrongNumber(const CLI::ParseError& error);

}  // namespace grinder
