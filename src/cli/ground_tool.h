#pragma once

#include "cli/csv.h"
#include "cli/json_output.h"
#include "flute_grinder/geometry/gouge.h"
#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/run_strokes.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A section of a ground cutter with what is measured for a report.
struct MeasuredSection {
  GroundSection ground;
  double area_removed = 0;  ///< [m^2]
};

/// A ground cutter as `grind simulate` shows it.
struct GroundTool {
  ValidJob job;
  std::string source;  ///< where it comes from, for the reader
  GroundCutter cutter;
  CutterCheck check;
  std::vector<MeasuredSection> sections;
  double volume_removed = 0;  ///< over the flute's length [m^3]
  bool of_run = false;        ///< as ground in a run
  bool on_planned = false;    ///< of a run of a relief: the operations ahead of it are taken as planned
  std::vector<RunStroke> strokes;
  std::vector<Gouge> gouges;  ///< those deeper than what sampling leaves
};

/// X of `count` sections that are even over the flute, its ends included [m]. @param count 2 or more.
std::vector<double> evenSections(const GrindJob& job, int count);

/// Measures a cutter. @param at X of the sections [m].
GroundTool measure(const ValidJob& job, const std::string& source, GroundCutter cutter, const std::vector<double>& at);

/// Measures the cutter of a run; gouges are among the reasons why it is unusable.
GroundTool measure(const std::string& source, const RunStrokes& strokes, const std::vector<double>& at);

/// Prints the sections and the extremes over all of them in shop units. Teeth count from 1.
void printText(const GroundTool& tool);

/// For `--json`, with the outlines of the sections. Teeth count from 0.
Json toJson(const GroundTool& tool);

/// A line for each section and tooth, which count from 0. What does not exist is an empty field.
class GroundToolCsv : public CsvFile {
 public:
  GroundToolCsv(const std::string& path, const ValidJob& job);
  void write(const GroundTool& tool);
};

}  // namespace grinder
