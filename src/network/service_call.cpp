#include "flute_grinder/network/service_call.h"

#include <ros/connection.h>
#include <ros/service_manager.h>

#include <utility>

namespace grinder {

ServiceCall::ServiceCall(std::string name, std::string md5sum, ros::SerializedMessage request,
                         ros::WallDuration timeout, Done done)
    : name_(std::move(name)),
      md5sum_(std::move(md5sum)),
      request_(std::move(request)),
      due_(ros::SteadyTime::now() + timeout),
      done_(std::move(done)) {
  thread_ = std::thread([this] { run(); });
}

ServiceCall::~ServiceCall() { end(); }

void ServiceCall::end() {
  close();
  if (thread_.joinable()) thread_.join();
}

void ServiceCall::abortIfOverdue() {
  if (ros::SteadyTime::now() > due_) close();
}

void ServiceCall::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  if (link_) link_->getConnection()->drop(ros::Connection::Destructing);
}

void ServiceCall::run() {
  // Persistent, because the server closes any other connection after its answer, and roscpp may see the close before it
  // reads the answer (ros_comm #1976).
  const auto link = ros::ServiceManager::instance()->createServiceServerLink(name_, true, md5sum_, md5sum_, {});
  bool wanted = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    link_ = link;
    wanted = link && !closed_;
  }
  ros::SerializedMessage answer;
  const bool answered = wanted && link->call(request_, answer);
  close();
  done_(answered ? &answer : nullptr);
  finished_ = true;
}

}  // namespace grinder
