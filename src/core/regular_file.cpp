#include "flute_grinder/core/regular_file.h"

#include "flute_grinder/core/yaml_text.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace flute_grinder {

void requireRegularFile(const std::string& path) {
  struct stat about {};
  std::string why;
  if (::stat(path.c_str(), &about) != 0) {
    why = std::strerror(errno);
  } else if (S_ISDIR(about.st_mode)) {
    why = std::strerror(EISDIR);
  } else if (!S_ISREG(about.st_mode)) {
    why = "not a regular file; allowed: a file on a disk, no FIFO and no device";
  }
  if (!why.empty()) throw JobFileError(path + ": cannot be read: " + why);
}

}  // namespace flute_grinder
