#include "flute_grinder/node/journal_keeper.h"

#include "journal_fixture.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <thread>

namespace flute_grinder {
namespace {

using namespace test_support;

Progress progressAt(int x) {
  Progress progress = someProgress();
  progress.x = x;
  return progress;
}

/// The disk is as slow as the tests say (slow_fsync.c).
class JournalKeeperTest : public test_support::JournalTest {
 protected:
  JournalKeeperTest() { setenv("SLOW_FSYNC", (folder_ + "/seconds").c_str(), 1); }
  ~JournalKeeperTest() override { unsetenv("SLOW_FSYNC"); }

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

  static void waitForOrder(const JournalKeeper& keeper, std::uint64_t number) {
    waitFor([&] { return keeper.told().number >= number; }, "the order's end");
  }

  /// Waits until the disk is busy with the first write.
  void waitForDisk() {
    waitFor([&] { return std::filesystem::exists(path_ + ".new"); }, "the write");
  }
};

TEST_F(JournalKeeperTest, TellsWhatIsThereAtTheStart) {
  Journal(path_, "/grinder").write(someProgress());
  const JournalKeeper keeper(path_, "/grinder");
  expectSame(keeper.told().on_disk, someProgress());
  EXPECT_EQ(keeper.told().number, 0U);
  EXPECT_EQ(keeper.told().error, "");
}

TEST_F(JournalKeeperTest, TellsThatNothingIsThere) {
  const JournalKeeper keeper(path_, "/grinder");
  expectSame(keeper.told().on_disk, Progress());
  EXPECT_EQ(keeper.told().error, "");
}

TEST_F(JournalKeeperTest, TellsAJournalThatCannotBeReadUntilOneIsWritten) {
  fill(path_, "nothing of a journal");
  JournalKeeper keeper(path_, "/grinder");
  expectSame(keeper.told().on_disk, Progress());
  EXPECT_EQ(keeper.told().error, "journal " + path_ + ": its checksum is missing");
  waitForOrder(keeper, keeper.write(someProgress()));
  EXPECT_EQ(keeper.told().error, "");
  expectSame(keeper.told().on_disk, someProgress());
}

TEST_F(JournalKeeperTest, ASecondOneIsRefused) {
  const JournalKeeper keeper(path_, "/grinder");
  EXPECT_THROW(JournalKeeper(path_, "/second"), JournalOwned);
}

TEST_F(JournalKeeperTest, NobodyWaitsForTheDiskAndTheNewestWins) {
  Journal(path_, "/grinder").write(progressAt(-1));
  const std::string before = contentOf(path_);
  constexpr int kOrders = 1000;
  {
    JournalKeeper keeper(path_, "/grinder");
    slowDown("100");
    EXPECT_EQ(keeper.write(progressAt(1)), 1U);
    ASSERT_EQ(keeper.told().number, 0U);
    waitForDisk();
    for (int i = 2; i <= kOrders; ++i) EXPECT_EQ(keeper.write(progressAt(i)), static_cast<std::uint64_t>(i));
    EXPECT_EQ(keeper.told().number, 0U);
    expectSame(keeper.told().on_disk, progressAt(-1));
    EXPECT_EQ(contentOf(path_), before);
    // One after another they would take more time than is waited here.
    slowDown("0.1");
    waitForOrder(keeper, kOrders);
    expectSame(keeper.told().on_disk, progressAt(kOrders));
  }
  expectSame(Journal(path_, "/grinder").read().value(), progressAt(kOrders));
}

TEST_F(JournalKeeperTest, WhatIsToldIsOnTheDisk) {
  JournalKeeper keeper(path_, "/grinder");
  for (int i = 1; i <= 100; ++i) {
    waitForOrder(keeper, keeper.write(progressAt(i)));
    ASSERT_NE(contentOf(path_).find("x_m: " + std::to_string(i) + "\n"), std::string::npos);
  }
}

TEST_F(JournalKeeperTest, ItsEndWritesWhatIsOrdered) {
  {
    JournalKeeper keeper(path_, "/grinder");
    slowDown("0.1");
    for (int i = 1; i <= 3; ++i) keeper.write(progressAt(i));
  }
  expectSame(Journal(path_, "/grinder").read().value(), progressAt(3));
}

TEST_F(JournalKeeperTest, ItsEndDoesNotWaitForADeadDisk) {
  {
    JournalKeeper keeper(path_, "/grinder");
    slowDown("100");
    keeper.write(progressAt(1));
    waitForDisk();
    keeper.write(progressAt(2));
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

TEST_F(JournalKeeperTest, AWriteThatFailsIsToldUntilOneIsDone) {
  JournalKeeper keeper(path_, "/grinder");
  waitForOrder(keeper, keeper.write(progressAt(1)));
  std::filesystem::create_directory(path_ + ".new");
  waitForOrder(keeper, keeper.write(progressAt(2)));
  EXPECT_NE(keeper.told().error.find("Is a directory"), std::string::npos) << keeper.told().error;
  expectSame(keeper.told().on_disk, progressAt(1));
  std::filesystem::remove(path_ + ".new");
  waitForOrder(keeper, keeper.write(progressAt(3)));
  EXPECT_EQ(keeper.told().error, "");
  expectSame(keeper.told().on_disk, progressAt(3));
}

TEST_F(JournalKeeperTest, ManyMayOrderAndAskAtOnce) {
  constexpr int kThreads = 4, kOrders = 500;
  std::vector<std::map<std::uint64_t, double>> orders(kThreads);
  {
    JournalKeeper keeper(path_, "/grinder");
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        std::uint64_t told = 0;
        for (int i = 0; i < kOrders; ++i) {
          const double x = kOrders * t + i;
          orders[static_cast<std::size_t>(t)][keeper.write(progressAt(static_cast<int>(x)))] = x;
          const JournalKeeper::Told now = keeper.told();
          EXPECT_GE(now.number, told);
          told = now.number;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::map<std::uint64_t, double> all;
  for (const auto& of_thread : orders) all.insert(of_thread.begin(), of_thread.end());
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kThreads * kOrders)) << "two orders had one number";
  EXPECT_EQ(all.rbegin()->first, static_cast<std::uint64_t>(kThreads * kOrders));
  EXPECT_EQ(Journal(path_, "/grinder").read().value().x, all.rbegin()->second) << "the newest is not on the disk";
}

}  // namespace
}  // namespace flute_grinder
