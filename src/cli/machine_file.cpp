#include "flute_grinder/cli/machine_file.h"

#include "flute_grinder/cli/csv.h"
#include "flute_grinder/control/machine_config.h"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <sstream>

namespace flute_grinder {

namespace {

/// As rosparam types it: a bool, an int or a double where it reads as one, else a string.
XmlRpc::XmlRpcValue toXmlRpc(const YAML::Node& node) {
  XmlRpc::XmlRpcValue value;
  if (node.IsMap()) {
    for (const auto& item : node) value[item.first.as<std::string>()] = toXmlRpc(item.second);
    return value;
  }
  if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (std::size_t i = 0; i < node.size(); ++i) value[static_cast<int>(i)] = toXmlRpc(node[i]);
    return value;
  }
  bool flag;
  int whole;
  double number;
  if (YAML::convert<bool>::decode(node, flag)) return XmlRpc::XmlRpcValue(flag);
  if (YAML::convert<int>::decode(node, whole)) return XmlRpc::XmlRpcValue(whole);
  if (YAML::convert<double>::decode(node, number)) return XmlRpc::XmlRpcValue(number);
  return XmlRpc::XmlRpcValue(node.Scalar());
}

}  // namespace

std::string readText(const std::string& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream || !text) throw FileError(path + ": cannot be read");
  return text.str();
}

LoopConfig readMachineFiles(const std::string& parameters, const std::string& urdf) {
  YAML::Node root;
  try {
    root = YAML::Load(readText(parameters));
  } catch (const YAML::Exception& error) {
    throw FileError(parameters + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  return readMachineConfig(readText(urdf), ParameterReader(toXmlRpc(root), parameters));
}

}  // namespace flute_grinder
