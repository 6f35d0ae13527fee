#pragma once

#include "control/fixtures.h"
#include "control/heap.h"
#include "control/paper_stream.h"
#include "flute_grinder/control/control_loop.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

// Runs the control loop cycle by cycle, without its thread and without ROS.
namespace grinder::test_support {

/// A drive and its loop; every cycle's sample is popped into the log. The swivel is confirmed for the paper's job.
/// Neither a cycle nor a request may use the heap.
template <typename Drive>
class Rig {
 public:
  explicit Rig(const LoopConfig& config = machineConfig(), const Wheel& wheel = {})
      : Rig(
            config, [&](Drive& d) { setUp(d, config); }, wheel) {}

  /// With a drive that `prepare` sets up.
  template <typename Prepare>
  Rig(const LoopConfig& config, const Prepare& prepare, const Wheel& wheel = {}) : config_(config) {
    prepare(drive);
    loop = std::make_unique<ControlLoop>(drive, config, wheel);
    loop->postSwivel(kPaperSwivel);
  }

  /// @param periods since the last cycle.
  const CycleSample& cycle(double periods = 1) {
    const ros::Duration period(periods * config_.machine.period);
    unseen(period);
    CycleSample sample;
    if (!loop->pop(sample)) ADD_FAILURE() << "a cycle left no sample";
    log.push_back(sample);
    return log.back();
  }

  /// Runs cycles whose samples nobody takes.
  void runUnseen(std::size_t cycles) {
    const ros::Duration period(config_.machine.period);
    for (std::size_t i = 0; i < cycles; ++i) unseen(period);
  }

  const CycleSample& run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
    return log.back();
  }

  /// Posts a request and runs cycles until it is answered.
  /// @param job for kStart.
  RequestReply ask(MachineEvent event, SetpointStream* job = nullptr) {
    if (event == MachineEvent::kStart) return askToStart(*job);
    if (event == MachineEvent::kJog) return jog({kY, false, 0.02, 0.05});
    if (isStop(event)) {
      std::uint32_t ticket = 0;
      useNoHeap([&] { ticket = loop->postStopWithReply(event); });
      return answerOf([&] { return loop->stopReply(event, ticket); });
    }
    return askBy([&] { return loop->post(event); }, [&] { return loop->reply(); });
  }

  /// Requests to start a job and runs cycles until the request is answered.
  RequestReply askToStart(SetpointStream& job) {
    return askBy([&] { return loop->startJob({&job, wheelOf(job.program())}); }, [&] { return loop->startJobReply(); });
  }

  /// Confirms the swivel and runs cycles until that is answered.
  RequestReply confirm(double angle) {
    return askBy([&] { return loop->postSwivel(angle); }, [&] { return loop->swivelReply(); });
  }

  /// Requests a jog and runs the cycle that answers it.
  RequestReply jog(const JogRequest& request) {
    return askBy([&] { return loop->postJog(request); }, [&] { return loop->jogReply(); });
  }

  /// Runs cycles until there is an answer.
  template <typename Poll>
  RequestReply answerOf(const Poll& poll) {
    for (int i = 0; i < 15; ++i) {
      cycle();
      if (const std::optional<RequestReply> answer = poll()) return *answer;
    }
    ADD_FAILURE() << "no answer within 15 cycles";
    return {};
  }

  void enable() {
    if (log.empty()) cycle();
    const RequestReply answer = ask(MachineEvent::kEnable);
    ASSERT_TRUE(answer.accepted) << answer.text;
  }

  /// Switches the power on again after a fault.
  void recover() {
    ASSERT_TRUE(ask(MachineEvent::kReset).accepted);
    enable();
  }

  /// The paper's job from the commanded position; the machine may differ from the loop's.
  SetpointStream paperStream(const Machine& machine) const {
    return test_support::paperStream(machine, last().command);
  }
  SetpointStream paperStream() const { return paperStream(config_.machine); }

  /// Starts a job and runs until spindle and coolant let it run: to its first setpoint, at rest.
  void start(SetpointStream& job) {
    const RequestReply answer = askToStart(job);
    ASSERT_TRUE(answer.accepted) << answer.text;
    if (last().state != MachineState::kRunning) runUntil(MachineState::kRunning);
  }

  /// Requests to start the paper's job.
  RequestReply askToStartPaper() {
    stream.emplace(paperStream());
    return askToStart(*stream);
  }

  /// Starts the paper's job, by a machine that is enabled if it has no power.
  void startPaper() {
    if (log.empty() || last().state == MachineState::kDisabled) enable();
    stream.emplace(paperStream());
    start(*stream);
  }

  /// Holds the job and runs until the axes rest.
  void hold() {
    ASSERT_TRUE(ask(MachineEvent::kHold).accepted);
    if (last().state != MachineState::kHeld) runUntil(MachineState::kHeld);
  }

  /// Takes the wheel of a held job off the work.
  void retract() {
    ASSERT_TRUE(ask(MachineEvent::kRetract).accepted);
    if (last().state != MachineState::kRetracted) runUntil(MachineState::kRetracted);
  }

  /// Lifts the wheel of no job.
  void lift() {
    ASSERT_TRUE(ask(MachineEvent::kLift).accepted);
    runUntil(MachineState::kReady);
  }

  /// Forgets what was before the last sample.
  void keepLast() {
    log.erase(log.begin(), log.end() - 1);
    log.front().job_ended = false;
  }

  /// Runs until a state is reached, by a cycle at least.
  void runUntil(MachineState state) {
    cycle();
    runWhile([&] { return last().state != state; }, toString(state));
  }

  /// Runs the job that has been started until the setpoint of a cycle.
  void runToCycle(std::uint64_t number) {
    runWhile([&] { return !last().has_setpoint || last().setpoint.cycle != number; }, std::to_string(number));
  }

  /// Runs the job that has been started until its first setpoint of a kind of move.
  void runTo(MoveKind move) {
    runWhile([&] { return isOnTheWay() && !(last().has_setpoint && last().setpoint.move == move); }, toString(move));
    ASSERT_TRUE(isOnTheWay()) << toString(last().state) << ", and the job has no " << toString(move);
  }

  /// Runs until the job has ended.
  void runToEnd() {
    cycle();
    runWhile([&] { return !last().job_ended; }, "the job's end");
  }

  const CycleSample& last() const { return log.back(); }

  int jobsEnded() const {
    int count = 0;
    for (const CycleSample& sample : log) count += sample.job_ended;
    return count;
  }

  std::vector<Setpoint> setpoints() const {
    std::vector<Setpoint> all;
    for (const CycleSample& sample : log) {
      if (sample.has_setpoint) all.push_back(sample.setpoint);
    }
    return all;
  }

  Drive drive;
  std::unique_ptr<ControlLoop> loop;
  std::vector<CycleSample> log;
  std::optional<SetpointStream> stream;

 private:
  bool isOnTheWay() const { return last().state == MachineState::kRunning || last().state == MachineState::kResuming; }

  /// @param what ends it.
  template <typename Condition>
  void runWhile(const Condition& condition, const std::string& what) {
    for (int i = 0; i < 100000; ++i) {
      if (!condition()) return;
      cycle();
    }
    FAIL() << "never " << what << ", but " << toString(last().state);
  }

  void unseen(const ros::Duration& period) {
    time_ += period;
    useNoHeap([&] {
      loop->cycle(time_, period);
      status_ = loop->status();  // as any thread reads it
    });
  }

  template <typename Post, typename Poll>
  RequestReply askBy(const Post& post, const Poll& poll) {
    bool taken = false;
    useNoHeap([&] { taken = post(); });
    EXPECT_TRUE(taken) << "the request was not taken";
    return answerOf(poll);
  }

  /// One failure says enough of a loop that uses the heap in every cycle.
  template <typename Work>
  void useNoHeap(const Work& work) {
    if (!heapUse(work).any() || heap_reported_) return;
    heap_reported_ = true;
    ADD_FAILURE() << "the heap was used by cycle " << log.size()
                  << " or a request before it; state: " << toString(status_.state);
  }

  LoopConfig config_;
  ros::Time time_{1000};
  LoopStatus status_;
  bool heap_reported_ = false;
};

/// Names a test by its state.
inline std::string stateName(const testing::TestParamInfo<S>& info) { return toString(info.param); }

/// Lets the drive fail for a cycle.
inline void breakDown(Rig<FakeDrive>& rig) {
  rig.drive.status.fault = true;
  rig.cycle();
  rig.drive.status.fault = false;
  ASSERT_EQ(rig.cycle().state, S::kFault);
}

/// Brings the machine to a state by requests and cycles; if that takes a job, it is the paper's, in the middle of its
/// stroke.
inline void bringTo(Rig<FakeDrive>& rig, MachineState state) {
  const auto ask = [&](E event) {
    const RequestReply answer = rig.ask(event);
    ASSERT_TRUE(answer.accepted) << answer.text;
  };
  rig.cycle();
  if (state == S::kDisabled) return;
  rig.enable();
  if (state == S::kReady) return;
  if (state == S::kHoming) return ask(E::kHome);
  if (state == S::kJogging) {
    ask(E::kJog);
    rig.run(30);
    return;
  }
  if (state == S::kStarting) {
    rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
    ASSERT_TRUE(rig.askToStartPaper().accepted);
    return;
  }
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
  rig.run(1000);
  if (state == S::kCanceling) return ask(E::kCancel);
  if (state == S::kFault || state == S::kLifting) {
    breakDown(rig);
    if (state == S::kFault) return;
    rig.recover();
    ask(E::kLift);
    rig.run(30);
  } else if (state != S::kRunning) {
    ask(E::kHold);
    if (state != S::kHolding) rig.runUntil(S::kHeld);
    const bool jogs = state == S::kJoggingRetracted;
    if (state == S::kRetracting || state == S::kRetracted || state == S::kResuming || jogs) ask(E::kRetract);
    if (state == S::kRetracted || state == S::kResuming || jogs) rig.runUntil(S::kRetracted);
    if (jogs) ask(E::kJog);
    if (jogs) rig.run(30);
    if (state == S::kResuming) ask(E::kResume);
  }
}

/// In a state.
class RigIn : public Rig<FakeDrive> {
 public:
  /// @param buffer of the drive [commands].
  explicit RigIn(MachineState state, const LoopConfig& config = machineConfig(), std::uint32_t buffer = 0)
      : Rig(config, [&](FakeDrive& drive) {
          setUp(drive, config);
          drive.can.buffer = buffer;
        }) {
    bringTo(*this, state);
    if (last().state != state) {
      throw std::runtime_error(std::string(toString(last().state)) + " instead of " + toString(state));
    }
  }
};

/// Ready, with the wheel in the work after a fault.
class RigInTheWork : public RigIn {
 public:
  RigInTheWork() : RigIn(S::kFault) {
    recover();
    EXPECT_TRUE(last().wheel_in_work);
  }
};

}  // namespace grinder::test_support
