#pragma once

#include "flute_grinder/tool/end_volumes.h"
#include "flute_grinder/tool/gouge.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/run_strokes.h"

#include <string>
#include <vector>

namespace grinder {

/// A section of a ground cutter, measured for a report.
struct MeasuredSection {
  GroundSection ground;
  double area_removed = 0;  ///< [m^2]
};

/// A ground cutter, measured as planned or as ground by a run.
struct GroundTool {
  ValidJob job;
  std::string source;  ///< origin of the data, for the reader
  GroundCutter cutter;
  CutterCheck check;
  EndVolumes end;  ///< what is taken from its end
  std::vector<MeasuredSection> sections;
  double volume_removed = 0;  ///< over the flute's length [m^3]
  bool of_run = false;        ///< as ground in a run, rather than as planned
  bool on_planned = false;    ///< for a run of a relief: the preceding operations are taken as planned
  std::vector<RunStroke> strokes;
  std::vector<Gouge> gouges;  ///< gouges deeper than the error of sampling

  /// Whether the run has a stroke of every tooth; a continued job's run does not.
  bool allTeethGround() const;
};

/// Depth above which the following error alone does not explain a gouge [m].
constexpr double kBadGouge = 10e-6;

/// Number of sections for judging a tool.
constexpr int kJudgedSections = 17;

/// X beyond which no wheel of the flutes and reliefs up to the job's operation touches the cutter: the strokes' ends,
/// and the run-out of the deepest pass [m].
double groundTo(const GrindJob& job);

/// X of `count` equidistant sections over the flute, including its ends [m].
/// @param count 2 or more.
std::vector<double> evenSections(const GrindJob& job, int count);

/// Measures a cutter.
/// @param at X of the sections [m].
GroundTool measure(const ValidJob& job, const std::string& source, GroundCutter cutter, const std::vector<double>& at);

/// Measures the cutter of a run; gouges are among the reasons for refusing it.
GroundTool measure(const std::string& source, const RunStrokes& strokes, const std::vector<double>& at);

}  // namespace grinder
