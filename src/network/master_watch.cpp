#include "flute_grinder/network/master_watch.h"

#include "flute_grinder/network/ros_api.h"

#include <ros/connection_manager.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/service_manager.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace grinder {

namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::seconds kInterval(1);
constexpr int kAttempts = 5;  ///< attempts at a list of publishers that keeps growing

XmlRpcValue listOf(const std::vector<XmlRpcValue>& values) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) list[static_cast<int>(i)] = values[i];
  return list;
}

/// The strings in a list; other members are skipped.
std::vector<std::string> texts(XmlRpcValue& list) {
  std::vector<std::string> found;
  if (list.getType() != XmlRpcValue::TypeArray) return found;
  for (int i = 0; i < list.size(); ++i) {
    if (list[i].getType() == XmlRpcValue::TypeString) found.push_back(list[i]);
  }
  return found;
}

/// The [topic, type] pairs in a list.
std::vector<std::pair<std::string, std::string>> topics(XmlRpcValue list) {
  std::vector<std::pair<std::string, std::string>> found;
  for (int i = 0; list.getType() == XmlRpcValue::TypeArray && i < list.size(); ++i) {
    const std::vector<std::string> topic = texts(list[i]);
    if (topic.size() == 2) found.emplace_back(topic[0], topic[1]);
  }
  return found;
}

std::string ownUri() { return ros::XMLRPCManager::instance()->getServerURI(); }

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services) : services_(std::move(services)) {
  // The services of every roscpp node.
  for (const char* service : {"/get_loggers", "/set_logger_level"}) {
    services_.push_back(ros::this_node::getName() + service);
  }
  thread_ = std::thread([this] { run(); });
}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_one();
  thread_.join();
}

void MasterWatch::run() {
  while (!stopping_ && ros::ok()) {
    checkMaster();
    std::unique_lock<std::mutex> lock(mutex_);
    stop_.wait_for(lock, kInterval, [this] { return stopping_.load(); });
  }
}

void MasterWatch::checkMaster() {
  const bool answers = callMaster("getPid").has_value();
  if (stopping_ || !ros::ok()) return;
  if (!answers) {
    if (master_.exchange(Master::kMissing) == Master::kAnswers) {
      ROS_WARN_THROTTLE(10, "no ROS master answers at %s", ros::master::getURI().c_str());
    }
    return;
  }
  if (!callMaster("lookupService", {services_.back()})) {
    if (!registerAgain()) return;
    ROS_WARN_THROTTLE(10, "registered again with the ROS master at %s", ros::master::getURI().c_str());
  }
  master_ = Master::kAnswers;
}

bool MasterWatch::registerAgain() {
  // Topics first, because other nodes wait for them. checkMaster() looks for the last service: if it is there, all the
  // rest is too.
  return registerPublications() && registerSubscriptions() && registerServices();
}

bool MasterWatch::registerPublications() {
  const auto publications = callSelf("getPublications");
  if (!publications) return false;
  for (const auto& [topic, type] : topics(*publications)) {
    if (!callMaster("registerPublisher", {topic, type, ownUri()})) return false;
  }
  return true;
}

bool MasterWatch::registerServices() {
  const std::string uri =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services_) {
    if (!ros::ServiceManager::instance()->lookupServicePublication(service)) continue;
    if (!callMaster("registerService", {service, uri, ownUri()})) return false;
  }
  return true;
}

bool MasterWatch::registerSubscriptions() {
  const auto subscriptions = callSelf("getSubscriptions");
  if (!subscriptions) return false;
  const auto connected = connectedPublishers();
  for (const auto& [topic, type] : topics(*subscriptions)) {
    const auto publishers = connected.find(topic);
    if (!registerSubscription(topic, type, publishers == connected.end() ? Uris() : publishers->second)) return false;
  }
  return true;
}

bool MasterWatch::registerSubscription(const std::string& topic, const std::string& type, const Uris& connected) {
  // Keep connections to publishers that the new master does not know yet. From now on the master reports new publishers
  // by itself, but its list passed on here overrides any report that arrived meanwhile; so repeat while the list grows.
  Uris known = connected;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    auto publishers = callMaster("registerSubscriber", {topic, type, ownUri()});
    if (!publishers) return false;
    const std::size_t before = known.size();
    for (const std::string& uri : texts(*publishers)) known.insert(uri);
    if (known.size() == before) return true;
    if (!callSelf("publisherUpdate", {topic, listOf({known.begin(), known.end()})})) return false;
  }
  return true;
}

std::map<std::string, MasterWatch::Uris> MasterWatch::connectedPublishers() {
  std::map<std::string, Uris> found;
  auto connections = callSelf("getBusInfo");
  if (!connections || connections->getType() != XmlRpcValue::TypeArray) return found;
  for (int i = 0; i < connections->size(); ++i) {
    // [number, publisher, "i", transport, topic, ...]; a connection to a subscriber has "o".
    const std::vector<std::string> connection = texts((*connections)[i]);
    if (connection.size() >= 4 && connection[1] == "i") found[connection[3]].insert(connection[0]);
  }
  return found;
}

std::optional<XmlRpcValue> MasterWatch::callMaster(const char* method, const std::vector<Value>& arguments) {
  return callRosApi(ros::master::getHost(), ros::master::getPort(), method, arguments, stopping_);
}

std::optional<XmlRpcValue> MasterWatch::callSelf(const char* method, const std::vector<Value>& arguments) {
  return callRosApi(ros::network::getHost(), ros::XMLRPCManager::instance()->getServerPort(), method, arguments,
                    stopping_);
}

}  // namespace grinder
