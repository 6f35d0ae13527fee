#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/motion/job_plan.h"

#include "flute_grinder/job/grind_job.h"
#include "generators.h"

#include <string>
#include <vector>

/// @file
/// Plans of jobs, for the tests of planJob().
namespace grinder::test_support {

inline JobPlan planOf(const GrindJob& job, const Machine& machine = plainMachine()) {
  return planJob(ValidJob(job), machine, machine.park);
}

inline std::string textOf(const JobPlan& plan) {
  std::string text;
  for (const Reason& reason : plan.reasons) text += grinder::text(reason) + "\n";
  return text;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The causes of all feed limits.
inline std::string causesOf(const std::vector<FeedLimit>& cuts) {
  std::string causes;
  for (const FeedLimit& cut : cuts) causes += (causes.empty() ? "" : ", ") + cut.cause;
  return causes;
}

/// The reasons that have a part.
inline std::vector<std::string> reasonsWith(const JobPlan& plan, const std::string& part) {
  std::vector<std::string> reasons;
  for (const Reason& reason : plan.reasons) {
    const std::string text = grinder::text(reason);
    if (contains(text, part)) reasons.push_back(text);
  }
  return reasons;
}

/// A cutter on which `published` drifts off: D1 2 mm, C 15 deg, S 45 deg.
inline GrindJob steepJob() {
  GrindJob j = paperJob();
  j.cutter.end_diameter = 2e-3;
  j.cutter.cone_angle = 15 * units::kDegree;
  j.cutter.spiral_angle = 45 * units::kDegree;
  j.cutter.rake_angle = 0;
  j.cutter.flute_length = 20e-3;
  j.process().overtravel_end = 0;
  j.process().depth = j.process().infeed = 0.2e-3;
  return j;
}

/// Limits that hardly hinder a feed.
inline Machine strongMachine() {
  Machine m = plainMachine();
  m.limits.max_velocity *= 50;
  m.limits.max_acceleration *= 1000;
  m.limits.max_jerk *= 100000;
  return m;
}

}  // namespace grinder::test_support
