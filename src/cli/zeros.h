#pragma once

#include "flute_grinder/job/job_file.h"
#include "flute_grinder/machine/machine_geometry.h"

#include <ros/node_handle.h>

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind zeros`.
struct ZerosOptions {
  std::string job;
  std::string operation;  ///< operation of the job file; empty for the only one
  double stickout_mm = 0;
  std::optional<double> flange_mm;  ///< flange length instead of the wheel file's
  std::string parameters;           ///< YAML of the machine
  std::string urdf;
  bool set = false;                  ///< sets them as work offsets, by the grinder's own geometry
  std::vector<std::string> answers;  ///< answers given beforehand
  bool json = false;
};

/// The length from the flange's face to the wheel's upper face [m], as given or from the wheel file of a job's
/// operation.
/// @param operation number from 0. @throw std::invalid_argument if neither has it; FileError
double flangeOf(const JobFile& job, const std::optional<double>& flange_mm);

/// Prints the zero points of a job's X, Y and Z in machine coordinates, by the geometry of options.parameters. @return
/// the exit status.
int printZeros(const ZerosOptions& options);

/// Sets a job's zero points as the grinder's work offsets, by its own geometry, and prints them. @param node name of
/// the grinder's node. @return the exit status.
int setZeros(const std::string& node, const ZerosOptions& options);

}  // namespace grinder
