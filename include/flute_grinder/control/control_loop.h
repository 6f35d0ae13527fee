#pragma once

#include "flute_grinder/control/command_history.h"
#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/control/drive_checks.h"
#include "flute_grinder/control/drive_preparation.h"
#include "flute_grinder/control/jog.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/control/request_box.h"
#include "flute_grinder/control/seq_lock.h"
#include "flute_grinder/control/wheel_watch.h"
#include "flute_grinder/drive/drive.h"
#include "flute_grinder/motion/axis_move.h"
#include "flute_grinder/motion/limit_check.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <boost/lockfree/policies.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

namespace grinder {

/// The thread that owns the setpoint stream and the drive. Each cycle waits, reads the drive, checks its reports,
/// executes requests, computes and checks the next setpoint, and writes it. The cycle does not allocate, lock, log,
/// throw or call ROS. Only the loop changes the machine's state, so no request can race with a fault; of the requests
/// that arrive in one cycle, stops are executed last.
class ControlLoop : public RequestBox {
 public:
  /// @param drive initialised; must outlive the loop.
  /// @param wheel state of the wheel when the previous run of the program ended.
  /// @throw std::invalid_argument unless the limits of every axis are finite and positive.
  ControlLoop(Drive& drive, const LoopConfig& config, const Wheel& wheel = {});
  ~ControlLoop();

  /// Starts the thread, with real-time scheduling and locked memory if the system grants them.
  void startThread();
  /// Ends the thread after its current cycle; the drive is then without power.
  void stopThread();
  /// Asks the thread to end, without waiting; while the drive hangs, the thread does not end. Thread safe.
  void requestEnd() noexcept { running_ = false; }
  bool hasEnded() const noexcept { return ended_; }

  /// For the watchdog, to be called before and after the drive's powerOff(). If the loop runs again after all, it
  /// reports a drive fault, and gives no power until powerOff() has returned. Thread safe; never waits.
  void beginPowerOff() noexcept { power_off_ = PowerOff::kCalled; }
  void endPowerOff() noexcept { power_off_ = PowerOff::kReturned; }
  /// Whether the drive's powerOff() is in progress. Thread safe.
  bool isPoweringOff() const noexcept { return power_off_ == PowerOff::kCalled; }

  /// The status of the most recent cycle. For any thread; never waits.
  LoopStatus status() const noexcept { return status_.load(); }

  /// Sets the feed override for the running job and all later jobs. Thread safe.
  /// @param fraction 0 to kMaxFeedOverride.
  /// @return false, and nothing changes, if the fraction is out of range.
  bool setFeedOverride(double fraction);

  /// Takes the oldest sample; false if there is none. One consumer at a time.
  bool pop(CycleSample& sample) { return samples_.pop(sample); }

  /// One cycle without the wait. Real-time.
  /// @param time time of the cycle, for stamps.
  /// @param period time since the previous cycle, monotonic.
  void cycle(const ros::Time& time, const ros::Duration& period);

  /// Whether the caller is the loop's own thread. Async-signal-safe.
  bool isOwnThread() const noexcept { return pthread_equal(own_thread_, pthread_self()) != 0; }
  bool realtimeScheduling() const { return realtime_scheduling_; }
  bool memoryLocked() const { return memory_locked_; }
  const LoopConfig& config() const { return config_; }
  /// Whether the drive's prepare() is in progress. Thread safe.
  bool isPreparing() const noexcept {
    return preparation_ && preparation_->state() == DrivePreparation::State::kPreparing;
  }
  const DriveCapabilities& capabilities() const { return capabilities_; }  ///< capabilities of the drive

 private:
  using Clock = std::chrono::steady_clock;
  using AxisFlags = Eigen::Array<bool, kAxisCount, 1>;

  /// Progress of the drive's powerOff() since the loop last looked.
  enum class PowerOff : std::uint8_t { kNotCalled, kCalled, kReturned };

  void run();

  /// Calls the drive; an exception becomes a drive fault in the next readDrive().
  template <typename Call>
  void callDrive(const char* function, const Call& call) noexcept;
  /// Waits for the next cycle. If the drive's own wait fails, this is a drive fault, and the monotonic clock is used.
  /// @param last start of the last cycle. @return time since then.
  ros::Duration awaitCycle(Clock::time_point last) noexcept;
  /// Tells the drive to switch the power off, after the last cycle.
  void writeOff(const DriveCycle& cycle) noexcept;

  void readDrive(const DriveCycle& cycle);
  void boundCommandsWaiting();
  void observeHang();
  void readSwivel();
  AxisFlags credibleFrom(const Axes& last, double elapsed) const;
  void judgeY(bool credible);
  void trackMotion();
  void checkDrive();
  void writeDrive(const DriveCycle& cycle);
  void publish();

  void executeRequests();
  void executeRequest(MachineEvent event);
  Refusal execute(MachineEvent event);
  bool driveCan(MachineEvent event) const;
  Refusal executeStop(MachineEvent event);
  Answer answerTo(MachineEvent event, Refusal refusal) const;
  Refusal enable();
  void awaitPower();
  Refusal commandPower();
  Refusal refusalWithoutPower() const;
  void answerEnable(Refusal refusal);
  void switchOff();
  Refusal reset();
  Refusal home();
  Refusal beginJob(const JobStart& job);
  Refusal resume();
  Refusal retract();
  Refusal lift();
  double liftTarget() const;
  Refusal refusalOfWheel() const;
  Refusal setSwivel(double angle);
  Refusal spindleOn();
  Refusal switchByHand(bool& commanded, bool on);
  Axes distanceToGo() const;
  Interlock openInterlock() const;
  Answer executeJog(const JogRequest& jog);
  Refusal jogOn(const JogRequest& jog, Answer& answer);
  Refusal beginJog(const JogRequest& jog, Answer& answer);
  Refusal refusalOfSpeed(const JogRequest& jog, Answer& answer) const;
  Refusal refusalOfPosition(Answer& answer) const;
  double lowestJog(int axis) const;

  void awaitHoming();
  bool awaitInterlocks();
  void advance();
  void slowDownIfLate();
  void advanceJob();
  void advanceLift();
  void advanceJog();
  void watchClients();
  void hearClient();
  void stopJogWithoutClient();
  void stopJogOnContact();
  void endJog();
  bool advanceAxisMove();
  void checkInterlocks();
  void commandOfJob();
  void command(const Axes& offset = Axes::Zero());
  bool allReachedAxes();
  void restJob();
  bool beginLiftOff();
  void comeToRest();
  void endJob(JobEnd end);
  void fail(const LoopFault& fault);
  void apply(MachineEvent event);

  Drive& drive_;
  const DriveCapabilities capabilities_;
  const LoopConfig config_;
  std::optional<DrivePreparation> preparation_;  ///< present if the drive has a prepare()

  // Used only by the control thread.
  MachineState state_ = MachineState::kDisabled;
  SetpointStream* stream_ = nullptr;
  double job_swivel_ = 0;           ///< swivel that the stream's job needs [rad]
  Axes job_offset_ = Axes::Zero();  ///< machine position - position of the stream's setpoints [m], A [rad]
  bool in_journal_ = true;          ///< the journal contained the job when it was started
  AxisMove axis_move_;              ///< motion of the lift or jog
  bool jogging_ = false;     ///< a jog is in progress; in the middle of a job the job's stream adopts its setpoints
  bool continuous_ = false;  ///< the jog is continuous
  bool touched_ = false;     ///< the probe was in contact in the previous cycle
  bool for_client_ = false;  ///< the jog stops when its client is silent
  DeadMansSwitch dead_man_;
  SilenceTimer client_;  ///< silence of a series' client
  std::uint32_t keep_alives_seen_ = 0;
  LimitCheck limit_check_;
  DriveChecks drive_checks_;
  WheelWatch wheel_;
  FaultText thrown_;            ///< text of the drive's exception, since the last readDrive()
  bool has_thrown_ = false;     ///< the drive has thrown since the last readDrive()
  bool has_hung_ = false;       ///< the drive hung until this cycle
  bool settled_ = false;        ///< the last two readings agree: every axis can have moved from one to the other
  bool has_positions_ = false;  ///< all positions have been finite at least once
  bool y_homed_ = false;        ///< the drive reports the reference, and is not homing
  DriveFeedback feedback_;
  Axes command_ = Axes::Zero();
  CommandHistory history_;
  JobTrack written_;                ///< setpoints written for the running job, or else the last one
  bool moving_unbuffered_ = false;  ///< the axes were moving, and the drive's buffer is empty
  bool may_lift_off_ = true;        ///< a canceled job lifts the wheel once it has stopped
  bool power_off_next_ = false;     ///< the power goes off once the axes are at rest
  std::uint64_t rested_ = 0;        ///< cycles since the last setpoint
  DriveCommand drive_command_;
  bool spindle_ = false;           ///< the spindle is commanded, by a job or by hand
  bool coolant_ = false;           ///< the coolant is commanded, by a job or by hand
  bool switched_by_hand_ = false;  ///< spindle or coolant, since the job began or was resumed
  double waited_ = 0;              ///< time waited for power, the reference, or a job's interlocks [s]
  bool awaiting_power_ = false;
  bool preparation_begun_ = false;  ///< prepare() was called for the power awaited
  double unwanted_power_ = 0;       ///< time for which the drive has reported power that is commanded off [s]
  bool homing_seen_ = false;        ///< the drive has reported the homing requested
  bool homing_of_before_ = false;   ///< the drive still reports a homing from before the request
  bool homing_over_ = false;        ///< homing has ended, and the axes were read since
  CycleSample sample_;
  LoopStatus next_status_;  ///< published at the end of the cycle

  SeqLock<LoopStatus> status_;
  boost::lockfree::spsc_queue<CycleSample, boost::lockfree::capacity<8192>> samples_;

  std::thread thread_;
  std::atomic<double> feed_override_{1};
  std::atomic<bool> running_{false};
  std::atomic<bool> ended_{false};
  std::atomic<PowerOff> power_off_{PowerOff::kNotCalled};
  std::atomic<pthread_t> own_thread_{};
  std::atomic<bool> realtime_scheduling_{false};
  std::atomic<bool> memory_locked_{false};
};

}  // namespace grinder
