#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/csv.h"
#include "cli/online.h"
#include "cli/state_watch.h"
#include "cli/usage.h"
#include "flute_grinder/connection/init_ros.h"

#include <ros/ros.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

using namespace flute_grinder;

constexpr int kUsage = 2;  ///< exit status for wrong usage and unreadable files

void addCompletion(Commands& commands) {
  const auto shell = std::make_shared<std::string>();
  auto& command = commands.add("completion", "print a script that completes command lines; source it", "bash",
                               [&commands] { return std::fputs(bashCompletion(commands.app()).c_str(), stdout), 0; });
  const std::string bash = "bash";
  command.add_option("SHELL", *shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({bash}).description(""))
      ->type_name("{" + bash + "}");
}

int run(int argc, char** argv) {
  const std::vector<char*> arguments =
      initRos(argc, argv, "grind",
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  // If the master goes away during a call, wait for it as long as for one that is missing.
  ros::master::setRetryTimeout(kPatience);
  CLI::App app{"Plans jobs for conical end mills and operates the grinder.", "grind"};
  app.require_subcommand(1);
  app.footer("Example:\n  rosrun flute_grinder grind plan --help");
  Commands commands(app);
  app.set_version_flag("--version", "flute_grinder " FLUTE_GRINDER_VERSION, "print the version and exit");
  app.add_option("--node", commands.node, "name of the grinder's node")->capture_default_str();
  addJobCommands(commands);
  addWheelCommands(commands);
  addMachineCommands(commands);
  addOffsetCommands(commands);
  addCompletion(commands);
  try {
    app.parse(static_cast<int>(arguments.size()) - 1, arguments.data());
  } catch (const CLI::ParseError& error) {
    // An unknown word is reported before what is missing, which it may have been meant for.
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknownWord(app);
    if (unknown.empty()) return app.exit(error) == 0 ? 0 : kUsage;
    std::fprintf(stderr, "%s\nRun with --help for more information.\n", unknown.c_str());
    return kUsage;
  }
  return commands.carryOut();
}

/// Opens a closed stdin, stdout or stderr so that writing fails; otherwise the next file or connection opened would get
/// its number.
void occupyStandardStreams() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDONLY);
    if (descriptor > STDERR_FILENO) ::close(descriptor);
    if (descriptor > STDERR_FILENO || descriptor < 0) return;
  }
}

/// Whether stdout is a pipe whose reader has gone, as of `| head -1`.
bool isLeftPipe() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/// @param status of the command. @return the exit status: failure if the output could not be written.
int closeOutput(int status) {
  std::fflush(stdout);
  if (std::ferror(stdout) == 0) return status;
  if (!isLeftPipe()) std::fprintf(stderr, "standard output: write failed\n");
  return status == 0 ? 1 : status;
}

/// @return the exit status, whatever happens.
int runToTheEnd(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const WriteError& error) {
    return fail(error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "unknown error\n");
  }
  return kUsage;
}

}  // namespace

int main(int argc, char** argv) {
  occupyStandardStreams();
  const int status = closeOutput(runToTheEnd(argc, argv));
  leaveRos();
  std::_Exit(status);  // at the end of main(), roscpp would wait for its threads
}
