#include "flute_grinder/check/joint_pose.h"

namespace grinder {

namespace {

/// The motion of a joint's child in the joint's frame.
Eigen::Isometry3d motionOf(const urdf::Joint& joint, double position) {
  const Eigen::Vector3d axis = toEigen(joint.axis).normalized();
  switch (joint.type) {
    case urdf::Joint::FIXED: return Eigen::Isometry3d::Identity();
    case urdf::Joint::PRISMATIC: return Eigen::Isometry3d(Eigen::Translation3d(position * axis));
    default: return Eigen::Isometry3d(Eigen::AngleAxisd(position, axis));
  }
}

}  // namespace

Eigen::Vector3d toEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return Eigen::Translation3d(toEigen(pose.position)) * Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized();
}

Eigen::Isometry3d childPose(const urdf::Joint& joint, double position) {
  return toEigen(joint.parent_to_joint_origin_transform) * motionOf(joint, position);
}

}  // namespace grinder
