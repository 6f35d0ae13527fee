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

namespace flute_grinder {

/// Whether a ROS master answers.
enum class Master { kAnswers, kMissing };

/// Looks once a second whether the ROS master answers, and registers this whole process with one that does not know it:
/// every topic that it publishes or subscribes to, whoever in the process does, and its services. Connections between
/// nodes outlive their master; with a new one a node would be found by nobody, and find nobody, until it is started
/// anew. What the old master's parameter server held does not come back.
///
/// All in a thread of its own, by connections of its own, with bounded waits: a master that hangs is missing.
class MasterWatch {
 public:
  /// To be made when ROS is up, and to go before ros::shutdown().
  /// @param services resolved names of the process' services, beside those that every node of roscpp has. One that is
  ///        not offered at the time is passed over.
  explicit MasterWatch(std::vector<std::string> services = {});
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;
  ~MasterWatch();

  /// As of the last look, at most some seconds ago. For any thread; never waits.
  Master master() const noexcept { return master_; }

 private:
  using Value = XmlRpc::XmlRpcValue;
  using Uris = std::set<std::string>;

  void run();
  void look();
  bool registerAnew();
  bool registerPublications();
  bool registerServices();
  bool registerSubscriptions();
  bool registerSubscription(const std::string& topic, const std::string& type, const Uris& connected);
  std::map<std::string, Uris> connectedPublishers();
  std::optional<Value> ask(const std::string& host, unsigned port, const char* method,
                           const std::vector<Value>& arguments);
  std::optional<Value> askMaster(const char* method, const std::vector<Value>& arguments = {});
  std::optional<Value> askSelf(const char* method, const std::vector<Value>& arguments = {});

  std::vector<std::string> services_;
  std::atomic<Master> master_{Master::kAnswers};
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;  ///< for the wait alone
  std::condition_variable stop_;
  std::thread thread_;
};

}  // namespace flute_grinder
