#include "flute_grinder/job/regular_file.h"

#include "flute_grinder/job/yaml_text.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>

namespace grinder {

namespace {

std::mutex mutex;
std::set<std::string> read_paths;  // guarded by mutex

}  // namespace

void requireRegularFile(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) error = std::make_error_code(std::errc::is_a_directory);
  std::string why = error.message();
  if (!error) {
    if (std::filesystem::is_regular_file(status)) {
      const std::lock_guard<std::mutex> lock(mutex);
      read_paths.insert(path);
      return;
    }
    why = "not a regular file; allowed: a file on a disk, no FIFO and no device";
  }
  throw JobFileError(path + ": cannot be read: " + why);
}

bool wasRead(const std::string& path) {
  const std::lock_guard<std::mutex> lock(mutex);
  std::error_code error;  // there may be no such file
  return std::filesystem::exists(path, error) &&
         std::any_of(read_paths.begin(), read_paths.end(),
                     [&](const std::string& read) { return std::filesystem::equivalent(read, path, error); });
}

}  // namespace grinder
