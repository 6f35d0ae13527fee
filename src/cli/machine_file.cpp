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

MachineFiles readMachineFiles(const std::string& parameters, const std::string& urdf) {
  const YAML::Node root = parseYaml(readTextFile(parameters), parameters);
  const MachineModel model(readTextFile(urdf, kMaxUrdfFile), urdf);
  return {model, readMachineConfig(model, ParameterReader(toXmlRpc(root), parameters))};
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
