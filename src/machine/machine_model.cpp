#include "flute_grinder/machine/machine_model.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "machine/strict_urdf.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace grinder {

namespace {

constexpr const char* kSwivel = "wheel_swivel";
constexpr double kWidestSwivel = units::kPi / 2;

using Type = decltype(urdf::Joint::type);

struct RequiredJoint {
  const char* name;
  Type type;
  const char* what;
};

constexpr RequiredJoint kJoints[] = {
    {kJointNames[kX], urdf::Joint::PRISMATIC, "prismatic"},
    {kJointNames[kY], urdf::Joint::PRISMATIC, "prismatic"},
    {kJointNames[kZ], urdf::Joint::PRISMATIC, "prismatic"},
    {kJointNames[kA], urdf::Joint::REVOLUTE, "revolute, with limits over several turns"},
    {"y_zero", urdf::Joint::PRISMATIC, "prismatic"},
    {"z_zero", urdf::Joint::PRISMATIC, "prismatic"},
    {kSwivel, urdf::Joint::REVOLUTE, "revolute, with limits"},
};

/// Frames that the node itself publishes.
constexpr const char* kTakenLinks[] = {"work", "cutter", "contact"};

}  // namespace

MachineModel::MachineModel(const std::string& urdf, const std::string& name) : urdf_(parseUrdf(urdf, name)) {
  const auto refuse = [&](const std::string& what) { throw std::invalid_argument(name + ": " + what); };
  for (const RequiredJoint& required : kJoints) {
    const auto joint = urdf_->getJoint(required.name);
    if (!joint) refuse(std::string("no joint ") + required.name);
    if (joint->type != required.type) refuse(std::string("joint ") + required.name + " must be " + required.what);
  }
  for (const auto& [joint_name, joint] : urdf_->joints_) {
    if (joint->type == urdf::Joint::FLOATING || joint->type == urdf::Joint::PLANAR) {
      refuse("joint " + joint_name + " is floating or planar; allowed: fixed, prismatic, revolute, continuous");
    }
  }
  if (!urdf_->getLink("wheel")) refuse("no link wheel");
  for (const char* taken : kTakenLinks) {
    if (!urdf_->getLink(taken)) continue;
    refuse(std::string("link ") + taken + "; allowed: another name, since the node itself publishes the frame " +
           taken);
  }
  const Range range = swivel();
  if (-kWidestSwivel < range.from && range.from < range.to && range.to < kWidestSwivel) return;
  refuse(format("limits of joint %s: %g to %g rad; allowed: the lower below the upper, both within -pi/2 to pi/2",
                kSwivel, range.from, range.to));
}

Range MachineModel::swivel() const {
  const urdf::JointLimits& limits = *joint(kSwivel).limits;
  return {limits.lower, limits.upper};
}

}  // namespace grinder
