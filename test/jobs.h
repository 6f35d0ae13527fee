#pragma once

#include "any_tool.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace grinder::test_support {

inline GrindJob jobOf(const std::string& name) { return readJobFile("jobs/" + name + ".yaml"); }

/// The paths of the job files in jobs/.
inline std::vector<std::string> shippedJobs() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator("jobs")) {
    const std::string path = entry.path();
    if (path.find(".setup.") == std::string::npos) paths.push_back(path);
  }
  return paths;
}

/// The paper's cutter by its published motion; any edge and core will do.
inline GrindJob paper() {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  askForRakeAlone(job.cutter);
  return job;
}

}  // namespace grinder::test_support
