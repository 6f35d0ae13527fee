#pragma once

#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind simulate`.
struct SimulateOptions {
  std::string file;           ///< a job, a bag, or a record of the grinder
  bool last = false;          ///< the newest record of the grinder instead
  std::string folder;         ///< folder of the records; empty for the grinder's default folder
  std::string job;            ///< job file for a bag; empty for the job in the bag
  std::string operation;      ///< last operation of a job file to grind; empty for the only one
  int run = 0;                ///< number of a bag's job, from 1; 0 for the last
  std::vector<double> at_mm;  ///< X of the sections; empty for `sections` of them over the flute's length
  int sections = 9;
  std::string csv, stl, svg;  ///< files to write, or empty
  bool json = false;
};

constexpr int kMaxSections = 1000;

/// Computes and measures the cutter that a job, or a recorded run, grinds.
/// @param node name of the grinder, see historyFolder(). @return the exit status.
/// @throw FileError if a file cannot be read or written; std::out_of_range for an X that is not on the
///        cutter.
int runSimulate(const std::string& node, const SimulateOptions& options);

}  // namespace grinder
