#pragma once

#include <urdf_model/model.h>

#include <memory>
#include <string>

namespace grinder {

/// Parses a URDF with urdfdom, and makes an error of everything that urdfdom would leave out.
/// @param name name of its file or parameter in messages.
/// @throw std::invalid_argument naming line, link or joint, element, attribute, value and what is allowed.
std::shared_ptr<const urdf::ModelInterface> parseUrdf(const std::string& urdf, const std::string& name);

}  // namespace grinder
