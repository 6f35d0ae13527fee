#include "flute_grinder/job/job_fields.h"

namespace grinder {

namespace {

/// The lists of a job: path, and key in a job file.
constexpr const char* kLists[][2]{{"cutter.tooth_angles", "cutter.tooth_angles_deg"},
                                  {"cutter.spiral_angles", "cutter.spiral_angles_deg"},
                                  {"process.wheel_points", "process.wheel.points_mm"}};

}  // namespace

std::string fieldName(const std::string& path) {
  std::string name = path;
  for (const auto& list : kLists) {
    if (path == list[0]) name = list[1];
  }
  visitJobFields([&](const JobField& field, auto) {
    if (field.path == path) name = field.file_key;
  });
  return name;
}

}  // namespace grinder
