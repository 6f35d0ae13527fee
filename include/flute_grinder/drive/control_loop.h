#pragma once

#include "flute_grinder/core/limit_check.h"
#include "flute_grinder/core/setpoint_stream.h"
#include "flute_grinder/drive/machine_state.h"
#include "flute_grinder/drive/robot_hw.h"

#include <boost/lockfree/policies.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
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

/// What must be so for the wheel to be at the work.
enum class Interlock : std::uint8_t {
  kNone,
  kNotHomed,
  kSpindle,  ///< not at speed
  kCoolant,  ///< does not flow
  kProbe,    ///< in the wheel's way
};

/// What is amiss, e.g. "the spindle is not at speed"; empty for kNone.
const char* toString(Interlock interlock) noexcept;

/// Why the loop stopped the machine.
enum class FaultKind : std::uint8_t {
  kNone,
  kEmergencyStop,
  kDriveFault,       ///< the drive reports one
  kPowerLost,        ///< the drive is no longer enabled
  kStaleFeedback,    ///< no fresh positions
  kInvalidFeedback,  ///< a position that is not a number
  kFollowingError,
  kUnderrun,   ///< the axes found no command, though they move by a buffer that the loop fills
  kLimit,      ///< a setpoint that an axis may not follow
  kHoming,     ///< the drive did not find its reference
  kInterlock,  ///< a job could not begin; the machine stays ready
};

/// A fault with its figures; plain data, put in words outside of the loop.
struct LoopFault {
  FaultKind kind = FaultKind::kNone;
  int axis = 0;
  double value = 0;                        ///< of what went too far
  double limit = 0;                        ///< how far it may go
  std::uint64_t cycle = 0;                 ///< of the last setpoint written, of kUnderrun
  LimitViolation violation;                ///< of kLimit
  Interlock interlock = Interlock::kNone;  ///< of kInterlock

  /// e.g. "axis_x following error 0.0012 m is beyond its limit 0.001 m".
  std::string text() const;
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
  Setpoint setpoint;                       ///< that was written, if there was one
  bool job_ended = false;                  ///< the job's stream is no longer in use
  LoopFault fault;                         ///< of the state kFault, or why the last job did not begin
  Interlock interlock = Interlock::kNone;  ///< why the loop has held the job by itself, until it is resumed
  double feed_override = 1;                ///< fraction
  std::uint64_t records_lost = 0;          ///< since the start, because nobody took them
};

/// Whether a request was carried out, and if not, why.
struct RequestReply {
  bool accepted = false;
  std::string text;      ///< why not
  bool answered = true;  ///< false if the loop has said nothing, and may yet take the request up
};

/// The one thread that owns the setpoint stream and the drive. Per cycle: wait, read, check, next, check, write.
/// Requests go in and records come out through lock-free rings; in the cycle nothing is allocated, locked, logged or
/// thrown, and nothing of ROS is called. The loop alone decides the machine's state, so that no request can cross a
/// fault.
class ControlLoop {
 public:
  /// @param hw the drive, initialised; must outlive the loop.
  /// @param config limits and tolerances.
  /// @throw HardwareInterfaceException if the drive lacks an interface or a joint.
  ControlLoop(RobotHW& hw, const LoopConfig& config);
  ~ControlLoop();

  /// Starts the thread, with real-time scheduling and locked memory where the system grants them.
  void start();
  /// Ends the thread after its cycle; the drive is left without power.
  void stop();

  /// Asks for something and waits for the answer. Thread safe; not for the control thread.
  /// @param stream of kStart: must stay alive until a record says job_ended, or the answer is no.
  RequestReply request(MachineEvent event, SetpointStream* stream = nullptr);

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

  /// Posts a request without waiting; cycle() takes it up. False while one is pending. For one thread at a time.
  bool post(MachineEvent event, SetpointStream* stream = nullptr);
  /// The answer to the last post(), once there is one.
  std::optional<RequestReply> reply();

  bool realtimeScheduling() const { return realtime_scheduling_; }
  bool memoryLocked() const { return memory_locked_; }
  const LoopConfig& config() const { return config_; }

 private:
  enum class Refusal : std::uint8_t {
    kNone,
    kState,
    kEmergencyStop,
    kDriveFault,
    kInterlock,
    kNoPower,
    kMoved,
    kFeedback
  };
  struct Command {
    MachineEvent event;
    SetpointStream* stream;
  };
  struct Answer {
    MachineEvent event;
    MachineState state;
    Refusal refusal;
    Interlock interlock;
  };

  void run();
  void observe();
  void takeCommand();
  Refusal carryOut(const Command& command);
  Refusal obstacleToPower() const;
  Refusal start(SetpointStream* stream);
  void answer(Refusal refusal);
  void awaitPower();
  void awaitHoming();
  void awaitSpindle();
  void checkDrive();
  void checkPositions();
  const Axes& commandInEffect() const;
  void remember();
  void checkInterlocks();
  Interlock openInterlock() const;
  void advanceJob();
  void move();
  void rest();
  void endJob();
  void fail(const LoopFault& fault);
  void apply(MachineEvent event);
  bool powered() const;

  RobotHW& hw_;
  LoopConfig config_;
  std::array<JointHandle, kAxisCount> joints_;
  DriveHandle drive_;

  // The control thread's own.
  MachineState state_ = MachineState::kDisabled;
  SetpointStream* stream_ = nullptr;
  LimitCheck limit_check_;
  Axes command_ = Axes::Zero();
  std::array<Axes, kMaxCommandsWaiting + 1> written_;  ///< the commands of the last cycles, in a ring
  std::size_t next_written_ = 0;                       ///< where the next one goes
  std::size_t written_count_ = 0;       ///< how many of them count: those since the commands no longer follow
  std::uint64_t rested_ = 0;            ///< cycles since the last setpoint
  std::uint64_t underruns_before_ = 0;  ///< those that the drive had counted when the power came
  DriveCommand drive_command_;
  std::uint64_t last_feedback_ = 0;
  double feedback_age_ = 0;
  double waited_ = 0;  ///< for power, the reference, or spindle and coolant [s]
  bool homing_seen_ = false;
  std::optional<Command> pending_;
  CycleRecord record_;

  boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<4>> commands_;
  boost::lockfree::spsc_queue<Answer, boost::lockfree::capacity<4>> answers_;
  boost::lockfree::spsc_queue<CycleRecord, boost::lockfree::capacity<8192>> records_;

  std::mutex request_mutex_;
  bool awaiting_answer_ = false;
  std::thread thread_;
  std::atomic<double> feed_override_{1};
  std::atomic<bool> running_{false};
  std::atomic<bool> realtime_scheduling_{false};
  std::atomic<bool> memory_locked_{false};
};

}  // namespace flute_grinder
