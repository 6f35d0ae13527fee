#pragma once

#include "flute_grinder/machine/probing_cycle.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind probe`.
struct ProbeOptions {
  std::string job;
  std::string operation;             ///< operation of the job file; empty for the only one
  double within = 0;                 ///< longest way to a touch [mm], A [deg]
  std::optional<double> at_mm;       ///< diameter of the blank, if known
  std::optional<double> flange_mm;   ///< flange length instead of the wheel file's
  std::vector<std::string> answers;  ///< answers given beforehand
};

/// Has the grinder run a probing cycle, and prints what it measured and the work offset that it set.
/// @param node name of the grinder's node. @return the exit status. @throw std::invalid_argument for contradictory
/// arguments. @throw JobError if the job file is refused.
int runProbe(const std::string& node, ProbingCycle cycle, const ProbeOptions& options);

}  // namespace grinder
