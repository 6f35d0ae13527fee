#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

/// @file
/// What a goal's zero points depend on.

namespace grinder {
namespace test_offset_basis {

const std::string kJob = "jobs/unequal_d12_t4.yaml";

TEST(OffsetBasis, IsThatOfTheJobFileAndItsWheelFile) {
  const OffsetBasis basis = basisOf(goalFromFile(kJob), OffsetMethod::kProbe);
  EXPECT_EQ(basis.method, OffsetMethod::kProbe);
  EXPECT_EQ(basis.job_name, "unequal_d12_t4.yaml");
  EXPECT_EQ(basis.wheel_name, "straight_d100_w3.yaml");
  EXPECT_EQ(basis.end_diameter, 0.012);
  EXPECT_EQ(basis.wheel_diameter, 0.1);
  EXPECT_EQ(basis.wheel_width, 0.003);
  EXPECT_EQ(basis.wheel_rim, 0);
  const std::string end = "jobs/left_hand_end_mill_d8_t3.yaml";
  EXPECT_EQ(basisOf(goalFromFile(end, "end_primary"), OffsetMethod::kProbe).wheel_rim, 0.006);
  EXPECT_TRUE(basis.hasJob());
  EXPECT_EQ(goalFromFile("test/jobs/paper.yaml").wheel_name, "");
  EXPECT_EQ(basisOf(goalFromFile("test/jobs/paper.yaml"), OffsetMethod::kProbe).wheel_name, "straight, 3 mm wide");
}

TEST(GoalFromFile, HasWhenTheWheelWasDressed) {
  const test_support::TempFolder folder;
  for (const std::string& file :
       {kJob, std::string("jobs/unequal_d12_t4.setup.yaml"), std::string("wheels/straight_d100_w3.yaml")}) {
    std::filesystem::create_directory((folder.path() / file).parent_path());
    std::filesystem::copy_file(file, folder.path() / file);
  }
  EXPECT_EQ(goalFromFile(folder.path() / kJob).wheel_dressed, "");
  std::ofstream(folder.path() / "wheels/straight_d100_w3.yaml", std::ios::app) << "dressed: 2026-11-20T08:15:30Z\n";
  EXPECT_EQ(goalFromFile(folder.path() / kJob).wheel_dressed, "2026-11-20T08:15:30Z");
}

/// The job that asks for nothing but what its wheel is.
TEST(OffsetBasis, EveryFigureOfTheWheelIsInItsDigestButWearAndWidth) {
  const GrindJob job = readJobFile(kJob);
  const std::string digest = wheelDigest(job);
  int of_wheel = 0;
  visitJobFields([&](const JobField& field, auto of) {
    GrindJob other = job;
    of(other) += 0.001;
    const std::string path = field.path;
    const bool counts =
        path.find("process.wheel_") == 0 && path.find("wear") == std::string::npos && path != "process.wheel_width";
    of_wheel += counts ? 1 : 0;
    EXPECT_EQ(wheelDigest(other) != digest, counts) << path;
  });
  EXPECT_EQ(of_wheel, 5) << "diameter, angle, two corners, rim";
  const std::function<void(GrindProcess&)> choices[]{[](GrindProcess& p) { p.wheel_profile = WheelShape::kFullRadius; },
                                                     [](GrindProcess& p) { p.wheel_side = WheelFace::kLower; },
                                                     [](GrindProcess& p) {
                                                       p.wheel_points.push_back({0, 0.05});
                                                     }};
  for (const auto& choose : choices) {
    GrindJob other = job;
    choose(other.process());
    EXPECT_NE(wheelDigest(other), digest);
  }
}

/// What the operator changes between flutes and reliefs, or after dressing, does not make another tool of it.
TEST(OffsetBasis, TheToolIsKnownByWhatPlacesItsTeeth) {
  const GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", "flute");
  const std::string digest = toolDigest(job);
  for (const int operation : {1, 2}) EXPECT_EQ(toolDigest(job.ofOperation(operation)), digest) << operation;
  const struct {
    bool another;
    void (*change)(GrindJob&);
  } rows[]{{true, [](GrindJob& j) { j.tooth_angles[1] += 0.01; }},
           {true, [](GrindJob& j) { j.cutter.end_diameter += 1e-4; }},
           {true, [](GrindJob& j) { j.cutter.cut = CutDirection::kLeftHand; }},
           {true, [](GrindJob& j) { j.process().setup_swivel += 1e-3; }},
           {true, [](GrindJob& j) { j.process().depth += 1e-4; }},
           {false, [](GrindJob& j) { j.process().feed *= 2; }},
           {false, [](GrindJob& j) { j.process().wheel_wear += 1e-5; }},
           {false, [](GrindJob& j) { j.cutter.clearance += 0.01; }},
           {false, [](GrindJob& j) { j.cutter.rake_tolerance *= 2; }}};
  for (const auto& row : rows) {
    GrindJob other = job;
    row.change(other);
    other.operations[0] = other.process();
    EXPECT_EQ(toolDigest(other) != digest, row.another) << &row - rows;
  }
}

TEST(OffsetBasis, SurvivesTheMessageOfTheWorkOffsetsAndAnUnknownMethodIsUnknown) {
  WorkOffsets offsets;
  for (WorkOffset& offset : offsets.axes) {
    offset = {0.001, "anna@grinder", 1.7e9, basisOf(goalFromFile(kJob), OffsetMethod::kProbe), 7};
  }
  offsets.wheel = {"a.yaml", std::string(64, 'a'), 0.1, 0.006, 7};
  offsets.tool = {"", "d6.yaml", 0b11, TeethUnknown::kHomed, 5};
  flute_grinder::WorkOffsets message = toMessage(offsets);
  EXPECT_TRUE(toMessage(fromMessage(message)) == message);
  EXPECT_EQ(message.wheel.rim, 0.006);
  EXPECT_EQ(message.wheel.mounting, 7U);
  EXPECT_EQ(message.tool.unknown, flute_grinder::ClampedTool::HOMED);
  EXPECT_EQ(message.tool.clamping, 5U);
  EXPECT_EQ(message.basis[kA].tool_digest, toolDigest(readJobFile(kJob)));
  message.basis[kX].method = 200;
  EXPECT_EQ(fromMessage(message).axes[kX].basis.method, OffsetMethod::kUnknown);
}

TEST(OffsetBasis, HasTheKindsOfTheOperationAndOfTheOneBeforeItNotTheirPlaces) {
  GrindJob job = readJobFile(kJob);
  job.operations.resize(3, job.process());
  job.operations[1].kind = OperationKind::kGash;
  job.operations[2].kind = OperationKind::kPrimaryEnd;
  const auto kinds = [&](int operation) {
    const flute_grinder::OffsetBasis sent =
        toMessage(basisOf(goalFromJob(job.ofOperation(operation)), OffsetMethod::kProbe));
    EXPECT_TRUE(toMessage(fromMessage(sent)) == sent);
    return std::pair<int, int>(sent.kind, sent.before);
  };
  using flute_grinder::Process;
  EXPECT_EQ(kinds(0).first, Process::FLUTE);
  EXPECT_EQ(kinds(1), (std::pair<int, int>(Process::GASH, Process::FLUTE)));
  EXPECT_EQ(kinds(2), (std::pair<int, int>(Process::END_PRIMARY, Process::GASH)));
}

TEST(OffsetBasis, DoesNotEnterTheDigestOfAJob) {
  flute_grinder::GrindGoal goal = goalFromFile(kJob);
  const std::string digest = jobDigest(jobFromGoal(goal));
  goal.wheel_name = "other.yaml";
  goal.answers = {"ignore-offsets"};
  EXPECT_EQ(jobDigest(jobFromGoal(goal)), digest);
}

}  // namespace test_offset_basis
}  // namespace grinder
