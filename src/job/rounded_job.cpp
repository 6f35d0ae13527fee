#include "flute_grinder/job/rounded_job.h"

#include "flute_grinder/job/format.h"
#include "flute_grinder/job/job_fields.h"

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

/// Rounds a job of one operation.
void roundOffOne(GrindJob& job) {
  visitJobFields([&](const JobField& field, auto of) { roundOff(of(job), field.unit); });
  roundOff(job.wheel_points);
}

}  // namespace

GrindJob roundedOff(GrindJob job) {
  roundOff(job.tooth_angles);
  roundOff(job.spiral_angles);
  roundOffOne(job);
  for (std::size_t i = 0; i < job.operations.size(); ++i) {
    GrindJob one = job.ofOperation(static_cast<int>(i));
    roundOffOne(one);
    job.operations[i] = {one.process, one.wheel_points};
  }
  return job;
}

}  // namespace grinder
