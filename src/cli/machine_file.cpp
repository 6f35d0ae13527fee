#include "cli/machine_file.h"

#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/job/yaml_text.h"

#include <ros/package.h>

namespace grinder {

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

LoopConfig readMachineFiles(const std::string& parameters, const std::string& urdf) {
  const YAML::Node root = parseYaml(readTextFile(parameters), parameters);
  return readMachineConfig(readUrdfFile(urdf), ParameterReader(toXmlRpc(root), parameters));
}

std::string readUrdfFile(const std::string& path) {
  std::string text = readTextFile(path, kMaxUrdfFile);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || text[first] != '<') {
    throw JobFileError(path +
                       ": is not a URDF, which is XML and begins with '<'; the machine's YAML goes with --machine");
  }
  return text;
}

std::string packageFile(const std::string& path) {
  const std::string package = ros::package::getPath("flute_grinder");
  if (package.empty()) {
    throw JobFileError("the package flute_grinder is not found, nor its " + path +
                       "; source build/devel/setup.bash of the clone in this shell");
  }
  return package + "/" + path;
}

}  // namespace grinder
