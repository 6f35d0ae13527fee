#pragma once

#include "flute_grinder/job/grind_job.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

class FlatFile;
struct JobField;
struct OtherKey;

/// A grinding wheel as described in its file, with its last measurement.
struct WheelFile {
  /// Only the wheel_... members are set: wheel_diameter is the diameter to which Y = 0 is set, wheel_wear follows from
  /// the measured diameter, and wheel_width is the measured width.
  GrindProcess process;
  double new_width = 0;          ///< width of the new wheel [m]
  std::optional<double> flange;  ///< distance from the flange's face down to the wheel's upper face, if stated [m]
  bool measured = false;
  std::string date;     ///< date of the measurement: YYYY-MM-DD, or YYYY-MM-DDThh:mm:ssZ
  std::string by;       ///< name of whoever measured; may be empty
  std::string dressed;  ///< date of the last dressing, in the format of `date`; empty if unknown

  /// The present maximum diameter [m].
  double diameter() const noexcept { return process.wheel_diameter - 2 * process.wheel_wear; }
};

/// Reads and checks a wheel file (YAML, mm and deg).
/// @throw FileError with a line for each error.
WheelFile readWheelFile(const std::string& path);

/// Reads and checks a wheel from text; `name` is the file in messages.
WheelFile parseWheel(const std::string& text, const std::string& name);

/// The numbers of a wheel file, with its own keys: what a job says of its wheel but the wear, the flange, and the
/// measured width.
std::vector<JobField> wheelFields();
/// The other keys of a wheel file.
std::vector<OtherKey> otherWheelKeys();

/// Puts the wheel into a job. The wear per pass belongs to the process and stays.
void mountWheel(const WheelFile& wheel, GrindJob& job);

/// Takes the choices and lists of a wheel, i.e. profile, larger face and points, from a file in which all the wheel's
/// keys begin with `prefix`.
void takeWheelShape(FlatFile& file, const std::string& prefix, GrindJob& job);

}  // namespace grinder
