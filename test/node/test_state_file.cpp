#include "node/journal.h"

#include "refusal.h"
#include "soon.h"
#include "state_file_fixture.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

// How a state file is kept; what is written in the background, by the journal.
namespace grinder {
namespace test_state_file {

using namespace test_support;

const std::string kText = "key: value\n";

class SealedFileTest : public StateFileTest {
 protected:
  static SealedFile open(const std::string& path, const std::string& owner = "/grinder") {
    return {"journal", path, owner};
  }

  /// The file with a text in it.
  std::string written() {
    open(path_).write(kText, false);
    return readFile(path_);
  }

  /// What reading the content is refused with, or what is read.
  std::string reading(const std::string& content) {
    fill(path_, content);
    try {
      return open(path_).read().value();
    } catch (const StateFileDamaged& error) {
      return error.what();
    }
  }
};

// FIPS 180-4, the examples of NIST.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256Hex("", 0), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256Hex("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(SealedFileTest, KeepsATextWhereThereHasBeenNoneNorAFolder) {
  SealedFile file = open(folder_ + "/folders/made/as needed/state");
  EXPECT_FALSE(file.read().has_value());
  file.write(kText, false);
  EXPECT_EQ(file.read(), kText);
}

TEST_F(SealedFileTest, WhatWasNotSealedAsItIsIsRefused) {
  const std::string good = written(), damaged = "journal " + path_ + ": its checksum is ";
  EXPECT_EQ(reading(good), kText);
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    std::string flipped = good;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << byte % 8));
    for (const std::string& bad : {flipped, good.substr(0, byte)}) {
      const std::string refusal = reading(bad);
      ASSERT_EQ(refusal.rfind(damaged, 0), 0U) << "byte " << byte << ": " << refusal;
    }
  }
  for (const char more : {'\0', '\n', ' ', 'x'}) EXPECT_NE(reading(good + more), kText);
  EXPECT_EQ(reading(good + good), damaged + "wrong: the file was damaged or changed");
  std::string binary;
  for (int byte = 0; byte < 256; ++byte) binary += static_cast<char>(byte);
  for (const std::string& content : {binary, std::string("job_digest: \"0123\"\nfinished: false\n")}) {
    EXPECT_EQ(reading(content), damaged + "missing");
  }
  EXPECT_EQ(reading(std::string(1 << 20, ' ')), "journal " + path_ + ": is longer than 65536 bytes");
}

/// That the path costs the file, and nothing else.
void expectUnusable(const std::string& path) {
  SealedFile file("journal", path, "/grinder");
  const std::function<void()> uses[]{[&] { file.read(); }, [&] { file.write(kText, false); }};
  for (const auto& use : uses) {
    EXPECT_EQ(refusalOf<StateFileError>(use).rfind("journal " + path + ": ", 0), 0U) << path;
  }
}

TEST_F(SealedFileTest, PathsThatCannotBeUsedAreRefusedByReadAndWrite) {
  std::filesystem::create_directory(folder_ + "/folder");
  std::filesystem::create_symlink("loop", folder_ + "/loop");
  std::filesystem::create_symlink("/dev/full", folder_ + "/device");
  fill(folder_ + "/file", "");
  for (const char* fifo : {"/fifo", "/a.lock", "/b.new"}) ASSERT_EQ(mkfifo((folder_ + fifo).c_str(), 0600), 0);
  for (const std::string& name :
       {std::string("/folder"), std::string("/folder/"), std::string("/loop"), std::string("/loop/state"),
        std::string("/fifo"), std::string("/device"), std::string("/a"), std::string("/file/state"),
        "/" + std::string(252, 'n'), "/" + std::string(256, 'n'),
        "/" + std::string(5000, '/') + "journal/" + std::string(5000, 'x')}) {
    expectUnusable(folder_ + name);
  }
  EXPECT_THROW(open(folder_ + "/b").write(kText, false), StateFileError);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ + "/fifo"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/folder.lock"));
  const Forbidden folder(folder_ + "/folder");
  expectUnusable(folder_ + "/folder/state");
}

// As root's is by others, and every one on a disk that is mounted read-only.
TEST_F(SealedFileTest, IsReadByWhoMayNotWriteIt) {
  written();
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  const Forbidden lock(path_ + ".lock", std::filesystem::perms{0444});
  SealedFile file = open(path_);
  EXPECT_EQ(file.read(), kText);
  EXPECT_THROW(open(path_, "/second").read(), StateFileOwned);
}

/// That the file is refused to whoever comes now, with the one who has it.
void expectOwned(const std::string& path, const std::string& owner, pid_t process) {
  EXPECT_EQ(refusalOf<StateFileOwned>([&] { SealedFile("journal", path, "/second").read(); }),
            "journal " + path + " is in use by node " + owner + ", process " + std::to_string(process) +
                "; allowed: a journal of its own for every node");
}

TEST_F(SealedFileTest, BelongsToOneAtATime) {
  std::filesystem::create_directory(folder_ + "/real");
  std::filesystem::create_directory_symlink("real", folder_ + "/other");
  path_ = folder_ + "/real/state";
  fill(path_ + ".lock", "node /a_longer_name_of_one_who_has_ended, process 4000000\n");
  {
    SealedFile first = open(path_, "/left/grinder");
    first.read();
    for (const std::string& path : {path_, folder_ + "/other/state", folder_ + "/real/../other/./state"}) {
      expectOwned(path, "/left/grinder", getpid());
    }
    first.write(kText, false);
    expectOwned(path_, "/left/grinder", getpid());
  }
  SealedFile next = open(path_, "/right/grinder");
  EXPECT_EQ(next.read(), kText);
  expectOwned(path_, "/right/grinder", getpid());
}

TEST_F(SealedFileTest, BelongsToOneProcessUntilThatIsKilled) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    SealedFile first = open(path_, "/first");
    first.read();
    static_cast<void>(write(ready[1], "x", 1));
    while (true) pause();
  }
  char got = 0;
  ASSERT_EQ(read(ready[0], &got, 1), 1);
  expectOwned(path_, "/first", child);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  open(path_, "/second").write(kText, false);
}

TEST_F(SealedFileTest, AFileOnALinkIsReplacedWhereItIs) {
  written();
  std::filesystem::create_symlink("state", folder_ + "/link");
  open(folder_ + "/link").write("other: text\n", false);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ + "/link"));
  EXPECT_EQ(open(path_).read(), "other: text\n");
}

Progress progressAt(int x) {
  Progress progress;
  progress.x = x;
  return progress;
}

/// The disk is as slow as the tests say (slow_fsync.c).
class StateFileInBackgroundTest : public StateFileTest {
 protected:
  StateFileInBackgroundTest() { setenv("SLOW_FSYNC", (folder_ + "/seconds").c_str(), 1); }
  ~StateFileInBackgroundTest() override { unsetenv("SLOW_FSYNC"); }

  void slowDown(const std::string& seconds) {
    fill(folder_ + "/other_seconds", seconds);
    std::filesystem::rename(folder_ + "/other_seconds", folder_ + "/seconds");
  }

  static void waitForWrite(const Journal& journal, std::uint64_t number) {
    EXPECT_TRUE(soon([&] { return journal.status().number >= number; }));
  }
  static void writeAndWait(Journal& journal, const Progress& progress) {
    waitForWrite(journal, journal.write(progress));
  }

  /// Waits until the disk is busy with the first write.
  void waitForDisk() {
    EXPECT_TRUE(soon([this] { return std::filesystem::exists(path_ + ".new"); }));
  }
};

TEST_F(StateFileInBackgroundTest, DamageAndAFailedWriteAreReportedUntilOneSucceeds) {
  fill(path_, "nothing of a state");
  Journal journal(path_, "/grinder");
  const std::string damage = "journal " + path_ + ": its checksum is missing";
  EXPECT_EQ(journal.status().on_disk.x, 0);
  EXPECT_EQ(journal.status().error, damage);
  EXPECT_EQ(journal.status().damage, damage);
  std::filesystem::create_directory(path_ + ".new");
  writeAndWait(journal, progressAt(7));
  EXPECT_EQ(journal.status().damage, damage);
  EXPECT_NE(journal.status().error.find("Is a directory"), std::string::npos) << journal.status().error;
  EXPECT_EQ(journal.status().on_disk.x, 0);
  std::filesystem::remove(path_ + ".new");
  writeAndWait(journal, progressAt(7));
  EXPECT_EQ(journal.status().error, "");
  EXPECT_EQ(journal.status().damage, "");
  EXPECT_EQ(journal.status().on_disk.x, 7);
}

TEST_F(StateFileInBackgroundTest, AStateCountsOnceItsFolderIsSynchronizedToo) {
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  Journal journal(path_, "/grinder");
  std::filesystem::permissions(path_ + ".lock", std::filesystem::perms::all);
  {
    // It takes files, but cannot be opened.
    const Forbidden forbidden(folder_, std::filesystem::perms::all & ~std::filesystem::perms(0444));
    writeAndWait(journal, progressAt(7));
    EXPECT_TRUE(std::filesystem::exists(path_));
    EXPECT_EQ(journal.status().error, "journal " + path_ + ": " + folder_ + ": Permission denied");
    EXPECT_EQ(journal.status().on_disk.x, 0);
  }
  writeAndWait(journal, progressAt(7));
  EXPECT_EQ(journal.status().error, "");
  EXPECT_EQ(journal.status().on_disk.x, 7);
}

// As after a start as root, which leaves its files to root.
TEST_F(StateFileInBackgroundTest, WhatCouldNotBeReadIsNotWrittenOver) {
  Journal(path_, "/grinder").write(progressAt(7));
  const std::string before = readFile(path_);
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  std::filesystem::permissions(path_ + ".lock", std::filesystem::perms::all);
  std::optional<Journal> journal;
  const std::string error = "journal " + path_ + ": " + path_ + ": Permission denied";
  {
    const Forbidden forbidden(path_);
    journal.emplace(path_, "/grinder");
    EXPECT_EQ(journal->status().error, error);
    EXPECT_EQ(journal->status().damage, "");
    writeAndWait(*journal, Progress());
    EXPECT_EQ(journal->status().error, error);
  }
  EXPECT_EQ(readFile(path_), before);
  writeAndWait(*journal, Progress());
  EXPECT_EQ(journal->status().error, error + "; it can be read now: start the grinder again");
  EXPECT_EQ(readFile(path_), before);
}

TEST_F(StateFileInBackgroundTest, NobodyWaitsForTheDiskAndTheNewestWins) {
  Journal(path_, "/grinder").write(progressAt(-1));
  const std::string before = readFile(path_);
  constexpr int kWrites = 1000;
  {
    Journal journal(path_, "/grinder");
    slowDown("100");
    EXPECT_EQ(journal.write(progressAt(1)), 1U);
    ASSERT_EQ(journal.status().number, 0U);
    waitForDisk();
    for (int i = 2; i <= kWrites; ++i) EXPECT_EQ(journal.write(progressAt(i)), static_cast<std::uint64_t>(i));
    EXPECT_EQ(journal.status().number, 0U);
    EXPECT_EQ(journal.status().on_disk.x, -1);
    EXPECT_EQ(readFile(path_), before);
    // One after another they would take more time than is waited here.
    slowDown("0.1");
    waitForWrite(journal, kWrites);
    EXPECT_EQ(journal.status().on_disk.x, kWrites);
  }
  EXPECT_EQ(Journal(path_, "/grinder").status().on_disk.x, kWrites);
}

TEST_F(StateFileInBackgroundTest, ItsEndDoesNotWaitForADeadDisk) {
  {
    Journal journal(path_, "/grinder");
    slowDown("100");
    journal.write(progressAt(1));
    waitForDisk();
    journal.write(progressAt(2));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_THROW(Journal(path_, "/second"), StateFileOwned) << "it is still being written";
  slowDown("0");
  EXPECT_TRUE(soon([&] {
    return refusalOf<StateFileOwned>([&] { EXPECT_EQ(Journal(path_, "/second").status().on_disk.x, 2); }).empty();
  }));
}

TEST_F(StateFileInBackgroundTest, WritesAndQueriesMayComeFromManyThreads) {
  constexpr int kThreads = 4, kWrites = 500;
  std::map<std::uint64_t, int> writes;
  std::mutex mutex;
  {
    Journal journal(path_, "/grinder");
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        std::uint64_t reported = 0;
        std::map<std::uint64_t, int> own;
        for (int x = kWrites * t; x < kWrites * (t + 1); ++x) {
          own[journal.write(progressAt(x))] = x;
          const Journal::Status now = journal.status();
          EXPECT_GE(now.number, reported);
          reported = now.number;
        }
        const std::lock_guard<std::mutex> lock(mutex);
        writes.insert(own.begin(), own.end());
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(writes.size(), static_cast<std::size_t>(kThreads * kWrites)) << "two writes had one number";
  EXPECT_EQ(writes.rbegin()->first, static_cast<std::uint64_t>(kThreads * kWrites));
  EXPECT_EQ(Journal(path_, "/grinder").status().on_disk.x, writes.rbegin()->second) << "the newest is not on the disk";
}

}  // namespace test_state_file
}  // namespace grinder
