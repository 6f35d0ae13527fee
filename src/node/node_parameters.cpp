#include "node/node_parameters.h"

#include "flute_grinder/motion/work_offsets.h"

namespace grinder {

namespace {

constexpr double kMaxHistory = 1e12;  ///< [bytes]

/// An atomic file; if the parameter is a folder, the file in it named after the node.
std::string filePath(const std::string& parameter, const std::string& node, const char* suffix) {
  return parameter.back() == '/' ? parameter + node.substr(1) + suffix : parameter;
}

FirstView readFirstView(const ParameterReader& p) {
  FirstView view;
  view.wheel_diameter = p.number("first_view/wheel_diameter", 1e-3, 0.5);
  view.wheel_width = p.number("first_view/wheel_width", 1e-4, 0.1);
  view.blank_diameter = p.number("first_view/blank_diameter", 1e-4, 0.2);
  view.blank_length = p.number("first_view/blank_length", 1e-4, 1);
  return view;
}

}  // namespace

NodeParameters readNodeParameters(const ParameterReader& parameters, const std::string& node,
                                  const std::string& drives) {
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
  own.first_view = readFirstView(parameters);
  own.drive = parameters.text("hardware/type", drives);
  return own;
}

}  // namespace grinder
