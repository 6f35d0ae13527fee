#pragma once

#include "cli/csv.h"
#include "cli/json_output.h"
#include "flute_grinder/tool/ground_tool.h"

#include <string>

namespace grinder {

/// Prints a figure over all teeth, with what is asked.
void printFigure(const GroundFigure& figure);

/// Prints the sections and the extremes over all of them in shop units. Teeth count from 1.
void printText(const GroundTool& tool);

/// The output of `--json`, with the outlines of the sections. Teeth count from 0.
Json toJson(const GroundTool& tool);

/// A CSV file with a line for each section and tooth, which count from 0. A figure that does not exist is an empty
/// field.
class GroundToolCsv : public CsvFile {
 public:
  GroundToolCsv(const std::string& path, const ValidJob& job);
  void write(const GroundTool& tool);
};

}  // namespace grinder
