#include "flute_grinder/network/ros_api.h"

#include "flute_grinder/base/await.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpc.h>

#include <chrono>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::seconds kTimeout(1), kParameterTimeout(10);
constexpr std::chrono::milliseconds kSlice(20);  ///< time between looks at `stop`

struct Answer {
  bool success;
  XmlRpcValue value;
};

/// What a ROS API response [code, text, value] says; nothing if it is malformed.
std::optional<Answer> answerOf(XmlRpcValue& response) {
  const bool complete = response.getType() == XmlRpcValue::TypeArray && response.size() == 3;
  if (!complete || response[0].getType() != XmlRpcValue::TypeInt) return std::nullopt;
  return Answer{static_cast<int>(response[0]) == 1, response[2]};
}

std::optional<Answer> call(const std::string& host, unsigned port, const char* method,
                           const std::vector<XmlRpcValue>& arguments, std::chrono::seconds timeout,
                           const std::atomic<bool>& stop) {
  XmlRpcValue all;
  all[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i) all[static_cast<int>(i) + 1] = arguments[i];
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.executeNonBlock(method, all)) return std::nullopt;
  XmlRpc::XmlRpcDispatch dispatch;
  dispatch.addSource(&client, XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
  XmlRpcValue response;
  bool done = false;
  const auto ended = [&] {
    done = client.executeCheckDone(response);
    return done || stop || client.getfd() < 0;
  };
  await(timeout, kSlice, ended, [&](std::chrono::duration<double> time) { dispatch.work(time.count()); });
  return done ? answerOf(response) : std::nullopt;
}

}  // namespace

std::optional<XmlRpcValue> callRosApi(const std::string& host, unsigned port, const char* method,
                                      const std::vector<XmlRpcValue>& arguments, const std::atomic<bool>& stop) {
  auto answer = call(host, port, method, arguments, kTimeout, stop);
  if (!answer || !answer->success) return std::nullopt;
  return std::move(answer->value);
}

std::optional<XmlRpcValue> readParameter(const std::string& name, const std::atomic<bool>& stop) {
  auto answer = call(ros::master::getHost(), ros::master::getPort(), "getParam", {name}, kParameterTimeout, stop);
  if (!answer) throw std::runtime_error("the ROS master at " + ros::master::getURI() + " does not answer");
  if (!answer->success) return std::nullopt;
  return std::move(answer->value);
}

}  // namespace grinder
