#include "flute_grinder/geometry/setup_file.h"

#include "flute_grinder/geometry/replace_file.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/format.h"
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

std::string changesText(const std::string& path, const JobSetup& setup) {
  FlatFile file(readTextFile(path), path, "job", "");
  std::string text;
  for (const JobEdit& edit : setup.edits) {
    double before = 0;
    const bool is_there = file.has(edit.key) && file.take(edit.key, "", before);
    const double change = parseNumber(edit.value.c_str()) - before;
    text += format("  %-32s", edit.key.c_str());
    text += is_there ? format("%.8g in the file, %s solved", before, edit.value.c_str())
                     : "not in the file, " + edit.value + " solved";
    text += !is_there ? "\n" : change == 0 ? ": the same\n" : format(": %+.5f\n", change);
  }
  return text;
}

void writeSetup(const std::string& path, const JobSetup& setup) {
  try {
    const std::string before = readTextFile(path);
    const std::string text = editJob(before, path, setup.edits);
    // The operations after this one may have no set-up yet.
    const GrindJob written = parseJob(text, path, unsolvedFields({}), toString(setup.job.process.kind));
    if (!sameNumbers(written, setup.job)) throw JobFileError(path + ": has changed since it was read");
    writeFile(path + ".before", before);
    replaceFile(path, text);
  } catch (const std::system_error& error) {
    throw JobFileError(path + ": cannot be written: " + error.code().message() + byHand(setup.edits));
  } catch (const JobFileError& error) {
    throw JobFileError(error.what() + byHand(setup.edits));
  }
}

}  // namespace grinder
