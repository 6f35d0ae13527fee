#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/stroke_log.h"
#include "flute_grinder/tool/ground_tool.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The tolerances by which a ground tool is judged, beside the tolerances in its job.
struct Tolerances {
  double land_mm = 0;              ///< minimum land [mm]
  double edge_diameter_mm = 0;     ///< difference of the edges' diameter from the blank's, with reliefs [mm]
  double following_error_um = 0;   ///< following error in the strokes, of A at the maximum radius [um]
  double feed_percent = 0;         ///< difference of the feed from the job's, between the ends of the flute [%]
  double late_cycles_percent = 0;  ///< late control cycles [%]
};

/// Reads the tolerances. @param path YAML file with the names above as keys. @throw FileError if it cannot be read,
/// a key is missing or unknown, or a value is not a number from 0.
Tolerances readTolerances(const std::string& path);

/// One line of a verdict: the figure with the largest difference from the value asked for, all in `unit`.
struct Criterion {
  std::string name, unit;
  bool of_tool = false;             ///< the criterion judges the tool's geometry, else the run
  std::optional<int> digits;        ///< digits behind the point; nothing for three digits in all
  std::optional<double> asked;      ///< value asked for; nothing if there is none, or nothing to compare it with
  std::optional<double> tolerance;  ///< maximum difference from `asked`; nothing if `asked` is a minimum
  std::optional<double> measured;   ///< value measured; nothing if it was not measured
  bool missing = false;             ///< the figure does not exist where it should
  std::string place;                ///< place, for the reader
  std::string remark;               ///< why it was not measured; may be empty

  /// "passed", "failed" or "not measured", which is never passed.
  const char* result() const;
};

/// The facts of a run for its verdict.
struct RunFacts {
  const ValidJob& job;
  const std::vector<StrokeFigures>& strokes;
  const std::vector<FeedLimit>& feed_limits;  ///< limits of the feed in the plan
  std::uint64_t cycles = 0;                   ///< cycles among which late ones were counted
  std::uint64_t late = 0;
  double longest = 0;  ///< longest period of a cycle [s]
};

/// The criteria of the tool: whether its figures are as asked. Unless all teeth were ground, only gouges are measured.
/// @param tool tool of a run of this job; null if it was not measured.
std::vector<Criterion> criteriaOfTool(const ValidJob& job, const GroundTool* tool, const Tolerances& tolerances);

/// The criteria of the run: path, following error, feed, late cycles.
std::vector<Criterion> criteriaOfRun(const RunFacts& run, const Tolerances& tolerances);

/// Judges again the criteria that depend on Tolerances alone.
void judgeAgain(std::vector<Criterion>& criteria, const Tolerances& tolerances);

struct Verdict {
  std::string verdict;               ///< passed, failed, unfinished or incomplete
  std::vector<std::string> because;  ///< names of the failed criteria, or the unknowns
};

/// @param outcome outcome of the job; empty if unknown. @param lost setpoints missing from the record.
/// @param unknown other reasons why the tool cannot pass, in words.
Verdict verdictOn(const std::vector<Criterion>& criteria, const std::string& outcome, std::uint64_t lost,
                  std::vector<std::string> unknown = {});

/// An entry of `unknown`: the goal skipped the check of the zero points.
constexpr const char* kNoOffsetCheck = "ground without the check of the zero points";

/// The criteria as written in records and reports, see docs/command-line.md.
Json toJson(const std::vector<Criterion>& criteria);
/// @throw Json::exception for JSON that toJson() does not write.
std::vector<Criterion> criteriaFrom(const Json& json);

}  // namespace grinder
