#pragma once

#include "flute_grinder/machine/probing_cycle.h"

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind probe`.
struct ProbeOptions {
  std::string job;
  std::string operation;            ///< of the job file; empty for the only one
  double within = 0;                ///< the farthest way to a touch [mm], of A [deg]
  std::optional<double> at_mm;      ///< the diameter of the blank, if it is known
  std::optional<double> flange_mm;  ///< instead of the wheel file's
  bool yes = false;                 ///< sets an offset even if it changes by much, without a question
};

/// Has the grinder run a probing cycle, and prints what it measured and the work offset that it set.
/// @param node the grinder's. @return the exit status. @throw std::invalid_argument for arguments that do not fit each
/// other. @throw JobError if the job file is refused.
int runProbe(const std::string& node, ProbingCycle cycle, const ProbeOptions& options);

}  // namespace grinder
