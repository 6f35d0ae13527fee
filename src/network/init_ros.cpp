#include "flute_grinder/network/init_ros.h"

#include <ros/init.h>

#include <cstdlib>
#include <cstring>
#include <regex>
#include <stdexcept>

namespace grinder {

namespace {

/// Requires a valid name of the master, because roscpp ends the program with a trap for a name that it cannot read.
void requireMaster(int argc, char** argv) {
  constexpr const char* argument = "__master:=";
  std::string name = "ROS_MASTER_URI";
  const char* uri = std::getenv(name.c_str());
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], argument, std::strlen(argument)) != 0) continue;
    name = "__master";
    uri = argv[i] + std::strlen(argument);
  }
  const std::string allowed = "; allowed: http://HOST:PORT, as http://localhost:11311";
  if (!uri) throw std::invalid_argument(name + " is not set" + allowed);
  static const std::regex form("http://[^:/ ]+:[0-9]{1,5}/?");
  if (!std::regex_match(uri, form)) throw std::invalid_argument(name + " = " + uri + allowed);
}

}  // namespace

std::vector<char*> initRos(int argc, char** argv, const std::string& name, std::uint32_t options) {
  requireMaster(argc, argv);
  // With a named log file, which is never opened, roscpp makes no folder. Under another name, the parameter that makes
  // it use the clock of a simulation is not there. First, so that what the command line says wins.
  static char no_log[] = "__log:=/dev/null";
  static char no_simulation[] = "/use_sim_time:=/flute_grinder/use_sim_time";
  std::vector<char*> arguments{no_log, no_simulation};
  arguments.insert(arguments.end(), argv, argv + argc);
  auto count = static_cast<int>(arguments.size());
  ros::init(count, arguments.data(), name, options);
  arguments.resize(static_cast<std::size_t>(count));
  arguments.push_back(nullptr);
  return arguments;
}

}  // namespace grinder
