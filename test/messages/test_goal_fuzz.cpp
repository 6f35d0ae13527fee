#include "flute_grinder/core/job_fields.h"
#include "flute_grinder/messages/conversions.h"

#include "core/generators.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

/// @file
/// Whatever bytes a goal is made of, the answer is a plan or a refusal with its reasons.

namespace flute_grinder {
namespace {

Machine machine() {
  Machine m = test_support::plainMachine();
  m.period = 2e-3;
  m.max_job_duration = 4;
  return m;
}

GrindGoal goodGoal() {
  GrindJob j;
  j.cutter = {10e-3, 0.09, 0.5, 0.1, 2e-3};
  j.tooth_angles = {0, 1};
  j.process.feed = 0.02;
  j.process.depth = 0.5e-3;
  j.process.infeed = 0.5e-3;
  j.process.clearance = 1e-3;
  j.process.overtravel_end = 0.1e-3;
  j.process.wheel_diameter = 100e-3;
  j.process.wheel_width = 8e-3;
  j.interpolation = {EvenStepRule::kPublished, 1e-6, 1e-3};
  GrindGoal goal = goalFromJob(j);
  goal.job_name = "paper.yaml";
  return goal;
}

std::vector<std::uint8_t> bytesOf(const GrindGoal& goal) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(goal));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, goal);
  return bytes;
}

constexpr int kTeethCount = 40;  ///< place of the count of teeth among the bytes, behind five numbers

/// @return whether the bytes are a goal's.
bool goalOf(std::vector<std::uint8_t> bytes, GrindGoal& goal) {
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  try {
    ros::serialization::deserialize(stream, goal);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expectSame(const GrindJob& a, const GrindJob& b) {
  visitJobFields([&](const JobField& f, auto of) { EXPECT_TRUE(sameBits(of(a), of(b))) << f.path; });
  ASSERT_EQ(a.tooth_angles.size(), b.tooth_angles.size());
  for (std::size_t i = 0; i < a.tooth_angles.size(); ++i) EXPECT_TRUE(sameBits(a.tooth_angles[i], b.tooth_angles[i]));
  EXPECT_EQ(a.process.spark_out, b.process.spark_out);
  EXPECT_EQ(a.process.order, b.process.order);
  EXPECT_EQ(a.process.direction, b.process.direction);
  EXPECT_EQ(a.interpolation.even_step, b.interpolation.even_step);
}

/// Does with a goal what the node does.
/// @return whether its job is good.
bool answer(const GrindGoal& goal) {
  const GrindJob job = jobFromGoal(goal);
  expectSame(job, jobFromGoal(goalFromJob(job)));
  EXPECT_EQ(jobDigest(job), jobDigest(jobFromGoal(goalFromJob(job))));
  const Machine m = machine();
  const JobPlan plan = planJob(job, m, m.park, {goal.first_tooth, goal.first_pass});
  EXPECT_EQ(plan.good(), plan.reasons.empty());
  EXPECT_TRUE(validate(job).empty() || plan.fault == PlanFault::kInvalidJob);
  const PathStatistics message = toMessage(plan.statistics);
  EXPECT_EQ(fromMessage(message).setpoints, plan.statistics.setpoints);
  for (const core::Reason& reason : plan.reasons) EXPECT_GT(text(reason, UnitSystem::kSi).size(), 10u);
  return plan.good();
}

TEST(GoalFuzz, TheGoodGoalIsGood) { EXPECT_TRUE(answer(goodGoal())); }

/// Bytes of a goal, three of them spoiled or all up to its name.
std::vector<std::uint8_t> spoiledBytes(std::mt19937& dice) {
  const GrindGoal good = goodGoal();
  std::vector<std::uint8_t> bytes = bytesOf(good);
  const std::size_t before_name = bytes.size() - good.job_name.size() - 5;
  const bool all = dice() % 8 == 0;
  for (std::size_t n = 0; n < (all ? before_name : 3); ++n) {
    bytes[all ? n : dice() % bytes.size()] = static_cast<std::uint8_t>(dice());
  }
  // Roscpp takes memory for as many teeth as a message claims to have, before it looks whether they are there.
  std::fill_n(bytes.begin() + kTeethCount, 4, std::uint8_t{0});
  bytes[kTeethCount] = static_cast<std::uint8_t>(dice() % 8 == 0 ? dice() % 9 : good.cutter.tooth_angles.size());
  if (dice() % 16 == 0) bytes.resize(dice() % (bytes.size() + 1));
  return bytes;
}

TEST(GoalFuzz, GoalsWithSpoiledBytesAreAnswered) {
  std::mt19937 dice(1);
  int goals = 0;
  int good_jobs = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    GrindGoal goal;
    if (!goalOf(spoiledBytes(dice), goal)) continue;
    ++goals;
    if (answer(goal)) ++good_jobs;
  }
  EXPECT_GT(goals, 14000);
  EXPECT_GT(good_jobs, 1000);
}

/// Every number of a goal, one by one.
std::vector<double*> numbersOf(GrindGoal& g) {
  std::vector<double*> numbers{&g.cutter.end_diameter,     &g.cutter.cone_angle,
                               &g.cutter.spiral_angle,     &g.cutter.rake_angle,
                               &g.cutter.flute_length,     &g.process.feed,
                               &g.process.depth,           &g.process.infeed,
                               &g.process.finish_infeed,   &g.process.clearance,
                               &g.process.overtravel_end,  &g.process.overtravel_shank,
                               &g.process.wheel_diameter,  &g.process.wheel_width,
                               &g.process.wheel_wear,      &g.process.wheel_wear_per_pass,
                               &g.interpolation.tolerance, &g.interpolation.rotary_scale};
  for (double& angle : g.cutter.tooth_angles) numbers.push_back(&angle);
  return numbers;
}

TEST(GoalFuzz, GoalsWithHostileNumbersAreAnswered) {
  using Limits = std::numeric_limits<double>;
  const double hostile[]{Limits::quiet_NaN(),
                         Limits::signaling_NaN(),
                         Limits::infinity(),
                         -Limits::infinity(),
                         Limits::max(),
                         Limits::lowest(),
                         Limits::min(),
                         Limits::denorm_min(),
                         -Limits::denorm_min(),
                         0.0,
                         -0.0,
                         1,
                         -1,
                         1e-9,
                         1e9};
  std::mt19937 dice(2);
  for (int i = 0; i < 8000 && !HasFailure(); ++i) {
    GrindGoal goal = goodGoal();
    const std::vector<double*> numbers = numbersOf(goal);
    for (std::size_t n = 0; n < 1 + dice() % 2; ++n) *numbers[dice() % numbers.size()] = hostile[dice() % 15];
    if (i % 5 == 0) goal.process.spark_out = static_cast<std::uint16_t>(dice());
    if (i % 6 == 0) goal.process.order = static_cast<std::uint8_t>(dice());
    if (i % 7 == 0) goal.process.direction = static_cast<std::uint8_t>(dice());
    if (i % 8 == 0) goal.interpolation.even_step = static_cast<std::uint8_t>(dice());
    if (i % 9 == 0) goal.first_tooth = static_cast<std::uint16_t>(dice());
    if (i % 10 == 0) goal.first_pass = static_cast<std::uint16_t>(dice());
    if (i % 400 == 0) goal.cutter.tooth_angles.assign(100000, hostile[dice() % 15]);
    answer(goal);
  }
}

}  // namespace
}  // namespace flute_grinder
