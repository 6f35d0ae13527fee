#pragma once

#include "flute_grinder/machine/machine_geometry.h"

#include <ros/node_handle.h>

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind zeros`.
struct ZerosOptions {
  std::string job;
  std::string operation;  ///< of the job file; empty for the only one
  double stickout_mm = 0;
  std::optional<double> flange_mm;  ///< instead of the wheel file's
  std::string parameters;           ///< YAML of the machine
  std::string urdf;
  bool set = false;  ///< by the grinder's own geometry, as its work offsets
  bool yes = false;  ///< sets them even if they change by much, without a question
  bool json = false;
};

/// From the flange's face to the wheel's upper face [m]: as given, or as the wheel file of an operation of a job says.
/// @param operation from 0. @throw std::invalid_argument if neither does; JobFileError
double flangeOf(const std::string& job, int operation, const std::optional<double>& flange_mm);

/// Prints where a job's X, Y and Z are zero in machine coordinates, by the geometry of options.parameters. @return the
/// exit status.
int printZeros(const ZerosOptions& options);

/// Sets them as the grinder's work offsets, by its own geometry, and prints them. @param node the grinder's. @return
/// the exit status.
int setZeros(const std::string& node, const ZerosOptions& options);

}  // namespace grinder
