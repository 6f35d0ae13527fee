#include "flute_grinder/base/read_file.h"

#include "flute_grinder/base/file_error.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
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
  throw FileError(path + ": cannot be read: " + why);
}

bool wasRead(const std::string& path) {
  const std::lock_guard<std::mutex> lock(mutex);
  std::error_code error;  // there may be no such file
  return std::filesystem::exists(path, error) &&
         std::any_of(read_paths.begin(), read_paths.end(),
                     [&](const std::string& read) { return std::filesystem::equivalent(read, path, error); });
}

std::string readTextFile(const std::string& path, std::size_t most) {
  requireRegularFile(path);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::string text(most + 1, '\0');
  if (file) text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (!file || std::ferror(file.get()) != 0) throw FileError(path + ": cannot be read: " + std::strerror(errno));
  if (text.empty()) throw FileError(path + ": is empty");
  if (text.size() > most) throw FileError(path + ": is too long; allowed: " + std::to_string(most) + " bytes");
  return text;
}

}  // namespace grinder
