#include "cli/last_job.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"

namespace grinder {

using units::kMillimetre;

std::string lastJob(const flute_grinder::JobProgress& p) {
  const std::string came_to =
      p.finished ? "finished"
                 : format("tooth %d, pass %d not finished, X %.3f mm", p.tooth + 1, p.pass + 1, p.x / kMillimetre);
  return jobText(p.job_name, p.operation, fromMessage(p.cutter), p.cutter.tooth_angles.size()) + ": " + came_to + " (" +
         p.job_digest.substr(0, 12) + ")";
}

}  // namespace grinder
