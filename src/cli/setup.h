#pragma once

#include <string>

namespace grinder {

/// Arguments of `grind setup`.
struct SetupOptions {
  std::string job;
  std::string operation;   ///< one of several operations; empty for the only one
  bool write = false;      ///< writes the set-up into its file
  std::string parameters;  ///< YAML of the machine
  std::string urdf;
  bool json = false;
};

/// Solves the set-up of a job, prints the sheet, and writes the set-up file. @return the exit status.
/// @throw FileError, ParameterError if a file cannot be read or written.
int runSetup(const SetupOptions& options);

}  // namespace grinder
