#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/stroke_log.h"
#include "flute_grinder/record/tool_records.h"
#include "flute_grinder/record/verdict.h"
#include "flute_grinder/report/bag_run.h"
#include "flute_grinder/tool/ground_tool.h"

#include <memory>
#include <optional>
#include <string>

namespace grinder {

class MotionOfRows;
class Plots;

/// The contents of a report that do not come from its file.
struct ReportContext {
  std::string file;                ///< name of the file for the reader
  Json words;                      ///< note, operator and serial number from the command line
  std::optional<GroundTool> tool;  ///< tool as the run ground it; nothing if unknown
  Json tool_json;                  ///< the tool in the JSON of `grind simulate`
  std::string no_tool;             ///< why the tool is unknown
  Tolerances tolerances;           ///< tolerances by which the tool is judged
};

/// Goes through the rows of a bag once, and computes all that a report shows of them.
class RunFindings {
 public:
  /// @param run must outlive this object. @param job job of the run, with its laws; nothing if the run has none.
  /// @param draws whether pictures are wanted.
  RunFindings(const BagRun& run, const std::optional<ValidJob>& job, bool draws);
  ~RunFindings();

  void add(const RunRow& row);

  /// The data of the report.
  Json json(const ReportContext& context) const;
  /// The points of the report's pictures; only if they are wanted.
  Json plots() const;

 private:
  /// Maximum absolute values of the axes, in the strokes and between them.
  struct MaxOfAxes {
    void add(bool in_stroke, const Axes& values);
    Axes stroke = Axes::Zero(), rapid = Axes::Zero();
  };

  Json ofSetpoints() const;
  void judge(Json& data, const ReportContext& context) const;
  Json axesJson(const Json& machine) const;
  Json loopJson() const;
  Json holdsAndOverrides() const;

  const BagRun& run_;
  std::unique_ptr<MotionOfRows> motion_;
  std::unique_ptr<Plots> plots_;
  StrokeLog strokes_;
  MaxOfAxes speed_, acceleration_, following_;
  double shortest_ = 0, longest_ = 0, sum_ = 0;  ///< shortest, longest and sum of the measured periods [s]
  std::uint64_t late_ = 0, count_ = 0;
};

/// The data of a report on a tool from the grinder's own records.
Json findingsOfTool(const ToolRecords& tool, const ReportContext& context);

}  // namespace grinder
