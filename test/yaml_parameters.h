#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace grinder::test_support {

/// Parameters as roslaunch would load them.
inline XmlRpc::XmlRpcValue toXmlRpc(const YAML::Node& node) {
  XmlRpc::XmlRpcValue value;
  if (node.IsMap()) {
    for (const auto& item : node) value[item.first.as<std::string>()] = toXmlRpc(item.second);
    return value;
  }
  const auto text = node.as<std::string>();
  int whole;
  double number;
  if (text == "true" || text == "false") return XmlRpc::XmlRpcValue(text == "true");
  if (YAML::convert<int>::decode(node, whole)) return XmlRpc::XmlRpcValue(whole);
  if (YAML::convert<double>::decode(node, number)) return XmlRpc::XmlRpcValue(number);
  return XmlRpc::XmlRpcValue(text);
}

}  // namespace grinder::test_support
