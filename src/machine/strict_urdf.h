#pragma once

#include <urdf_model/model.h>

#include <memory>
#include <string>

namespace grinder {

/// Parses a URDF by urdfdom, which leaves out what it cannot read: here that is an error.
/// @param name of its file or parameter, in messages.
/// @throw std::invalid_argument naming line, link or joint, element, attribute, value and what is allowed.
std::shared_ptr<const urdf::ModelInterface> parseUrdf(const std::string& urdf, const std::string& name);

}  // namespace grinder
