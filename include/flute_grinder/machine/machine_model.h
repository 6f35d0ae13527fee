#pragma once

#include "flute_grinder/curve/conical_cutter.h"

#include <urdf_model/model.h>

#include <memory>
#include <string>

namespace grinder {

/// The machine as its URDF (`robot_description`) describes it, with the joints and links that urdf/grinder.urdf has.
class MachineModel {
 public:
  /// Refuses a URDF that would be read only in part: every element and attribute must be known, every number valid.
  /// @param urdf the robot description in XML.
  /// @param name name of its file or parameter in messages.
  /// @throw std::invalid_argument naming line, link or joint, element, value and what is allowed.
  explicit MachineModel(const std::string& urdf, const std::string& name = "robot_description");

  const urdf::ModelInterface& urdf() const { return *urdf_; }
  /// @param name name of an existing link.
  const urdf::Link& link(const std::string& name) const { return *urdf_->getLink(name); }
  /// @param name name of an existing joint: axis_x, axis_y, axis_z, axis_a, y_zero, z_zero, wheel_swivel.
  const urdf::Joint& joint(const std::string& name) const { return *urdf_->getJoint(name); }

  /// The swivel that the machine allows: the limits of the joint wheel_swivel [rad].
  Range swivel() const;

 private:
  std::shared_ptr<const urdf::ModelInterface> urdf_;
};

}  // namespace grinder
