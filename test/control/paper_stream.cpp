#include "control/paper_stream.h"

#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"

namespace grinder::test_support {

SetpointStream paperStream(const Machine& machine, const RunStart& run) {
  static const ValidJob job(readJobFile("test/jobs/paper.yaml"));
  return SetpointStream(GrindProgram(job, machine, run));
}

}  // namespace grinder::test_support
