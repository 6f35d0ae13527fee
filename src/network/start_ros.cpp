#include "flute_grinder/network/start_ros.h"

#include "flute_grinder/network/prompt_connections.h"

#include <ros/connection_manager.h>
#include <ros/console_impl.h>
#include <ros/ros.h>
#include <ros/service_manager.h>
#include <ros/transport/transport_udp.h>
#include <roscpp/GetLoggers.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace grinder {

namespace {

void allowDescriptors() {
  // No more: libxmlrpcpp looks at each of them whenever a client connects.
  constexpr rlim_t descriptors = 4096;
  rlimit limit{};
  const bool known = getrlimit(RLIMIT_NOFILE, &limit) == 0;
  limit.rlim_cur = std::max(limit.rlim_cur, std::min(limit.rlim_max, descriptors));
  if (!known || setrlimit(RLIMIT_NOFILE, &limit) != 0) {
    throw std::system_error(errno, std::generic_category(), "the limit of file descriptors");
  }
}

/// Lists the loggers whose level is worth changing, each with the lowest level that it logs.
bool listLoggers(roscpp::GetLoggers::Request&, roscpp::GetLoggers::Response& response) {
  namespace console = ros::console;
  constexpr std::array<const char*, console::levels::Count> levels{"debug", "info", "warn", "error", "fatal"};
  for (const char* name : {"ros", "ros.flute_grinder", "ros.roscpp"}) {
    void* logger = console::impl::getHandle(name);
    int level = console::levels::Debug;
    while (level < console::levels::Fatal && !console::impl::isEnabledFor(logger, console::Level(level))) ++level;
    roscpp::Logger& listed = response.loggers.emplace_back();
    listed.name = name;
    listed.level = levels[level];
  }
  return true;
}

}  // namespace

ros::ServiceServer startRos() {
  allowDescriptors();
  connectPromptly();
  ros::start();
  ros::ConnectionManager::instance()->getUDPServerTransport()->disableRead();
  ros::ServiceManager::instance()->unadvertiseService(ros::names::resolve("~get_loggers"));
  return ros::NodeHandle("~").advertiseService("get_loggers", listLoggers);
}

}  // namespace grinder
