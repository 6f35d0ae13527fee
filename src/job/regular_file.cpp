#include "flute_grinder/job/regular_file.h"

#include "flute_grinder/job/yaml_text.h"

#include <filesystem>
#include <system_error>

namespace grinder {

void requireRegularFile(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) error = std::make_error_code(std::errc::is_a_directory);
  std::string why = error.message();
  if (!error) {
    if (std::filesystem::is_regular_file(status)) return;
    why = "not a regular file; allowed: a file on a disk, no FIFO and no device";
  }
  throw JobFileError(path + ": cannot be read: " + why);
}

}  // namespace grinder
