#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/core/limit_check.h"

#include <diagnostic_updater/diagnostic_updater.h>

#include <array>
#include <functional>
#include <mutex>
#include <string>

namespace flute_grinder {

/// From where on a figure is a warning, and from where on an error.
struct DiagnosticLevels {
  double warn = 0;
  double error = 0;
};

/// The levels of all figures that have some; fractions.
struct DiagnosticThresholds {
  DiagnosticLevels late_cycles;      ///< above: of all cycles since the last report
  DiagnosticLevels following_error;  ///< above: of what the axis is allowed
  DiagnosticLevels limit_use;        ///< above: of a limit of the axis
  DiagnosticLevels buffer_fill;      ///< below: of the fullest that the buffer has been since the power came
};

/// Reads diagnostics/<figure>/warn and .../error.
/// @throw ParameterError unless all are there, in range, and the error no earlier than the warning.
DiagnosticThresholds readDiagnosticThresholds(const ParameterReader& parameters);

/// What the system has granted the control loop.
struct Scheduling {
  bool realtime = false;
  bool memory_locked = false;
};

/// Watches every cycle of the control loop, and reports for /diagnostics the worst since the report before. Thread
/// safe.
class Diagnostics {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// @param config the machine's limits and tolerances.
  /// @param scheduling asked at each report.
  Diagnostics(const LoopConfig& config, const DiagnosticThresholds& thresholds, std::function<Scheduling()> scheduling);

  /// Has the updater, which this object must outlive, ask for all reports.
  void addTo(diagnostic_updater::Updater& updater);

  /// Takes the record of a cycle; of every one, in order.
  void watch(const CycleRecord& record);
  /// Takes what is amiss with the journal; empty for nothing.
  void setJournalError(const std::string& error);

  void reportLoop(Status& status);
  void reportDrive(Status& status);
  void reportFollowing(Status& status);
  void reportLimits(Status& status);
  void reportBuffer(Status& status);
  void reportJournal(Status& status);

 private:
  /// Position, velocity, acceleration and jerk of every axis over their limits, by LimitedQuantity.
  using LimitUse = std::array<Axes, 4>;

  struct Loop {
    std::uint64_t cycles = 0;
    std::uint64_t late = 0;
    double longest = 0;  ///< period [s]
    double total = 0;    ///< [s]
  };
  struct Drive {
    double feedback_age = 0;  ///< longest [s]
    bool emergency_stop = false;
    bool fault = false;
    Interlock interlock = Interlock::kNone;
    LoopFault loop_fault;
    Axes position = Axes::Zero();  ///< the last one, or one that was not a number
  };
  struct Limits {
    std::uint64_t setpoints = 0;
    LimitUse use{Axes::Zero(), Axes::Zero(), Axes::Zero(), Axes::Zero()};
  };
  struct Buffer {
    bool watched = false;
    std::uint32_t least = 0;  ///< commands
  };

  void watchDrive(const CycleRecord& record);
  void watchSetpoint(const Setpoint& setpoint);
  void watchViolation(const LimitViolation& violation);
  void watchBuffer(const DriveStatus& drive);
  double positionUse(int axis, double position) const;

  const LoopConfig config_;
  const DiagnosticThresholds thresholds_;
  const std::function<Scheduling()> scheduling_;

  std::mutex mutex_;  ///< guards all below
  CycleRecord last_;
  std::string journal_error_;
  LimitCheck limit_check_;
  std::uint64_t next_setpoint_ = 0;  ///< its cycle
  int unknown_setpoints_ = 0;        ///< how many are yet to come whose past is not all known
  std::uint32_t fullest_ = 0;        ///< that the buffer has been since the power came
  std::uint64_t records_lost_ = 0;   ///< as of the last report
  std::uint64_t underruns_ = 0;      ///< as of the last report

  // Since the last report of each.
  Loop loop_;
  Drive drive_;
  Axes following_error_ = Axes::Zero();  ///< largest [m], A [rad]
  Limits limits_;
  Buffer buffer_;
};

}  // namespace flute_grinder
