#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/machine/machine_geometry.h"
#include "temp_folder.h"
#include "yaml_parameters.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <random>
#include <string>

/// @file
/// The zeros of a job, against figures by hand and against the URDF's chain of joints.

namespace grinder {
namespace test_machine_geometry {

const double kDegree = std::acos(-1.0) / 180;

MachineModel machineModel() { return MachineModel(test_support::readFile("urdf/grinder.urdf")); }

/// Of config/grinder.yaml.
MachineGeometry shippedGeometry() {
  return readMachineGeometry(
      ParameterReader(test_support::toXmlRpc(YAML::LoadFile("config/grinder.yaml")), "/grinder"));
}

/// Where a link stands in the root's frame.
Eigen::Isometry3d poseOf(const MachineModel& model, const std::string& name,
                         const std::map<std::string, double>& joints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const urdf::Link* link = &model.link(name); link->parent_joint; link = link->getParent().get()) {
    const urdf::Joint& joint = *link->parent_joint;
    const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
    const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
    const auto found = joints.find(joint.name);
    const double position = found == joints.end() ? 0 : found->second;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (joint.type == urdf::Joint::PRISMATIC) {
      motion.translate(position * axis);
    } else {
      motion.rotate(Eigen::AngleAxisd(position, axis));
    }
    const urdf::Rotation& r = origin.rotation;
    pose = Eigen::Translation3d(origin.position.x, origin.position.y, origin.position.z) *
           Eigen::Quaterniond(r.w, r.x, r.y, r.z) * motion * pose;
  }
  return pose;
}

TEST(WorkZero, KnowsTheShippedMachineAsItsUrdfShowsIt) {
  const MachineModel model = machineModel();
  const MachineGeometry machine = shippedGeometry();
  const auto shapeOf = [&](const char* link, const char* name) {
    for (const auto& shape : model.link(link).visual_array) {
      if (shape->name == name) return shape;
    }
    throw std::runtime_error(name);
  };
  const auto lengthOf = [](const urdf::VisualSharedPtr& shape) {
    return dynamic_cast<const urdf::Cylinder&>(*shape->geometry).length;
  };
  const auto mouth = shapeOf("chuck", "collet_mouth");
  EXPECT_NEAR(machine.collet_face, mouth->origin.position.x - lengthOf(mouth) / 2, 1e-12);
  const auto flange = shapeOf("wheel", "flange");
  EXPECT_NEAR(machine.flange, flange->origin.position.z - lengthOf(flange) / 2, 1e-12);
  const Eigen::Vector3d axis = poseOf(model, "chuck", {}).translation();
  EXPECT_NEAR(machine.work_axis_y, axis.y(), 1e-12);
  EXPECT_NEAR(machine.work_axis_z, axis.z(), 1e-12);
}

/// Wherever work axis, collet and swivel are: what the URDF has otherwise is added.
TEST(WorkZero, PutsTheUrdfsWheelOverTheCuttersEnd) {
  const MachineModel model = machineModel();
  std::mt19937 engine(12);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); };
  for (int i = 0; i < 200; ++i) {
    MachineGeometry machine = shippedGeometry();
    machine.work_axis_y = within(-0.1, 0.1);
    machine.work_axis_z = within(-0.1, 0.1);
    machine.collet_face = within(-0.1, 0.1);
    machine.swivel_centre = {within(-0.1, 0.1), within(-0.1, 0.1), within(-0.1, 0.1)};
    machine.flange = within(-0.05, 0.05);
    GrindJob job;
    job.cutter.end_diameter = within(0.0005, 0.03);
    job.process().wheel_diameter = within(0.05, 0.2);
    job.process().wheel_wear = within(0, 0.005);
    job.process().wheel_width = within(0.0005, 0.02);
    job.process().setup_height = within(-0.01, 0.01);
    job.process().setup_swivel = within(-60, 60) * kDegree;
    const Mounting mounting{within(-0.02, 0.02), within(0.03, 0.1)};
    const Eigen::Vector3d zero = workZero(machine, job, mounting);
    const std::map<std::string, double> joints{{"axis_x", zero.x()},
                                               {"axis_y", zero.y()},
                                               {"axis_z", zero.z()},
                                               {"y_zero", machine.swivel_centre.y()},
                                               {"z_zero", machine.swivel_centre.z()},
                                               {"wheel_swivel", job.process().setup_swivel}};
    // In the URDF's wheel frame the flange's face looks down at the wheel's upper face.
    const double upper_face = machine.flange - mounting.flange_to_wheel;
    const Eigen::Vector3d wheel =
        poseOf(model, "wheel", joints) * Eigen::Vector3d(0, 0, upper_face - job.process().wheel_width / 2);
    const Eigen::Vector3d end =
        poseOf(model, "chuck", joints) * Eigen::Vector3d(machine.collet_face - mounting.stickout, 0, 0);
    const Eigen::Vector3d from_end = wheel - end;
    EXPECT_NEAR(from_end.x() + machine.swivel_centre.x(), 0, 1e-12);
    EXPECT_NEAR(from_end.y() - machine.work_axis_y, (job.cutter.end_diameter + job.process().wheel_diameter) / 2,
                1e-12);
    EXPECT_NEAR(from_end.z() - machine.work_axis_z, job.process().setup_height, 1e-12);
  }
}

}  // namespace test_machine_geometry
}  // namespace grinder
