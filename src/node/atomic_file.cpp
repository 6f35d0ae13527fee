#include "node/atomic_file.h"

#include "flute_grinder/geometry/replace_file.h"
#include "flute_grinder/plan/sha256.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace grinder {

namespace {

constexpr std::size_t kMaxFile = 1 << 16;
const std::string kSealKey = "checksum: ";

/// The last line of a file.
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

}  // namespace

/// An open file, closed by the destructor. No call blocks on a peer, as with a FIFO.
class AtomicFile::File {
 public:
  File(const std::string& path, int flags)
      : path_(path), fd_(open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, 0644)) {
    requireDone(fd_ >= 0);
  }
  ~File() { close(fd_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void requireRegular() const {
    struct stat about {};
    requireDone(fstat(fd_, &about) == 0);
    if (!S_ISREG(about.st_mode)) throw std::runtime_error(path_ + " is not a regular file");
  }

  /// At most one byte more than an atomic file has.
  std::string read() const {
    std::string text(kMaxFile + 1, '\0');
    std::size_t done = 0;
    for (ssize_t count = 1; count > 0 && done < text.size(); done += static_cast<std::size_t>(count)) {
      do {
        count = ::read(fd_, &text[done], text.size() - done);
      } while (count < 0 && errno == EINTR);
      requireDone(count >= 0);
    }
    text.resize(done);
    return text;
  }

  /// @param text short. @return whether it is there.
  bool replace(const std::string& text) {
    return ftruncate(fd_, 0) == 0 && ::write(fd_, text.data(), text.size()) >= 0;
  }

  /// @return false if another process has locked it.
  bool lock() {
    const bool done = flock(fd_, LOCK_EX | LOCK_NB) == 0;
    requireDone(done || errno == EWOULDBLOCK);
    return done;
  }

 private:
  void requireDone(bool done) const {
    if (!done) throw std::system_error(errno, std::generic_category(), path_);
  }

  std::string path_;
  int fd_;
};

AtomicFile::AtomicFile(std::string kind, std::string path, std::string owner)
    : kind_(std::move(kind)), path_(std::move(path)), owner_(std::move(owner)) {
  try {
    named([&] { acquire(); });
  } catch (const AtomicFileOwned&) {
    throw;
  } catch (const AtomicFileError&) {
    // read() and write() will meet it again, and report it.
  }
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::acquire() const {
  if (lock_) return;
  const std::filesystem::path file = std::filesystem::weakly_canonical(std::filesystem::absolute(path_));
  const std::filesystem::file_status status = std::filesystem::status(file);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("is not a regular file");
  }
  std::filesystem::create_directories(file.parent_path());
  const std::string beside = file.string() + ".lock";
  // Root's, or on a disk that is mounted read-only, it can be locked all the same, so that the file is read.
  const bool writable = faccessat(AT_FDCWD, beside.c_str(), W_OK, AT_EACCESS) == 0 || errno == ENOENT;
  auto lock = std::make_unique<File>(beside, writable ? O_RDWR | O_CREAT : O_RDONLY);
  lock->requireRegular();
  if (!lock->lock()) {
    const std::string holder = lock->read();
    throw AtomicFileOwned(kind_ + " " + path_ + " is in use by " + holder.substr(0, holder.find('\n')) +
                          "; allowed: a " + kind_ + " of its own for every node");
  }
  lock->replace("node " + owner_ + ", process " + std::to_string(getpid()) + "\n");  // for people, if it can be
  file_ = file.string();
  lock_ = std::move(lock);
}

std::optional<std::string> AtomicFile::read() const {
  return named([&]() -> std::optional<std::string> {
    acquire();
    if (!std::filesystem::exists(file_)) return std::nullopt;
    const File file(file_, O_RDONLY);
    file.requireRegular();
    const std::string text = file.read();
    return named<AtomicFileDamaged>([&] { return unsealed(text); });
  });
}

void AtomicFile::write(const std::string& text) const {
  named([&] {
    const std::string sealed = text + seal(text);
    requireAllowed(sealed.size() <= kMaxFile, "size", sealed.size(), std::to_string(kMaxFile) + " bytes at most");
    acquire();
    writeFile(file_, sealed);
  });
}

void AtomicFile::settle() const {
  named([&] {
    acquire();
    settleFile(file_);
  });
}

}  // namespace grinder
