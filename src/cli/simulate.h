#pragma once

#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind simulate`.
struct SimulateOptions {
  std::string file;           ///< a job, a bag, or a record of the grinder
  bool last = false;          ///< the newest record of the grinder instead
  std::string folder;         ///< of these records; empty for the default folder of the grinder
  std::string job;            ///< of a bag; empty for the one in the bag
  std::string operation;      ///< of a job file, up to which the cutter is ground; empty for the only one
  int run = 0;                ///< which of a bag's jobs, from 1; 0 for the last
  std::vector<double> at_mm;  ///< X of the sections; empty: `sections` over the flute's length
  int sections = 9;
  std::string csv, stl, svg;  ///< files to write, or empty
  bool json = false;
};

constexpr int kMaxSections = 1000;

/// Computes and measures the cutter that a job, or a recorded run, grinds.
/// @param node the grinder's name, as for historyFolder(). @return the exit status.
/// @throw FileError, JobFileError if a file cannot be read or written; std::out_of_range for an X that is not on the
///        cutter.
int runSimulate(const std::string& node, const SimulateOptions& options);

}  // namespace grinder
