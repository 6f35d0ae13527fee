#pragma once

#include <Eigen/Core>

#include <array>
#include <string>

namespace grinder {

/// The machine's axes, in the order used everywhere. Every value is the motion of the wheel relative to the cutter.
enum Axis : int {
  kX = 0,  ///< along the cutter's axis, from the small end toward the shank [m]
  kY = 1,  ///< radial: infeed is negative, away from the cutter is positive [m]
  kZ = 2,  ///< height [m]
  kA = 3,  ///< rotation about X, right-handed [rad]
};

constexpr int kAxisCount = 4;

/// One number per axis. Unaligned, so that messages, ring buffers and containers can hold it without special
/// allocators.
using Axes = Eigen::Array<double, kAxisCount, 1, Eigen::DontAlign>;

/// The joint names of the axes, as in the URDF.
constexpr std::array<const char*, kAxisCount> kJointNames{"axis_x", "axis_y", "axis_z", "axis_a"};

/// The name of an axis: X, Y, Z or A.
constexpr char axisLetter(int axis) { return "XYZA"[axis]; }

/// The text that refuses a request for an axis that does not exist.
inline std::string axisRefusal(int axis) {
  return "axis = " + std::to_string(axis) + "; allowed: 0 to 3 for X, Y, Z, A";
}

/// The unit of an axis position, for messages.
constexpr const char* axisUnit(int axis) { return axis == kA ? "rad" : "m"; }

}  // namespace grinder
