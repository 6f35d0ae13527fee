#include "flute_grinder/geometry/write_setup.h"

#include "flute_grinder/geometry/replace_file.h"

#include <filesystem>
#include <system_error>

namespace grinder {

void requireSetupFile(const JobFile& asked) {
  if (!asked.setup_path.empty()) return;
  const std::string stem = std::filesystem::path(asked.path).stem();
  throw JobFileError(
      asked.path + ": the figures of the set-up are written by hand; to have them written, put setup: {file: " + stem +
      ".setup.yaml} in place of setup, depth_mm, depth_end_mm and overtravel_mm");
}

void writeSetup(const JobFile& asked, const GrindJob& solved) {
  requireSetupFile(asked);
  const std::string& file = asked.setup_path;
  try {
    const std::string before = std::filesystem::exists(file) ? readTextFile(file) : "";
    replaceFile(file, withSetup(before, file, std::filesystem::path(asked.path).filename(), solved));
  } catch (const std::system_error& error) {
    throw JobFileError(file + ": cannot be written: " + error.code().message());
  }
}

}  // namespace grinder
