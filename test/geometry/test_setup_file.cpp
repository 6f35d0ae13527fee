// A set-up written into its job's file, or nothing.

#include "flute_grinder/geometry/setup_file.h"

#include "flute_grinder/curve/units.h"

#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

namespace grinder {
namespace test_setup_file {

namespace fs = std::filesystem;
using test_support::readFile;

constexpr Range kMachine{-60 * units::kDegree, 60 * units::kDegree};

class SetupFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string text = readFile("jobs/paper.yaml");
    text.replace(text.find("32.34"), 5, "31");
    write(text);
    fs::permissions(job_, fs::perms(0640));
  }

  void write(const std::string& text) const { std::ofstream(job_, std::ios::binary) << text; }

  JobSetup setup() const {
    return std::get<JobSetup>(solveJobSetup(readJobFile(job_, unsolvedFields({})), kMachine, std::nullopt));
  }
  std::ptrdiff_t filesInFolder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  static std::string refusal(const fs::path& path, const JobSetup& setup) {
    try {
      writeSetup(path, setup);
    } catch (const JobFileError& error) {
      return error.what();
    }
    return "";
  }

  const test_support::TempFolder temp_;
  const fs::path folder_ = temp_.path();
  const fs::path job_ = folder_ / "job.yaml";
};

TEST_F(SetupFile, IsReadBackAsSolved) {
  const JobSetup solved = setup();
  const std::string before = readFile(job_);
  writeSetup(job_, solved);
  const GrindJob read = readJobFile(job_);
  EXPECT_EQ(read.process.setup_swivel, solved.job.process.setup_swivel);
  EXPECT_EQ(read.process.setup_height, solved.job.process.setup_height);
  EXPECT_NE(readFile(job_), before);
  const std::regex number("-?[0-9.]+");
  EXPECT_EQ(std::regex_replace(readFile(job_), number, "#"), std::regex_replace(before, number, "#"));
  EXPECT_EQ(readFile(job_.string() + ".before"), before);
  EXPECT_EQ(filesInFolder(), 2);
  EXPECT_EQ(fs::status(job_).permissions(), fs::perms(0640));
}

TEST_F(SetupFile, WhatChangesIsSaid) {
  const std::string changes = changesText(job_, setup());
  EXPECT_NE(changes.find("  process.setup.swivel_deg        31 in the file, 32.34"), std::string::npos) << changes;
  EXPECT_NE(changes.find(" solved: +1.34"), std::string::npos) << changes;
  std::string text = readFile(job_);
  const std::string figures = "  setup: {swivel_deg: 31, height_mm: 5.882, x_shift_mm: 11.853}\n";
  text.erase(text.find(figures), figures.size());
  write(text);
  EXPECT_NE(changesText(job_, setup()).find("swivel_deg        not in the file, 32.3"), std::string::npos);
}

TEST_F(SetupFile, ALinkToItStays) {
  const fs::path link = folder_ / "link.yaml";
  fs::create_symlink("job.yaml", link);
  writeSetup(link, setup());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_NE(readFile(job_).find("32.34"), std::string::npos);
}

TEST_F(SetupFile, AFileThatHasChangedIsLeft) {
  const JobSetup solved = setup();
  std::string text = readFile(job_);
  text.replace(text.find("rake_angle_deg: 8"), 17, "rake_angle_deg: 9");
  write(text);
  const std::string said = refusal(job_, solved);
  EXPECT_NE(said.find("has changed"), std::string::npos) << said;
  EXPECT_NE(said.find("process.setup.swivel_deg: 32.34"), std::string::npos) << said;
  EXPECT_EQ(readFile(job_), text);
}

TEST_F(SetupFile, OneThatCannotBeEditedIsLeftAndTheFiguresAreReported) {
  std::string text = readFile(job_);
  text.replace(text.find("swivel_deg: "), 12, "swivel_deg: !!float ");
  write(text);
  const std::string said = refusal(job_, setup());
  EXPECT_NE(said.find(":35: has a value that is not written as a plain number"), std::string::npos) << said;
  EXPECT_NE(said.find("process.setup.height_mm: 5.88"), std::string::npos) << said;
  EXPECT_EQ(readFile(job_), text);
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(SetupFile, AFileThatIsGoneIsNotMade) {
  const JobSetup solved = setup();
  const std::string said = refusal(folder_ / "missing.yaml", solved);
  EXPECT_NE(said.find("missing.yaml: cannot be read"), std::string::npos) << said;
  EXPECT_EQ(filesInFolder(), 1);
}

}  // namespace test_setup_file
}  // namespace grinder
