#pragma once

#include "flute_grinder/PlanReport.h"
#include "flute_grinder/curve/odd_even_interpolator.h"

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind table`.
struct TableOptions {
  std::string job;
  double step_length_mm = 0;
  std::optional<EvenStepRule> even_step;  ///< rule instead of the job's
  std::string csv;                        ///< file, or empty
  bool json = false;
};

/// Arguments of `grind plan`.
struct PlanOptions {
  std::string job;
  std::string operation;   ///< one of several operations; empty for the only one
  std::string csv;         ///< file, or empty
  std::string parameters;  ///< YAML of the machine
  std::string urdf;
  bool json = false;
};

/// Interpolates a job's curve with a fixed step length, as the paper's Table 1. @return the exit status.
int runTable(const TableOptions& options);

/// Plans and checks a whole job without a machine, from the park position. @return the exit status.
int runPlan(const PlanOptions& options);

/// Prints, in the operator's units, a job's statistics, the tool's figures beside those asked for, the range of X in
/// which the flutes are complete, the two bodies that come closest to each other, the cut of the first pass into the
/// shank, and what each pass of a tooth removes. Unknown and empty values are left out.
void printPlan(const flute_grinder::PlanReport& plan);

}  // namespace grinder
