#include "node/journal.h"

#include "soon.h"
#include "state_file_fixture.h"

#include <functional>
#include <limits>
#include <tuple>

// The fields of a state file, by those of the journal. How it is kept is in test_state_file.cpp.
namespace grinder {
namespace test_journal {

using namespace test_support;

/// No figure of it is a default, nor like another.
Progress someProgress() {
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
  p.wheel.clear_x = -0.002;
  p.wheel.back = 0.003;
  p.wheel.y_doubted = true;
  p.offset << 0.11, -0.0225, 1.0 / 7, -3;
  p.mounting = 5;
  p.clamping = 3;
  p.tool_digest = std::string(64, 'e');
  p.kind = OperationKind::kPrimaryRelief;
  return p;
}

void expectSame(const Progress& a, const Progress& b) {
  const auto all = [](const Progress& p) {
    return std::tie(p.job_digest, p.job_name, p.operation, p.cutter.end_diameter, p.cutter.cone_angle,
                    p.cutter.spiral_angle, p.cutter.rake_angle, p.cutter.flute_length, p.tooth_angles, p.finished,
                    p.next.tooth, p.next.pass, p.x, p.end, p.feed_override, p.wheel.in_work, p.wheel.clear_y,
                    p.wheel.lift, p.wheel.clear_x, p.wheel.back, p.wheel.y_doubted, p.mounting, p.clamping,
                    p.tool_digest, p.kind);
  };
  EXPECT_TRUE(all(a) == all(b));
  EXPECT_TRUE((a.offset == b.offset).all()) << a.offset.transpose() << " and " << b.offset.transpose();
}

class JournalTest : public StateFileTest {
 protected:
  /// Writes an entry. @return why it is not on the disk.
  std::string enter(const Progress& progress) {
    Journal journal(path_, "/grinder");
    journal.write(progress);
    EXPECT_TRUE(soon([&] { return journal.status().number == 1; }));
    return journal.status().error;
  }

  /// What reading the content is refused with; empty if it is read.
  std::string refusalOf(const std::string& content) {
    fill(path_, content);
    return Journal(path_, "/grinder").status().error;
  }
};

TEST_F(JournalTest, KeepsAllFiguresAndAnyName) {
  for (const std::string name : {"", "null", "~", "true", "7", "a: b", "- a", "# a", "'", "\"", "\\", "\n", "\t",
                                 "job\nchecksum: 0\n", "{", "%", "größe", "\x01"}) {
    Progress progress = someProgress();
    progress.job_name = progress.job_digest = name;
    EXPECT_EQ(enter(progress), "");
    expectSame(Journal(path_, "/grinder").status().on_disk, progress);
  }
}

TEST_F(JournalTest, WrongFiguresAreRefusedUnderARightChecksumToo) {
  EXPECT_EQ(enter(someProgress()), "");
  const std::string good = readFile(path_);
  const std::string body = good.substr(0, good.rfind("checksum: "));
  ASSERT_EQ(refusalOf(sealed(body)), "");
  // The line of a key, or all of them; what it is replaced by, and what the refusal must say.
  const struct {
    std::string key, replacement, refusal;
  } lines[]{
      {"pass", "", "pass is missing"},
      {"pass", "pass: 1.5\n", "bad conversion"},
      {"pass", "pass: 99999999999999999999\n", "bad conversion"},
      {"pass", "pass: -1\n", "pass = -1; allowed: 0 to 9999"},
      {"pass", "pass: 10000\n", "pass = 10000; allowed: 0 to 9999"},
      {"pass", "pass: 1\nfail: 1\n", "key fail is unknown"},
      {"pass", "pass: 1\npass: 1\n", "key pass is unknown or duplicate"},
      {"pass", "pass: [1]\n", "bad conversion"},
      {"pass", "pass: [1\n", "error at line"},
      {"tooth", "tooth: 3\n", "tooth = 3; allowed: 0 to 2"},
      {"tooth", "tooth: -1\n", "tooth = -1; allowed: 0 to 2"},
      {"kind", "kind: end\n", "kind = end; allowed: flute, primary, "},
      {"feed_override", "feed_override: 1.3\n", "feed_override = 1.3; allowed: 0 to 1.2"},
      {"finished", "finished: perhaps\n", "bad conversion"},
      {"x_m", "x_m: .nan\n", "x_m = nan; allowed: a finite number"},
      {"x_m", "x_m: -.inf\n", "x_m = -inf; allowed: a finite number"},
      {"x_m", "x_m: 1e999\n", "bad conversion"},
      {"offset_a_rad", "", "offset_a_rad is missing"},
      {"tooth_angles_rad", "tooth_angles_rad: [0, .nan, 2]\n", "tooth_angles_rad = nan"},
      {"tooth_angles_rad", "tooth_angles_rad: []\n", "tooth = 2; allowed: 0 to 0"},
      {"", "- a list\n", ""},
      {"", "a word\n", ""},
      {"", "", ""},
  };
  for (const auto& wrong : lines) {
    const std::string bad = wrong.key.empty() ? wrong.replacement : withLine(body, wrong.key, wrong.replacement);
    const std::string refusal = refusalOf(sealed(bad));
    EXPECT_EQ(refusal.rfind("journal " + path_ + ": ", 0), 0U) << wrong.replacement << ": " << refusal;
    EXPECT_NE(refusal.find(wrong.refusal), std::string::npos) << wrong.replacement << ": " << refusal;
  }
}

TEST_F(JournalTest, WhatCouldNotBeReadIsNotWritten) {
  const std::function<void(Progress&)> spoils[]{
      [](Progress& p) { p.x = std::numeric_limits<double>::quiet_NaN(); },
      [](Progress& p) { p.offset[kZ] = -std::numeric_limits<double>::infinity(); },
      [](Progress& p) { p.tooth_angles[1] = std::numeric_limits<double>::infinity(); },
      [](Progress& p) { p.next.tooth = 3; },
      [](Progress& p) { p.next.pass = kMaxPasses; },
      [](Progress& p) { p.tooth_angles.resize(kMaxTeeth + 1); },
      [](Progress& p) { p.job_name.resize(1 << 16); },
  };
  for (const auto& spoil : spoils) {
    Progress progress = someProgress();
    spoil(progress);
    EXPECT_NE(enter(progress), "") << &spoil - spoils;
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace test_journal
}  // namespace grinder
