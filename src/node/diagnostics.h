#pragma once

#include "flute_grinder/base/durations.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/diagnostic_thresholds.h"
#include "flute_grinder/motion/limit_check.h"

#include <diagnostic_updater/diagnostic_updater.h>

#include <array>
#include <functional>
#include <string>

namespace grinder {

/// What the operating system granted the control loop.
struct Scheduling {
  bool realtime = false;
  bool memory_locked = false;
};

/// Monitors every cycle of the control loop, and reports the worst since the previous report on /diagnostics. Not
/// thread safe.
class Diagnostics {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// @param config the machine's limits and tolerances.
  /// @param scheduling called for each report.
  Diagnostics(const LoopConfig& config, const DiagnosticThresholds& thresholds, std::function<Scheduling()> scheduling);

  /// Registers all reports with the updater, which this object must outlive.
  void addTo(diagnostic_updater::Updater& updater);

  /// Adds the sample of a cycle. To be called for every cycle, in order.
  void add(const CycleSample& sample);
  /// Sets the error of the journal; empty for none.
  void setJournalError(const std::string& error) { journal_error_ = error; }
  /// Sets why the records of jobs are not kept; empty if they are.
  void setHistoryError(const std::string& error) { history_error_ = error; }

  void reportLoop(Status& status);
  void reportDrive(Status& status);
  void reportFollowing(Status& status);
  void reportLimits(Status& status);
  void reportBuffer(Status& status);
  void reportJournal(Status& status);
  void reportHistory(Status& status);

 private:
  /// Position, velocity, acceleration and jerk of every axis as fractions of their limits, by LimitedQuantity.
  using LimitUse = std::array<Axes, 4>;

  struct Loop {
    std::uint64_t cycles = 0;
    std::uint64_t late = 0;
    double longest = 0;  ///< longest period [s]
    double total = 0;    ///< sum of the periods [s]
    Durations busy;      ///< durations of the cycles, without the wait
    Durations delay;     ///< delays of the wake-ups: period less nominal period
  };
  struct Drive {
    double feedback_age = 0;  ///< longest age of the feedback [s]
    bool emergency_stop = false;
    bool fault = false;
    FaultText fault_text;
    Interlock interlock = Interlock::kNone;
    LoopFault loop_fault;
    Axes position = Axes::Zero();  ///< the latest position, or one that was not finite
  };
  struct Limits {
    std::uint64_t setpoints = 0;
    LimitUse use{Axes::Zero(), Axes::Zero(), Axes::Zero(), Axes::Zero()};
  };
  struct Buffer {
    bool used = false;
    std::uint32_t min = 0;  ///< smallest fill [commands]
  };

  void addDrive(const CycleSample& sample);
  void addSetpoint(const Setpoint& setpoint, const Axes& command);
  void addViolation(const LimitViolation& violation);
  void addBuffer(const DriveStatus& drive);
  double positionUse(int axis, double position) const;

  const LoopConfig config_;
  const DiagnosticThresholds thresholds_;
  const std::function<Scheduling()> scheduling_;

  CycleSample last_;
  std::string journal_error_, history_error_;
  LimitCheck limit_check_;
  std::uint64_t next_setpoint_ = 0;  ///< cycle number of the next setpoint
  int unknown_setpoints_ = 0;        ///< setpoints to come whose history is incomplete
  std::uint32_t fullest_ = 0;        ///< largest fill since power-on [commands]
  std::uint64_t samples_lost_ = 0;   ///< count at the last report
  std::uint64_t underruns_ = 0;      ///< count at the last report

  // Values since each one's last report.
  Loop loop_;
  Drive drive_;
  Axes following_error_ = Axes::Zero();  ///< largest following errors [m], A [rad]
  Limits limits_;
  Buffer buffer_;
};

}  // namespace grinder
