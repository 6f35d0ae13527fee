#include "flute_grinder/messages/continue_job.h"

#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/messages/conversions.h"

namespace grinder {

std::string continueFrom(const flute_grinder::JobProgress& progress, const GrindJob& job,
                         flute_grinder::GrindGoal& goal) {
  if (progress.job_digest.empty()) return "there is no job to continue: the grinder's journal is empty";
  if (progress.job_digest != jobDigest(job)) {
    return "the grinder's last job was another one, or its file has changed since; run it from the beginning";
  }
  if (progress.finished) return "the job is finished: every pass of it is ground";
  goal.first_tooth = progress.tooth;
  goal.first_pass = progress.pass;
  return "";
}

std::string endText(const flute_grinder::JobProgress& progress) {
  return progress.end.empty() ? "in the middle, with the grinder's program" : progress.end;
}

}  // namespace grinder
