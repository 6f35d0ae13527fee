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
  void keep(const std::string& name, const std::string& text) {
    history_->keep(name, [text] { return text; });
  }
  /// Waits until there is an error, or none.
  void waitForError(bool is) const {
    EXPECT_TRUE(test_support::soon([&] { return history_->error().empty() != is; }));
  }
  /// Waits until all is on the disk.
  void close() { history_.reset(); }

  static std::string nameOf(int number) {
    std::string name = "20261122T170413.000Z.json";
    name.replace(16, 3, std::to_string(100 + number));
    return name;
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
  for (int i = 0; i < 10; ++i) keep(nameOf(i), "record " + std::to_string(i));
  close();
  ASSERT_EQ(files().size(), 10U);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(readFile(folder_ / "a" / "b" / nameOf(i)), "record " + std::to_string(i));
}

TEST_F(HistoryTest, RemovesTheOldestBeyondTheLimitAndKeepsTheNewestWhateverItsSize) {
  open(250);
  for (int i = 0; i < 5; ++i) keep(nameOf(i), std::string(100, 'x'));
  close();
  EXPECT_EQ(files(), (std::vector<std::string>{nameOf(3), nameOf(4)}));
  open(250);
  keep(nameOf(5), std::string(1000, 'x'));
  close();
  EXPECT_EQ(files(), std::vector<std::string>{nameOf(5)});
}

TEST_F(HistoryTest, RemovesNothingThatIsNotItsOwn) {
  fs::create_directories(folder_ / "a" / "b");
  const std::vector<std::string> foreign{"20261122T170413.123Z.json.bak", "20261122T170413.json", "a.json",
                                         "notes.txt"};
  for (const std::string& name : foreign) put(name, 1000);
  put("20261122T170413.000Z.json.new", 1000);  // left by a power failure
  open(250);
  for (int i = 0; i < 3; ++i) keep(nameOf(i), std::string(200, 'x'));
  close();
  std::vector<std::string> left = foreign;
  left.push_back(nameOf(2));
  std::sort(left.begin(), left.end());
  EXPECT_EQ(files(), left);
}

TEST_F(HistoryTest, SkipsWhatIsNamedLikeARecordButIsNoFile) {
  const fs::path folder = folder_ / "a" / "b";
  fs::create_directories(folder / "20201122T170413.000Z.json" / "inside");
  fs::create_symlink("nowhere", folder / "20201122T170413.001Z.json");
  fs::create_symlink("/proc/self/exe", folder / "20201122T170413.002Z.json");
  ASSERT_EQ(mkfifo((folder / "20201122T170413.003Z.json.new").c_str(), 0600), 0);
  const std::vector<std::string> others = files();
  open(250);
  for (int i = 0; i < 4; ++i) keep(nameOf(i), std::string(100, 'x'));
  waitForError(true);
  EXPECT_EQ(history_->error(), "history " + folder.string() +
                                   ": named like records but no regular files, and skipped: 20201122T170413.000Z.json, "
                                   "20201122T170413.001Z.json, 20201122T170413.002Z.json, "
                                   "20201122T170413.003Z.json.new; move them elsewhere");
  close();
  std::vector<std::string> left = others;
  left.insert(left.end(), {nameOf(2), nameOf(3)});
  EXPECT_EQ(files(), left);
}

TEST_F(HistoryTest, NamesTenOfWhatItSkips) {
  std::string names;
  for (int i = 0; i < 12; ++i) {
    fs::create_directories(folder_ / "a" / "b" / nameOf(i));
    if (i < 10) names += (i == 0 ? "" : ", ") + nameOf(i);
  }
  open(kPlenty);
  keep(nameOf(20), "x");
  waitForError(true);
  EXPECT_NE(history_->error().find("skipped: " + names + " and 2 more; move them elsewhere"), std::string::npos)
      << history_->error();
}

TEST_F(HistoryTest, IsNeverReadHalf) {
  open(kPlenty);
  const std::string whole(1 << 20, 'x');
  for (int i = 0; i < 10; ++i) keep(nameOf(0), whole);
  keep(nameOf(1), "the last");
  const fs::path folder = folder_ / "a" / "b";
  int reads = 0;
  while (!fs::exists(folder / nameOf(1))) {
    if (!fs::exists(folder / nameOf(0))) continue;
    EXPECT_EQ(readFile(folder / nameOf(0)).size(), whole.size());
    ++reads;
  }
  EXPECT_GT(reads, 0);
  close();
}

TEST_F(HistoryTest, ReportsAFolderThatCannotBe) {
  std::ofstream(folder_ / "a") << "a file";
  open(kPlenty);
  keep(nameOf(0), "x");
  waitForError(true);
  EXPECT_NE(history_->error().find((folder_ / "a" / "b").string()), std::string::npos) << history_->error();
  // It is well again as soon as a record is kept.
  fs::remove(folder_ / "a");
  keep(nameOf(1), "y");
  waitForError(false);
  EXPECT_EQ(history_->error(), "");
  close();
  EXPECT_EQ(files().back(), nameOf(1));
}

TEST_F(HistoryTest, ARecordThatCannotBeMadeIsReported) {
  open(kPlenty);
  history_->keep(nameOf(0), []() -> std::string { throw std::runtime_error("no such thing"); });
  waitForError(true);
  EXPECT_NE(history_->error().find("no such thing"), std::string::npos);
  close();
  EXPECT_TRUE(files().empty());
}

}  // namespace test_history
}  // namespace grinder
