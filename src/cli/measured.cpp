#include "cli/measured.h"

#include "cli/history.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/network/user_at_host.h"
#include "flute_grinder/record/measured.h"

#include <cstdio>

namespace grinder {

int keepMeasured(const std::string& node, const MeasuredOptions& options) {
  const GrindJob job = readJobFile(options.job, options.operation);
  std::vector<MeasuredFigure> figures;
  for (const std::string& text : options.figures) figures.push_back(measuredFrom(text, job));
  const std::vector<ToolNumber> tools = toolsOf(node, options.folder, job);
  const ToolNumber& tool = toolOf(tools, options.tool);
  const ValidJob asked(job);
  const Record record = keepMeasured(tool, figures, userAtHost());
  std::printf("tool %ju, %s, ground until %s\n", std::uintmax_t{tool.number}, record.head.tool.c_str(),
              record.head.ended.c_str());
  for (const MeasuredFigure& measured : figures) std::printf("%s\n", text(measured, asked).c_str());
  return 0;
}

}  // namespace grinder
