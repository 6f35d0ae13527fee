#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace grinder {

/// Whether a ROS master answers.
enum class Master { kAnswers, kMissing };

/// Checks once a second whether the ROS master answers, and registers the whole process again with a master that does
/// not know it: its services, and every topic that it publishes or subscribes to. Connections between nodes survive
/// their master, but under a new master an unregistered node neither is found nor finds others. The old master's
/// parameters are not restored.
///
/// Uses its own thread and connections, with bounded waits: a master that hangs counts as missing.
class MasterWatch {
 public:
  /// To be created after ros::start() and destroyed before ros::shutdown().
  /// @param services resolved names of the process' services, without the services of every roscpp node. Services not
  ///        advertised at the time are skipped.
  explicit MasterWatch(std::vector<std::string> services = {});
  ~MasterWatch();

  /// The result of the last check, at most a few seconds ago. Thread safe; never blocks.
  Master master() const noexcept { return master_; }

 private:
  using Value = XmlRpc::XmlRpcValue;
  using Uris = std::set<std::string>;

  void run();
  void checkMaster();
  bool registerAgain();
  bool registerPublications();
  bool registerServices();
  bool registerSubscriptions();
  bool registerSubscription(const std::string& topic, const std::string& type, const Uris& connected);
  std::map<std::string, Uris> connectedPublishers();
  std::optional<Value> callMaster(const char* method, const std::vector<Value>& arguments = {});
  std::optional<Value> callSelf(const char* method, const std::vector<Value>& arguments = {});

  std::vector<std::string> services_;
  std::atomic<Master> master_{Master::kAnswers};
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;  ///< used only with stop_
  std::condition_variable stop_;
  std::thread thread_;
};

}  // namespace grinder
