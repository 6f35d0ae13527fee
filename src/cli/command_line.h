#pragma once

#include "cli/commands.h"

#include <optional>

namespace grinder {

constexpr int kUsage = 2;  ///< exit status for wrong usage and unreadable files

/// The command line of `grind`: its commands, and its messages on wrong usage.
class CommandLine {
 public:
  CommandLine();

  /// Parses the arguments, without carrying out the command.
  /// @return nothing if carryOut() may follow; else the exit status, after the help, the version or a refusal was
  /// printed.
  std::optional<int> parse(int argc, const char* const* argv);

  /// Carries out the command that was parsed. @return the exit status. @throw std::exception from the command.
  int carryOut() const { return commands_.carryOut(); }

 private:
  CLI::App app_{"Plans jobs for conical end mills and operates the grinder.", "grind"};
  Commands commands_{app_};
};

}  // namespace grinder
