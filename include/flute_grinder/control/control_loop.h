#pragma once

#include "flute_grinder/control/command_history.h"
#include "flute_grinder/control/loop_requests.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/control/seq_lock.h"
#include "flute_grinder/core/lift_move.h"
#include "flute_grinder/core/limit_check.h"
#include "flute_grinder/core/loop_fault.h"
#include "flute_grinder/core/machine_state.h"
#include "flute_grinder/core/setpoint_stream.h"
#include "flute_grinder/drive/robot_hw.h"

#include <boost/lockfree/policies.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include <array>
#include <atomic>
#include <optional>
#include <thread>

namespace flute_grinder {

/// What the control loop must know of the machine.
struct LoopConfig {
  Machine machine;
  Axes following_error = Axes::Zero();  ///< largest |command - position| [m], A [rad]
  double feedback_timeout = 0;          ///< longest time without fresh positions [s]
  double enable_timeout = 0;            ///< longest time from the enable command to power [s]
  double homing_timeout = 0;            ///< longest time that homing may take [s]
  double spindle_timeout = 0;           ///< longest time until spindle and coolant are ready for a job [s]
  double late_slow_down = 2;  ///< period from which on a cycle is late and the speed is taken up anew [periods]
  double late_fault = 10;     ///< period from which on the machine stops [periods]
};

/// What happened in one cycle; what the rest of the program learns of the loop.
struct CycleRecord {
  double time = 0;    ///< since the epoch of ROS time, but monotonic [s]
  double period = 0;  ///< since the cycle before [s]
  MachineState state = MachineState::kDisabled;
  DriveStatus drive;
  Axes position = Axes::Zero();  ///< as read in this cycle [m], A [rad]
  Axes velocity = Axes::Zero();  ///< as read in this cycle [m/s], A [rad/s]
  Axes command = Axes::Zero();   ///< as written in this cycle [m], A [rad]
  Axes target = Axes::Zero();    ///< the command that the positions are to follow; older if the drive buffers
  bool has_setpoint = false;
  Setpoint setpoint;       ///< that was written, if there was one
  std::uint64_t job = 0;   ///< its number; 0 of a setpoint that lifts the wheel without a job. Else of the last job
  bool job_ended = false;  ///< the job's stream is no longer in use; of a lost record, told by the next
  bool wheel_in_work = false;
  LoopFault fault;                         ///< of the state kFault, or why the last job did not begin
  Interlock interlock = Interlock::kNone;  ///< why the loop has held the job by itself, until it is resumed
  double feed_override = 1;                ///< fraction
  std::uint64_t records_lost = 0;          ///< since the start, because nobody took them
};

/// The one thread that owns the setpoint stream and the drive. Per cycle: wait, read, check, next, check, write.
/// Stops, starts and other requests go in by a slot of their own each, so that none waits for another; records and a
/// status come out. In the cycle nothing is allocated, locked, logged or thrown, and nothing of ROS is called. The loop
/// alone decides the machine's state, so that no request can cross a fault; of all that is asked for in one cycle,
/// stops are carried out last.
class ControlLoop {
 public:
  /// @param hw the drive, initialised; must outlive the loop.
  /// @param config limits and tolerances.
  /// @param wheel as it was left, if the program was started anew since.
  /// @throw HardwareInterfaceException if the drive lacks an interface or a joint.
  /// @throw std::invalid_argument unless the limits of Y are finite and positive.
  ControlLoop(RobotHW& hw, const LoopConfig& config, const Wheel& wheel = {});
  ~ControlLoop();

  /// Starts the thread, with real-time scheduling and locked memory where the system grants them.
  void startThread();
  /// Ends the thread after its cycle; the drive is left without power.
  void stopThread();

  /// The newest cycle's. For any thread; waits for nothing.
  LoopStatus status() const noexcept { return status_.load(); }

  /// Asks to enable, home, resume, retract, lift or reset, and waits for the answer. For one thread at a time.
  ///
  /// Lift takes the wheel off the work where it was left, straight up: to Y where it is clear if the axes are homed,
  /// else by the way from the deepest place of the last job. Until then no job starts, and nothing homes.
  RequestReply request(MachineEvent event);

  /// Asks for a stop - hold, cancel or disable - and waits for the answer, 100 ms at the most. For one thread at a
  /// time.
  ///
  /// Hold stops a job on its path, before its first setpoint too; cancel stops it on its path, lifts the wheel off the
  /// work and ends the job; disable does that and switches the power off. Each stops a lift on its way, a hold that of
  /// a canceled job too, which ends there. Each ends homing by the power: the drive moves by itself then, and no
  /// command of the loop's counts.
  RequestReply stop(MachineEvent event);
  /// The same without the answer. For any thread and for signal handlers; what is no stop is not taken.
  void postStop(MachineEvent event) noexcept { stops_.post(event); }

  /// Asks to start a job. For one thread at a time.
  /// @param stream not null; must stay alive until the job has ended (LoopStatus::jobs_ended), or the start is refused.
  /// @return false while the start before has not been answered; it is then not asked.
  bool postStart(SetpointStream* stream) noexcept;
  /// The answer to the last start, once the loop has given it. For one thread at a time.
  std::optional<RequestReply> startReply();

  /// Sets the feed override, of the running job and of those to come. Thread safe.
  /// @param fraction 0 to kMaxFeedOverride.
  /// @return whether it is in that range; others are not taken.
  bool setFeedOverride(double fraction);

  /// Takes the oldest record; false if there is none. One consumer at a time.
  bool pop(CycleRecord& record) { return records_.pop(record); }

  /// One cycle without the wait. Real-time.
  /// @param time of the cycle, for stamps.
  /// @param period since the last cycle, monotonic.
  void cycle(const ros::Time& time, const ros::Duration& period);

  /// request() without the wait: cycle() takes it up. False while the one before has not been answered.
  bool post(MachineEvent event) noexcept { return requests_.post(event); }
  /// The answer to the last post(), once there is one.
  std::optional<RequestReply> reply();
  /// stop() without the wait.
  /// @return what to ask for the answer with.
  std::uint32_t postAskedStop(MachineEvent event) noexcept { return stops_.ask(event); }
  /// The answer to postAskedStop(), once there is one.
  std::optional<RequestReply> stopReply(MachineEvent event, std::uint32_t ticket) const;

  bool realtimeScheduling() const { return realtime_scheduling_; }
  bool memoryLocked() const { return memory_locked_; }
  const LoopConfig& config() const { return config_; }

 private:
  struct Start {
    SetpointStream* stream = nullptr;
    Wheel wheel;  ///< of this job
  };

  void run();
  void observe();
  void watchWheel();
  bool powered() const;

  void takeRequests();
  void takeRequest(MachineEvent event);
  Refusal carryOut(MachineEvent event);
  Refusal enable();
  Refusal start(const Start& job);
  Refusal lift();
  double liftTarget() const;
  Refusal stopMotion(MachineEvent event);
  Refusal obstacleToPower() const;
  Answer answerTo(MachineEvent event, Refusal refusal) const;
  void answerEnable(Refusal refusal);

  void checkDrive();
  void checkFeedback();
  void checkPositions();
  void checkInterlocks();
  Interlock openInterlock() const;
  bool axesWaited() const;

  void awaitPower();
  void awaitHoming();
  void awaitSpindle();
  void takeUpSpeed();
  void advance();
  void advanceJob();
  void advanceLift();
  void write(const Setpoint& setpoint);
  bool axesGotAll();
  void restJob();
  bool liftsOff();
  void comeToRest();
  void endJob(JobEnd end);
  void fail(const LoopFault& fault);
  void apply(MachineEvent event);
  void switchOff();

  void writeDrive(const ros::Time& time, const ros::Duration& period);
  void tell();

  RobotHW& hw_;
  LoopConfig config_;
  std::array<JointHandle, kAxisCount> joints_;
  DriveHandle drive_;

  // The control thread's own.
  MachineState state_ = MachineState::kDisabled;
  SetpointStream* stream_ = nullptr;
  LiftMove lift_;
  LimitCheck limit_check_;
  Axes command_ = Axes::Zero();
  CommandHistory history_;
  JobTrack written_;                    ///< of the job that runs, or of the last one
  bool moving_ = false;                 ///< the cycle before wrote a setpoint that moves an axis
  bool lifts_off_ = true;               ///< the job is to lift the wheel when it has stopped for a cancel
  bool power_off_next_ = false;         ///< once the axes rest
  std::uint64_t rested_ = 0;            ///< cycles since the last setpoint
  std::uint64_t underruns_before_ = 0;  ///< those that the drive had counted when the power came
  DriveCommand drive_command_;
  std::uint64_t last_feedback_ = 0;
  double feedback_age_ = 0;
  double waited_ = 0;  ///< for power, the reference, or spindle and coolant [s]
  bool awaiting_power_ = false;
  bool homing_seen_ = false;
  CycleRecord record_;
  LoopStatus now_;  ///< what is told next

  StopRoad stops_;
  RequestSlot<Start> starts_;
  RequestSlot<MachineEvent> requests_;
  SeqLock<LoopStatus> status_;
  boost::lockfree::spsc_queue<CycleRecord, boost::lockfree::capacity<8192>> records_;

  std::thread thread_;
  std::atomic<double> feed_override_{1};
  std::atomic<bool> running_{false};
  std::atomic<bool> realtime_scheduling_{false};
  std::atomic<bool> memory_locked_{false};
};

}  // namespace flute_grinder
