#include "flute_grinder/geometry/setup_file.h"

#include "flute_grinder/geometry/replace_file.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/job_fields.h"

#include <system_error>

namespace grinder {

namespace {

bool sameNumbers(const GrindJob& a, const GrindJob& b) {
  bool same = a.tooth_angles == b.tooth_angles && a.spiral_angles == b.spiral_angles;
  visitJobFields([&](const JobField&, auto of) { same = same && of(a) == of(b); });
  visitJobChoices([&](const char*, int, auto of) { same = same && of(a) == of(b); });
  return same;
}

std::string byHand(const std::vector<JobEdit>& edits) {
  std::string text = "; nothing was written, write by hand:";
  for (const JobEdit& edit : edits) text += "\n  " + edit.key + ": " + edit.value;
  return text;
}

}  // namespace

void writeSetup(const std::string& path, const JobSetup& setup) {
  try {
    const std::string text = editJob(readTextFile(path), path, setup.edits);
    // The operations behind this one may still be without a set-up.
    const GrindJob written = parseJob(text, path, unsolvedFields({}), toString(setup.job.process.kind));
    if (!sameNumbers(written, setup.job)) throw JobFileError(path + ": has changed since it was read");
    replaceFile(path, text);
  } catch (const std::system_error& error) {
    throw JobFileError(path + ": cannot be written: " + error.code().message() + byHand(setup.edits));
  } catch (const JobFileError& error) {
    throw JobFileError(error.what() + byHand(setup.edits));
  }
}

}  // namespace grinder
