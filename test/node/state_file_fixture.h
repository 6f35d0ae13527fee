#pragma once

#include "flute_grinder/job/sha256.h"

#include "temp_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace grinder::test_support {

/// A folder of its own, with a state file that is not there yet.
class StateFileTest : public ::testing::Test {
 protected:
  static void fill(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
  }

  static std::string sealed(const std::string& body) {
    return body + "checksum: " + sha256Hex(body.data(), body.size()) + "\n";
  }

  /// The body with the line of a key replaced.
  static std::string withLine(const std::string& body, const std::string& key, const std::string& line) {
    const std::size_t begin = body.find("\n" + key + ": ") + 1;
    EXPECT_NE(begin, 0U) << key;
    return body.substr(0, begin) + line + body.substr(body.find('\n', begin) + 1);
  }

  const TempFolder temp_;
  const std::string folder_ = temp_.path();
  std::string path_ = folder_ + "/state";
};

/// Nobody may use a file or a folder, but as said, while this lives; root, who may always, is nobody meanwhile.
class Forbidden {
 public:
  explicit Forbidden(const std::string& path, std::filesystem::perms allowed = std::filesystem::perms::none)
      : path_(path) {
    permit(allowed);
    EXPECT_EQ(seteuid(user_ == 0 ? 65534 : user_), 0);
  }
  ~Forbidden() {
    EXPECT_EQ(seteuid(user_), 0);
    permit(std::filesystem::perms::owner_all);
  }

 private:
  void permit(std::filesystem::perms permissions) { std::filesystem::permissions(path_, permissions); }

  const std::string path_;
  const uid_t user_ = geteuid();
};

}  // namespace grinder::test_support
