// A file that is replaced in one step, on a disk with files that have no name and on one without.

#include "flute_grinder/base/replace_file.h"

#include "temp_folder.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace {

bool refuses_nameless = false;

}  // namespace

/// In place of the C library's: refuses files without a name, as FAT does, if it is to.
extern "C" int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (refuses_nameless && (flags & O_TMPFILE) == O_TMPFILE) {
    errno = EOPNOTSUPP;
    return -1;
  }
  static const auto real = reinterpret_cast<int (*)(const char*, int, ...)>(::dlsym(RTLD_NEXT, "open"));
  return real(path, flags, mode);
}

namespace grinder {
namespace test_replace_file {

namespace fs = std::filesystem;
using test_support::readFile;

class FileReplacements : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override { refuses_nameless = GetParam(); }
  void TearDown() override { refuses_nameless = false; }

  std::ptrdiff_t filesInFolder() const {
    return std::distance(fs::directory_iterator(temp_.path()), fs::directory_iterator());
  }

  const test_support::TempFolder temp_;
  const fs::path file_ = fs::path(temp_.path()) / "file";
};

TEST_P(FileReplacements, OldContentsStayUntilTheEndAndNoOtherFileIsTaken) {
  const std::string other = file_.string() + ".0.new";
  std::ofstream(other) << "other";
  std::ofstream(file_) << "old";
  {
    FileReplacement fresh(file_);
    ASSERT_EQ(::write(fresh.descriptor(), "new", 3), 3);
    EXPECT_EQ(readFile(file_), "old");
    EXPECT_EQ(filesInFolder(), GetParam() ? 3 : 2);
    fresh.commit();
  }
  EXPECT_EQ(readFile(file_), "new");
  EXPECT_EQ(readFile(other), "other");
  EXPECT_EQ(filesInFolder(), 2);
}

TEST_P(FileReplacements, NothingIsLeftWithoutTheEnd) {
  {
    const FileReplacement fresh(file_);
    ASSERT_EQ(::write(fresh.descriptor(), "new", 3), 3);
    EXPECT_FALSE(fs::exists(file_));
  }
  EXPECT_EQ(filesInFolder(), 0);
}

TEST_P(FileReplacements, WhatCannotBeDoneIsSaid) {
  EXPECT_THROW(FileReplacement fresh(file_ / "none"), std::system_error);
  fs::create_symlink(file_.filename(), file_);
  EXPECT_THROW(FileReplacement fresh(file_), std::system_error);
}

INSTANTIATE_TEST_SUITE_P(Disks, FileReplacements, ::testing::Bool());

}  // namespace test_replace_file
}  // namespace grinder
