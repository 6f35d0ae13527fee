#pragma once

#include "flute_grinder/drive/robot_hw.h"
#include "flute_grinder/job/axes.h"

#include <array>

namespace grinder {

/// Base class of a drive for the grinder's four axes. It holds the state and command buffers, and registers the joints
/// axis_x, axis_y, axis_z and axis_a (kJointNames) and the handle "drive". A driver implements init(), read(), which
/// fills in the state, and write(), which sends the commands.
class AxesHW : public RobotHW {
 public:
  AxesHW(const AxesHW&) = delete;
  AxesHW& operator=(const AxesHW&) = delete;

 protected:
  /// One value per axis, in the order of kJointNames.
  using Buffer = std::array<double, kAxisCount>;

  AxesHW();

  // State, set by read().
  Buffer position_{};  ///< [m], A [rad]
  Buffer velocity_{};  ///< [m/s], A [rad/s]
  Buffer effort_{};    ///< [N], A [Nm]
  DriveStatus status_;

  // Commands, sent by write().
  Buffer command_{};  ///< positions [m], A [rad]
  DriveCommand drive_command_;

 private:
  void registerHandles();

  JointStateInterface joint_states_;
  PositionJointInterface joint_commands_;
  DriveInterface drive_;
};

}  // namespace grinder
