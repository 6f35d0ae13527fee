/// @file
/// How long a client of the node waits from a goal to the first motion, with the simulated drive. Beside it the floors
/// of that on this computer: the same for an action that does nothing, and the wake-up of a thread that sleeps.
///
///     bench_goal --server                  the action that does nothing; has to run beside the other call
///     bench_goal NODE [GOALS [SECONDS]]    measures so many goals of each kind, for so many seconds at most
///
/// Prints JSON: `samples` in s, `values`, and whether real-time scheduling was granted. The machine is enabled first,
/// and left enabled. A spindle that has to run up counts: a node is measured with `hardware/spindle_run_up_time` 0.

#include "flute_grinder/ConfirmSwivel.h"
#include "flute_grinder/GrindAction.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/control/realtime.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/json.h"
#include "goals.h"

#include <actionlib/TestAction.h>
#include <actionlib/client/action_client.h>
#include <actionlib/server/action_server.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

namespace {

using namespace grinder;

const char* const kFloorAction = "empty_action";
constexpr std::chrono::seconds kPatience(60);
constexpr std::chrono::milliseconds kRest(100);  ///< of the machine between goals
constexpr std::chrono::microseconds kStagger(1370);
constexpr int kStaggers = 37;
constexpr int kWakeUps = 5000;

/// Of the system's clock, as in the stamps of messages [s].
double now() { return ros::WallTime::now().toSec(); }

/// Values that callbacks set and the main thread waits for.
class Shared {
 public:
  template <typename Change>
  void change(const Change& change) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      change();
    }
    changed_.notify_all();
  }
  /// @throw std::runtime_error if it does not come true.
  template <typename Condition>
  void wait(const char* what, const Condition& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, kPatience, condition)) throw std::runtime_error(std::string("timed out: ") + what);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
};

/// Sends goals, one after the other.
template <typename Action>
class Sender {
 public:
  ACTION_DEFINITION(Action)
  using Handle = actionlib::ClientGoalHandle<Action>;

  explicit Sender(const std::string& name) : client_(name) {
    if (!client_.waitForActionServerToStart(ros::Duration(kPatience.count()))) {
      throw std::runtime_error("no action server " + name);
    }
  }

  /// @return when the goal was handed over [s].
  double send(const Goal& goal) {
    shared_.change([this] {
      accepted_.reset();
      ended_ = false;
    });
    const double sent = now();
    handle_ = client_.sendGoal(goal, [this](const Handle& handle) { onTransition(handle); });
    return sent;
  }

  void cancel() { handle_.cancel(); }

  /// Waits until the goal is accepted. @return when the client knows it [s]. @throw std::runtime_error if it is not.
  double accepted() {
    shared_.wait("goal accepted", [this] { return accepted_ || ended_; });
    if (!accepted_) throw std::runtime_error("the goal was not accepted: " + handle_.getTerminalState().getText());
    return *accepted_;
  }

  /// Waits for the end of the goal.
  ResultConstPtr result() {
    shared_.wait("goal ended", [this] { return ended_; });
    return handle_.getResult();
  }

 private:
  void onTransition(const Handle& handle) {
    const actionlib::CommState state = handle.getCommState();
    const double at = now();
    shared_.change([&] {
      if (state == actionlib::CommState::ACTIVE) accepted_ = at;
      ended_ = state == actionlib::CommState::DONE;
    });
  }

  Shared shared_;
  std::optional<double> accepted_;
  bool ended_ = false;
  actionlib::ActionClient<Action> client_;
  Handle handle_;
};

/// When axes begin to move, by the times of the cycles that wrote the setpoints.
class MotionWatch {
 public:
  explicit MotionWatch(const std::string& node)
      : subscriber_(ros::NodeHandle().subscribe(node + "/setpoints", 1000, &MotionWatch::onBatch, this,
                                                ros::TransportHints().tcpNoDelay())) {}

  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  /// To be called ahead of the goal whose motion is awaited.
  void expect() {
    shared_.change([this] {
      after_ = now();
      first_.reset();
    });
  }

  /// Waits for the first motion. @return when it begins [s].
  double first() {
    shared_.wait("motion", [this] { return first_.has_value(); });
    return *first_;
  }

  /// How far each cycle of a setpoint came from its period after the one before [s]; call without a job.
  const std::vector<double>& deviations() const { return deviations_; }

 private:
  void onBatch(const flute_grinder::SetpointBatch& batch) {
    shared_.change([&] {
      double at = batch.header.stamp.toSec();
      for (std::size_t i = 0; i < batch.setpoints.size(); ++i) {
        const flute_grinder::WrittenSetpoint& setpoint = batch.setpoints[i];
        if (i > 0) at += setpoint.cycle_period;
        deviations_.push_back(std::abs(setpoint.cycle_period - batch.period));
        const auto& v = setpoint.velocity;
        const bool moves = std::any_of(v.begin(), v.end(), [](double axis) { return axis != 0; });
        if (moves && at > after_ && !first_) first_ = at;
      }
    });
  }

  Shared shared_;
  double after_ = std::numeric_limits<double>::infinity();
  std::optional<double> first_;
  std::vector<double> deviations_;
  ros::Subscriber subscriber_;
};

/// Of a thread like the control loop's that sleeps for a millisecond [s].
void wakeUps(Json& out) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> delays;
  delays.reserve(kWakeUps);
  bool realtime = false;
  std::thread([&] {
    realtime = becomeRealtime();
    Clock::time_point due = Clock::now();
    for (int i = 0; i < kWakeUps; ++i) {
      due = std::max(due, Clock::now()) + std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);
      delays.push_back(std::chrono::duration<double>(Clock::now() - due).count());
    }
  }).join();
  out["realtime"] = realtime;
  out["samples"]["wake_up"] = delays;
}

template <typename Service>
void call(const std::string& name, Service service) {
  if (!ros::service::waitForService(name, ros::Duration(kPatience.count())) ||
      !ros::NodeHandle().serviceClient<Service>(name, true).call(service)) {
    throw std::runtime_error("no answer of " + name);
  }
  if (!service.response.success) throw std::runtime_error(name + ": " + service.response.message);
}

/// Measures a node's goals.
class Bench {
 public:
  Bench(const std::string& node, int goals, double seconds)
      : goals_(goals), seconds_(seconds), floor_(kFloorAction), grinder_(node + "/grind"), motion_(node) {
    while (!motion_.connected()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    call(node + "/enable", std_srvs::Trigger());
    flute_grinder::ConfirmSwivel swivel;
    swivel.request.swivel = processOf(paperGoal()).setup_swivel;  // that of all jobs here
    call(node + "/confirm_swivel", swivel);
  }

  /// A job that the node has not planned before, over and over, and one after a dry run from the same place.
  void measure(const std::string& name, flute_grinder::GrindGoal goal) {
    out_["values"][name + "/goal_bytes"] = ros::serialization::serializationLength(goal);
    const flute_grinder::GrindGoal repeated = goal;
    const double feed = processOf(goal).feed;
    repeat(name + "/new", [&](int i) {
      processOf(goal).feed = feed * (1 - 1e-5 * (i + 1));
      return goal;
    });
    repeat(name + "/repeated", [&](int) -> const flute_grinder::GrindGoal& {
      dryRun(repeated);
      return repeated;
    });
    out_["values"][name + "/max_odd_error"] = statistics_.max_odd_error;
  }

  Json results() {
    wakeUps(out_);
    out_["samples"]["loop_deviation"] = motion_.deviations();
    return out_;
  }

 private:
  struct Times {
    double floor, accepted, motion;  ///< since a goal was handed over [s]
  };

  template <typename MakeGoal>
  void repeat(const std::string& name, const MakeGoal& make_goal) {
    auto& samples = out_["samples"];
    const double end = now() + seconds_;
    for (int i = 0; i < goals_ && now() < end; ++i) {
      const Times times = sendOnce(make_goal(i));
      samples["empty_action"].push_back(times.floor);
      samples[name + "/accepted"].push_back(times.accepted);
      samples[name + "/motion"].push_back(times.motion);
    }
  }

  void dryRun(flute_grinder::GrindGoal goal) {
    goal.dry_run = true;
    grinder_.send(goal);
    const auto result = grinder_.result();
    if (!result || result->error_code != flute_grinder::GrindResult::SUCCESSFUL) {
      throw std::runtime_error("a dry run failed: " + (result ? result->error_string : "no result"));
    }
  }

  /// Begins at rest, in the state ready, and ends so.
  Times sendOnce(const flute_grinder::GrindGoal& goal) {
    // At ever other points of the node's own periods.
    std::this_thread::sleep_for(kRest + sent_++ % kStaggers * kStagger);
    Times times{};
    double sent = floor_.send(actionlib::TestGoal());
    times.floor = floor_.accepted() - sent;
    floor_.result();

    motion_.expect();
    sent = grinder_.send(goal);
    times.accepted = grinder_.accepted() - sent;
    times.motion = motion_.first() - sent;
    grinder_.cancel();
    const auto result = grinder_.result();
    if (!result || result->error_code != flute_grinder::GrindResult::CANCELED) {
      throw std::runtime_error("a goal was not canceled: " + (result ? result->error_string : "no result"));
    }
    statistics_ = result->plan.statistics;
    return times;
  }

  const int goals_;
  const double seconds_;
  Sender<actionlib::TestAction> floor_;
  Sender<flute_grinder::GrindAction> grinder_;
  MotionWatch motion_;
  int sent_ = 0;
  flute_grinder::PathStatistics statistics_;  ///< of the last goal
  Json out_;
};

/// Accepts every goal at once, and ends it.
void serve() {
  using Server = actionlib::ActionServer<actionlib::TestAction>;
  const auto accept = [](Server::GoalHandle handle) {
    handle.setAccepted();
    handle.setSucceeded();
  };
  Server server(
      ros::NodeHandle(), kFloorAction, accept, [](const Server::GoalHandle&) {}, false);
  server.start();
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bench_goal", ros::init_options::AnonymousName);
  if (argc < 2 || argc > 4) {
    std::cerr << "usage: bench_goal --server | bench_goal NODE [GOALS [SECONDS]]\n";
    return EXIT_FAILURE;
  }
  const std::string node = argv[1];
  try {
    if (node == "--server") {
      serve();
      return EXIT_SUCCESS;
    }
    ros::AsyncSpinner spinner(1);
    spinner.start();
    Bench bench(node, argc > 2 ? std::stoi(argv[2]) : 100, argc > 3 ? std::stod(argv[3]) : 30);
    bench.measure("paper", paperGoal());
    bench.measure("tool", wholeToolGoal());
    std::cout << bench.results() << '\n';
  } catch (const std::exception& error) {
    std::cerr << "bench_goal: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
