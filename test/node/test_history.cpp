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
  void open(std::uint64_t limit) { history_ = std::make_unique<History>(kept_, limit); }
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
    for (const auto& entry : fs::directory_iterator(kept_)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  void put(const std::string& name, std::size_t size) const { std::ofstream(kept_ / name) << std::string(size, '.'); }

  const test_support::TempFolder temp_;
  const fs::path folder_ = temp_.path(), kept_ = folder_ / "a" / "b";
  std::unique_ptr<History> history_;
};

TEST_F(HistoryTest, KeepsEveryRecordWithinTheLimitWhichIsNeverReadHalf) {
  open(kPlenty);
  const auto textOf = [](int i) { return std::string(1 << 20, static_cast<char>('a' + i)); };
  for (int i = 0; i < 9; ++i) keep(i, textOf(i));
  for (int i = 0; i < 9; ++i) {
    const fs::path file = kept_ / nameOf(i);
    EXPECT_TRUE(test_support::soon([&] { return fs::exists(file); }));
    EXPECT_TRUE(readFile(file) == textOf(i)) << i;
  }
  close();
  EXPECT_EQ(files().size(), 9U);
}

TEST_F(HistoryTest, RemovesThoseWrittenFirstWhateverTheClockWasAndKeepsTheNewestWhateverItsSize) {
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
  open(250);
  keep(5, std::string(1000, 'x'));
  close();
  EXPECT_EQ(files(), std::vector<std::string>{nameOf(5, 6)});
}

TEST_F(HistoryTest, RemovesNothingThatIsNotItsOwn) {
  fs::create_directories(kept_);
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

TEST_F(HistoryTest, SkipsWhatIsNamedLikeARecordButIsNoFileAndNamesTenOfIt) {
  fs::create_directories(kept_ / nameOf(0) / "inside");
  fs::create_symlink("nowhere", kept_ / nameOf(1));
  fs::create_symlink("/proc/self/exe", kept_ / nameOf(2));
  ASSERT_EQ(mkfifo((kept_ / (nameOf(3) + ".new")).c_str(), 0600), 0);
  std::vector<std::string> left = files();
  open(250);
  for (int i = 0; i < 4; ++i) keep(i, std::string(100, 'x'));
  waitForError(true);
  const std::string skipped = "history " + kept_.string() + ": named like records but no regular files, and skipped: ",
                    four = nameOf(0) + ", " + nameOf(1) + ", " + nameOf(2) + ", " + nameOf(3) + ".new";
  EXPECT_EQ(history_->error(), skipped + four + "; move them elsewhere");
  close();
  left.insert(left.end(), {nameOf(2, 7), nameOf(3, 8)});
  EXPECT_EQ(files(), left);
  for (int number = 4; number < 12; ++number) fs::create_directories(kept_ / nameOf(4, number));
  open(kPlenty);
  keep(0, "x");
  waitForError(true);
  EXPECT_EQ(history_->error(), skipped + four + ", " + nameOf(4, 4) + ", " + nameOf(4, 5) + ", " + nameOf(4, 6) + ", " +
                                   nameOf(4, 7) + ", " + nameOf(4, 8) + ", " + nameOf(4, 9) +
                                   " and 2 more; move them elsewhere");
}

TEST_F(HistoryTest, ReportsAFolderThatCannotBe) {
  std::ofstream(folder_ / "a") << "a file";
  open(kPlenty);
  waitForError(true);
  EXPECT_NE(history_->error().find(kept_.string()), std::string::npos) << history_->error();
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
