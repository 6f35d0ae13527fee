#include "flute_grinder/messages/json.h"

#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "motion/generators.h"

#include "jobs.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <type_traits>

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

/// Numbers of any digits, as somebody may write them into a file.
RC_GTEST_PROP(JobJson, ReadsBackEveryNumberOfAFile, ()) {
  GrindJob job = *test_support::job();
  visitJobFields([&](const JobField& field, auto of) {
    const double digits = std::pow(10, *test_support::whole(0, 12));
    const double shop = std::round(of(job) / shopScale(field.unit) * digits) / digits;
    of(job) = shop * shopScale(field.unit);
    RC_ASSERT(shopNumber(of(job), field.unit) * shopScale(field.unit) == of(job));
  });
  if (validate(job).empty()) RC_ASSERT(goalFromJob(readBack(job)) == goalFromJob(job));
}

/// Numbers that no file has, as a client may compute them.
RC_GTEST_PROP(JobJson, OfAnyJobIsTheSameWithinRounding, ()) {
  GrindJob job = *test_support::job();
  for (int tooth = 1; tooth < *test_support::whole(1, 5); ++tooth) job.tooth_angles.push_back(tooth * 1.1);
  RC_PRE(validate(job).empty());
  const GrindJob back = readBack(job);
  visitJobFields(
      [&](const JobField&, auto of) { RC_ASSERT(std::abs(of(back) - of(job)) <= 1e-15 * std::abs(of(job))); });
  visitJobChoices([&](const char*, int, auto of) { RC_ASSERT(of(back) == of(job)); });
  RC_ASSERT(back.tooth_angles.size() == job.tooth_angles.size());
}

}  // namespace test_json
}  // namespace grinder
