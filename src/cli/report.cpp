#include "cli/report.h"

#include "cli/csv.h"
#include "cli/history.h"
#include "cli/machine_file.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/regular_file.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace flute_grinder {

namespace {

std::filesystem::path ownPath() {
  std::error_code error;
  std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw FileError("/proc/self/exe: cannot be read: " + error.message());
  return self;
}

/// The report program, which is beside this one both in the build and where it is installed.
std::filesystem::path programPath() { return ownPath().parent_path() / "report"; }

std::vector<char*> pointersTo(std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  return argv;
}

void append(std::vector<std::string>& arguments, const char* option, const Axes& values) {
  arguments.emplace_back(option);
  for (int axis = 0; axis < kAxisCount; ++axis) arguments.push_back(format("%.17g", values[axis]));
}

/// The newest record in a folder. @throw FileError if there is none.
std::string lastRecord(const std::string& folder) {
  const std::optional<std::string> newest = newestRecord(folder);
  if (!newest) throw FileError(folder + ": has no record of a job");
  return *newest;
}

}  // namespace

void writeReport(const std::string& node, const ReportOptions& options) {
  if (options.file.empty() && !options.last) throw std::invalid_argument("FILE is missing; allowed: a file, or --last");
  if (options.html.empty() && options.pdf.empty() && !options.json)
    throw std::invalid_argument("nothing to write; allowed: --output, --pdf, --json");
  for (const std::string& path : {options.file, options.tolerances}) {
    if (!path.empty()) requireRegularFile(path);
  }
  const LoopConfig config = readMachineFiles(options.parameters, options.urdf);
  std::vector<std::string> arguments{PYTHON_EXECUTABLE, programPath(), "--grind", ownPath()};
  const auto add = [&](const char* option, const std::string& value) {
    // In one word, since a value may begin with a dash.
    if (!value.empty()) arguments.push_back(std::string(option) + "=" + value);
  };
  add("--output", options.html);
  add("--pdf", options.pdf);
  add("--note", options.note);
  add("--operator", options.operator_name);
  add("--serial", options.serial);
  add("--tolerances", options.tolerances.empty() ? packageFile("config/tolerances.yaml") : options.tolerances);
  add("--job", std::to_string(options.job));
  if (options.json) arguments.emplace_back("--json");
  append(arguments, "--max-velocity", config.machine.limits.max_velocity);
  append(arguments, "--max-acceleration", config.machine.limits.max_acceleration);
  append(arguments, "--max-following-error", config.following_error);
  arguments.insert(
      arguments.end(),
      {"--", options.last ? lastRecord(options.folder.empty() ? historyFolder(node) : options.folder) : options.file});
  std::vector<char*> argv = pointersTo(arguments);
  execv(argv[0], argv.data());
  throw FileError(arguments[0] + ": cannot be started: " + std::strerror(errno));
}

bool drawTool(const std::string& json, const std::string& svg) {
  // By a file, so that nothing waits for the other end of a pipe.
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), std::fclose);
  if (!input || std::fputs(json.c_str(), input.get()) < 0 || std::fseek(input.get(), 0, SEEK_SET) != 0)
    throw FileError(std::string("a temporary file cannot be written: ") + std::strerror(errno));
  std::vector<std::string> arguments{PYTHON_EXECUTABLE, programPath() / "tool.py", svg};
  const std::vector<char*> argv = pointersTo(arguments);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(input.get()), STDIN_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw FileError(arguments[0] + ": cannot be started: " + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace flute_grinder
