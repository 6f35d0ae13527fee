#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

class FlatFile;

/// A grinding wheel as its file describes it, and as it was last measured.
struct WheelFile {
  /// The wheel_... members, as the wheel is now: wheel_diameter is the one to which Y = 0 is set, wheel_wear follows
  /// from the measured diameter, wheel_width is the measured width. All others are without meaning.
  GrindProcess process;
  std::vector<ProfilePoint> points;  ///< as GrindJob::wheel_points
  double new_width = 0;              ///< the width before any measurement [m]
  std::optional<double> flange;  ///< from the flange's face down to the wheel's upper face, if the file states it [m]
  bool measured = false;
  std::string date;     ///< of the measurement: YYYY-MM-DD, or YYYY-MM-DDThh:mm:ssZ
  std::string by;       ///< who measured; may be empty
  std::string dressed;  ///< when last, as `date`; empty if that is not known

  /// The maximum diameter, as the wheel is now [m].
  double diameter() const noexcept { return process.wheel_diameter - 2 * process.wheel_wear; }
};

/// Reads and checks a wheel file (YAML, mm and deg).
/// @throw JobFileError if it cannot be read, with a line for each error, as for a job file.
WheelFile readWheelFile(const std::string& path);

/// The same from text; `name` is the file in messages.
WheelFile parseWheel(const std::string& text, const std::string& name);

/// Gives a job the wheel. The wear per pass stays, since it is the process's.
void mountWheel(const WheelFile& wheel, GrindJob& job);

/// Takes what is no number of a wheel, profile, larger face and points, from a file in which all the wheel's keys begin
/// with `prefix`.
void takeWheelShape(FlatFile& file, const std::string& prefix, GrindJob& job);

}  // namespace grinder
