#pragma once

#include "flute_grinder/geometry/ground_tool.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/stroke_log.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// What a ground tool is passed by, beside the tolerances that its job has.
struct Tolerances {
  double land_mm = 0;              ///< minimum land [mm]
  double edge_diameter_mm = 0;     ///< difference of the edges' diameter from the blank's, where there are reliefs [mm]
  double following_error_um = 0;   ///< following error in the strokes, of A at the maximum radius [um]
  double feed_percent = 0;         ///< difference of the feed from the job's, between the ends of the flute [%]
  double late_cycles_percent = 0;  ///< late control cycles [%]
};

/// @param path of a YAML file with the names above as keys. @throw JobFileError if it cannot be read, a key is missing
/// or unknown, or a value is no number from 0.
Tolerances readTolerances(const std::string& path);

/// One line of a verdict: the figure that is farthest off what is asked, all in `unit`.
struct Criterion {
  std::string name, unit;
  bool of_tool = false;             ///< of the tool's geometry, else of the run
  std::optional<int> digits;        ///< behind the point; nothing: three in all
  std::optional<double> asked;      ///< nothing if nothing is asked, or there is nothing to compare it with
  std::optional<double> tolerance;  ///< maximum difference from `asked`; nothing: that is the minimum allowed
  std::optional<double> measured;   ///< nothing if it was not measured
  bool missing = false;             ///< it was looked for where it should be, and there is none
  std::string place;                ///< where, for the reader
  std::string remark;               ///< why it was not measured; may be empty

  /// "passed", "failed" or "not measured", which is never passed.
  const char* result() const;
};

/// What a verdict is made of, beside the tool.
struct RunFacts {
  const ValidJob& job;
  const std::vector<StrokeFigures>& strokes;
  const std::vector<FeedLimit>& feed_limits;  ///< of the plan
  std::uint64_t cycles = 0;                   ///< in which late ones were counted
  std::uint64_t late = 0;
  double longest = 0;  ///< period of a cycle [s]
};

/// Whether and how the tool's figures are as asked. They are not measured unless all teeth were ground; gouges are.
/// @param tool of a run of this job; null if it was not measured.
std::vector<Criterion> criteriaOfTool(const ValidJob& job, const GroundTool* tool, const Tolerances& tolerances);

/// The same of the run: path, following error, feed, late cycles.
std::vector<Criterion> criteriaOfRun(const RunFacts& run, const Tolerances& tolerances);

/// Judges again what is passed by Tolerances alone.
void judgeAgain(std::vector<Criterion>& criteria, const Tolerances& tolerances);

struct Verdict {
  std::string verdict;               ///< passed, failed, unfinished or incomplete
  std::vector<std::string> because;  ///< which criteria failed, or what is not known
};

/// @param outcome of the job; empty if it is not known. @param lost setpoints that are not in the record.
/// @param unknown what else keeps the tool from passing, in words.
Verdict verdictOn(const std::vector<Criterion>& criteria, const std::string& outcome, std::uint64_t lost,
                  std::vector<std::string> unknown = {});

/// Of `unknown`: a goal has said that the zero points are right.
constexpr const char* kNoOffsetCheck = "ground without the check of the zero points";

/// As records and reports have them, see docs/command-line.md.
Json toJson(const std::vector<Criterion>& criteria);
/// @throw Json::exception for what toJson() does not write.
std::vector<Criterion> criteriaFrom(const Json& json);

}  // namespace grinder
