#include "node/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

namespace grinder {

namespace {

/// Reopens the file behind a descriptor: changing the flags of an inherited one would change them for every process
/// that shares it.
void reopenWithoutWaiting(int fd) {
  struct stat what {};
  if (fstat(fd, &what) != 0 || !(S_ISFIFO(what.st_mode) || S_ISCHR(what.st_mode))) return;
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  const int fresh = open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY);
  if (fresh < 0) return;  // another user's terminal, left as it is
  dup2(fresh, fd);
  close(fresh);
}

}  // namespace

void dropBlockedOutput() {
  reopenWithoutWaiting(STDOUT_FILENO);
  reopenWithoutWaiting(STDERR_FILENO);
}

}  // namespace grinder
