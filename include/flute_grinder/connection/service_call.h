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

namespace flute_grinder {

/// A service call in a thread of its own, which can be broken off. ros::ServiceClient waits for ever for a node that
/// hangs, and must not be shut down by another thread while it does.
class ServiceCall {
 public:
  /// Called in the thread of the call. @param answer null where none came.
  using Done = std::function<void(ros::SerializedMessage* answer)>;

  /// @param name resolved name of the service.
  /// @param md5sum of its type.
  /// @param timeout how long the answer is waited for, if breakOffWhenDue() is called now and then.
  ServiceCall(std::string name, std::string md5sum, ros::SerializedMessage request, ros::WallDuration timeout,
              Done done);
  ServiceCall(const ServiceCall&) = delete;
  ServiceCall& operator=(const ServiceCall&) = delete;
  /// Breaks the call off if it still waits.
  ~ServiceCall();

  bool finished() const { return finished_; }
  void breakOffWhenDue();
  /// Breaks it off if it still waits, and waits for the end of its thread.
  void end();

 private:
  void run();
  void breakOff();

  const std::string name_, md5sum_;
  const ros::SerializedMessage request_;
  const ros::SteadyTime due_;
  const Done done_;
  std::atomic<bool> finished_{false};
  std::mutex mutex_;  ///< guards the next two
  ros::ServiceServerLinkPtr link_;
  bool broken_off_ = false;
  std::thread thread_;
};

/// What a call has brought. @param answer as Done is given it. @return nothing where none came, or one that is cut off.
template <typename Service>
std::optional<typename Service::Response> answerOf(ros::SerializedMessage* answer) {
  std::optional<typename Service::Response> response;
  try {
    if (answer) ros::serialization::deserializeMessage(*answer, response.emplace());
  } catch (const ros::serialization::StreamOverrunException&) {
    response.reset();
  }
  return response;
}

}  // namespace flute_grinder
