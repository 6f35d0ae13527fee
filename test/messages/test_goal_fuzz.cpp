#include "flute_grinder/messages/conversions.h"

#include "any_tool.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

/// @file
/// Whatever numbers a goal is made of, its job is the same, bit for bit, and is good or refused with reasons. What a
/// plan makes of any job is test_job_fuzz.cpp's.

namespace grinder {
namespace test_goal_fuzz {

flute_grinder::GrindGoal goodGoal() {
  GrindJob j;
  j.cutter = {10e-3, 0.09, 0.5, 0.1, 2e-3, CutDirection::kRightHand, 0.01, 10e-3};
  test_support::askForRakeAlone(j.cutter);
  j.tooth_angles = {0, 1};
  j.process().feed = 0.02;
  j.process().depth = 0.5e-3;
  j.process().infeed = 0.5e-3;
  j.process().clearance = 1e-3;
  j.process().overtravel_end = 0.1e-3;
  j.process().wheel_diameter = 100e-3;
  j.process().wheel_width = 8e-3;
  j.interpolation = {EvenStepRule::kPublished, 1e-6, 1e-3};
  flute_grinder::GrindGoal goal = goalFromJob(j);
  goal.job_name = "paper.yaml";
  return goal;
}

std::vector<std::uint8_t> bytesOf(const flute_grinder::GrindGoal& goal) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(goal));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, goal);
  return bytes;
}

/// @return whether its job is good.
bool answer(const flute_grinder::GrindGoal& goal) {
  flute_grinder::GrindGoal there_and_back = goal;
  const flute_grinder::GrindGoal back = goalFromJob(jobFromGoal(goal));
  there_and_back.cutter = back.cutter;
  there_and_back.interpolation = back.interpolation;
  there_and_back.operations = back.operations;
  there_and_back.operation = back.operation;
  EXPECT_EQ(bytesOf(there_and_back), bytesOf(goal));
  const std::vector<Reason> reasons = validate(jobFromGoal(goal));
  for (const Reason& reason : reasons) EXPECT_GT(text(reason).size(), 10u);
  return reasons.empty();
}

/// Where a goal's bytes say how many elements an array has; no client writes a wrong count.
template <typename Array>
std::size_t countAt(Array array) {
  flute_grinder::GrindGoal longer = goodGoal();
  array(longer).emplace_back();
  const std::vector<std::uint8_t> good = bytesOf(goodGoal());
  const std::vector<std::uint8_t> more = bytesOf(longer);
  return static_cast<std::size_t>(std::mismatch(good.begin(), good.end(), more.begin()).first - good.begin());
}

/// Bytes of a goal, three of them spoiled or all up to its name, but for the counts of its arrays.
std::vector<std::uint8_t> spoiledBytes(std::mt19937& dice) {
  const flute_grinder::GrindGoal good = goodGoal();
  std::vector<std::uint8_t> bytes = bytesOf(good);
  const std::size_t before_name = bytes.size() - good.job_name.size() - 5;
  const bool all = dice() % 8 == 0;
  for (std::size_t n = 0; n < (all ? before_name : 3); ++n) {
    bytes[all ? n : dice() % bytes.size()] = static_cast<std::uint8_t>(dice());
  }
  static const std::size_t counts[] = {
      countAt([](flute_grinder::GrindGoal& g) -> std::vector<double>& { return g.cutter.tooth_angles; }),
      countAt([](flute_grinder::GrindGoal& g) -> std::vector<double>& { return g.cutter.spiral_angles; }),
      countAt([](flute_grinder::GrindGoal& g) -> std::vector<double>& { return g.operations[0].wheel_points; }),
      countAt([](flute_grinder::GrindGoal& g) -> std::vector<std::string>& { return g.answers; }),
      countAt([](flute_grinder::GrindGoal& g) -> std::vector<flute_grinder::Process>& { return g.operations; })};
  const std::vector<std::uint8_t> whole = bytesOf(good);
  for (const std::size_t at : counts) std::copy_n(whole.begin() + at, 4, bytes.begin() + at);
  if (dice() % 16 == 0) bytes.resize(dice() % (bytes.size() + 1));
  return bytes;
}

TEST(GoalFuzz, GoodGoalsAndThoseWithSpoiledBytesAreAnswered) {
  EXPECT_TRUE(answer(goodGoal()));
  std::mt19937 dice(1);
  int goals = 0;
  int good_jobs = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    flute_grinder::GrindGoal goal;
    std::vector<std::uint8_t> bytes = spoiledBytes(dice);
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    try {
      ros::serialization::deserialize(stream, goal);
    } catch (const ros::serialization::StreamOverrunException&) {
      continue;
    }
    for (flute_grinder::Process& process : goal.operations) process.incomplete_ok = process.incomplete_ok != 0;
    ++goals;
    if (answer(goal)) ++good_jobs;
  }
  EXPECT_GT(goals, 13000);
  EXPECT_GT(good_jobs, 1000);
}

}  // namespace test_goal_fuzz
}  // namespace grinder
