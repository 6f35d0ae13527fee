#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

/// @file
/// The shipped jobs that name a wheel file give the goal and the digest that they give with the wheel's keys in them.

namespace flute_grinder {
namespace test_wheel_goal {

std::string withKeys(const std::string& job, const std::string& file, const std::string& keys) {
  std::ifstream stream("jobs/" + job + ".yaml");
  std::ostringstream text;
  text << stream.rdbuf();
  std::string changed = text.str();
  const std::string line = "    file: ../wheels/" + file + ".yaml\n";
  EXPECT_NE(changed.find(line), std::string::npos) << changed;
  return changed.replace(changed.find(line), line.size(), keys);
}

void expectSame(const std::string& job, const std::string& file, const std::string& keys) {
  const GrindJob named = readJobFile("jobs/" + job + ".yaml");
  const GrindJob own = parseJob(withKeys(job, file, keys), "own.yaml");
  EXPECT_TRUE(goalFromJob(named) == goalFromJob(own));
  EXPECT_EQ(jobDigest(named), jobDigest(own));
}

TEST(WheelGoal, OfANewWheel) {
  expectSame(
      "unequal_d12_t4", "straight_d100_w3",
      "    diameter_mm: 100\n    width_mm: 3\n    profile: straight\n    corner_radius_mm: [0, 0]\n    wear_mm: 0\n");
}

TEST(WheelGoal, OfAWornWheel) {
  expectSame("finishing_d20_t8", "straight_d125_w2",
             "    diameter_mm: 125\n    width_mm: 2\n    profile: straight\n    corner_radius_mm: [0, 0]\n    wear_mm: "
             "0.12\n");
}

}  // namespace test_wheel_goal
}  // namespace flute_grinder
