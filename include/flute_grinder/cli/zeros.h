#pragma once

#include <optional>
#include <string>

namespace flute_grinder {

/// Arguments of `grind zeros`.
struct ZerosOptions {
  std::string job;
  double stickout_mm = 0;
  std::optional<double> flange_mm;  ///< instead of the wheel file's
  std::string parameters;           ///< YAML of the machine
  std::string urdf;
  bool json = false;
};

/// From the flange's face to the wheel's upper face [m]: as given, or as the wheel file of a job says.
/// @throw std::invalid_argument if neither does; JobFileError
double flangeOf(const std::string& job, const std::optional<double>& flange_mm);

/// Prints where a job's X, Y and Z are zero in machine coordinates, by the machine's geometry. @return the exit status.
int printZeros(const ZerosOptions& options);

}  // namespace flute_grinder
