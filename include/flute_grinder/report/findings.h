#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/machine_info.h"
#include "flute_grinder/record/stroke_log.h"
#include "flute_grinder/record/verdict.h"
#include "flute_grinder/report/run_file.h"

#include <memory>
#include <optional>
#include <string>

namespace grinder {

class MotionOfRows;
class Plots;

/// What a report says beside what its file has.
struct ReportContext {
  std::string file;       ///< its name for the reader
  Json words;             ///< note, operator and serial, of whoever asks for the report
  Json tool;              ///< as `grind simulate` measures it; null if it cannot be
  std::string no_tool;    ///< why not
  Tolerances tolerances;  ///< by which the tool is passed
  MachineInfo limits;     ///< of a machine, for files without theirs
};

/// Goes through the rows of a file once, and works out all that a report says of them.
class Survey {
 public:
  /// @param run must outlive this object. @param job of the run, with its laws; nothing if it has none.
  /// @param draws pictures are wanted.
  Survey(const RunFile& run, const std::optional<ValidJob>& job, bool draws);
  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;
  ~Survey();

  void add(const RunRow& row);

  /// The data of the report, in the keys of the grinder's own records, with more.
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
  Json axesJson(const Json& limits) const;
  Json loopJson() const;
  Json holdsAndOverrides() const;

  const RunFile& run_;
  std::unique_ptr<MotionOfRows> motion_;
  std::unique_ptr<Plots> plots_;
  StrokeLog strokes_;
  MaxOfAxes speed_, acceleration_, following_;
  double shortest_ = 0, longest_ = 0, sum_ = 0;  ///< of the cycles' measured periods [s]
  std::uint64_t late_ = 0, count_ = 0;
};

/// What a report says of a record that the grinder keeps of a job, see readRecord().
Json findingsOfRecord(const Json& record, const ReportContext& context);

}  // namespace grinder
