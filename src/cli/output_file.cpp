#include "cli/output_file.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

namespace grinder {

namespace {

std::set<std::string> open_files;  // files that OutputFile is to replace

/// The unique name of a file, however its path is given.
std::string nameOf(const FileReplacement& replacement) {
  return std::filesystem::absolute(replacement.file()).lexically_normal();
}

/// Whether the program's standard output goes into this file.
bool isStandardOutput(const struct stat& file) {
  struct stat output {};
  return ::fstat(STDOUT_FILENO, &output) == 0 && output.st_dev == file.st_dev && output.st_ino == file.st_ino;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw FileError(path + ": cannot be written: " + why);
}

}  // namespace

void requireNotRead(const std::string& path) {
  if (wasRead(path)) refuse(path, "the command reads it; allowed: a file that it does not read");
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  requireNotRead(path_);
  struct stat status {};
  const bool there = ::stat(path_.c_str(), &status) == 0;
  int descriptor = -1;
  if (there && isStandardOutput(status)) {
    descriptor = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  } else if (there && !S_ISREG(status.st_mode)) {
    descriptor = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    try {
      replacement_.emplace(path_);
    } catch (const std::system_error& error) {
      refuse(path_, error.code().message());
    }
    if (!open_files.insert(nameOf(*replacement_)).second)
      refuse(path_, "another option writes it; allowed: a file of its own for each");
    descriptor = ::fcntl(replacement_->descriptor(), F_DUPFD_CLOEXEC, 0);
  }
  if (descriptor >= 0) stream_.reset(::fdopen(descriptor, "w"));
  if (!stream_) refuse(path_, std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (replacement_) open_files.erase(nameOf(*replacement_));
}

std::string OutputFile::forProgram() const {
  const int descriptor = ::fileno(stream_.get());
  if (::fcntl(descriptor, F_SETFD, 0) != 0) refuse(path_, std::strerror(errno));
  return std::to_string(descriptor) + ':' + path_;
}

void OutputFile::close(int error) {
  requireNotRead(path_);
  if (std::fclose(stream_.release()) != 0 && error == 0) error = errno;
  if (error != 0) throw WriteError(path_ + ": write failed: " + std::strerror(error));
  try {
    if (replacement_) replacement_->commit();
  } catch (const std::system_error& error) {
    throw WriteError(path_ + ": write failed: " + error.code().message());
  }
}

std::unique_ptr<OutputFile> openOutput(const std::string& path) {
  return path.empty() ? nullptr : std::make_unique<OutputFile>(path);
}

}  // namespace grinder
