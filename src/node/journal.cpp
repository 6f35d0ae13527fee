#include "flute_grinder/node/journal.h"

#include "flute_grinder/messages/sha256.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <system_error>

namespace flute_grinder {

namespace {

constexpr std::size_t kLargestFile = 1 << 16;
const std::string kSealKey = "checksum: ";

/// The last line of a file.
std::string seal(const std::string& body) { return kSealKey + sha256Hex(body.data(), body.size()) + "\n"; }

/// Calls visit(key, value) for every field of the file.
template <typename AnyProgress, typename Visit>
void visitFields(AnyProgress& progress, const Visit& visit) {
  visit("job_digest", progress.job_digest);
  visit("job_name", progress.job_name);
  visit("end_diameter_m", progress.cutter.end_diameter);
  visit("cone_angle_rad", progress.cutter.cone_angle);
  visit("spiral_angle_rad", progress.cutter.spiral_angle);
  visit("rake_angle_rad", progress.cutter.rake_angle);
  visit("flute_length_m", progress.cutter.flute_length);
  visit("tooth_angles_rad", progress.tooth_angles);
  visit("finished", progress.finished);
  visit("tooth", progress.next.tooth);
  visit("pass", progress.next.pass);
  visit("x_m", progress.x);
  visit("wheel_in_work", progress.wheel.in_work);
  visit("clear_y_m", progress.wheel.clear_y);
  visit("lift_m", progress.wheel.lift);
}

/// Throws for a value out of range.
template <typename Value>
void require(bool good, const std::string& key, const Value& value, const std::string& allowed) {
  if (good) return;
  std::ostringstream text;
  text << key << " = " << value << "; allowed: " << allowed;
  throw std::runtime_error(text.str());
}

void requireFinite(const std::string& key, double value) {
  require(std::isfinite(value), key, value, "a finite number");
}

void requireSound(const Progress& progress) {
  visitFields(progress, [](const char* key, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, double>) requireFinite(key, value);
    if constexpr (std::is_same_v<Value, std::vector<double>>) {
      for (const double element : value) requireFinite(key, element);
    }
  });
  const std::size_t teeth = progress.tooth_angles.size();
  require(teeth <= kMaxTeeth, "number of tooth_angles_rad", teeth, "0 to " + std::to_string(kMaxTeeth));
  const int last_tooth = teeth == 0 ? 0 : static_cast<int>(teeth) - 1;
  const ToothPass& next = progress.next;
  require(next.tooth >= 0 && next.tooth <= last_tooth, "tooth", next.tooth, "0 to " + std::to_string(last_tooth));
  require(next.pass >= 0 && next.pass < kMaxPasses, "pass", next.pass, "0 to " + std::to_string(kMaxPasses - 1));
}

std::string toText(const Progress& progress) {
  requireSound(progress);
  YAML::Emitter text;
  text.SetDoublePrecision(17);
  text << YAML::Comment("The grinder's progress; tooth and pass, from 0, are the first that is not finished.")
       << YAML::BeginMap;
  visitFields(progress, [&](const char* key, const auto& value) {
    text << YAML::Key << key << YAML::Value << YAML::Flow << YAML::DoubleQuoted << value;
  });
  text << YAML::EndMap;
  const std::string body = std::string(text.c_str()) + "\n";
  return body + seal(body);
}

Progress fromText(const std::string& text) {
  const std::size_t seal_length = kSealKey.size() + 64 + 1;
  const std::string body = text.substr(0, text.size() - std::min(text.size(), seal_length));
  if (text.compare(body.size(), kSealKey.size(), kSealKey) != 0) throw std::runtime_error("its checksum is missing");
  if (text.substr(body.size()) != seal(body)) {
    throw std::runtime_error("its checksum is wrong: the file was damaged or changed");
  }
  const YAML::Node file = YAML::Load(body);
  Progress progress;
  std::set<std::string> known;
  visitFields(progress, [&](const char* key, auto& value) {
    known.insert(key);
    if (!file[key]) throw std::runtime_error(std::string(key) + " is missing");
    value = file[key].as<std::decay_t<decltype(value)>>();
  });
  for (const auto& entry : file) {
    const auto key = entry.first.as<std::string>();
    if (known.erase(key) == 0) throw std::runtime_error("key " + key + " is unknown or duplicate");
  }
  requireSound(progress);
  return progress;
}

/// Rethrows any error of an action as a JournalError that names the file.
template <typename Action>
auto withPath(const std::string& path, const Action& action) {
  try {
    return action();
  } catch (const JournalError&) {
    throw;
  } catch (const std::exception& error) {
    throw JournalError("journal " + path + ": " + error.what());
  }
}

}  // namespace

/// An open file or folder, closed by the destructor. No call blocks on a peer, as with a FIFO.
class Journal::File {
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

  std::string read() const {
    std::string text(kLargestFile + 1, '\0');
    std::size_t done = 0;
    for (ssize_t count = 1; count > 0 && done < text.size(); done += static_cast<std::size_t>(count)) {
      do {
        count = ::read(fd_, &text[done], text.size() - done);
      } while (count < 0 && errno == EINTR);
      requireDone(count >= 0);
    }
    if (done > kLargestFile) throw std::runtime_error("is longer than " + std::to_string(kLargestFile) + " bytes");
    text.resize(done);
    return text;
  }

  void replace(const std::string& text) {
    requireDone(ftruncate(fd_, 0) == 0);
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(fd_, text.data() + done, text.size() - done);
      if (count < 0 && errno == EINTR) continue;
      requireDone(count >= 0);
      done += static_cast<std::size_t>(count);
    }
  }

  void sync() { requireDone(fsync(fd_) == 0); }

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

Journal::Journal(std::string path, std::string owner) : path_(std::move(path)), owner_(std::move(owner)) {
  try {
    withPath(path_, [&] { acquire(); });
  } catch (const JournalOwned&) {
    throw;
  } catch (const JournalError&) {
    // read() and write() will meet it again, and report it.
  }
}

Journal::~Journal() = default;

void Journal::acquire() const {
  if (lock_) return;
  const std::filesystem::path file = std::filesystem::weakly_canonical(std::filesystem::absolute(path_));
  const std::filesystem::file_status status = std::filesystem::status(file);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("is not a regular file");
  }
  std::filesystem::create_directories(file.parent_path());
  auto lock = std::make_unique<File>(file.string() + ".lock", O_RDWR | O_CREAT);
  lock->requireRegular();
  if (!lock->lock()) {
    const std::string holder = lock->read();
    throw JournalOwned("journal " + path_ + " is in use by " + holder.substr(0, holder.find('\n')) +
                       "; allowed: a journal of its own for every node");
  }
  lock->replace("node " + owner_ + ", process " + std::to_string(getpid()) + "\n");
  file_ = file.string();
  lock_ = std::move(lock);
}

std::optional<Progress> Journal::read() const {
  return withPath(path_, [&]() -> std::optional<Progress> {
    acquire();
    if (!std::filesystem::exists(file_)) return std::nullopt;
    const File file(file_, O_RDONLY);
    file.requireRegular();
    return fromText(file.read());
  });
}

void Journal::write(const Progress& progress) const {
  withPath(path_, [&] {
    const std::string text = toText(progress);
    require(text.size() <= kLargestFile, "size", text.size(), std::to_string(kLargestFile) + " bytes at most");
    acquire();
    const std::string fresh = file_ + ".new";
    {
      File file(fresh, O_WRONLY | O_CREAT);
      file.requireRegular();
      file.replace(text);
      file.sync();
    }
    std::filesystem::rename(fresh, file_);
    // The rename is safe only once the folder is synced too.
    File(std::filesystem::path(file_).parent_path().string(), O_RDONLY | O_DIRECTORY).sync();
  });
}

}  // namespace flute_grinder
