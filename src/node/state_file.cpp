#include "node/state_file.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/replace_file.h"
#include "flute_grinder/job/sha256.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace grinder {

namespace {

constexpr std::size_t kMaxFile = 1 << 16;
using File = SealedFile::File;

const std::string kSealKey = "checksum: ";

/// The last line of a file, with the checksum of its body.
std::string seal(const std::string& body) { return kSealKey + sha256Hex(body.data(), body.size()) + "\n"; }

/// The text without its last line, which must be its seal. @throw std::runtime_error if it is damaged.
std::string unsealed(const std::string& text) {
  if (text.size() > kMaxFile) throw std::runtime_error("is longer than " + std::to_string(kMaxFile) + " bytes");
  const std::size_t seal_length = kSealKey.size() + 64 + 1;
  std::string body = text.substr(0, text.size() - std::min(text.size(), seal_length));
  if (text.compare(body.size(), kSealKey.size(), kSealKey) != 0) throw std::runtime_error("its checksum is missing");
  if (text.substr(body.size()) != seal(body)) {
    throw std::runtime_error("its checksum is wrong: the file was damaged or changed");
  }
  return body;
}

void require(bool done, const std::string& path) {
  if (!done) throw std::system_error(errno, std::generic_category(), path);
}

/// Opens a regular file, without blocking on a FIFO's peer.
File openFile(const std::string& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, 0644);
  require(descriptor >= 0, path);
  File file(fdopen(descriptor, flags == O_RDONLY ? "r" : "r+"), std::fclose);
  require(file != nullptr, path);
  struct stat about {};
  require(fstat(descriptor, &about) == 0, path);
  if (!S_ISREG(about.st_mode)) throw std::runtime_error(path + " is not a regular file");
  return file;
}

/// The contents of a file, cut one byte beyond the longest sealed file.
std::string contents(std::FILE* file, const std::string& path) {
  std::string text(kMaxFile + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file));
  require(std::ferror(file) == 0, path);
  return text;
}

std::string contents(const std::string& path) { return contents(openFile(path, O_RDONLY).get(), path); }

}  // namespace

SealedFile::SealedFile(std::string kind, std::string path, std::string owner)
    : kind_(std::move(kind)), path_(std::move(path)), owner_(std::move(owner)) {}

void SealedFile::acquire() {
  if (lock_) return;
  const std::filesystem::path file = std::filesystem::weakly_canonical(std::filesystem::absolute(path_));
  const std::filesystem::file_status status = std::filesystem::status(file);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("is not a regular file");
  }
  std::filesystem::create_directories(file.parent_path());
  const std::string beside = file.string() + ".lock";
  // A lock file that is root's, or on a read-only disk, can be locked all the same, so that the file can be read.
  const bool writable = faccessat(AT_FDCWD, beside.c_str(), W_OK, AT_EACCESS) == 0 || errno == ENOENT;
  File lock = openFile(beside, writable ? O_RDWR | O_CREAT : O_RDONLY);
  if (flock(fileno(lock.get()), LOCK_EX | LOCK_NB) != 0) {
    require(errno == EWOULDBLOCK, beside);
    const std::string holder = contents(lock.get(), beside);
    throw StateFileOwned(kind_ + " " + path_ + " is in use by " + holder.substr(0, holder.find('\n')) +
                         "; allowed: a " + kind_ + " of its own for every node");
  }
  // For people, if the lock file is writable.
  if (ftruncate(fileno(lock.get()), 0) == 0) {
    std::fputs(format("node %s, process %d\n", owner_.c_str(), getpid()).c_str(), lock.get());
    std::fflush(lock.get());
  }
  file_ = file.string();
  lock_ = std::move(lock);
}

std::optional<std::string> SealedFile::read() {
  return named([&]() -> std::optional<std::string> {
    acquire();
    if (!std::filesystem::exists(file_)) return std::nullopt;
    return named<StateFileDamaged>([text = contents(file_)] { return unsealed(text); });
  });
}

void SealedFile::write(const std::string& text, bool undo) {
  named([&] {
    const std::string sealed = text + seal(text);
    StateFields::require(sealed.size() <= kMaxFile, "size", sealed.size(), std::to_string(kMaxFile) + " bytes at most");
    acquire();
    std::optional<std::string> before;
    if (undo && std::filesystem::exists(file_)) before = contents(file_);
    writeFile(file_, sealed);
    try {
      settleFile(file_);
    } catch (const std::exception& unsettled) {
      if (!undo) throw;
      try {
        before ? writeFile(file_, *before) : static_cast<void>(std::filesystem::remove(file_));
      } catch (const std::exception& error) {
        throw std::runtime_error(unsettled.what() + std::string("; the file has the change all the same: ") +
                                 error.what());
      }
      throw;
    }
  });
}

}  // namespace grinder
