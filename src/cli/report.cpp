#include "flute_grinder/cli/report.h"

#include "flute_grinder/cli/csv.h"
#include "flute_grinder/cli/machine_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

namespace flute_grinder {

namespace {

/// The report program, which is beside this one both in the build and where it is installed.
std::string programPath() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw FileError("/proc/self/exe: cannot be read: " + error.message());
  return self.parent_path() / "report";
}

void append(std::vector<std::string>& arguments, const char* option, const Axes& values) {
  arguments.emplace_back(option);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", values[axis]);
    arguments.emplace_back(text);
  }
}

}  // namespace

void writeReport(const ReportOptions& options) {
  const LoopConfig config = readMachineFiles(options.parameters, options.urdf);
  std::vector<std::string> arguments{PYTHON_EXECUTABLE, programPath(), "--output",
                                     options.output,    "--job",       std::to_string(options.job)};
  append(arguments, "--max-velocity", config.machine.limits.max_velocity);
  append(arguments, "--max-acceleration", config.machine.limits.max_acceleration);
  append(arguments, "--max-following-error", config.following_error);
  arguments.insert(arguments.end(), {"--", options.file});
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  throw FileError(arguments[0] + ": cannot be started: " + std::strerror(errno));
}

}  // namespace flute_grinder
