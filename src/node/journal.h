#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/job/tooth_pass.h"
#include "node/state_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// How far a job has come.
struct Progress {
  std::string job_digest;            ///< see jobDigest(); empty if there has been no job
  std::string job_name;              ///< as given in the goal, for display
  std::string operation;             ///< as GrindJob::operationText()
  CutterGeometry cutter;             ///< of the job, for display
  std::vector<double> tooth_angles;  ///< of the job, for display [rad]
  bool finished = false;             ///< every pass is ground
  ToothPass next;                    ///< the first unfinished pass
  double x = 0;                      ///< reached in its stroke, or in the last one [m]
  std::string end;             ///< how it ended, for display; empty while it runs, and if this process ended first
  double feed_override = 1;    ///< at which it was left, fraction
  Wheel wheel;                 ///< as it was left
  Axes offset = Axes::Zero();  ///< with which the job began, see RunStart [m], A [rad]
  std::uint32_t mounting = 0;  ///< of the wheel with which the job began, see MountedWheel
  std::uint32_t clamping = 0;  ///< of the tool in the same way, see ClampedTool
  std::string tool_digest;     ///< as OffsetBasis::tool_digest
  int tool_operation = 0;      ///< as OffsetBasis::operation
};

template <>
struct StateForm<Progress> {
  static constexpr const char* kKind = "journal";
  static constexpr const char* kComment =
      "The grinder's progress; tooth and pass, from 0, are the first that is not finished.";
  static constexpr bool kInBackground = true;
  static void visit(StateFields& field, Progress& progress);
};

/// The progress of the last job on disk.
using Journal = StateFile<Progress>;

}  // namespace grinder
