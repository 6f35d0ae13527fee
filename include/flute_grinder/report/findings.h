#pragma once

#include "flute_grinder/geometry/ground_tool.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/stroke_log.h"
#include "flute_grinder/record/verdict.h"
#include "flute_grinder/report/bag_run.h"
#include "flute_grinder/report/tool_records.h"

#include <memory>
#include <optional>
#include <string>

namespace grinder {

class MotionOfRows;
class Plots;

/// What a report says beside what its file has.
struct ReportContext {
  std::string file;                ///< its name for the reader
  Json words;                      ///< note, operator and serial, of whoever asks for the report
  std::optional<GroundTool> tool;  ///< as the run ground it; nothing if that is not known
  Json tool_json;                  ///< the same as `grind simulate` has it
  std::string no_tool;             ///< why it is not known
  Tolerances tolerances;           ///< by which the tool is passed
};

/// Goes through the rows of a bag once, and works out all that a report says of them.
class Survey {
 public:
  /// @param run must outlive this object. @param job of the run, with its laws; nothing if it has none.
  /// @param draws pictures are wanted.
  Survey(const BagRun& run, const std::optional<ValidJob>& job, bool draws);
  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;
  ~Survey();

  void add(const RunRow& row);

  /// The data of the report.
  Json findings(const ReportContext& context) const;
  /// The points of its pictures. Only if they are wanted.
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
  double shortest_ = 0, longest_ = 0, sum_ = 0;  ///< of the cycles' measured periods [s]
  std::uint64_t late_ = 0, count_ = 0;
};

/// What a report says of a tool by the grinder's own records.
Json findingsOfTool(const ToolRecords& tool, const ReportContext& context);

}  // namespace grinder
