#include "node/node_parameters.h"

#include "flute_grinder/motion/work_offsets.h"

namespace flute_grinder {

namespace {

constexpr double kMaxHistory = 1e12;  ///< [bytes]

/// A kept file; if the parameter is a folder, the file in it named after the node.
std::string filePath(const std::string& parameter, const std::string& node, const char* suffix) {
  return parameter.back() == '/' ? parameter + node.substr(1) + suffix : parameter;
}

}  // namespace

NodeParameters readNodeParameters(const ParameterReader& parameters, const std::string& node) {
  NodeParameters own;
  own.journal = filePath(parameters.text("journal"), node, ".journal");
  own.offsets = filePath(parameters.text("offsets"), node, ".offsets");
  own.history = filePath(parameters.text("history"), node, "/");
  own.history_limit = static_cast<std::uint64_t>(parameters.number("history_limit", 0, kMaxHistory));
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    own.offset_change_limit[axis] = parameters.number("offset_change_limit/" + joint, 0, 2 * kMaxOffset);
  }
  own.thresholds = readDiagnosticThresholds(parameters);
  own.drive = parameters.text("hardware/type");
  return own;
}

}  // namespace flute_grinder
