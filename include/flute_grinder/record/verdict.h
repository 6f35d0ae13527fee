#pragma once

#include "flute_grinder/messages/json.h"

#include <string>
#include <vector>

namespace grinder {

/// What a ground tool is passed by, beside the tolerances that its job has.
struct Tolerances {
  double land_mm = 0;              ///< minimum land [mm]
  double primary_mm = 0;           ///< difference of the primary relief's width at the small end from the job's [mm]
  double following_error_um = 0;   ///< following error in the strokes, of A at the maximum radius [um]
  double feed_percent = 0;         ///< difference of the feed from the job's, between the ends of the flute [%]
  double late_cycles_percent = 0;  ///< late control cycles [%]
};

/// @param path of a YAML file with the names above as keys. @throw JobFileError if it cannot be read, a key is missing
/// or unknown, or a value is no number from 0.
Tolerances readTolerances(const std::string& path);

struct Verdict {
  std::string verdict;               ///< passed, failed, unfinished or incomplete
  std::vector<std::string> because;  ///< which criteria failed, or what is not known
};

/// Whether a tool, as `grind simulate` measures it, has a stroke of each tooth: of a job that was continued it has not.
bool allTeethGround(const Json& tool);

/// Passes or fails a ground tool: adds "criteria", "verdict" and "verdict_because", see docs/command-line.md.
/// @param data in the keys of a record of a job, with "kind", which is "record" for the grinder's own. Such a one has
/// no
///        positions, so that its tool is not measured, and needs "duration_s"; others may have "tool", as ground.
/// @throw Json::exception if a key is missing or has another type.
void addVerdict(Json& data, const Tolerances& tolerances);

/// The same for a record that the grinder keeps of a job: adds "kind" and "duration_s", too.
void judgeRecord(Json& record, const Tolerances& tolerances);

/// The same without "criteria", "verdict" and "verdict_because", which take time. @param record or its summary.
Verdict verdictOnRecord(Json& record, const Tolerances& tolerances);

}  // namespace grinder
