#include "flute_grinder/operator/last_job.h"

#include "flute_grinder/core/units.h"

#include <cstdio>

namespace flute_grinder {

namespace {

using namespace units;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string tool(const Cutter& c) {
  return format("D %g mm, cone %g deg, spiral %g deg, rake %g deg, %zu %s", c.end_diameter / kMillimetre,
                c.cone_angle / kDegree, c.spiral_angle / kDegree, c.rake_angle / kDegree, c.tooth_angles.size(),
                c.tooth_angles.size() == 1 ? "tooth" : "teeth");
}

}  // namespace

std::string lastJob(const JobProgress& p) {
  const std::string came_to =
      p.finished ? "finished"
                 : format("tooth %d, pass %d not finished, X %.3f mm", p.tooth + 1, p.pass + 1, p.x / kMillimetre);
  return (p.job_name.empty() ? "without a name" : p.job_name) + ": " + tool(p.cutter) + "; " + came_to + " (" +
         p.job_digest.substr(0, 12) + ")";
}

}  // namespace flute_grinder
