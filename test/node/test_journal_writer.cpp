#include "node/journal_writer.h"

#include "journal_fixture.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <thread>

namespace grinder {
namespace test_journal_writer {

using test_support::expectSame;
using test_support::Forbidden;
using test_support::someProgress;

Progress progressAt(int x) {
  Progress progress = someProgress();
  progress.x = x;
  return progress;
}

/// The disk is as slow as the tests say (slow_fsync.c).
class JournalWriterTest : public test_support::JournalTest {
 protected:
  JournalWriterTest() { setenv("SLOW_FSYNC", (folder_ + "/seconds").c_str(), 1); }
  ~JournalWriterTest() override { unsetenv("SLOW_FSYNC"); }

  void slowDown(const std::string& seconds) {
    fill(folder_ + "/other_seconds", seconds);
    std::filesystem::rename(folder_ + "/other_seconds", folder_ + "/seconds");
  }

  static void waitFor(const std::function<bool()>& condition, const char* what) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition()) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "timed out waiting for " << what;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  static void waitForWrite(const JournalWriter& writer, std::uint64_t number) {
    waitFor([&] { return writer.status().number >= number; }, "the write to finish");
  }

  /// Waits until the disk is busy with the first write.
  void waitForDisk() {
    waitFor([&] { return std::filesystem::exists(path_ + ".new"); }, "the write");
  }
};

TEST_F(JournalWriterTest, ReadsTheJournalAtTheStartIfThereIsOneAndIsTheOnlyOne) {
  for (const Progress& progress : {Progress(), someProgress()}) {
    JournalWriter writer(path_, "/grinder");
    expectSame(writer.status().on_disk, progress);
    EXPECT_EQ(writer.status().number, 0U);
    EXPECT_EQ(writer.status().error, "");
    EXPECT_THROW(JournalWriter(path_, "/second"), JournalOwned);
    waitForWrite(writer, writer.write(someProgress()));
  }
}

TEST_F(JournalWriterTest, ReportsADamagedJournalAndAFailedWriteUntilOneIsWritten) {
  fill(path_, "nothing of a journal");
  JournalWriter writer(path_, "/grinder");
  const std::string damage = "journal " + path_ + ": its checksum is missing";
  expectSame(writer.status().on_disk, Progress());
  EXPECT_EQ(writer.status().error, damage);
  EXPECT_EQ(writer.status().damage, damage);
  std::filesystem::create_directory(path_ + ".new");
  waitForWrite(writer, writer.write(someProgress()));
  EXPECT_EQ(writer.status().damage, damage);
  EXPECT_NE(writer.status().error.find("Is a directory"), std::string::npos) << writer.status().error;
  expectSame(writer.status().on_disk, Progress());
  std::filesystem::remove(path_ + ".new");
  waitForWrite(writer, writer.write(someProgress()));
  EXPECT_EQ(writer.status().error, "");
  EXPECT_EQ(writer.status().damage, "");
  expectSame(writer.status().on_disk, someProgress());
}

// As after a start as root, which leaves its files to root.
TEST_F(JournalWriterTest, WhatCouldNotBeReadIsNotWrittenOver) {
  Journal(path_, "/grinder").write(someProgress());
  const std::string before = contentOf(path_);
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  std::filesystem::permissions(path_ + ".lock", std::filesystem::perms::all);
  std::optional<JournalWriter> writer;
  const std::string error = "journal " + path_ + ": " + path_ + ": Permission denied";
  {
    const Forbidden forbidden(path_);
    writer.emplace(path_, "/grinder");
    EXPECT_EQ(writer->status().error, error);
    EXPECT_EQ(writer->status().damage, "");
    waitForWrite(*writer, writer->write(Progress()));
    EXPECT_EQ(writer->status().error, error);
  }
  EXPECT_EQ(contentOf(path_), before);
  waitForWrite(*writer, writer->write(Progress()));
  EXPECT_EQ(writer->status().error, error + "; it can be read now: start the grinder again");
  EXPECT_EQ(contentOf(path_), before);
}

TEST_F(JournalWriterTest, AFolderThatIsThereLaterIsUsed) {
  fill(folder_ + "/file", "");
  JournalWriter writer(folder_ + "/file/journal", "/grinder");
  EXPECT_NE(writer.status().error, "");
  std::filesystem::remove(folder_ + "/file");
  waitForWrite(writer, writer.write(someProgress()));
  EXPECT_EQ(writer.status().error, "");
  expectSame(writer.status().on_disk, someProgress());
}

TEST_F(JournalWriterTest, NobodyWaitsForTheDiskAndTheNewestWins) {
  Journal(path_, "/grinder").write(progressAt(-1));
  const std::string before = contentOf(path_);
  constexpr int kWrites = 1000;
  {
    JournalWriter writer(path_, "/grinder");
    slowDown("100");
    EXPECT_EQ(writer.write(progressAt(1)), 1U);
    ASSERT_EQ(writer.status().number, 0U);
    waitForDisk();
    for (int i = 2; i <= kWrites; ++i) EXPECT_EQ(writer.write(progressAt(i)), static_cast<std::uint64_t>(i));
    EXPECT_EQ(writer.status().number, 0U);
    expectSame(writer.status().on_disk, progressAt(-1));
    EXPECT_EQ(contentOf(path_), before);
    // One after another they would take more time than is waited here.
    slowDown("0.1");
    waitForWrite(writer, kWrites);
    expectSame(writer.status().on_disk, progressAt(kWrites));
  }
  expectSame(Journal(path_, "/grinder").read().value(), progressAt(kWrites));
}

TEST_F(JournalWriterTest, ItsEndDoesNotWaitForADeadDisk) {
  {
    JournalWriter writer(path_, "/grinder");
    slowDown("100");
    writer.write(progressAt(1));
    waitForDisk();
    writer.write(progressAt(2));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_THROW(Journal(path_, "/second"), JournalOwned) << "it is still being written";
  slowDown("0");
  const auto isFree = [&] {
    try {
      return Journal(path_, "/second").read().has_value();
    } catch (const JournalOwned&) {
      return false;
    }
  };
  waitFor(isFree, "the disk");
  expectSame(Journal(path_, "/second").read().value(), progressAt(2));
}

TEST_F(JournalWriterTest, WritesAndQueriesMayComeFromManyThreads) {
  constexpr int kThreads = 4, kWrites = 500;
  std::vector<std::map<std::uint64_t, double>> writes(kThreads);
  {
    JournalWriter writer(path_, "/grinder");
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        std::uint64_t reported = 0;
        for (int i = 0; i < kWrites; ++i) {
          const double x = kWrites * t + i;
          writes[static_cast<std::size_t>(t)][writer.write(progressAt(static_cast<int>(x)))] = x;
          const JournalWriter::Status now = writer.status();
          EXPECT_GE(now.number, reported);
          reported = now.number;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::map<std::uint64_t, double> all;
  for (const auto& of_thread : writes) all.insert(of_thread.begin(), of_thread.end());
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kThreads * kWrites)) << "two writes had one number";
  EXPECT_EQ(all.rbegin()->first, static_cast<std::uint64_t>(kThreads * kWrites));
  EXPECT_EQ(Journal(path_, "/grinder").read().value().x, all.rbegin()->second) << "the newest is not on the disk";
}

}  // namespace test_journal_writer
}  // namespace grinder
