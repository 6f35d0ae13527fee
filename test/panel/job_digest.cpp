#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "panel_fixture.h"

namespace grinder {

std::string digestOf(const QString& job, const std::string& operation) {
  return jobDigest(readJobFile(job.toStdString(), operation));
}

}  // namespace grinder
