#include "flute_grinder/geometry/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace grinder {

namespace {

/// @param path what it is about, for the message.
void require(bool done, const std::string& path) {
  if (!done) throw std::system_error(errno, std::generic_category(), path);
}

/// A descriptor, which is closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(int number, const std::string& path) : number_(number), path_(path) { require(number >= 0, path); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }

  void sync() const { require(::fsync(number_) == 0, path_); }
  void write(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(number_, text.data() + done, text.size() - done);
      if (count < 0 && errno == EINTR) continue;
      require(count >= 0, path_);
      done += static_cast<std::size_t>(count);
    }
  }

 private:
  int number_;
  const std::string& path_;
};

/// @param fresh path of the new file. @param number its descriptor. @param old whose owner and mode it gets, if any.
void writeInOneStep(const std::string& file, const std::string& text, const std::string& fresh, int number,
                    const struct stat* old = nullptr) {
  const Descriptor descriptor(number, fresh);
  try {
    // Who is not root cannot give a file away, and need not, if it is his own.
    require(!old || ::fchown(number, old->st_uid, old->st_gid) == 0 || errno == EPERM, fresh);
    require(!old || ::fchmod(number, old->st_mode & 07777) == 0, fresh);
    descriptor.write(text);
    descriptor.sync();
    require(::rename(fresh.c_str(), file.c_str()) == 0, file);
  } catch (const std::system_error&) {
    ::unlink(fresh.c_str());
    throw;
  }
}

}  // namespace

void replaceFile(const std::string& path, const std::string& text) {
  const std::string file = std::filesystem::canonical(path);
  struct stat old {};
  require(::stat(file.c_str(), &old) == 0 && ::access(file.c_str(), W_OK) == 0, file);
  std::string fresh = file + ".XXXXXX";
  const int number = ::mkostemp(fresh.data(), O_CLOEXEC);
  writeInOneStep(file, text, fresh, number, &old);
  settleFile(file);
}

void writeFile(const std::string& path, const std::string& text) {
  const std::string fresh = path + ".new";
  // A FIFO must not block.
  const int flags = O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC;
  writeInOneStep(path, text, fresh, ::open(fresh.c_str(), flags, 0644));
}

void settleFile(const std::string& path) {
  const std::string folder = std::filesystem::absolute(path).parent_path();
  Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder).sync();
}

}  // namespace grinder
