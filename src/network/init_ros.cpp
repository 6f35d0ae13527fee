#include "flute_grinder/network/init_ros.h"

#include <ros/init.h>

namespace grinder {

std::vector<char*> initRos(int argc, char** argv, const std::string& name, std::uint32_t options) {
  // With a log file named, none is looked for; it is never opened. First, so that one on the command line counts.
  static char no_log[] = "__log:=/dev/null";
  std::vector<char*> arguments{no_log};
  arguments.insert(arguments.end(), argv, argv + argc);
  auto count = static_cast<int>(arguments.size());
  ros::init(count, arguments.data(), name, options);
  arguments.resize(static_cast<std::size_t>(count));
  arguments.push_back(nullptr);
  return arguments;
}

}  // namespace grinder
