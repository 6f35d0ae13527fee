#include "flute_grinder/check/machine_shapes.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/check/joint_pose.h"

#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

constexpr const char* kYZero = "y_zero";
constexpr const char* kSwivel = "wheel_swivel";
constexpr const char* kWheel = "wheel";

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("robot_description: " + what); }

std::string nameOf(const urdf::Collision& shape, const urdf::Link& link) {
  return shape.name.empty() ? link.name : shape.name;
}

Solid toSolid(const urdf::Collision& shape, const urdf::Link& link) {
  const std::string what = "link " + link.name + ", <collision> " + nameOf(shape, link) + ": ";
  const auto positive = [&](double size, const char* name) {
    if (!(size > 0 && std::isfinite(size))) refuse(what + format("%s = %g m; allowed: positive", name, size));
    return size;
  };
  Solid solid;
  if (const auto* box = dynamic_cast<const urdf::Box*>(shape.geometry.get())) {
    for (const double side : {box->dim.x, box->dim.y, box->dim.z}) positive(side, "size");
    solid = Solid::box(toEigen(box->dim));
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(shape.geometry.get())) {
    solid = Solid::cylinder(positive(cylinder->radius, "radius"), positive(cylinder->length, "length"));
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(shape.geometry.get())) {
    solid = Solid::sphere(positive(sphere->radius, "radius"));
  } else {
    refuse(what + "no box, cylinder or sphere; allowed: these");
  }
  solid.name = nameOf(shape, link);
  solid.pose = toEigen(shape.origin);
  return solid;
}

}  // namespace

MachineShapes::MachineShapes(const MachineModel& model)
    : model_(model), chuck_(model.joint(kJointNames[kA]).child_link_name) {
  if (isBelow(kWheel, chuck_)) refuse("link wheel turns with axis_a");
  for (const urdf::Link* at = &model_.link(kWheel); at && !isBelow(chuck_, at->name); at = at->getParent().get()) {
    wheel_side_ = at->name;
  }
  if (wheel_side_.empty()) refuse("joint axis_a moves with link wheel");
  parts(0, 0);
}

std::vector<MachinePart> MachineShapes::parts(double y_zero, double swivel) const {
  const Eigen::Isometry3d turning = pose(chuck_, {{kYZero, y_zero}, {kSwivel, swivel}});
  const urdf::Joint& axis_a = model_.joint(kJointNames[kA]);
  const Eigen::Isometry3d axis =
      turning * Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), toEigen(axis_a.axis));
  std::vector<MachinePart> parts;
  for (const auto& [name, link] : model_.urdf().links_) {
    for (const urdf::CollisionSharedPtr& shape : link->collision_array) {
      MachinePart part = on(name, y_zero, swivel);
      const Eigen::Isometry3d link_pose = part.solid.pose;
      part.solid = toSolid(*shape, *link);
      part.solid.pose = link_pose * part.solid.pose;
      if (part.turns) part.solid = part.solid.swept(axis);
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

MachinePart MachineShapes::on(const std::string& name, double y_zero, double swivel) const {
  Joints joints{{kYZero, y_zero}, {kSwivel, swivel}};
  MachinePart part;
  part.link = name;
  part.with_wheel = isBelow(name, wheel_side_);
  part.turns = isBelow(name, chuck_);
  part.solid.pose = pose(name, joints);
  for (int axis = kX; axis <= kZ; ++axis) {
    joints[kJointNames[static_cast<std::size_t>(axis)]] = 1;
    part.motion.col(axis) = pose(name, joints).translation() - part.solid.pose.translation();
    joints[kJointNames[static_cast<std::size_t>(axis)]] = 0;
  }
  const urdf::Link* carrier = model_.link(name).getParent().get();
  while (carrier && carrier->collision_array.empty()) carrier = carrier->getParent().get();
  if (carrier) part.carrier = carrier->name;
  return part;
}

Eigen::Isometry3d MachineShapes::pose(const std::string& name, const Joints& joints) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const urdf::Link* at = &model_.link(name); at->parent_joint; at = at->getParent().get()) {
    const urdf::Joint& joint = *at->parent_joint;
    const auto position = joints.find(joint.name);
    pose = childPose(joint, position == joints.end() ? 0 : position->second) * pose;
  }
  return pose;
}

bool MachineShapes::isBelow(const std::string& name, const std::string& other) const {
  for (const urdf::Link* at = &model_.link(name); at; at = at->getParent().get()) {
    if (at->name == other) return true;
  }
  return false;
}

}  // namespace grinder
