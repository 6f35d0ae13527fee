#pragma once

#include "any_tool.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"

#include <string>

namespace grinder::test_support {

inline GrindJob jobOf(const std::string& name) { return readJobFile("jobs/" + name + ".yaml"); }

/// The paper's cutter by its published motion; any edge and core will do.
inline GrindJob paper() {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  askForRakeAlone(job.cutter);
  return job;
}

}  // namespace grinder::test_support
