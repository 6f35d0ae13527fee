#include "flute_grinder/connection/service_call.h"

#include <ros/connection.h>
#include <ros/service_manager.h>

#include <utility>

namespace flute_grinder {

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
  abort();
  if (thread_.joinable()) thread_.join();
}

void ServiceCall::abortIfOverdue() {
  if (ros::SteadyTime::now() > due_) abort();
}

void ServiceCall::abort() {
  const std::lock_guard<std::mutex> lock(mutex_);
  aborted_ = true;
  if (link_) link_->getConnection()->drop(ros::Connection::Destructing);
}

void ServiceCall::run() {
  const auto link = ros::ServiceManager::instance()->createServiceServerLink(name_, false, md5sum_, md5sum_, {});
  bool wanted = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    link_ = link;
    wanted = link && !aborted_;
  }
  ros::SerializedMessage answer;
  done_(wanted && link->call(request_, answer) ? &answer : nullptr);
  finished_ = true;
}

}  // namespace flute_grinder
