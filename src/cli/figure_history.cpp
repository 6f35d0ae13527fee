#include "cli/figure_history.h"

#include "cli/history.h"
#include "cli/json_output.h"
#include "cli/output_file.h"
#include "cli/report.h"
#include "cli/time_text.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/measured_tools.h"

#include <cmath>
#include <cstdio>

namespace grinder {

namespace {

/// @param history see figureHistory().
void printTable(const Json& history) {
  const std::string unit = history["unit"];
  const bool is_asked = !history["asked"].is_null();
  std::printf("%s", history["words"].get_ref<const std::string&>().c_str());
  if (!history["x_mm"].is_null()) std::printf(" at X = %.6g mm", history["x_mm"].get<double>());
  if (is_asked) {
    std::printf("; asked %.6g %s within %.6g %s", history["asked"].get<double>(), unit.c_str(),
                history["tolerance"].get<double>(), unit.c_str());
  }
  std::printf("\n%6s  %-19s  %12s  %10s  %10s  zero points\n", "tool", "ground until", ("measured, " + unit).c_str(),
              "Y, mm", "Z, mm");
  for (const Json& tool : history["tools"]) {
    const Json& measured = tool["measured"];
    const std::string value = measured.is_null() ? "-" : format("%.4f", measured.get<double>());
    const bool is_off =
        is_asked && !measured.is_null() &&
        !(std::abs(measured.get<double>() - history["asked"].get<double>()) <= history["tolerance"].get<double>());
    std::printf("%6ju  %-19s  %12s  %10.4f  %10.4f  %s%s\n", std::uintmax_t{tool["tool"].get<std::uint64_t>()},
                timeText(timeOf(tool["ended"]), false).c_str(), value.c_str(), tool["y_mm"].get<double>(),
                tool["z_mm"].get<double>(), tool["zero_points"].get_ref<const std::string&>().c_str(),
                is_off ? "; OUT OF TOLERANCE" : "");
  }
}

}  // namespace

int printFigureHistory(const std::string& node, const std::string& folder, const FigureHistoryOptions& options,
                       bool json) {
  const GrindJob job = readJobFile(options.job, options.operation);
  const FigureAt at = figureFrom(options.figure, job);
  const std::vector<ToolNumber> tools = toolsOf(node, folder, job);
  toolOf(tools, 0);  // there is one
  const auto svg = openOutput(options.svg);
  const Json history = figureHistory(ValidJob(job), measuredTools(tools), at);
  if (json) {
    print(history);
  } else {
    printTable(history);
  }
  return svg ? drawPicture("measured.py", history, *svg) : 0;
}

}  // namespace grinder
