#include "flute_grinder/node/journal.h"

#include <fcntl.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

namespace flute_grinder {

namespace {

/// An open file, closed at the end of its life.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags) : path_(path), fd_(open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    require(fd_ >= 0);
  }
  ~Descriptor() { close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(fd_, text.data() + done, text.size() - done);
      if (count < 0 && errno == EINTR) continue;
      require(count >= 0);
      done += static_cast<std::size_t>(count);
    }
  }
  void sync() { require(fsync(fd_) == 0); }

 private:
  void require(bool good) const {
    if (!good) throw JournalError("journal " + path_ + ": " + std::strerror(errno));
  }

  std::string path_;
  int fd_;
};

}  // namespace

std::optional<Progress> Journal::read() const {
  if (!std::filesystem::exists(path_)) return std::nullopt;
  try {
    const YAML::Node file = YAML::LoadFile(path_);
    Progress progress;
    progress.job_digest = file["job_digest"].as<std::string>();
    progress.finished = file["finished"].as<bool>();
    progress.next.tooth = file["tooth"].as<std::uint16_t>();
    progress.next.pass = file["pass"].as<std::uint16_t>();
    progress.x = file["x_m"].as<double>();
    return progress;
  } catch (const YAML::Exception& error) {
    throw JournalError("journal " + path_ + ": " + error.what());
  }
}

void Journal::write(const Progress& progress) const {
  YAML::Emitter text;
  text.SetDoublePrecision(17);
  text << YAML::Comment("The grinder's progress; tooth and pass, from 0, are the first that is not finished.")
       << YAML::BeginMap;
  text << YAML::Key << "job_digest" << YAML::Value << progress.job_digest;
  text << YAML::Key << "finished" << YAML::Value << progress.finished;
  text << YAML::Key << "tooth" << YAML::Value << progress.next.tooth;
  text << YAML::Key << "pass" << YAML::Value << progress.next.pass;
  text << YAML::Key << "x_m" << YAML::Value << progress.x << YAML::EndMap;

  try {
    const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
    std::filesystem::create_directories(folder);
    const std::string fresh = path_ + ".new";
    {
      Descriptor file(fresh, O_WRONLY | O_CREAT | O_TRUNC);
      file.write(std::string(text.c_str()) + "\n");
      file.sync();
    }
    std::filesystem::rename(fresh, path_);
    Descriptor(folder.string(), O_RDONLY | O_DIRECTORY).sync();  // the new name is safe only with its folder
  } catch (const std::filesystem::filesystem_error& error) {
    throw JournalError("journal " + path_ + ": " + error.what());
  }
}

}  // namespace flute_grinder
