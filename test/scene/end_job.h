#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/z_law.h"

#include <algorithm>
#include <map>
#include <string>

namespace grinder::test_support {

/// The shipped end mill's job of an operation on the end, computed once.
inline const ValidJob& endJob(const std::string& operation) {
  static std::map<std::string, ValidJob> jobs;
  if (jobs.count(operation) == 0) {
    jobs.emplace(operation, withLaws(ValidJob(readJobFile("jobs/end_mill_d10_t4.yaml", operation))));
  }
  return jobs.at(operation);
}

/// The same on two teeth without reliefs, whose sections cost a tenth.
inline ValidJob lightEndJob(OperationKind kind) {
  GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "chamfer");
  auto& all = job.operations;
  all.erase(std::remove_if(all.begin(), all.end(), [](const GrindProcess& p) { return isRelief(p.kind); }), all.end());
  job.tooth_angles = {0, units::kPi};
  const auto of_kind = std::find_if(all.begin(), all.end(), [&](const GrindProcess& p) { return p.kind == kind; });
  return withLaws(ValidJob(job.ofOperation(static_cast<int>(of_kind - all.begin()))));
}

/// The same of its mirror image, without flanks, which need a cup.
inline ValidJob leftHandEndJob(OperationKind kind) {
  GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "chamfer");
  auto& all = job.operations;
  const auto is_left_out = [](const GrindProcess& p) { return isRelief(p.kind) || isEndFlank(p.kind); };
  all.erase(std::remove_if(all.begin(), all.end(), is_left_out), all.end());
  job.cutter.cut = CutDirection::kLeftHand;
  job.cutter.spiral_angle *= -1;
  for (GrindProcess& p : all) {
    p.wheel_side = WheelFace::kLower;
    p.setup_swivel *= -1;
    p.setup_height *= -1;
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    all[i].setup_swivel = swivelOfPlane(job.ofOperation(static_cast<int>(i)));
  }
  job.operation = kind == OperationKind::kGash ? 1 : 2;
  return withLaws(ValidJob(job.ofOperation(job.operation)));
}

}  // namespace grinder::test_support
