#include "flute_grinder/control/swivel_range.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/drive/parameters.h"

#include <urdf/model.h>

#include <sstream>

namespace grinder {

Range readSwivelRange(const std::string& urdf) {
  constexpr const char* name = "wheel_swivel";
  constexpr double widest = units::kPi / 2;
  urdf::Model model;
  if (!model.initString(urdf)) throw ParameterError("robot_description is not a URDF");
  const auto joint = model.getJoint(name);
  if (!joint) throw ParameterError(std::string("robot_description has no joint ") + name);
  if (joint->type != urdf::Joint::REVOLUTE || !joint->limits) {
    throw ParameterError(std::string("robot_description: joint ") + name + " must be revolute, with limits");
  }
  const Range range{joint->limits->lower, joint->limits->upper};
  if (!(-widest < range.from && range.from < range.to && range.to < widest)) {
    std::ostringstream text;
    text << "robot_description: limits of joint " << name << ": " << range.from << " to " << range.to
         << " rad; allowed: the lower below the upper, both within -pi/2 to pi/2";
    throw ParameterError(text.str());
  }
  return range;
}

}  // namespace grinder
