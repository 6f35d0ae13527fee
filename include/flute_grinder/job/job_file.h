#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/setup_file.h"
#include "flute_grinder/job/wheel_file.h"

#include <optional>
#include <string>

namespace grinder {

/// Reads and checks a job from a YAML file in the operator's units (mm, deg, mm/min), with the wheel files and the
/// set-up file that it may name, relative to the job file.
/// @param path the file.
/// @param operation the job's operation if there are several: its number, from 1, or its kind, e.g. "primary".
/// @return the job in SI.
/// @throw FileError if a file cannot be read, a key is missing, unknown or duplicated, a value has the wrong type,
/// is
///        not finite or is not allowed, or a set-up was solved for another cutter or wheel.
GrindJob readJobFile(const std::string& path, const std::string& operation = "");

/// Reads and checks a job from text; `name` is the file in messages, and other files are relative to its folder.
GrindJob parseJob(const std::string& text, const std::string& name, const std::string& operation = "");

/// A job file, and the files that the job's operation names.
struct JobFile {
  std::string path;
  GrindJob job;
  std::string wheel_path;          ///< path of the wheel file; empty if the job file states the wheel itself
  std::optional<WheelFile> wheel;  ///< what the wheel file says
  std::string setup_path;          ///< path of the set-up file; empty if the job file states the set-up itself
};

/// Reads a job as readJobFile(), once for everything that its files say.
JobFile openJobFile(const std::string& path, const std::string& operation = "");

/// A job whose set-up is to be solved. It has the set-up that the job file states, or else starts from clearSetup()
/// with the wanted figure.
struct JobToSetUp : JobFile {
  std::optional<GrindProcess>
      before;                         ///< its operation with the set-up that it has; nothing if there is none that fits
  std::optional<SetupFigure> wanted;  ///< the figure that the job file asks for beside the set-up file
};

/// Reads a job to solve the set-up of one of its operations, as readJobFile(), but the set-ups of this and of the later
/// operations need not be there. The preceding operations must be set up.
JobToSetUp readJobToSetUp(const std::string& path, const std::string& operation = "");

}  // namespace grinder
