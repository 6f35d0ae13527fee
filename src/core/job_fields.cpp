#include "flute_grinder/core/job_fields.h"

namespace flute_grinder {

std::string fieldName(const std::string& path, UnitSystem units) {
  if (units == UnitSystem::kSi) return path;
  std::string name = path == "cutter.tooth_angles" ? "cutter.tooth_angles_deg" : path;
  visitJobFields([&](const JobField& field, auto) {
    if (field.path == path) name = field.file_key;
  });
  return name;
}

}  // namespace flute_grinder
