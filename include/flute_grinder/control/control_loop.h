#pragma once

#include "flute_grinder/control/command_history.h"
#include "flute_grinder/control/drive_checks.h"
#include "flute_grinder/control/drive_link.h"
#include "flute_grinder/control/job_run.h"
#include "flute_grinder/control/jogging.h"
#include "flute_grinder/control/loop_state.h"
#include "flute_grinder/control/power.h"
#include "flute_grinder/control/request_box.h"
#include "flute_grinder/control/seq_lock.h"

#include <boost/lockfree/policies.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include <pthread.h>

#include <atomic>
#include <cstdint>
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
  void beginPowerOff() noexcept { power_.beginPowerOff(); }
  void endPowerOff() noexcept { power_.endPowerOff(); }
  /// Whether the drive's powerOff() is in progress. Thread safe.
  bool isPoweringOff() const noexcept { return power_.isPoweringOff(); }

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
  const LoopConfig& config() const { return now_.config; }
  /// Whether the drive's prepare() is in progress. Thread safe.
  bool isPreparing() const noexcept { return power_.isPreparing(); }
  const DriveCapabilities& capabilities() const { return link_.capabilities(); }  ///< capabilities of the drive

 private:
  void run();

  void readDrive(const DriveCycle& cycle);
  void judgeY();
  void trackMotion();
  void checkDrive();
  void writeDrive(const DriveCycle& cycle);
  void publish();

  void executeRequests();
  void executeRequest(MachineEvent event);
  Refusal execute(MachineEvent event);
  bool driveCan(MachineEvent event) const;
  Refusal executeStop(MachineEvent event);
  Answer executeJog(const JogRequest& jog);
  Answer answerTo(MachineEvent event, Refusal refusal) const;
  void awaitPower();
  void switchOff();
  Refusal reset();
  Refusal home();
  Refusal lift();
  /// Continues a lift along one of its axes.
  void beginLiftAlong(int axis);
  LiftTarget liftTarget() const;
  Refusal setSwivel(double angle);
  Refusal switchByHand(MachineEvent event);

  void awaitHoming();
  void advance();
  void advanceJob();
  bool advanceAxisMove();
  void command(const Axes& offset = Axes::Zero());
  bool allReachedAxes();
  void comeToRest();
  void fail(const LoopFault& fault);

  // Used only by the control thread, except for the capabilities and what Power offers to any thread.
  LoopState now_;
  DriveLink link_;
  DriveChecks drive_checks_;
  Power power_;
  JobRun job_;
  Jogging jog_;
  CommandHistory history_;
  LiftTarget lift_to_;              ///< target of the lift in progress
  bool y_homed_ = false;            ///< the drive reports the reference, and is not homing
  bool moving_unbuffered_ = false;  ///< the axes were moving, and the drive's buffer is empty
  bool resets_ = false;             ///< the drive is commanded to clear its fault
  std::uint64_t rested_ = 0;        ///< cycles since the last setpoint
  double waited_ = 0;               ///< time waited for the reference [s]
  bool homing_seen_ = false;        ///< the drive has reported the homing requested
  bool homing_of_before_ = false;   ///< the drive still reports a homing from before the request
  bool homing_over_ = false;        ///< homing has ended, and the axes were read since

  SeqLock<LoopStatus> status_;
  boost::lockfree::spsc_queue<CycleSample, boost::lockfree::capacity<8192>> samples_;

  std::thread thread_;
  std::atomic<double> feed_override_{1};
  std::atomic<bool> running_{false};
  std::atomic<bool> ended_{false};
  std::atomic<pthread_t> own_thread_{};
  std::atomic<bool> realtime_scheduling_{false};
  std::atomic<bool> memory_locked_{false};
};

}  // namespace grinder
