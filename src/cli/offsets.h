#pragma once

#include "flute_grinder/motion/work_offsets.h"

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The axes' letters on the command line.
constexpr const char* kAxisLetters = "xyza";

/// Arguments of `grind offsets`.
struct OffsetsOptions {
  std::vector<std::string> set;      ///< AXIS=VALUE, in mm or deg
  std::string job;                   ///< job file for which the offsets are set
  std::string operation;             ///< operation of that job file; empty for the only one
  std::vector<std::string> answers;  ///< answers given beforehand
  bool json = false;
};

/// Arguments of `grind touch-off`.
struct TouchOffOptions {
  std::string axis;                  ///< a letter of kAxisLetters
  std::optional<double> at;          ///< for Y, diameter of the blank touched; else the work position [mm or deg]
  std::string job;                   ///< job file for which the offset is set
  std::string operation;             ///< operation of the job file; empty for the only one
  std::vector<std::string> answers;  ///< answers given beforehand
};

/// Arguments of `grind confirm-wheel`.
struct ConfirmWheelOptions {
  std::string job;        ///< job file whose wheel is confirmed
  std::string operation;  ///< operation of the job file; empty for the only one
  bool again = false;     ///< the wheel was taken off and mounted anew
};

/// Confirms which wheel is on the spindle. @param node name of the grinder's node. @return the exit status.
/// @throw JobError if the job file is refused.
int confirmWheel(const std::string& node, const ConfirmWheelOptions& options);

/// Reports that a tool was clamped. @param node name of the grinder's node. @return the exit status.
int sayReclamped(const std::string& node);

/// Sets work offsets, all of them or none, in the name of this command's user, and asks for the answers that they need.
/// @param nh the grinder's namespace.
/// @param basis job and wheel for which they are set. @param answers answers given beforehand.
/// @return the exit status.
int setWorkOffsets(ros::NodeHandle& nh, const OffsetValues& values, const OffsetBasis& basis,
                   const std::vector<std::string>& answers);

/// Why `grind offsets --set` cannot take an argument; empty if it can.
std::string offsetRefusal(const std::string& argument);

/// Sets work offsets as asked, and prints all. @param node name of the grinder's node. @return the exit status. @throw
/// std::invalid_argument for contradictory arguments. @throw JobError if a job file is refused.
int runOffsets(const std::string& node, const OffsetsOptions& options);

/// Sets the work offset of an axis from its present position. @param node name of the grinder's node. @return the exit
/// status. @throw std::invalid_argument for contradictory arguments. @throw JobError if the job file is refused.
int runTouchOff(const std::string& node, const TouchOffOptions& options);

}  // namespace grinder
