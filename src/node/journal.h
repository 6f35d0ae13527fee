#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/job/cutter_geometry.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/tooth_pass.h"
#include "node/state_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// The progress of a job.
struct Progress {
  std::string job_digest;            ///< see jobDigest(); empty if there has been no job
  std::string job_name;              ///< name given in the goal, for display
  std::string operation;             ///< text of GrindJob::operationText()
  CutterGeometry cutter;             ///< cutter of the job, for display
  std::vector<double> tooth_angles;  ///< angles of the job's teeth, for display [rad]
  bool finished = false;             ///< every pass is ground
  ToothPass next;                    ///< the first unfinished pass
  double x = 0;                      ///< X reached in the stroke of `next`, or in the last stroke [m]
  std::string end;             ///< how the job ended, for display; empty while it runs, or if this process ended first
  double feed_override = 1;    ///< last feed override, fraction
  Wheel wheel;                 ///< last state of the wheel
  Axes offset = Axes::Zero();  ///< work offsets with which the job began, see RunStart [m], A [rad]
  std::uint32_t mounting = 0;  ///< mounting of the wheel when the job began, see MountedWheel
  std::uint32_t clamping = 0;  ///< clamping of the tool when the job began, see ClampedTool
  std::string tool_digest;     ///< see OffsetBasis::tool_digest
  OperationKind kind{};        ///< see OffsetBasis::kind
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
