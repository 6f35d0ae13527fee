// Rides random jobs on random machines through the control loop, in simulated time, each from its start to its end:
// with holds, overrides, retracts, jogs whose messages fail to come, cancels, stops, faults and restarts at random
// moments. Every cycle is judged by the second opinion, and the rides that went wrong are reported.

#include "flute_grinder/control/control_loop.h"
#include "ride_job.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <exception>
#include <iterator>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder::test_support {

namespace {

using E = MachineEvent;
using S = MachineState;

constexpr std::uint64_t kMostRideCycles = 300000;
constexpr int kMostEvents = 30;
constexpr int kMostBuffered = 50;
constexpr double kJogTimeout = 0.05;  ///< [s]
constexpr double kStall = 20;         ///< periods of a cycle in which nobody was heard
/// Cycles in which the spindle runs up, and in which it is still at speed once it was switched off.
constexpr int kRunUp = 20, kRunDown = 100;
constexpr double kTurn = 10e-3;  ///< of Y's screw [m]

/// Axes that reach every command at once, or after some that wait before it, and what can go wrong with them.
class RideDrive : public Drive {
 public:
  enum class Failure {
    kNone,
    kEmergencyStop,
    kFault,
    kJump,
    kGlitch,
    kTurn,  ///< from then on Y counts so much too high or too low, until it is homed
    kNan,
    kStale,
    kThrow,
    kSpindle,
    kCoolant,
    kProbe,
    kReference
  };

  void init(ros::NodeHandle&, ros::NodeHandle&) override {}
  DriveCapabilities capabilities() const override {
    DriveCapabilities can;
    can.homing = can.spindle = can.coolant = true;
    can.buffer = static_cast<std::uint32_t>(buffer_);
    return can;
  }
  void read(const DriveCycle& cycle, DriveFeedback& feedback) override {
    DriveStatus& status = feedback.status;
    if (left_ > 0) --left_;
    if (fails(Failure::kThrow)) throw std::runtime_error("of the ride");
    status.emergency_stop = fails(Failure::kEmergencyStop);
    status.fault = fails(Failure::kFault);
    play(cycle, status);
    status.enabled = sent_.enable && !status.emergency_stop;
    status.homing = status.enabled && sent_.home && ++homed_for_ < 4;
    if (!sent_.home) homed_for_ = 0;
    if (homed_for_ == 4) findReference();
    if (fails(Failure::kReference)) lost_ = true;
    status.homed = !lost_ && !status.homing;
    runs_up_ = sent_.spindle ? std::min(runs_up_ + 1, kRunUp) : 0;
    const bool at_speed = runs_up_ == kRunUp;
    runs_down_ = at_speed ? kRunDown : sent_.spindle ? 0 : std::max(runs_down_ - 1, 0);
    status.spindle_at_speed = runs_down_ > 0 && !fails(Failure::kSpindle);
    status.coolant_on = sent_.coolant && !fails(Failure::kCoolant);
    status.probe_free = !fails(Failure::kProbe);
    double& at = at_[static_cast<std::size_t>(axis_)];
    if (fails(Failure::kJump)) at = away(at);
    feedback.position = at_;
    feedback.position[kY] += off_;
    double& read = feedback.position[static_cast<std::size_t>(axis_)];
    if (fails(Failure::kGlitch)) read = away(read);
    if (fails(Failure::kNan)) read = std::numeric_limits<double>::quiet_NaN();
    if (!fails(Failure::kStale)) ++status.feedback_count;
  }
  void write(const DriveCycle&, const DriveCommand& command) override { sent_ = command; }

  bool isCommandedOn() const { return sent_.enable; }
  double y() const { return at_[kY]; }
  double yOff() const { return commands_off_; }
  void setUp(const Machine& machine, std::size_t buffer) {
    limits_ = machine.limits;
    buffer_ = buffer;
    std::copy(machine.park.data(), machine.park.data() + kAxisCount, at_.begin());
  }
  void fail(Failure failure, int axis, int cycles) {
    failure_ = failure;
    axis_ = axis;
    left_ = cycles + 1;
    if (failure == Failure::kTurn) off_ += axis < kZ ? kTurn : -kTurn;
  }

 private:
  bool fails(Failure failure) const { return left_ > 0 && failure_ == failure; }

  /// One command per period, once the buffer has been full; when the computer is late, those that wait.
  void play(const DriveCycle& cycle, DriveStatus& status) {
    const bool follows = status.enabled && sent_.enable && !sent_.home;
    if (!follows) waiting_.clear();
    full_ = full_ && !waiting_.empty();
    status.commands_waiting = 0;
    if (!follows) {
      commands_off_ = off_;
      return;
    }
    waiting_.push_back(sent_.position);
    full_ = full_ || waiting_.size() > buffer_;
    const long periods = full_ ? std::lround(cycle.period.toSec() / cycle.nominal.toSec()) : 0;
    for (long i = 0; i < periods && waiting_.size() > 1; ++i) waiting_.pop_front();
    at_ = waiting_.front();
    at_[kY] -= commands_off_;
    status.commands_waiting = static_cast<std::uint32_t>(waiting_.size() - 1);
  }
  void findReference() {
    lost_ = false;
    off_ = commands_off_ = 0;
  }
  /// Within the limits, beyond which nobody turns an axis.
  double away(double at) const {
    return std::clamp(at + 5e-3, limits_.min_position[axis_], limits_.max_position[axis_]);
  }

  AxisLimits limits_;
  std::size_t buffer_ = 0;
  std::deque<AxisValues> waiting_;  ///< the first of them has been reached
  bool full_ = false;
  AxisValues at_{};
  double off_ = 0,
         commands_off_ = 0;  ///< what Y reads and is commanded too high; an axis under power does not jump [m]
  DriveCommand sent_;
  Failure failure_ = Failure::kNone;
  int axis_ = 0, left_ = 0, homed_for_ = 0;
  bool lost_ = false;
  int runs_up_ = 0, runs_down_ = 0;  ///< cycles: of the first so far, of the other to come
};

/// Where nothing may move, but homing axes.
constexpr S kAtRest[]{S::kDisabled, S::kReady, S::kHoming, S::kStarting, S::kHeld, S::kRetracted, S::kFault};

LoopConfig configOf(const Machine& machine) {
  LoopConfig config;
  config.machine = machine;
  config.following_error << 1e-3, 1e-3, 1e-3, 1e-3;
  config.feedback_timeout = 2.5 * machine.period;
  config.enable_timeout = config.homing_timeout = config.spindle_timeout = 0.5;
  config.jog_timeout = kJogTimeout;
  config.jog_velocity << 0.01, 0.01, 0.01, 0.5;
  return config;
}

/// Cycles in which every axis comes to rest, whatever it does, and the drive has played that.
std::uint64_t mostBraking(const Machine& machine) {
  const AxisLimits& l = machine.limits;
  const double longest = (l.max_velocity / l.max_acceleration + 3 * l.max_acceleration / l.max_jerk).maxCoeff();
  return static_cast<std::uint64_t>(longest / machine.period) + kMostBuffered + 10;
}

/// What a ride has come to.
struct RideResult {
  std::string fault;  ///< what is wrong with it; empty if nothing
  std::uint64_t setpoints = 0;
  std::uint64_t cycles = 0;
  int events = 0;  ///< requests and failures on the way
  int runs = 0;    ///< starts of the job
};

class Ride {
 public:
  explicit Ride(std::uint64_t number)
      : random_(number),
        job_(randomJob(random_)),
        event_every_(job_.cycles * acrossDecades(random_, 0.004, 0.04)),
        recover_every_(acrossDecades(random_, 10, 100)),
        failures_(acrossDecades(random_, 0.02, 0.5)),
        most_braking_(mostBraking(job_.machine)),
        watch_(job_.asked) {
    drive_.setUp(job_.machine, flip(random_, 0.5) ? 0 : static_cast<std::size_t>(between(random_, 1, kMostBuffered)));
    loop_ = std::make_unique<ControlLoop>(drive_, configOf(job_.machine));
    loop_->postSwivel(job_.job->process().setup_swivel);
  }

  RideResult run() {
    try {
      while (!isOver()) cycle();
    } catch (const second_opinion::Violation& violation) {
      result_.fault = std::string(violation.what()) + " in cycle " + std::to_string(result_.cycles) + ", " +
                      toString(sample_.state) + ", " + toString(sample_.setpoint.move) + " " +
                      std::to_string(sample_.setpoint.cycle) + " of run " + std::to_string(result_.runs);
    }
    return result_;
  }

 private:
  bool isOver() {
    if (result_.cycles > kMostRideCycles)
      throw second_opinion::Violation("the job does not end: " + last_reply_ + "; " + sample_.fault.text());
    if (!sample_.job_ended && watch_.ground() < job_.asked.passes.size()) return false;
    const LoopStatus status = loop_->status();
    const bool ended = status.jobs_ended == status.jobs_started;
    if (ended && status.end == JobEnd::kDone) checkDone();
    return ended && watch_.ground() == job_.asked.passes.size();
  }

  void checkDone() const {
    if (watch_.ground() != job_.asked.passes.size()) {
      throw second_opinion::Violation("done with " + std::to_string(watch_.ground()) + " of " +
                                      std::to_string(job_.asked.passes.size()) + " passes");
    }
    if (!((sample_.command - job_.machine.park).abs() <= 1e-12).all())
      throw second_opinion::Violation("done, but not parked");
  }

  void cycle() {
    // What happens before the first reading nobody can see.
    if (result_.cycles > 0 && result_.events < kMostEvents && flip(random_, 1 / event_every_)) happen();
    if (result_.events >= kMostEvents || flip(random_, 1 / recover_every_)) recover();
    keepJogging();
    const bool late = periods_ > 1;
    const double periods = std::exchange(periods_, 1.0);
    const ros::Duration period(job_.machine.period * periods);
    time_ += period;
    loop_->cycle(time_, period);
    if (periods > kStall) button_.stall();
    seeButton(std::min(period.toSec(), 2 * job_.machine.period));
    if (const auto reply = loop_->reply()) last_reply_ = reply->text;
    loop_->jogReply();
    if (const auto reply = loop_->startJobReply()) last_reply_ = reply->text;
    loop_->swivelReply();
    ++result_.cycles;
    if (!loop_->pop(sample_)) throw second_opinion::Violation("a cycle without a sample");
    if (sample_.job_ended) endRun();
    see(late && sample_.drive.commands_waiting == 0);
    checkStop();
    past_.push_back(watch_.progress());
    if (past_.size() > kMostBuffered + 1) past_.pop_front();
  }

  /// What the axes have not reached is not ground; the loop knows that.
  void endRun() {
    watch_.goOnFrom(past_[past_.size() - 1 - sample_.drive.commands_waiting]);
    const std::vector<Move>& moves = streams_.back().program().moves();
    const auto ended = std::count_if(moves.begin(), moves.begin() + loop_->status().strokes_ended_at,
                                     [](const Move& move) { return move.kind == MoveKind::kStroke; });
    next_ += static_cast<std::size_t>(ended);
    // A stroke that was stopped within rounding of its end is ground once more.
    again_ = watch_.progress().again || (again_ && ended == 0);
    if (next_ != watch_.ground() && !(again_ && next_ + 1 == watch_.ground())) {
      throw second_opinion::Violation("the loop has ground " + std::to_string(next_) + " passes, not " +
                                      std::to_string(watch_.ground()));
    }
  }

  void see(bool late) {
    second_opinion::Row row;
    std::copy(sample_.command.data(), sample_.command.data() + kAxisCount, row.at.begin());
    row.late = late;
    row.moves = sample_.has_setpoint;
    row.of_job = sample_.has_setpoint && sample_.job != 0;
    row.free = sample_.state == S::kDisabled || sample_.state == S::kHoming;
    row.cycle = sample_.setpoint.cycle;
    row.tooth = sample_.setpoint.tooth;
    row.pass = sample_.setpoint.pass;
    row.y = drive_.y();
    row.y_off = drive_.yOff();
    row.rises = sample_.state == S::kRetracting || sample_.state == S::kLifting;
    row.lifts = sample_.setpoint.move == MoveKind::kLift;
    const bool of_straight = job_.asked.straight && sample_.setpoint.move == MoveKind::kStroke;
    row.in_stroke = of_straight || sample_.setpoint.step != StepKind::kNone;
    row.ends_stroke = row.in_stroke && sample_.setpoint.move_fraction >= 1;
    std::copy(sample_.setpoint.position.data(), sample_.setpoint.position.data() + kAxisCount, row.work.begin());
    if (sample_.state == S::kFault && drive_.isCommandedOn()) throw second_opinion::Violation("the power stays on");
    if (row.moves && std::find(std::begin(kAtRest), std::end(kAtRest), sample_.state) != std::end(kAtRest))
      throw second_opinion::Violation("it moves");
    const bool to_the_work = sample_.state == S::kRunning || sample_.state == S::kResuming;
    const bool turns = sample_.drive.spindle_at_speed && sample_.spindle_commanded;
    const bool flows = sample_.drive.coolant_on && sample_.coolant_commanded;
    if (to_the_work && !(turns && flows)) throw second_opinion::Violation("to the work with a dry or a stopped wheel");
    // No job is planned beyond a limit of its machine: what the loop refuses is the stream's fault, or the jog's.
    if (sample_.fault.kind == FaultKind::kLimit) throw second_opinion::Violation(sample_.fault.text());
    if (row.of_job) ++result_.setpoints;
    watch_.see(row);
  }

  /// Something that somebody asks for, or that goes wrong.
  void happen() {
    ++result_.events;
    const int axis = static_cast<int>(fraction(random_) * kAxisCount);
    const int some = 1 + static_cast<int>(fraction(random_) * 200);
    flip(random_, failures_) ? fail(axis, some) : ask(axis, some);
  }

  void ask(int axis, int some) {
    switch (static_cast<int>(fraction(random_) * 16)) {
      case 0:
      case 1:
      case 2:
      case 3: return stop(E::kHold);
      case 4: return post(E::kResume);
      case 5: return post(E::kRetract);
      case 6:
      case 7: return setOverride(between(random_, 0.05, 1.2));
      case 8: return setOverride(kMaxFeedOverride);
      case 9: return setOverride(0);
      case 10: return stop(E::kCancel);
      case 11: return stop(E::kDisable);
      case 12: return jogStep(axis);
      case 13: return beginJog(axis, some);
      case 14: return post(flip(random_, 0.5) ? E::kLift : E::kHome);
      default: return switchByHand();
    }
  }
  void switchByHand() {
    const bool on = flip(random_, 0.5);
    flip(random_, 0.5) ? post(on ? E::kSpindleOn : E::kSpindleOff) : post(on ? E::kCoolantOn : E::kCoolantOff);
  }

  void fail(int axis, int some) {
    using F = RideDrive::Failure;
    switch (static_cast<int>(fraction(random_) * 10)) {
      case 0: periods_ = 3; return;
      case 1: periods_ = kStall + (flip(random_, 0.5) ? -1 : 1); return;
      case 2: return drive_.fail(F::kEmergencyStop, axis, some);
      case 3: return drive_.fail(F::kFault, axis, some);
      case 4: return drive_.fail(flip(random_, 0.3) ? F::kTurn : flip(random_, 0.5) ? F::kJump : F::kNan, axis, 1);
      case 9: return drive_.fail(F::kGlitch, axis, 1 + some / 10);
      case 5: return drive_.fail(F::kStale, axis, some);
      case 6: return drive_.fail(F::kThrow, axis, 2);
      case 7: return drive_.fail(flip(random_, 0.5) ? F::kSpindle : F::kCoolant, axis, some);
      default: return drive_.fail(flip(random_, 0.7) ? F::kProbe : F::kReference, axis, some);
    }
  }

  /// What an operator does to go on.
  void recover() {
    const LoopStatus status = loop_->status();
    if (status.feed_override < 0.05 || result_.events >= kMostEvents) setOverride(1);
    switch (status.state) {
      case S::kFault: return post(E::kReset);
      case S::kDisabled: return post(E::kEnable);
      case S::kHeld:
      case S::kRetracted:
        if (flip(random_, 0.5)) return lookAtTheWork(status.state);
        // Somebody may be hasty.
        if (!sample_.spindle_commanded && flip(random_, 0.5)) return post(E::kSpindleOn);
        if (!sample_.coolant_commanded && flip(random_, 0.5)) return post(E::kCoolantOn);
        return status.homed ? post(E::kResume) : stop(E::kCancel);
      case S::kReady:
        if (status.wheel.in_work) return post(E::kLift);
        return status.homed ? startRun(status) : post(E::kHome);
      default: return;
    }
  }

  void lookAtTheWork(S state) {
    if (state == S::kHeld) return post(E::kRetract);
    if (flip(random_, 0.3)) return switchByHand();
    jogStep(static_cast<int>(fraction(random_) * kAxisCount));
  }

  void startRun(const LoopStatus& status) {
    if (status.jobs_ended != status.jobs_started || watch_.ground() == job_.asked.passes.size()) return;
    const second_opinion::Pass& first = job_.asked.passes[next_];
    streams_.clear();
    streams_.emplace_back(GrindProgram(job_.job, job_.machine,
                                       RunStart(Axes(status.command.data()), {first.tooth, first.pass}, job_.offset)));
    if (loop_->startJob({&streams_.back(), wheelOf(streams_.back().program())})) ++result_.runs;
  }

  void post(E event) { loop_->post(event); }
  void stop(E event) {
    loop_->postStop(event);
    is_stopped_ = true;
    if (loop_->status().jogs_begun != loop_->status().jogs_ended) rest_by_ = result_.cycles + most_braking_;
  }
  /// A jog that was stopped rests, whatever is pressed meanwhile.
  void checkStop() {
    if (rest_by_ == 0) return;
    const LoopStatus status = loop_->status();
    if (status.jogs_begun == status.jogs_ended) rest_by_ = 0;
    if (result_.cycles > rest_by_ && rest_by_ > 0) throw second_opinion::Violation("a jog does not stop");
  }
  void setOverride(double fraction) { loop_->setFeedOverride(fraction); }
  void jogStep(int axis) {
    const double distance = axis == kA ? between(random_, -1, 1) : between(random_, -5e-3, 5e-3);
    postJog({axis, false, distance, axis == kA ? 1.0 : 0.02});
  }
  void postJog(const JogRequest& jog) {
    if (loop_->postJog(jog)) jog_posted_ = jog;
  }
  void beginJog(int axis, int cycles) {
    jog_ = {axis, true, 0, between(random_, -1, 1) * (axis == kA ? 10 : 0.1)};
    jog_left_ = cycles;
  }
  void keepJogging() {
    if (pause_left_ > 0) {
      --pause_left_;
      return;
    }
    if (jog_left_ == 0 || jog_left_-- % 5 != 0) return;
    JogRequest request = jog_;
    if (flip(random_, 0.1)) request.velocity = 0;
    postJog(request);
    if (flip(random_, 0.1)) pause_left_ = static_cast<int>(between(random_, 0, 3) * kJogTimeout / job_.machine.period);
  }
  /// Judges what the messages of a continuous jog have done in a cycle. @param period as it counts [s].
  void seeButton(double period) {
    const auto jog = std::exchange(jog_posted_, std::nullopt);
    const bool was_barred = button_.isBarred();
    button_.wait(period);
    if (jog && jog->continuous) jog->velocity == 0 ? button_.release() : button_.press(jog->axis);
    const LoopStatus status = loop_->status();
    if (status.jogs_begun != jogs_begun_) {
      jogs_begun_ = status.jogs_begun;
      continuous_ = jog && jog->continuous;
      if (continuous_ && button_.isBarred()) throw second_opinion::Violation("a jog begins that was not released");
    }
    if (std::exchange(is_stopped_, false)) button_.stop();
    const bool runs = continuous_ && status.jogs_begun != status.jogs_ended;
    if (runs && !was_barred && button_.isBarred()) rest_by_ = result_.cycles + most_braking_;
  }

  Random random_;
  RideJob job_;
  double event_every_;    ///< cycles
  double recover_every_;  ///< cycles; at once when no event is to come
  double failures_;       ///< of the events
  std::uint64_t most_braking_;
  second_opinion::Watch watch_;
  RideDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
  std::list<SetpointStream> streams_;
  std::size_t next_ = 0;                              ///< pass, by the loop's account
  bool again_ = false;                                ///< the last stroke may be one that had come to its end before
  std::deque<second_opinion::Watch::Progress> past_;  ///< the newest last
  CycleSample sample_;
  RideResult result_;
  ros::Time time_{1000};
  double periods_ = 1;  ///< that the next cycle takes
  std::string last_reply_;
  JogRequest jog_;                        ///< continuous
  int jog_left_ = 0;                      ///< cycles in which it is repeated
  int pause_left_ = 0;                    ///< cycles until it is repeated again
  std::optional<JogRequest> jog_posted_;  ///< for this cycle
  bool is_stopped_ = false;               ///< in this cycle
  bool continuous_ = false;               ///< the last jog that began
  std::uint64_t jogs_begun_ = 0;
  second_opinion::Button button_{kJogTimeout};
  std::uint64_t rest_by_ = 0;  ///< cycle, of a jog that was stopped
};

volatile std::sig_atomic_t g_is_stopped = 0;

}  // namespace

}  // namespace grinder::test_support

int main(int argc, char** argv) {
  using Clock = std::chrono::steady_clock;
  CLI::App app(
      "Rides random jobs through the control loop, with everything that may happen, and judges every setpoint.");
  std::uint64_t first = 0, count = 1000;
  double seconds = 1e9;
  app.add_option("--from", first, "number of the first ride; each number is always the same ride")
      ->capture_default_str();
  app.add_option("--count", count, "how many rides")->capture_default_str();
  app.add_option("--for", seconds, "for at most this long, e.g. 8h")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                        CLI::AsNumberWithUnit::CASE_INSENSITIVE));
  CLI11_PARSE(app, argc, argv);
  // What has been ridden until then is still reported.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { grinder::test_support::g_is_stopped = 1; });
  const Clock::time_point start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  grinder::test_support::RideResult total;
  std::uint64_t number = first, wrong = 0;
  for (; number < first + count && elapsed() < seconds && !grinder::test_support::g_is_stopped; ++number) {
    try {
      const auto one = grinder::test_support::Ride(number).run();
      total.setpoints += one.setpoints;
      total.cycles += one.cycles;
      total.events += one.events;
      total.runs += one.runs;
      if (one.fault.empty()) continue;
      std::printf("ride %llu: %s\n", static_cast<unsigned long long>(number), one.fault.c_str());
    } catch (const std::exception& error) {
      std::printf("ride %llu: %s\n", static_cast<unsigned long long>(number), error.what());
    }
    ++wrong;
    std::fflush(stdout);
  }
  std::printf("%llu rides (%llu to %llu), %llu setpoints in %llu cycles, %d runs, %d events, %.0f s; wrong: %llu\n",
              static_cast<unsigned long long>(number - first), static_cast<unsigned long long>(first),
              static_cast<unsigned long long>(number - 1), static_cast<unsigned long long>(total.setpoints),
              static_cast<unsigned long long>(total.cycles), total.runs, total.events, elapsed(),
              static_cast<unsigned long long>(wrong));
  return wrong == 0 ? 0 : 1;
}
