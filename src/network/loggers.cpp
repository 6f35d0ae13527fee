/// @file
/// Answers ~get_loggers, which every roscpp node serves. With the log4cxx of Debian 12, rosconsole's own answer frees
/// the loggers that it lists, and the second call ends the process. This definition overrides the library's in the
/// programs that link it.

#include <ros/console.h>
#include <ros/console_impl.h>

#include <map>
#include <string>

namespace ros::console {

/// Lists the loggers whose level is worth changing, each with the lowest level that it logs. @return true.
bool get_loggers(std::map<std::string, levels::Level>& loggers) {
  for (const char* name : {"ros", "ros.flute_grinder", "ros.roscpp"}) {
    void* logger = impl::getHandle(name);
    int level = levels::Debug;
    while (level < levels::Fatal && !impl::isEnabledFor(logger, static_cast<levels::Level>(level))) ++level;
    loggers[name] = static_cast<levels::Level>(level);
  }
  return true;
}

}  // namespace ros::console
