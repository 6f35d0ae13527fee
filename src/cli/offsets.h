#pragma once

#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/motion/work_offsets.h"

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// On the command line.
constexpr const char* kAxisLetters = "xyza";

/// Arguments of `grind offsets`.
struct OffsetsOptions {
  std::vector<std::string> set;  ///< AXIS=VALUE, in mm or deg
  std::string job;               ///< job file, for which they are set
  std::string fit;               ///< job file, to which those that can be computed are fitted
  std::string operation;         ///< of either; empty for the only one
  bool yes = false;              ///< sets them even if they change by much, without a question
  bool json = false;
};

/// Arguments of `grind touch-off`.
struct TouchOffOptions {
  std::string axis;          ///< a letter of kAxisLetters
  std::optional<double> at;  ///< of Y, diameter of the blank that the wheel touches; else the work position [mm or deg]
  std::string job;           ///< job file, for which the offset is set
  std::string operation;     ///< of that; empty for the only one
  bool yes = false;          ///< sets it even if it changes by much, without a question
};

/// Arguments of `grind confirm-wheel`.
struct ConfirmWheelOptions {
  std::string job;        ///< job file, whose wheel it is
  std::string operation;  ///< of that; empty for the only one
  bool again = false;     ///< it was taken off and mounted anew
};

/// Confirms which wheel is on the spindle. @param node the grinder's. @return the exit status.
/// @throw JobError if the job file is refused.
int confirmWheel(const std::string& node, const ConfirmWheelOptions& options);

/// Says that a tool was clamped. @param node the grinder's. @return the exit status.
int sayReclamped(const std::string& node);

/// Sets a work offset in the name of who runs this command. A change beyond the parameter offset_change_limit is
/// confirmed at the terminal; without one it is refused.
/// @param nh the grinder's namespace.
/// @param value [m], A [rad]. @param basis what it is set for.
/// @param large_change_ok it may change by any amount, and nobody is asked. @return the exit status.
int setWorkOffset(ros::NodeHandle& nh, int axis, double value, const OffsetBasis& basis, bool large_change_ok);

/// The work offsets; nothing if the grinder does not publish them in time.
std::optional<flute_grinder::WorkOffsets> workOffsets(ros::NodeHandle& nh);

/// Why `grind offsets --set` cannot take an argument; empty if it can.
std::string offsetRefusal(const std::string& argument);

/// Sets work offsets as asked, and prints all. @param node the grinder's. @return the exit status; 1 if some do not fit
/// the job of options.fit, after it has printed why. @throw std::invalid_argument for arguments that do not fit each
/// other. @throw JobError if a job file is refused.
int runOffsets(const std::string& node, const OffsetsOptions& options);

/// Sets the work offset of an axis from where it stands. @param node the grinder's. @return the exit status.
/// @throw std::invalid_argument for arguments that do not fit each other. @throw JobError if the job file is refused.
int runTouchOff(const std::string& node, const TouchOffOptions& options);

}  // namespace grinder
