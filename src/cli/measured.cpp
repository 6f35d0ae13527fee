#include "cli/measured.h"

#include "cli/history.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/replace_file.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/network/user_at_host.h"
#include "flute_grinder/record/measured.h"

#include <chrono>
#include <cstdio>
#include <system_error>

namespace grinder {

int keepMeasured(const std::string& node, const MeasuredOptions& options) {
  const GrindJob job = readJobFile(options.job, options.operation);
  std::vector<MeasuredFigure> figures;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  for (const std::string& text : options.figures) {
    MeasuredFigure& measured = figures.emplace_back(measuredFrom(text, job));
    measured.when = utcText(std::chrono::duration<double>(now).count());
    measured.by = userAtHost();
  }
  const std::vector<ToolNumber> tools = toolsOf(node, options.folder, job);
  const ToolNumber& tool = toolOf(tools, options.tool);
  Record record = readRecord(tool.path);
  for (const MeasuredFigure& measured : figures) addMeasured(record, measured);
  const ValidJob asked(job);
  try {
    replaceFile(tool.path, text(record));
  } catch (const std::system_error& error) {
    throw FileError(tool.path + ": what was measured cannot be kept: " + error.code().message());
  }
  std::printf("tool %ju, %s, ground until %s\n", std::uintmax_t{tool.number}, record.head.tool.c_str(),
              record.head.ended.c_str());
  for (const MeasuredFigure& measured : figures) std::printf("%s\n", text(measured, asked).c_str());
  return 0;
}

}  // namespace grinder
