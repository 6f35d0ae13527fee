#include "flute_grinder/job/rounded_job.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/job/job_fields.h"

#include <utility>

namespace grinder {

namespace {

constexpr int kFigureDigits = 9;

void roundOff(double& si, Unit unit) {
  si = parseNumber(format("%.*g", kFigureDigits, si / shopScale(unit)).c_str()) * shopScale(unit);
}

void roundOff(std::vector<double>& angles) {
  for (double& angle : angles) roundOff(angle, Unit::kRadian);
}

void roundOff(std::vector<ProfilePoint>& points) {
  for (ProfilePoint& point : points) roundOff(point.w, Unit::kMetre), roundOff(point.radius, Unit::kMetre);
}

}  // namespace

GrindJob roundedOff(GrindJob job) {
  roundOff(job.tooth_angles);
  roundOff(job.spiral_angles);
  const int own = std::exchange(job.operation, 0);
  for (; job.operation < static_cast<int>(job.operations.size()); ++job.operation) {
    visitJobFields([&](const JobField& field, auto of) { roundOff(of(job), field.unit); });
    roundOff(job.process().wheel_points);
  }
  job.operation = own;
  return job;
}

}  // namespace grinder
