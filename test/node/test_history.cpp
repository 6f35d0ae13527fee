#include "node/history.h"

#include "soon.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_history {

namespace fs = std::filesystem;
using test_support::readFile;

constexpr std::uint64_t kPlenty = 1 << 30;

class HistoryTest : public ::testing::Test {
 protected:
  void open(std::uint64_t limit) { history_ = std::make_unique<History>(folder_ / "a" / "b", limit); }
  /// The record of a job that started so many days after 1 January 2026, by a clock that may be wrong.
  void keep(int day, const std::string& text) {
    history_->keep(1767225600 + 86400.0 * day, [text] { return text; });
  }
  /// Waits until there is an error, or none.
  void waitForError(bool is) const {
    EXPECT_TRUE(test_support::soon([&] { return history_->error().empty() != is; }));
  }
  /// Waits until all is on the disk.
  void close() { history_.reset(); }

  /// Of the record of a day from 0 to 8, by default the first one of a folder for day 0, and so on.
  static std::string nameOf(int day, int number = 0) {
    const std::string digits = std::to_string(number == 0 ? day + 1 : number);
    return std::string(10 - digits.size(), '0') + digits + "_2026010" + std::to_string(day + 1) + "T000000.000Z.json";
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "a" / "b")) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  void put(const std::string& name, std::size_t size) const {
    std::ofstream(folder_ / "a" / "b" / name) << std::string(size, '.');
  }

  const test_support::TempFolder temp_;
  const fs::path folder_ = temp_.path();
  std::unique_ptr<History> history_;
};

TEST_F(HistoryTest, KeepsEveryRecordWithinTheLimit) {
  open(kPlenty);
  for (int i = 0; i < 9; ++i) keep(i, "record " + std::to_string(i));
  close();
  ASSERT_EQ(files().size(), 9U);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(readFile(folder_ / "a" / "b" / nameOf(i)), "record " + std::to_string(i));
}

TEST_F(HistoryTest, RemovesTheOldestBeyondTheLimitAndKeepsTheNewestWhateverItsSize) {
  open(250);
  for (int i = 0; i < 5; ++i) keep(i, std::string(100, 'x'));
  close();
  EXPECT_EQ(files(), (std::vector<std::string>{nameOf(3), nameOf(4)}));
  open(250);
  keep(5, std::string(1000, 'x'));
  close();
  EXPECT_EQ(files(), std::vector<std::string>{nameOf(5)});
}

TEST_F(HistoryTest, RemovesThoseWrittenFirstWhateverTheClockWas) {
  open(250);
  keep(8, std::string(100, 'x'));
  keep(7, std::string(100, 'x'));
  keep(3, std::string(100, 'x'));
  close();
  EXPECT_EQ(files(), (std::vector<std::string>{nameOf(7, 2), nameOf(3, 3)}));
  open(250);
  keep(5, std::string(100, 'x'));
  keep(3, std::string(100, 'y'));
  close();
  EXPECT_EQ(files(), (std::vector<std::string>{nameOf(5, 4), nameOf(3, 5)}));
}

TEST_F(HistoryTest, SaysThatNoNumberIsLeft) {
  fs::create_directories(folder_ / "a" / "b");
  put("9999999999_20260101T000000.000Z.json", 1);
  open(250);
  keep(0, "x");
  waitForError(true);
  EXPECT_EQ(history_->error(), "history " + (folder_ / "a" / "b").string() + ": " + (folder_ / "a" / "b").string() +
                                   "/9999999999_20260101T000000.000Z.json: has the greatest number; move it elsewhere");
}

TEST_F(HistoryTest, RemovesNothingThatIsNotItsOwn) {
  fs::create_directories(folder_ / "a" / "b");
  const std::vector<std::string> foreign{"0000000001_20261122T170413.123Z.json.bak", "20261122T170413.123Z.json",
                                         "a.json", "notes.txt"};
  for (const std::string& name : foreign) put(name, 1000);
  put("0000000041_20261122T170413.000Z.json.new", 1000);  // left by a power failure
  open(250);
  for (int i = 0; i < 3; ++i) keep(i, std::string(200, 'x'));
  close();
  std::vector<std::string> left = foreign;
  left.push_back(nameOf(2, 44));
  std::sort(left.begin(), left.end());
  EXPECT_EQ(files(), left);
}

TEST_F(HistoryTest, SkipsWhatIsNamedLikeARecordButIsNoFile) {
  const fs::path folder = folder_ / "a" / "b";
  fs::create_directories(folder / nameOf(0) / "inside");
  fs::create_symlink("nowhere", folder / nameOf(1));
  fs::create_symlink("/proc/self/exe", folder / nameOf(2));
  ASSERT_EQ(mkfifo((folder / (nameOf(3) + ".new")).c_str(), 0600), 0);
  const std::vector<std::string> others = files();
  open(250);
  for (int i = 0; i < 4; ++i) keep(i, std::string(100, 'x'));
  waitForError(true);
  EXPECT_EQ(history_->error(), "history " + folder.string() +
                                   ": named like records but no regular files, and skipped: " + nameOf(0) + ", " +
                                   nameOf(1) + ", " + nameOf(2) + ", " + nameOf(3) + ".new; move them elsewhere");
  close();
  std::vector<std::string> left = others;
  left.insert(left.end(), {nameOf(2, 7), nameOf(3, 8)});
  EXPECT_EQ(files(), left);
}

TEST_F(HistoryTest, NamesTenOfWhatItSkips) {
  std::string names;
  for (int i = 0; i < 12; ++i) {
    const std::string name = nameOf(0, i + 1);
    fs::create_directories(folder_ / "a" / "b" / name);
    if (i < 10) names += (i == 0 ? "" : ", ") + name;
  }
  open(kPlenty);
  keep(0, "x");
  waitForError(true);
  EXPECT_NE(history_->error().find("skipped: " + names + " and 2 more; move them elsewhere"), std::string::npos)
      << history_->error();
}

TEST_F(HistoryTest, IsNeverReadHalf) {
  open(kPlenty);
  const std::string whole(1 << 20, 'x');
  for (int i = 0; i < 9; ++i) keep(i, whole);
  for (int i = 0; i < 9; ++i) {
    const fs::path file = folder_ / "a" / "b" / nameOf(i);
    EXPECT_TRUE(test_support::soon([&] { return fs::exists(file); }));
    EXPECT_EQ(readFile(file).size(), whole.size());
  }
  close();
}

TEST_F(HistoryTest, ReportsAFolderThatCannotBe) {
  std::ofstream(folder_ / "a") << "a file";
  open(kPlenty);
  keep(0, "x");
  waitForError(true);
  EXPECT_NE(history_->error().find((folder_ / "a" / "b").string()), std::string::npos) << history_->error();
  // It is well again as soon as a record is kept.
  fs::remove(folder_ / "a");
  keep(1, "y");
  waitForError(false);
  EXPECT_EQ(history_->error(), "");
  close();
  EXPECT_EQ(files().back(), nameOf(1, 1));
}

TEST_F(HistoryTest, ARecordThatCannotBeMadeIsReported) {
  open(kPlenty);
  history_->keep(0, []() -> std::string { throw std::runtime_error("no such thing"); });
  waitForError(true);
  EXPECT_NE(history_->error().find("no such thing"), std::string::npos);
  close();
  EXPECT_TRUE(files().empty());
}

}  // namespace test_history
}  // namespace grinder
