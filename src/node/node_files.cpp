#include "node/node_files.h"

namespace grinder {

namespace {

/// The path of a state file; if the parameter is a folder, of the file in it that is named after the node.
std::string filePath(const std::string& parameter, const std::string& node, const char* suffix) {
  return parameter.back() == '/' ? parameter + node.substr(1) + suffix : parameter;
}

}  // namespace

NodeFiles readNodeFiles(const ParameterReader& parameters, const std::string& node) {
  return {filePath(parameters.path("journal"), node, ".journal"),
          filePath(parameters.path("offsets"), node, ".offsets"), filePath(parameters.path("history"), node, "/"),
          parameters.path("tolerances")};
}

}  // namespace grinder
