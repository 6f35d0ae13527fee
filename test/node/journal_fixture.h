#pragma once

#include "flute_grinder/plan/sha256.h"
#include "node/journal.h"

#include "temp_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace grinder::test_support {

/// A folder of its own, with a journal that is not there yet.
class JournalTest : public ::testing::Test {
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
  std::string path_ = folder_ + "/journal";
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

/// No figure of it is a default, nor like another.
inline Progress someProgress() {
  Progress p;
  p.job_digest = std::string(64, 'd');
  p.job_name = "jobs/mill 10°.yaml";
  p.operation = "primary relief";
  p.cutter = {0.01, 0.1, 0.5, -0.2, 0.03};
  p.tooth_angles = {0, 1.0 / 3, 2};
  p.finished = true;
  p.next = {2, 7};
  p.x = 0.1 + 0.2;
  p.end = "canceled";
  p.feed_override = 0.36;
  p.wheel.in_work = true;
  p.wheel.clear_y = 0.0125;
  p.wheel.lift = 0.005;
  p.wheel.y_doubted = true;
  p.offset << 0.11, -0.0225, 1.0 / 7, -3;
  p.mounting = 5;
  p.clamping = 3;
  p.tool_digest = std::string(64, 'e');
  p.tool_operation = 1;
  return p;
}

inline void expectSame(const Progress& a, const Progress& b) {
  EXPECT_EQ(a.job_digest, b.job_digest);
  EXPECT_EQ(a.job_name, b.job_name);
  EXPECT_EQ(a.operation, b.operation);
  EXPECT_EQ(a.cutter.end_diameter, b.cutter.end_diameter);
  EXPECT_EQ(a.cutter.cone_angle, b.cutter.cone_angle);
  EXPECT_EQ(a.cutter.spiral_angle, b.cutter.spiral_angle);
  EXPECT_EQ(a.cutter.rake_angle, b.cutter.rake_angle);
  EXPECT_EQ(a.cutter.flute_length, b.cutter.flute_length);
  EXPECT_EQ(a.tooth_angles, b.tooth_angles);
  EXPECT_EQ(a.finished, b.finished);
  EXPECT_EQ(a.next.tooth, b.next.tooth);
  EXPECT_EQ(a.next.pass, b.next.pass);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.feed_override, b.feed_override);
  EXPECT_EQ(a.wheel.in_work, b.wheel.in_work);
  EXPECT_EQ(a.wheel.clear_y, b.wheel.clear_y);
  EXPECT_EQ(a.wheel.lift, b.wheel.lift);
  EXPECT_EQ(a.wheel.y_doubted, b.wheel.y_doubted);
  EXPECT_EQ(a.mounting, b.mounting);
  EXPECT_EQ(a.clamping, b.clamping);
  EXPECT_EQ(a.tool_digest, b.tool_digest);
  EXPECT_EQ(a.tool_operation, b.tool_operation);
  EXPECT_TRUE((a.offset == b.offset).all()) << a.offset.transpose() << " and " << b.offset.transpose();
}

}  // namespace grinder::test_support
