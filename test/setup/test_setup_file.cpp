// The set-up file of a job: written, read back, and refused where it does not fit.

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/setup/write_setup.h"

#include "jobs.h"
#include "random_cases.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>

namespace grinder {
namespace test_setup_file {

namespace fs = std::filesystem;
using test_support::readFile;

/// The operations of a shipped job, of every kind.
template <typename Use>
void forEachOperation(const Use& use) {
  for (const GrindJob& job : readJobFile("jobs/end_mill_d10_t4.yaml", "1").ofAllOperations()) {
    SCOPED_TRACE(job.operationText());
    use(job);
  }
}

std::string refusalOf(const std::string& text, GrindJob job) {
  return test_support::refusalOf([&] { takeSetup(text, "my.setup.yaml", job); });
}

TEST(SetupFile, IsReadBackToTheLastBit) {
  std::mt19937 random(20);
  const int cases = test_support::randomCases(10);
  forEachOperation([&](GrindJob job) {
    for (int i = 0; i < cases; ++i) {
      visitJobFields([&](const JobField& field, auto of) {
        if (!isOfSetup(field) || !field.isOf(job.process().kind)) return;
        const double part = random() % 1000001 / 1e6;
        // As read from a file, of any number of digits.
        of(job) = (field.min + part * (field.max - field.min)) * shopScale(field.unit);
      });
      GrindJob back = job;
      clearSetup(back);
      takeSetup(withSetup("", "my.setup.yaml", "my.yaml", job), "my.setup.yaml", back);
      visitJobFields([&](const JobField& field, auto of) { EXPECT_EQ(of(back), of(job)) << field.path; });
    }
  });
}

// The reason is named as in the job file; what only says how good the tool must be, and what Y compensates, is none.
TEST(SetupFile, IsRefusedForAnyOtherCutterOrWheel) {
  const std::set<std::string> others{"cutter.rake_tolerance_deg",
                                     "cutter.core_tolerance_mm",
                                     "cutter.spiral_tolerance_deg",
                                     "process.wheel.wear_mm",
                                     "process.wheel.rim_mm",
                                     "cutter.clearance_tolerance_deg",
                                     "cutter.chordal_rake_tolerance_deg",
                                     "process.feed_mm_min",
                                     "process.infeed_mm",
                                     "process.removal_mm3_s",
                                     "process.finish_infeed_mm",
                                     "process.clearance_mm",
                                     "process.wheel.wear_per_pass_mm",
                                     "interpolation.tolerance_um",
                                     "interpolation.rotary_scale_mm_per_rad"};
  const std::set<std::string> of_reliefs{"cutter.clearance_deg", "cutter.land_mm", "cutter.second_clearance_deg"};
  forEachOperation([&](const GrindJob& job) {
    const std::string text = withSetup("", "my.setup.yaml", "my.yaml", job);
    EXPECT_EQ(refusalOf(text, job), "");
    if (isStraight(job.process().kind)) return;  // see StraightSetup
    visitJobFields([&](const JobField& field, auto of) {
      if (!field.isOf(job.process().kind)) return;
      GrindJob other = job;
      of(other) += 0.001 * shopScale(field.unit);
      const std::string said = refusalOf(text, other);
      const std::string key = field.file_key;
      const bool of_end = key.find("cutter.end.") == 0 || key.find("cutter.chamfer.") == 0;
      const bool is_free = isOfSetup(field) || of_end || others.count(key) != 0 ||
                           (!isRelief(job.process().kind) && of_reliefs.count(key) != 0);
      const std::string named = std::string("solved for ") + field.file_key + " = ";
      EXPECT_EQ(said.find(named) == std::string::npos, is_free) << field.file_key << ": " << said;
      EXPECT_EQ(said.empty(), is_free) << field.file_key << ": " << said;
    });
    GrindJob left = job, one_tooth = job;
    left.cutter.cut = job.cutter.cut == CutDirection::kLeftHand ? CutDirection::kRightHand : CutDirection::kLeftHand;
    EXPECT_NE(refusalOf(text, left).find("solved for cutter.cut = "), std::string::npos);
    one_tooth.tooth_angles.resize(1);
    EXPECT_EQ(refusalOf(text, one_tooth), "");
  });
}

class WrittenSetup : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "jobs");
    fs::copy("jobs/end_mill_d10_t4.yaml", job_);
    fs::copy("wheels", folder_ / "wheels");
  }

  std::string refusal(const std::string& operation) const {
    return test_support::refusalOf([&] { readJobFile(job_, operation); });
  }

  void write(const char* operation) const {
    writeSetup(readJobToSetUp(job_, operation), readJobFile("jobs/end_mill_d10_t4.yaml", operation));
  }

  const test_support::TempFolder temp_;
  const fs::path folder_ = temp_.path();
  const fs::path job_ = folder_ / "jobs/mill.yaml", setup_ = folder_ / "jobs/end_mill_d10_t4.setup.yaml";
};

TEST_F(WrittenSetup, IsOneOfEachOperationInTurn) {
  const std::string missing =
      job_.string() + ":39: operations[0].setup.file = " + setup_.string() +
      ": cannot be read: No such file or directory; 'grind setup --operation flute --write' solves it";
  EXPECT_EQ(refusal("flute").substr(0, missing.size()), missing);
  EXPECT_EQ(readJobToSetUp(job_, "flute").before, std::nullopt);
  EXPECT_THROW(readJobToSetUp(job_, "primary"), FileError);
  write("flute");
  EXPECT_NE(refusal("flute").find("no set-up of the primary relief; 'grind setup --operation primary"),
            std::string::npos);
  write("primary");
  write("secondary");
  for (const char* operation : {"gash", "end_primary", "end_secondary", "chamfer"}) write(operation);
  const GrindJob all = readJobFile(job_, "1"), all_shipped = readJobFile("jobs/end_mill_d10_t4.yaml", "1");
  ASSERT_EQ(all.operations.size(), std::size(kOperationKinds));
  for (std::size_t i = 0; i < all.operations.size(); ++i) {
    const GrindProcess &written = all.operations[i], &shipped = all_shipped.operations[i];
    const char* const operation = toString(written.kind);
    EXPECT_EQ(written.setup_swivel, shipped.setup_swivel) << operation;
    EXPECT_EQ(written.setup_height, shipped.setup_height) << operation;
    EXPECT_EQ(written.depth, shipped.depth) << operation;
    EXPECT_EQ(written.overtravel_shank, shipped.overtravel_shank) << operation;
  }
}

TEST_F(WrittenSetup, DoesNotReplaceWhatIsNotItsOwn) {
  for (const std::string& other :
       {std::string("job: other.yaml\nflute: {}\n"), readFile("jobs/paper.yaml"), std::string("[1]")}) {
    std::ofstream(setup_) << other;
    const std::string said = test_support::refusalOf([&] { write("flute"); });
    EXPECT_NE(said.find("not written over; name a file of its own in mill.yaml"), std::string::npos) << other << said;
    EXPECT_EQ(readFile(setup_), other);
  }
}

TEST_F(WrittenSetup, IsNotTakenFromAJobFileWithFigures) {
  const std::string path = "test/jobs/paper.yaml", before = readFile(path);
  const JobToSetUp asked = readJobToSetUp(path);
  ASSERT_TRUE(asked.before.has_value());
  EXPECT_EQ(asked.before->setup_swivel, asked.job.process().setup_swivel);
  const std::string said = test_support::refusalOf([&] { writeSetup(asked, asked.job); });
  EXPECT_NE(said.find("put setup: {file: paper.setup.yaml} in place"), std::string::npos) << said;
  EXPECT_EQ(readFile(path), before);
}

// The figure that the job file asks for is kept, and a set-up that was solved without it is not the job's.
TEST_F(WrittenSetup, IsRefusedWithAnotherFigureThanTheWantedOne) {
  write("flute");
  const std::string text = readFile(job_), name = "setup: {file: end_mill_d10_t4.setup.yaml";
  const auto ask = [&](const std::string& figures) {
    std::ofstream(job_) << std::string(text).replace(text.find(name), name.size(), name + figures);
  };
  ask(", swivel_deg: 42");
  EXPECT_NE(refusal("flute").find("solved with process.setup.swivel_deg = 43.32 deg; the job now asks for 42 deg"),
            std::string::npos)
      << refusal("flute");
  const JobToSetUp asked = readJobToSetUp(job_, "flute");
  EXPECT_EQ(asked.wanted, SetupFigure::kSwivel);
  EXPECT_DOUBLE_EQ(asked.job.process().setup_swivel, 42 * units::kDegree);
  EXPECT_EQ(asked.job.process().setup_height, 0);
  EXPECT_EQ(asked.job.process().overtravel_end, 1e-3) << "to reach the feed in the air";
  ask(", swivel_deg: 43.32");
  EXPECT_EQ(readJobToSetUp(job_, "flute").before.value().setup_height,
            readJobFile("jobs/end_mill_d10_t4.yaml", "1").process().setup_height);
  for (const char* others : {", x_shift_mm: 1", ", swivel_deg: 42, height_mm: 1"}) {
    ask(others);
    EXPECT_NE(refusal("flute").find(" stands beside operations[0].setup.file; allowed beside it: one of "),
              std::string::npos)
        << refusal("flute");
  }
}

}  // namespace test_setup_file
}  // namespace grinder
