#include "node/probing_cycles.h"

#include "control/fixtures.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "refusal.h"

#include <cmath>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

// The probing cycles on a control loop that runs as fast as it can, with a drive whose probe touches what a test puts
// there.
namespace grinder {
namespace test_probing_cycles {

using test_support::FakeDrive;

/// Its time runs as fast as the cycles do.
class FastDrive : public FakeDrive {
 public:
  ros::Duration wait(const ros::Duration& period) override {
    std::this_thread::yield();
    return period;
  }
};

constexpr double kBall = 0.001;  ///< radius [m]
/// By which the slow touches may be late: their speed in one cycle [m].
constexpr double kTouch = 1e-4 * 1e-3 * 1.01;

LoopConfig config() {
  LoopConfig config = test_support::machineConfig();
  config.jog_timeout = 1e6;  // nobody is to repeat that the client is alive
  config.geometry.work_axis_y = 0.01;
  config.geometry.collet_face = 0.1;
  config.geometry.probe = ProbeBall{{0.06, 0, 0}, 2 * kBall};
  config.probing.velocity << 0.01, 0.01, 0.01, 0.1;
  config.probing.slow = 0.01;
  config.probing.back_off << 0.0005, 0.0005, 0.0005, 0.02;
  config.probing.max_spread << 1e-6, 1e-6, 1e-6, 1e-4;
  config.probing.touches = 2;
  return config;
}

class ProbingCycles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  /// Powers the machine. @param touches whether the probe touches, by the axes' positions.
  void start(const LoopConfig& config, std::function<bool(const FakeDrive&)> touches) {
    loop_.reset();
    test_support::setUp(drive_, config);
    drive_.on_read = [touches = std::move(touches)](FakeDrive& drive) { drive.status.probe_contact = touches(drive); };
    loop_ = std::make_unique<ControlLoop>(drive_, config);
    loop_->startThread();
    ASSERT_TRUE(loop_->request(MachineEvent::kEnable).accepted);
    loop_->keepAlive();
  }

  double run(const flute_grinder::ProbeGoal& goal) {
    Prober prober(*loop_, loop_->status().stops, [this](int place, int touch) {
      touches_.emplace_back(place, touch);
      if (touches_.size() == stop_at_) loop_->stop(MachineEvent::kHold);
    });
    return runCycle(prober, goal, offsets_, result_);
  }

  std::string refusal(const flute_grinder::ProbeGoal& goal) {
    return test_support::refusalOf<ProbingError>([&] { run(goal); });
  }

  static flute_grinder::ProbeGoal goal(std::uint8_t cycle, double within) {
    flute_grinder::ProbeGoal goal;
    goal.cycle = cycle;
    goal.within = within;
    return goal;
  }

  FastDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
  WorkOffsets offsets_;
  flute_grinder::ProbeResult result_;
  std::vector<std::pair<int, int>> touches_;
  std::size_t stop_at_ = 0;  ///< before this touch, from 1; 0: never
};

/// X of an axis that stands there when the ball touches a face [m].
bool beyond(const FakeDrive& drive, double face) { return drive.position[kX] + 0.06 + kBall >= face; }

TEST_F(ProbingCycles, EndFaceGivesTheStickOutAndXOfTheJob) {
  start(config(), [](const FakeDrive& drive) { return beyond(drive, 0.013); });
  flute_grinder::ProbeGoal probe = goal(flute_grinder::ProbeGoal::END_FACE, 0.005);
  probe.set_offset = 1;
  probe.flange = 0.002;
  probe.job = goalFromJob(readJobFile("test/jobs/paper.yaml"));
  ASSERT_EQ(goalRefusal(probe), "");
  const double offset = run(probe);
  ASSERT_EQ(result_.figures.size(), 2U);
  EXPECT_EQ(result_.figures[0].name, "end face");
  EXPECT_NEAR(result_.figures[0].value, 0.013, kTouch);
  EXPECT_LE(result_.figures[0].spread, kTouch);
  EXPECT_NEAR(result_.figures[1].value, 0.1 - 0.013, kTouch);
  EXPECT_EQ(offset, workZero(config().geometry, jobFromGoal(probe.job), {0.002, result_.figures[1].value}).x());
  EXPECT_EQ(touches_, (std::vector<std::pair<int, int>>{{0, 0}, {0, 1}, {0, 2}}));
}

TEST_F(ProbingCycles, DiameterIsTheMeanOfFourSidesAndTheRunOutTheirWay) {
  constexpr double radius = 0.006, centre = 2e-5;
  start(config(), [](const FakeDrive& drive) {
    const double y = drive.position[kY] - 0.01 - centre * std::cos(drive.position[kA] + 0.4);
    return std::hypot(y, centre * std::sin(drive.position[kA] + 0.4)) <= radius + kBall;
  });
  run(goal(flute_grinder::ProbeGoal::DIAMETER, 0.035));
  ASSERT_EQ(result_.figures.size(), 2U);
  EXPECT_NEAR(result_.figures[0].value, 2 * radius, 2 * kTouch + centre * centre / radius);
  EXPECT_NEAR(result_.figures[1].value, 2 * centre, 4 * kTouch + centre * centre / radius);
  EXPECT_EQ(touches_.size(), 4U * 3U);
  EXPECT_EQ(touches_.back(), std::make_pair(3, 2));
  EXPECT_NEAR(loop_->status().command[kA], 0, 1e-9);
}

TEST_F(ProbingCycles, ADiameterFarFromTheKnownOneSetsNothing) {
  start(config(), [](const FakeDrive& drive) { return std::abs(drive.position[kY] - 0.01) <= 0.006 + kBall; });
  flute_grinder::ProbeGoal probe = goal(flute_grinder::ProbeGoal::DIAMETER, 0.035);
  probe.set_offset = 1;
  probe.job = goalFromJob(readJobFile("test/jobs/paper.yaml"));
  for (const double known : {0.0109, 0.0131, 0.006, 0.022}) {
    probe.diameter = known;
    EXPECT_CONTAINS(refusal(probe), "diameter = 11.9999 mm, known as ");
    EXPECT_CONTAINS(refusal(probe), "; allowed: up to 1.0000 mm apart");
  }
  probe.diameter = 0.0111;
  // As if the axis were farther by half of what is too much.
  const double fits = workZero(config().geometry, jobFromGoal(probe.job), {0, 0.1}).y();
  EXPECT_NEAR(run(probe), fits + (0.012 - 0.0111) / 2, kTouch);
}

TEST_F(ProbingCycles, WhatIsNoGoodTouchIsRefused) {
  const struct {
    const char* why;
    std::function<bool(const FakeDrive&)> touches;
  } rows[]{{"nothing was touched over 5 mm", [](const FakeDrive&) { return false; }},
           {"the touches spread over 0.00",
            [face = 0.013, touched = false](const FakeDrive& drive) mutable {
              const bool touches = beyond(drive, face);
              // The face yields a little at each touch.
              if (touched && !touches) face += 3e-6;
              touched = touches;
              return touches;
            }},
           {"the contact was lost again before the axis came to rest",
            [touched = false](const FakeDrive& drive) mutable {
              const bool begins = beyond(drive, 0.013) && !touched;
              touched = begins || touched;
              return begins;
            }},
           {"jog refused: the probe touches already", [](const FakeDrive&) { return true; }}};
  for (const auto& row : rows) {
    start(config(), row.touches);
    const double before = loop_->status().command[kX];
    EXPECT_CONTAINS(refusal(goal(flute_grinder::ProbeGoal::END_FACE, 0.005)), row.why);
    EXPECT_TRUE(result_.figures.empty());
    if (&row == rows) {
      EXPECT_EQ(loop_->status().command[kX], before) << "it goes back";
    }
  }
}

TEST_F(ProbingCycles, AStopBeforeATouchRefusesIt) {
  for (const std::size_t touch : {1U, 2U, 3U}) {
    touches_.clear();
    stop_at_ = touch;
    if (!loop_) start(config(), [](const FakeDrive& drive) { return beyond(drive, 0.013); });
    EXPECT_EQ(refusal(goal(flute_grinder::ProbeGoal::END_FACE, 0.005)), "stopped") << touch;
    EXPECT_EQ(touches_.size(), touch);
    EXPECT_EQ(loop_->status().state, MachineState::kReady);
  }
}

TEST_F(ProbingCycles, AStopOnTheLastWayBackIsOneToo) {
  start(config(), [this, touched = false, touches = 0](const FakeDrive& drive) mutable {
    const bool leaves = touched && !beyond(drive, 0.013);
    touched = beyond(drive, 0.013);
    touches += leaves ? 1 : 0;
    if (leaves && touches == 3) loop_->postStop(MachineEvent::kHold);  // the search and two that count
    return touched;
  });
  EXPECT_EQ(refusal(goal(flute_grinder::ProbeGoal::END_FACE, 0.005)), "stopped");
  EXPECT_EQ(touches_.size(), 3U);
}

TEST_F(ProbingCycles, ToothNeedsTheOffsetOfX) {
  start(config(), [](const FakeDrive&) { return false; });
  EXPECT_EQ(refusal(goal(flute_grinder::ProbeGoal::TOOTH, 0.1)),
            "the work offset of X was never set; probe the end face first");
  EXPECT_TRUE(touches_.empty());
}

TEST_F(ProbingCycles, GoalsThatAreWrongAreRefused) {
  using Goal = flute_grinder::ProbeGoal;
  const Goal free = goal(Goal::DIAMETER, 0.005);
  Goal good = free;
  good.set_offset = 1;
  good.diameter = 0.01;
  good.job = goalFromJob(readJobFile("test/jobs/paper.yaml"));
  for (const Goal& right : {free, good}) EXPECT_EQ(goalRefusal(right), "");
  const auto with = [&](const std::function<void(Goal&)>& change) {
    Goal goal = good;
    change(goal);
    return goalRefusal(goal);
  };
  EXPECT_EQ(with([](Goal& g) { g.cycle = 3; }), "cycle = 3; allowed: 0 to 2");
  for (const double wrong : {0.0, -0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_CONTAINS(with([&](Goal& g) { g.within = wrong; }), "; allowed: finite, and above 0");
  }
  EXPECT_EQ(goalRefusal(goal(Goal::TOOTH, 0.1)), "set_offset = false; allowed: true, for TOOTH");
  EXPECT_CONTAINS(with([](Goal& g) { g.diameter = 0; }), "diameter = 0");
  EXPECT_CONTAINS(with([](Goal& g) { g.job = {}; }), "allowed: ");
  EXPECT_EQ(with([](Goal& g) { g.flange = std::nan(""); }), "flange = nan; allowed: finite");
  EXPECT_CONTAINS(with([](Goal& g) { g.set_by = "a\x1b[2J"; }), "set_by has 5 characters; allowed: ");
}

}  // namespace test_probing_cycles
}  // namespace grinder
