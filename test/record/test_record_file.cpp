#include "flute_grinder/base/file_error.h"
#include "flute_grinder/record/record_file.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

/// @file
/// A record that was cut off at any byte, or changed in any, is none; its head is read without the rest.

namespace grinder {
namespace test_record_file {

Record record() {
  Record record;
  record.head.started = "2026-11-22T17:04:13.123Z";
  record.head.job = "a \"job\" {[,\n\x1b[2J";
  record.head.outcome = "done";
  record.head.strokes = 4;
  record.head.duration = 12.5;
  record.head.holds = 3;
  record.head.setpoints = 12500;
  record.head.lost = 2;
  record.head.verdict = "incomplete";
  record.head.because = {"rake: not measured", "core \x1b"};
  record.body = {{"criteria", Json::array()}, {"not_ground", "by \x1b"}};
  return record;
}

class RecordFile : public ::testing::Test {
 protected:
  const std::string& write(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  /// What is said of a text, without its path.
  template <typename Read>
  std::string refused(const std::string& text, const Read& read) {
    try {
      read(write(text));
    } catch (const FileError& error) {
      const std::string said = error.what(), named = path_ + ": is no record of a job: ";
      EXPECT_EQ(said.substr(0, named.size()), named);
      return said.substr(std::min(said.size(), named.size()));
    }
    return "";
  }

  const test_support::TempFolder folder_;
  const std::string path_ = folder_.path() / "record.json";
};

TEST_F(RecordFile, IsReadAsItWasWrittenAndIsOneObjectForOtherReaders) {
  const Record read = readRecord(write(text(record())));
  EXPECT_TRUE(isRecord(path_));
  EXPECT_EQ(read.head.job, "a \"job\" {[,\\n\\x1b[2J");
  EXPECT_EQ(read.head.because, (std::vector<std::string>{"rake: not measured", "core \\x1b"}));
  EXPECT_EQ(read.body["not_ground"], "by \\x1b");
  EXPECT_EQ(toJson(readHead(path_)), toJson(read.head));
  EXPECT_EQ(read.head.strokes, 4U);
  EXPECT_EQ(read.head.duration, 12.5);
  EXPECT_EQ(read.head.holds, 3U);
  EXPECT_EQ(read.head.setpoints, 12500U);
  EXPECT_EQ(read.head.lost, 2U);
  const Json whole = Json::parse(text(record()));
  EXPECT_EQ(whole["record"], 2);
  EXPECT_EQ(whole["head"]["outcome"], "done");
}

TEST_F(RecordFile, CutOffAtAnyByteIsRefusedAndTheHeadIsReadWhereItIsWhole) {
  const std::string whole = text(record());
  const std::size_t head = whole.find('\n') + 1;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(readRecord(write(whole.substr(0, size))), FileError) << size;
    if (size < head) {
      EXPECT_THROW(readHead(path_), FileError) << size;
    } else {
      EXPECT_EQ(readHead(path_).outcome, "done") << size;
    }
  }
}

TEST_F(RecordFile, ChangedInAnyByteIsRefused) {
  const std::string whole = text(record());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = changed[i] == 'x' ? 'y' : 'x';
    EXPECT_THROW(readRecord(write(changed)), FileError) << i;
  }
  EXPECT_EQ(refused(whole + "\n", readRecord), "its seal is not that of its text: it is cut off, or was changed");
}

TEST_F(RecordFile, HeadThatLacksAFieldOrHasAnotherTypeNamesIt) {
  const std::string whole = text(record());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = whole;
    changed.replace(changed.find(from), from.size(), to);
    return refused(changed, readHead);
  };
  EXPECT_EQ(with("\"strokes\":4", "\"strokes\":\"all\""), "strokes = \"all\", which is of another type");
  EXPECT_EQ(with("\"verdict\"", "\"judged\""), "verdict is missing");
  EXPECT_EQ(with("\"record\":2", "\"record\":1"), "it begins otherwise than {\"record\":2,\"head\":");
  EXPECT_FALSE(isRecord(write("cutter:\n")));
}

TEST_F(RecordFile, IsJudgedAgainByOtherTolerances) {
  Record kept = record();
  kept.head.lost = 0;
  Criterion land{"land", "mm", true, 3, 0.05, {}, 0.3, false, "tooth 1", ""};
  Criterion rake{"rake", "deg", true, 3, 8, 0.5, 8.4, false, "tooth 1", ""};
  kept.body["criteria"] = toJson({land, rake});
  kept.body["zero_points"]["said_right"] = false;
  Tolerances tolerances;
  tolerances.land_mm = 0.3;
  EXPECT_TRUE(judgeAgain(kept, nullptr, tolerances));
  EXPECT_EQ(kept.head.verdict, "passed");
  EXPECT_FALSE(judgeAgain(kept, nullptr, tolerances));
  tolerances.land_mm = 0.31;
  EXPECT_TRUE(judgeAgain(kept, nullptr, tolerances));
  EXPECT_EQ(kept.head.verdict, "failed");
  EXPECT_EQ(kept.head.because, std::vector<std::string>{"land"});
  EXPECT_EQ(kept.body["criteria"][1]["result"], "passed");
  tolerances.land_mm = 0;
  kept.body["zero_points"]["said_right"] = true;
  EXPECT_TRUE(judgeAgain(kept, nullptr, tolerances));
  EXPECT_EQ(kept.head.verdict, "incomplete");
  EXPECT_EQ(kept.head.because, std::vector<std::string>{kNoOffsetCheck});
}

}  // namespace test_record_file
}  // namespace grinder
