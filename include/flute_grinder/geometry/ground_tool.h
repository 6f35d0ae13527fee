#pragma once

#include "flute_grinder/geometry/gouge.h"
#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/geometry/run_strokes.h"

#include <string>
#include <vector>

namespace grinder {

/// A section of a ground cutter with what is measured for a report.
struct MeasuredSection {
  GroundSection ground;
  double area_removed = 0;  ///< [m^2]
};

/// A ground cutter, measured as a job asks for it or as a run ground it.
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

  /// Whether its run has a stroke of every tooth: that of a job which was continued has not.
  bool allTeethGround() const;
};

/// A gouge deeper than that is not the following error alone [m].
constexpr double kBadGouge = 10e-6;

/// How many sections a tool is judged by.
constexpr int kJudgedSections = 17;

/// X of `count` sections that are even over the flute, its ends included [m]. @param count 2 or more.
std::vector<double> evenSections(const GrindJob& job, int count);

/// Measures a cutter. @param at X of the sections [m].
GroundTool measure(const ValidJob& job, const std::string& source, GroundCutter cutter, const std::vector<double>& at);

/// Measures the cutter of a run; gouges are among the reasons why it is unusable.
GroundTool measure(const std::string& source, const RunStrokes& strokes, const std::vector<double>& at);

}  // namespace grinder
