#include "flute_grinder/network/ros_api.h"

#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpc.h>

#include <chrono>

namespace grinder {

namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::seconds kTimeout(1);
constexpr double kSlice = 0.02;  ///< time between looks at `stop` [s]

/// The value of a ROS API response [1, text, value]; nothing if it is malformed or reports an error.
std::optional<XmlRpcValue> valueOf(XmlRpcValue& answer) {
  const bool complete = answer.getType() == XmlRpcValue::TypeArray && answer.size() == 3;
  if (!complete || answer[0].getType() != XmlRpcValue::TypeInt || static_cast<int>(answer[0]) != 1) return std::nullopt;
  return answer[2];
}

}  // namespace

std::optional<XmlRpcValue> callRosApi(const std::string& host, unsigned port, const char* method,
                                      const std::vector<XmlRpcValue>& arguments, const std::atomic<bool>& stop) {
  XmlRpcValue all;
  all[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i) all[static_cast<int>(i) + 1] = arguments[i];
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.executeNonBlock(method, all)) return std::nullopt;
  XmlRpc::XmlRpcDispatch dispatch;
  dispatch.addSource(&client, XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
  const auto due = std::chrono::steady_clock::now() + kTimeout;
  while (!stop && client.getfd() >= 0 && std::chrono::steady_clock::now() < due) {
    dispatch.work(kSlice);
    XmlRpcValue answer;
    if (client.executeCheckDone(answer)) return valueOf(answer);
  }
  return std::nullopt;
}

}  // namespace grinder
