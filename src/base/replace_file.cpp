#include "flute_grinder/base/replace_file.h"

#include "flute_grinder/base/file_error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <thread>

namespace grinder {

namespace {

/// @param path file named in the message.
void require(bool done, const std::string& path) {
  if (!done) throw std::system_error(errno, std::generic_category(), path);
}

/// Writes the new text and commits it.
void fill(FileReplacement& fresh, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(fresh.descriptor(), text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    require(count >= 0, fresh.file());
    done += static_cast<std::size_t>(count);
  }
  fresh.commit();
}

/// The target of symbolic links; it need not exist.
std::string behindLinks(const std::string& path) {
  constexpr int most = 40;  // as in Linux
  std::filesystem::path file = path;
  std::error_code error;
  for (int i = 0; i < most && std::filesystem::is_symlink(file, error); ++i) {
    file = file.parent_path() / std::filesystem::read_symlink(file, error);
  }
  return file;
}

std::string folderOf(const std::string& path) { return std::filesystem::absolute(path).parent_path(); }

/// Takes an unused name beside a file.
/// @param take returns whether it could take a name; EEXIST if not.
template <typename Take>
std::string takeName(const std::string& file, const Take& take) {
  for (int i = 0;; ++i) {
    const std::string name = file + "." + std::to_string(i) + ".new";
    if (take(name.c_str())) return name;
    require(errno == EEXIST, file);
  }
}

}  // namespace

FileReplacement::FileReplacement(const std::string& path) : file_(behindLinks(path)) {
  is_new_ = ::stat(file_.c_str(), &old_) != 0;
  require(is_new_ ? errno == ENOENT : ::access(file_.c_str(), W_OK) == 0, file_);
  constexpr mode_t mode = 0666;
  descriptor_ = ::open(folderOf(file_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
  // FAT and NFS have no unnamed files.
  if (descriptor_ < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {
    fresh_ = takeName(file_, [this](const char* name) {
      descriptor_ = ::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
      return descriptor_ >= 0;
    });
  }
  require(descriptor_ >= 0, file_);
}

FileReplacement::FileReplacement(const std::string& path, const std::string& fresh)
    : file_(path), fresh_(fresh), is_new_(true) {
  // Opening a FIFO must not block.
  descriptor_ = ::open(fresh_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0644);
  require(descriptor_ >= 0, fresh_);
}

FileReplacement::~FileReplacement() {
  ::close(descriptor_);
  if (!fresh_.empty()) ::unlink(fresh_.c_str());
}

void FileReplacement::commit() {
  // Only root can give a file away; an owner need not.
  require(is_new_ || ::fchown(descriptor_, old_.st_uid, old_.st_gid) == 0 || errno == EPERM, file_);
  require(is_new_ || ::fchmod(descriptor_, old_.st_mode & 07777) == 0, file_);
  require(::fsync(descriptor_) == 0, file_);
  if (fresh_.empty()) {
    const std::string nameless = "/proc/self/fd/" + std::to_string(descriptor_);
    fresh_ = takeName(file_, [&](const char* name) {
      return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
    });
  }
  require(::rename(fresh_.c_str(), file_.c_str()) == 0, file_);
  fresh_.clear();
}

FileLock::FileLock(const std::string& path) {
  constexpr std::chrono::milliseconds pause(10), patience(10'000);
  const auto failed = [&](const std::string& why) { return FileError(path + ": cannot be changed: " + why); };
  for (auto waited = std::chrono::milliseconds(0);; waited += pause) {
    descriptor_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) throw failed(std::generic_category().message(errno));
    struct stat own, now;
    const bool locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    const int error = errno;
    // Who had it has replaced the file, which is then another one.
    if (locked && ::fstat(descriptor_, &own) == 0 && ::stat(path.c_str(), &now) == 0 && own.st_ino == now.st_ino)
      return;
    ::close(descriptor_);
    if (!locked && error != EWOULDBLOCK) throw failed(std::generic_category().message(error));
    if (waited >= patience) throw failed("another program has been changing it for 10 s");
    if (!locked) std::this_thread::sleep_for(pause);
  }
}

FileLock::~FileLock() { ::close(descriptor_); }

void replaceFile(const std::string& path, const std::string& text) {
  FileReplacement fresh(path);
  fill(fresh, text);
  settleFile(fresh.file());
}

void writeFile(const std::string& path, const std::string& text) {
  FileReplacement fresh(path, path + ".new");
  fill(fresh, text);
}

void settleFile(const std::string& path) {
  const std::string folder = folderOf(path);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  require(descriptor >= 0, folder);
  const bool done = ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  require(done, folder);
}

}  // namespace grinder
