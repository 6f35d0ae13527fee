#pragma once

#include <optional>
#include <string>

namespace flute_grinder {

/// Arguments of `grind probe`.
struct ProbeOptions {
  std::string job;
  double within_mm = 5;             ///< the farthest that X or Y moves
  double within_deg = 90;           ///< the farthest that A turns
  std::optional<double> at_mm;      ///< the diameter of the blank, if it is known
  std::optional<double> flange_mm;  ///< instead of the wheel file's
};

/// Probes the cutter's end face with X, prints the stick-out, and sets the work offset of X. @return the exit status.
int probeEndFace(const std::string& node, const ProbeOptions& options);

/// Probes a cylinder with Y on four sides, and prints its diameter and run-out. With options.at_mm, sets the work
/// offset of Y so that the diameter is the known one. @return the exit status.
int probeDiameter(const std::string& node, const ProbeOptions& options);

/// Probes the first tooth's rake face with A, and sets the work offset of A. @return the exit status.
int probeTooth(const std::string& node, const ProbeOptions& options);

}  // namespace flute_grinder
