#include "node/journal.h"
#include "node/journal_writer.h"

#include "journal_fixture.h"
#include "soon.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <thread>

namespace grinder {
namespace test_journal {

using namespace test_support;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class JournalFileTest : public JournalTest {
 protected:
  /// The journal's file with some progress in it.
  std::string written() {
    Journal(path_, "/grinder").write(someProgress());
    return readFile(path_);
  }

  /// What reading the content is refused with, or "read".
  std::string refusalOf(const std::string& content) {
    fill(path_, content);
    try {
      static_cast<void>(Journal(path_, "/grinder").read());
      return "read";
    } catch (const JournalError& error) {
      return error.what();
    }
  }
};

// FIPS 180-4, the examples of NIST.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256Hex("", 0), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256Hex("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(JournalFileTest, KeepsWhereThereHasBeenNoJobNorAFolder) {
  Journal journal(folder_ + "/folders/made/as needed/journal", "/grinder");
  EXPECT_FALSE(journal.read().has_value());
  journal.write(Progress());
  expectSame(journal.read().value(), Progress());
}

TEST_F(JournalFileTest, KeepsAllFiguresAndAnyName) {
  Journal journal(path_, "/grinder");
  for (const std::string name : {"", "null", "~", "true", "7", "a: b", "- a", "# a", "'", "\"", "\\", "\n", "\t",
                                 "job\nchecksum: 0\n", "{", "%", "größe", "\x01"}) {
    Progress progress = someProgress();
    progress.job_name = progress.job_digest = name;
    journal.write(progress);
    expectSame(journal.read().value(), progress);
  }
}

TEST_F(JournalFileTest, AFlippedBitOfAnyByteIsRefused) {
  const std::string good = written();
  ASSERT_GT(good.size(), 300U);
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ (1 << byte % 8));
    const std::string refusal = refusalOf(bad);
    ASSERT_EQ(refusal.rfind("journal " + path_ + ": its checksum is ", 0), 0U) << "byte " << byte << ": " << refusal;
  }
}

TEST_F(JournalFileTest, EveryShorterAndEveryLongerFileIsRefused) {
  const std::string good = written();
  for (std::size_t size = 0; size < good.size(); ++size) {
    ASSERT_NE(refusalOf(good.substr(0, size)).find("its checksum is"), std::string::npos) << size;
  }
  EXPECT_EQ(refusalOf(good), "read");
  for (const char more : {'\0', '\n', ' ', 'x'}) EXPECT_NE(refusalOf(good + more), "read");
  EXPECT_NE(refusalOf(good + good).find("its checksum is wrong"), std::string::npos);
}

TEST_F(JournalFileTest, WhatNoJournalWroteIsRefused) {
  std::string binary;
  for (int byte = 0; byte < 256; ++byte) binary += static_cast<char>(byte);
  const std::string without_checksum = "job_digest: \"0123\"\nfinished: false\ntooth: 0\npass: 0\nx_m: 0\n";
  for (const std::string& content : {binary, without_checksum}) {
    EXPECT_EQ(refusalOf(content), "journal " + path_ + ": its checksum is missing");
  }
  EXPECT_EQ(refusalOf(std::string(1 << 20, ' ')), "journal " + path_ + ": is longer than 65536 bytes");
}

TEST_F(JournalFileTest, WrongFiguresAreRefusedUnderARightChecksumToo) {
  const std::string good = written();
  const std::string body = good.substr(0, good.rfind("checksum: "));
  ASSERT_EQ(refusalOf(sealed(body)), "read");
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
      {"finished", "finished: perhaps\n", "bad conversion"},
      {"x_m", "x_m: .nan\n", "x_m = nan; allowed: a finite number"},
      {"x_m", "x_m: -.inf\n", "x_m = -inf; allowed: a finite number"},
      {"x_m", "x_m: 1e999\n", ""},
      {"lift_m", "lift_m: .inf\n", "lift_m = inf"},
      {"offset_y_m", "offset_y_m: .nan\n", "offset_y_m = nan; allowed: a finite number"},
      {"offset_a_rad", "", "offset_a_rad is missing"},
      {"end_diameter_m", "end_diameter_m: .nan\n", "end_diameter_m = nan"},
      {"tooth_angles_rad", "tooth_angles_rad: [0, .nan, 2]\n", "tooth_angles_rad = nan"},
      {"tooth_angles_rad", "tooth_angles_rad: []\n", "tooth = 2; allowed: 0 to 0"},
      {"", "- a list\n", ""},
      {"", "a word\n", ""},
      {"", "", ""},
  };
  for (const auto& wrong : lines) {
    const std::string bad = wrong.key.empty() ? wrong.replacement : withLine(body, wrong.key, wrong.replacement);
    const std::string refusal = refusalOf(sealed(bad));
    EXPECT_NE(refusal, "read") << wrong.replacement;
    EXPECT_NE(refusal.find(wrong.refusal), std::string::npos) << wrong.replacement << ": " << refusal;
  }
}

TEST_F(JournalFileTest, WhatCouldNotBeReadIsNotWritten) {
  const std::string good = written();
  Journal journal(path_, "/grinder");
  const std::vector<std::function<void(Progress&, double)>> figures = {
      [](Progress& p, double v) { p.x = v; },
      [](Progress& p, double v) { p.wheel.clear_y = v; },
      [](Progress& p, double v) { p.wheel.lift = v; },
      [](Progress& p, double v) { p.offset[kZ] = v; },
      [](Progress& p, double v) { p.tooth_angles[1] = v; },
      [](Progress& p, double v) { p.cutter.end_diameter = v; },
      [](Progress& p, double v) { p.cutter.cone_angle = v; },
      [](Progress& p, double v) { p.cutter.spiral_angle = v; },
      [](Progress& p, double v) { p.cutter.rake_angle = v; },
      [](Progress& p, double v) { p.cutter.flute_length = v; },
      [](Progress& p, double) { p.next.tooth = 3; },
      [](Progress& p, double) { p.next.tooth = -1; },
      [](Progress& p, double) { p.next.pass = kMaxPasses; },
      [](Progress& p, double) { p.next.pass = -1; },
      [](Progress& p, double) { p.tooth_angles.resize(kMaxTeeth + 1); },
      [](Progress& p, double) { p.job_name.resize(1 << 16); },
  };
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    for (const auto& set : figures) {
      Progress progress = someProgress();
      set(progress, value);
      EXPECT_THROW(journal.write(progress), JournalError) << &set - figures.data();
    }
  }
  EXPECT_EQ(readFile(path_), good);
}

/// That the path costs the journal, and nothing else.
void expectUnusable(const std::string& path) {
  const Journal journal(path, "/grinder");
  for (const std::function<void()>& use : {std::function<void()>([&] { journal.read(); }),
                                           std::function<void()>([&] { journal.write(someProgress()); })}) {
    try {
      use();
      ADD_FAILURE() << path << " is used";
    } catch (const JournalOwned& error) {
      ADD_FAILURE() << error.what();
    } catch (const JournalError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("journal " + path + ": ", 0), 0U) << error.what();
    }
  }
}

TEST_F(JournalFileTest, PathsThatCannotBeUsedAreRefusedByReadAndWrite) {
  std::filesystem::create_directory(folder_ + "/folder");
  std::filesystem::create_symlink("loop", folder_ + "/loop");
  std::filesystem::create_symlink("/dev/full", folder_ + "/device");
  fill(folder_ + "/file", "");
  for (const char* fifo : {"/fifo", "/a.lock", "/b.new"}) ASSERT_EQ(mkfifo((folder_ + fifo).c_str(), 0600), 0);
  for (const std::string& name :
       {std::string("/folder"), std::string("/folder/"), std::string("/loop"), std::string("/loop/journal"),
        std::string("/fifo"), std::string("/device"), std::string("/a"), std::string("/file/journal"),
        "/" + std::string(252, 'n'), "/" + std::string(256, 'n'),
        "/" + std::string(5000, '/') + "journal/" + std::string(5000, 'x')}) {
    expectUnusable(folder_ + name);
  }
  EXPECT_THROW(Journal(folder_ + "/b", "/grinder").write(someProgress()), JournalError);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ + "/fifo"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/folder.lock"));
}

TEST_F(JournalFileTest, ForbiddenFoldersAreRefusedByReadAndWrite) {
  std::filesystem::create_directory(folder_ + "/forbidden");
  const Forbidden now(folder_ + "/forbidden");
  expectUnusable(folder_ + "/forbidden/journal");
}

// As root's is by others, and every one on a disk that is mounted read-only.
TEST_F(JournalFileTest, IsReadByWhoMayNotWriteIt) {
  written();
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  const Forbidden lock(path_ + ".lock", std::filesystem::perms{0444});
  const Journal journal(path_, "/grinder");
  expectSame(journal.read().value(), someProgress());
  EXPECT_THROW(Journal(path_, "/second"), JournalOwned);
}

/// That the journal is refused to whoever comes now, with the one who has it.
void expectOwned(const std::string& path, const std::string& owner, pid_t process) {
  try {
    const Journal second(path, "/second");
    ADD_FAILURE() << "it has two owners";
  } catch (const JournalOwned& error) {
    EXPECT_EQ(std::string(error.what()), "journal " + path + " is in use by node " + owner + ", process " +
                                             std::to_string(process) +
                                             "; allowed: a journal of its own for every node");
  }
}

TEST_F(JournalFileTest, BelongsToOneAtATime) {
  std::filesystem::create_directory(folder_ + "/real");
  std::filesystem::create_directory_symlink("real", folder_ + "/other");
  path_ = folder_ + "/real/journal";
  fill(path_ + ".lock", "node /a_longer_name_of_one_who_has_ended, process 4000000\n");
  {
    const Journal first(path_, "/left/grinder");
    expectOwned(path_, "/left/grinder", getpid());
    expectOwned(folder_ + "/other/journal", "/left/grinder", getpid());
    expectOwned(folder_ + "/real/../other/./journal", "/left/grinder", getpid());
    first.write(someProgress());
    expectOwned(path_, "/left/grinder", getpid());
  }
  const Journal next(path_, "/right/grinder");
  expectSame(next.read().value(), someProgress());
  expectOwned(path_, "/right/grinder", getpid());
}

TEST_F(JournalFileTest, BelongsToOneProcessUntilThatIsKilled) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const Journal first(path_, "/first");
    static_cast<void>(write(ready[1], "x", 1));
    while (true) pause();
  }
  char got = 0;
  ASSERT_EQ(read(ready[0], &got, 1), 1);
  expectOwned(path_, "/first", child);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  Journal(path_, "/second").write(someProgress());
}

TEST_F(JournalFileTest, AFileOnALinkIsReplacedWhereItIs) {
  written();
  std::filesystem::create_symlink("journal", folder_ + "/link");
  Progress other = someProgress();
  other.x = 1;
  Journal(folder_ + "/link", "/grinder").write(other);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ + "/link"));
  expectSame(Journal(path_, "/grinder").read().value(), other);
}

Progress progressAt(int x) {
  Progress progress = someProgress();
  progress.x = x;
  return progress;
}

/// The disk is as slow as the tests say (slow_fsync.c).
class JournalWriterTest : public JournalTest {
 protected:
  JournalWriterTest() { setenv("SLOW_FSYNC", (folder_ + "/seconds").c_str(), 1); }
  ~JournalWriterTest() override { unsetenv("SLOW_FSYNC"); }

  void slowDown(const std::string& seconds) {
    fill(folder_ + "/other_seconds", seconds);
    std::filesystem::rename(folder_ + "/other_seconds", folder_ + "/seconds");
  }

  static void waitForWrite(const JournalWriter& writer, std::uint64_t number) {
    EXPECT_TRUE(soon([&] { return writer.status().number >= number; }));
  }

  /// Waits until the disk is busy with the first write.
  void waitForDisk() {
    EXPECT_TRUE(soon([this] { return std::filesystem::exists(path_ + ".new"); }));
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

TEST_F(JournalWriterTest, AnEntryCountsOnceItsFolderIsSynchronizedToo) {
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  JournalWriter writer(path_, "/grinder");
  std::filesystem::permissions(path_ + ".lock", std::filesystem::perms::all);
  {
    // It takes files, but cannot be opened.
    const Forbidden forbidden(folder_, std::filesystem::perms::all & ~std::filesystem::perms(0444));
    waitForWrite(writer, writer.write(someProgress()));
    EXPECT_TRUE(std::filesystem::exists(path_));
    EXPECT_EQ(writer.status().error, "journal " + path_ + ": " + folder_ + ": Permission denied");
    expectSame(writer.status().on_disk, Progress());
  }
  waitForWrite(writer, writer.write(someProgress()));
  EXPECT_EQ(writer.status().error, "");
  expectSame(writer.status().on_disk, someProgress());
}

// As after a start as root, which leaves its files to root.
TEST_F(JournalWriterTest, WhatCouldNotBeReadIsNotWrittenOver) {
  Journal(path_, "/grinder").write(someProgress());
  const std::string before = readFile(path_);
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
  EXPECT_EQ(readFile(path_), before);
  waitForWrite(*writer, writer->write(Progress()));
  EXPECT_EQ(writer->status().error, error + "; it can be read now: start the grinder again");
  EXPECT_EQ(readFile(path_), before);
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
  const std::string before = readFile(path_);
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
    EXPECT_EQ(readFile(path_), before);
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
  EXPECT_TRUE(soon(isFree));
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

}  // namespace test_journal
}  // namespace grinder
