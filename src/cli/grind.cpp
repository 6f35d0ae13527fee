#include "cli/command_line.h"
#include "cli/csv.h"
#include "cli/online.h"
#include "cli/waiting.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/network/init_ros.h"

#include <ros/ros.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

namespace {

using namespace grinder;

int run(int argc, char** argv) {
  const std::vector<char*> arguments =
      initRos(argc, argv, "grind",
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  // If the master goes away during a call, wait for it as long as for a missing master.
  ros::master::setRetryTimeout(kMasterPatience);
  CommandLine line;
  const std::optional<int> refused = line.parse(static_cast<int>(arguments.size()) - 1, arguments.data());
  return refused ? *refused : line.carryOut();
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

/// Whether stdout is a pipe whose reader has gone, as with `| head -1`.
bool isLeftPipe() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/// @param status exit status of the command. @return `status`, or failure if the output could not be written.
int closeOutput(int status) {
  std::fflush(stdout);
  if (std::ferror(stdout) == 0) return status;
  if (!isLeftPipe()) std::fprintf(stderr, "standard output: write failed\n");
  return status == 0 ? 1 : status;
}

/// Runs the command and catches every exception. @return the exit status.
int runToTheEnd(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const WriteError& error) {
    return fail(error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", escaped(error.what(), "\n").c_str());
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
