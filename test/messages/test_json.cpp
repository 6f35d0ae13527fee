#include "flute_grinder/messages/json.h"

#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"

#include "jobs.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

/// @file
/// A job reported in JSON is a job file, which reads back as the same job; no other job has its digest.

namespace grinder {
namespace test_json {

using units::kDegree;
using units::kMillimetre;

GrindJob readBack(const GrindJob& job) { return parseJob(text(toJson(job), -1), "reported"); }

void expectSameBits(const GrindJob& job) {
  const GrindJob back = readBack(job);
  EXPECT_TRUE(goalFromJob(back) == goalFromJob(job)) << text(toJson(job));
  EXPECT_EQ(jobDigest(back), jobDigest(job));
  EXPECT_EQ(back.operationText(), job.operationText());
}

GrindJob paper() { return readJobFile("test/jobs/paper.yaml"); }

TEST(JobJson, OfEveryOperationOfEveryShippedJobIsTheSameJob) {
  const std::vector<std::string> jobs = test_support::shippedJobs();
  EXPECT_GE(jobs.size(), 8U);
  for (const std::string& entry : jobs) {
    SCOPED_TRACE(entry);
    const std::size_t operations = readJobFile(entry, "flute").operations.size();
    for (std::size_t i = 1; i <= operations; ++i) expectSameBits(readJobFile(entry, std::to_string(i)));
  }
}

TEST(JobJson, HasTheKeysAndNumbersOfTheFile) {
  const Json file = toJson(paper()), process = file["operations"][0];
  EXPECT_EQ(file["operation"], "flute");
  EXPECT_EQ(file["cutter"]["end_diameter_mm"], 10);
  EXPECT_EQ(file["cutter"]["teeth"], 1);
  EXPECT_EQ(file["cutter"]["cut"], "right_hand");
  EXPECT_EQ(process["feed_mm_min"], 600);
  EXPECT_EQ(process["overtravel_mm"], Json({1.0, 7.0}));
  EXPECT_EQ(process["setup"]["swivel_deg"], 31.769);
  EXPECT_EQ(process["wheel"]["profile"], "straight");
  EXPECT_FALSE(process["wheel"].contains("side"));
  EXPECT_EQ(file["interpolation"]["tolerance_um"], 1);
}

TEST(JobJson, OfListsAndOfEveryWheelIsTheSameJob) {
  GrindJob job = paper();
  job.tooth_angles = {0, 88 * kDegree, 180.5 * kDegree, 268 * kDegree};
  job.spiral_angles = {30 * kDegree, 31.3 * kDegree, 30 * kDegree, 29.1 * kDegree};
  expectSameBits(job);
  EXPECT_EQ(toJson(job)["cutter"]["tooth_angles_deg"][2], 180.5);
  EXPECT_FALSE(toJson(job)["cutter"].contains("spiral_angle_deg"));
  job = paper();
  job.process().wheel_profile = WheelShape::kAngled;
  job.process().wheel_angle = 12.5 * kDegree;
  job.process().wheel_side = WheelFace::kLower;
  job.process().wheel_corner_radius_upper = 0.1 * kMillimetre;
  expectSameBits(job);
  job = paper();
  job.process().wheel_profile = WheelShape::kPoints;
  job.process().wheel_points = {{-1.5 * kMillimetre, 49.7 * kMillimetre},
                                {0.2 * kMillimetre, 50 * kMillimetre},
                                {1.5 * kMillimetre, 49 * kMillimetre}};
  expectSameBits(job);
}

// So that a job whose file was changed is another one, which is not continued.
TEST(JobDigest, DependsOnEveryFigureAndChoice) {
  const GrindJob job = paper();
  const auto expectOther = [&](const char* changed, const auto& change) {
    GrindJob other = job;
    change(other);
    EXPECT_NE(jobDigest(other), jobDigest(job)) << changed;
  };
  visitJobFields([&](const JobField& field, auto of) {
    expectOther(field.path, [&](GrindJob& other) { of(other) = std::nextafter(of(job), 1); });
  });
  visitJobChoices([&](const char* path, int, auto of) {
    expectOther(path, [&](GrindJob& other) {
      auto& choice = of(other);
      choice = static_cast<std::decay_t<decltype(choice)>>(static_cast<int>(choice) == 0 ? 1 : 0);
    });
  });
  expectOther("teeth", [](GrindJob& other) { other.tooth_angles.push_back(1); });
  expectOther("spirals", [](GrindJob& other) { other.spiral_angles = {other.cutter.spiral_angle}; });
  expectOther("points", [](GrindJob& other) { other.process().wheel_points.push_back({0, 0.05}); });
}

/// Jobs that are like the paper's, with other numbers and choices.
class AnyJob : public testing::Test {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(dice_); }
  int whole(int low, int high) { return std::uniform_int_distribution<>(low, high)(dice_); }

  GrindJob job() {
    GrindJob job = paper();
    visitJobFields([&](const JobField&, auto of) { of(job) *= between(0.9, 1.1); });
    visitJobChoices([&](const std::string& path, int most, auto of) {
      auto& choice = of(job);
      // A wheel of this profile has no side.
      if (path != "process.wheel_side" && whole(0, 29) == 0)
        choice = static_cast<std::decay_t<decltype(choice)>>(whole(0, most));
    });
    for (int tooth = 1; tooth < whole(1, 5); ++tooth) job.tooth_angles.push_back(tooth * 1.1);
    return job;
  }

  const int cases_ = test_support::randomCases(300);
  std::mt19937 dice_{1};
};

/// Numbers of any digits, as somebody may write them into a file.
TEST_F(AnyJob, HasEveryNumberOfItsFile) {
  int good = 0;
  for (int i = 0; i < cases_; ++i) {
    GrindJob any = job();
    visitJobFields([&](const JobField& field, auto of) {
      const double digits = std::pow(10, whole(0, 12));
      const double shop = std::round(of(any) / shopScale(field.unit) * digits) / digits;
      of(any) = shop * shopScale(field.unit);
      EXPECT_EQ(shopNumber(of(any), field.unit) * shopScale(field.unit), of(any)) << field.path;
    });
    if (!validate(any).empty()) continue;
    ++good;
    EXPECT_TRUE(goalFromJob(readBack(any)) == goalFromJob(any)) << text(toJson(any));
  }
  EXPECT_GT(good, cases_ / 3);
}

/// Numbers that no file has, as a client may compute them.
TEST_F(AnyJob, IsTheSameWithinRounding) {
  int good = 0;
  for (int i = 0; i < cases_; ++i) {
    const GrindJob any = job();
    if (!validate(any).empty()) continue;
    ++good;
    const GrindJob back = readBack(any);
    visitJobFields([&](const JobField& field, auto of) {
      EXPECT_LE(std::abs(of(back) - of(any)), 1e-15 * std::abs(of(any))) << field.path;
    });
    visitJobChoices([&](const char* path, int, auto of) { EXPECT_EQ(of(back), of(any)) << path; });
    EXPECT_EQ(back.tooth_angles.size(), any.tooth_angles.size());
  }
  EXPECT_GT(good, cases_ / 3);
}

}  // namespace test_json
}  // namespace grinder
