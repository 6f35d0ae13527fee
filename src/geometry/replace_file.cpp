#include "flute_grinder/geometry/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace flute_grinder {

namespace {

void require(bool done) {
  if (!done) throw std::system_error(errno, std::generic_category());
}

/// A descriptor, which is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) { require(number >= 0); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }

  int number() const noexcept { return number_; }
  void sync() const { require(::fsync(number_) == 0); }
  void write(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(number_, text.data() + done, text.size() - done);
      if (count < 0 && errno == EINTR) continue;
      require(count >= 0);
      done += static_cast<std::size_t>(count);
    }
  }

 private:
  int number_;
};

/// @param adorn gives the new file owner and mode. @param file an absolute path.
template <typename Adorn>
void writeInOneStep(const std::filesystem::path& file, const std::string& text, const Adorn& adorn) {
  std::string fresh = file.string() + ".XXXXXX";
  const Descriptor descriptor(::mkostemp(fresh.data(), O_CLOEXEC));
  try {
    adorn(descriptor.number());
    descriptor.write(text);
    descriptor.sync();
    require(::rename(fresh.c_str(), file.c_str()) == 0);
  } catch (const std::system_error&) {
    ::unlink(fresh.c_str());
    throw;
  }
  // The rename is safe only once the folder is synced too.
  Descriptor(::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)).sync();
}

}  // namespace

void replaceFile(const std::string& path, const std::string& text) {
  const std::filesystem::path file = std::filesystem::canonical(path);
  struct stat old {};
  require(::stat(file.c_str(), &old) == 0 && ::access(file.c_str(), W_OK) == 0);
  writeInOneStep(file, text, [&](int descriptor) {
    // Who is not root cannot give a file away, and need not, if it is his own.
    require(::fchown(descriptor, old.st_uid, old.st_gid) == 0 || errno == EPERM);
    require(::fchmod(descriptor, old.st_mode & 07777) == 0);
  });
}

void writeFile(const std::string& path, const std::string& text) {
  writeInOneStep(std::filesystem::absolute(path), text,
                 [](int descriptor) { require(::fchmod(descriptor, 0644) == 0); });
}

}  // namespace flute_grinder
