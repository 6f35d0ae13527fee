#pragma once

#include <urdf_model/joint.h>

#include <Eigen/Geometry>

namespace grinder {

Eigen::Vector3d toEigen(const urdf::Vector3& v);
Eigen::Isometry3d toEigen(const urdf::Pose& pose);

/// The pose of a joint's child in the frame of its parent.
/// @param joint fixed, prismatic, revolute or continuous.
/// @param position position of the joint [m or rad].
Eigen::Isometry3d childPose(const urdf::Joint& joint, double position);

}  // namespace grinder
