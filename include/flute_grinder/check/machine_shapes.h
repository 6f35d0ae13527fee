#pragma once

#include "flute_grinder/check/solid.h"
#include "flute_grinder/machine/machine_model.h"

#include <Eigen/Geometry>

#include <map>
#include <string>
#include <vector>

namespace grinder {

/// A body of the machine, with X, Y and Z of the axes at zero.
struct MachinePart {
  Solid solid;
  std::string link;
  std::string carrier;      ///< nearest link up the tree with a shape, on which this part slides or turns
  Eigen::Matrix3d motion;   ///< motion of the body per motion of X, Y and Z
  bool with_wheel = false;  ///< whether it moves with the wheel, rather than with the cutter or the bed
  bool turns = false;       ///< whether it turns with the cutter
};

/// The machine's bodies: the <collision> shapes of its URDF. Bodies that turn with axis_a are replaced by the volume
/// that they sweep in a turn, so the angle of A makes no difference.
class MachineShapes {
 public:
  /// @throw std::invalid_argument naming the link, for a shape other than box, cylinder or sphere, or if wheel and
  ///        cutter are on the same side of the machine.
  explicit MachineShapes(const MachineModel& model);

  /// The bodies with the joints y_zero [m] and wheel_swivel [rad] set for a job.
  std::vector<MachinePart> parts(double y_zero, double swivel) const;

  /// A part without a body, for what a job fastens to a link. The pose of its solid is the link's pose.
  MachinePart on(const std::string& link, double y_zero, double swivel) const;

  /// The link that holds the cutter, the child of axis_a. Its origin is the centre of the small end face of a cutter
  /// without a work offset, with +X toward the shank.
  const std::string& chuck() const { return chuck_; }

 private:
  using Joints = std::map<std::string, double>;

  Eigen::Isometry3d pose(const std::string& link, const Joints& joints) const;
  bool isBelow(const std::string& link, const std::string& other) const;

  MachineModel model_;
  std::string chuck_;
  std::string wheel_side_;  ///< topmost link above the wheel that does not also carry the cutter
};

}  // namespace grinder
