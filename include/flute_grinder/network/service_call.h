#pragma once

#include <ros/serialization.h>
#include <ros/serialized_message.h>
#include <ros/service_server_link.h>
#include <ros/steady_timer.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace grinder {

/// A service call in its own thread, which can be aborted. ros::ServiceClient would wait for ever for a hanging
/// node, and another thread must not shut it down meanwhile.
class ServiceCall {
 public:
  /// Called in the call's thread. @param answer null if none came.
  using Done = std::function<void(ros::SerializedMessage* answer)>;

  /// @param name resolved name of the service.
  /// @param md5sum digest of its type.
  /// @param timeout longest wait for the answer; takes effect when abortIfOverdue() is called.
  ServiceCall(std::string name, std::string md5sum, ros::SerializedMessage request, ros::WallDuration timeout,
              Done done);
  /// Aborts the call if it is still waiting.
  ~ServiceCall();

  bool finished() const { return finished_; }
  void abortIfOverdue();
  /// Aborts the call if it is still waiting, and joins its thread.
  void end();

 private:
  void run();
  void close();

  const std::string name_, md5sum_;
  const ros::SerializedMessage request_;
  const ros::SteadyTime due_;
  const Done done_;
  std::atomic<bool> finished_{false};
  std::mutex mutex_;  ///< guards the next two members
  ros::ServiceServerLinkPtr link_;
  bool closed_ = false;
  std::thread thread_;
};

/// Deserialises an answer. @param answer as passed to Done. @return nothing if none came or it is truncated.
template <typename Service>
std::optional<typename Service::Response> responseFrom(ros::SerializedMessage* answer) {
  std::optional<typename Service::Response> response;
  try {
    if (answer) ros::serialization::deserializeMessage(*answer, response.emplace());
  } catch (const ros::serialization::StreamOverrunException&) {
    response.reset();
  }
  return response;
}

}  // namespace grinder
