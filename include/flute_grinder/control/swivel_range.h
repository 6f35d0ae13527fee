#pragma once

#include "flute_grinder/curve/conical_cutter.h"

#include <string>

namespace grinder {

/// The swivel that a machine allows: the limits of the joint `wheel_swivel` [rad].
/// @param urdf the robot description in XML.
/// @throw ParameterError naming what is missing or not allowed.
Range readSwivelRange(const std::string& urdf);

}  // namespace grinder
