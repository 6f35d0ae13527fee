#include "flute_grinder/setup/write_setup.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/replace_file.h"

#include <filesystem>
#include <system_error>

namespace grinder {

void requireSetupFile(const JobFile& asked) {
  if (!asked.setup_path.empty()) return;
  const std::string stem = std::filesystem::path(asked.path).stem();
  throw FileError(asked.path +
                  ": the figures of the set-up are written by hand; to have them written, put setup: {file: " + stem +
                  ".setup.yaml} in place of setup, depth_mm, depth_end_mm and overtravel_mm");
}

void writeSetup(const JobFile& asked, const GrindJob& solved) {
  requireSetupFile(asked);
  const std::string& file = asked.setup_path;
  try {
    const std::string before = std::filesystem::exists(file) ? readTextFile(file) : "";
    replaceFile(file, withSetup(before, file, std::filesystem::path(asked.path).filename(), solved));
  } catch (const std::system_error& error) {
    throw FileError(file + ": cannot be written: " + error.code().message());
  }
}

}  // namespace grinder
