#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/motion/job_plan.h"

#include "motion/examples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

/// @file
/// Whatever a job holds, the answer is a plan that keeps all limits, or a refusal with its reasons.

namespace grinder {
namespace test_job_fuzz {

using test_support::paperJob;
using test_support::plainMachine;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kHuge = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}

  bool once(int in) { return below(in) == 0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  double within(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  double scaled(double low, double high) { return low * std::pow(high / low, within(0, 1)); }
  template <typename T>
  T of(std::initializer_list<T> values) {
    return *(values.begin() + below(static_cast<int>(values.size())));
  }

 private:
  std::mt19937 engine_;
};

/// What a field may hold at the worst: no numbers, ends of all ranges and what is next to them.
std::vector<double> hostileValues(double min, double max) {
  std::vector<double> values{kNaN, kInf, -kInf, kHuge, -kHuge, kTiny, -kTiny, 0.0, -0.0, -1, min, max, (min + max) / 2};
  for (const double end : {min, max}) {
    values.push_back(std::nextafter(end, kInf));
    values.push_back(std::nextafter(end, -kInf));
    values.push_back(-end);
    values.push_back(end * (1 + 1e-9));
    values.push_back(end * (1 - 1e-9));
  }
  return values;
}

/// Any value of a range, often near its lower end.
double anyWithin(Dice& dice, double min, double max) {
  if (min > 0 && dice.once(2)) return dice.scaled(min, max);
  if (dice.once(3)) return min + (max - min) * dice.scaled(1e-15, 1);
  return dice.within(min, max);
}

double hostileOrAny(Dice& dice, double min, double max) {
  if (!dice.once(3)) return anyWithin(dice, min, max);
  const std::vector<double> values = hostileValues(min, max);
  return values[static_cast<std::size_t>(dice.below(static_cast<int>(values.size())))];
}

/// A number of a job, and its range in SI.
struct Number {
  JobNumber::Of of;
  double min, max;
};

std::vector<Number> numbers() {
  std::vector<Number> all;
  visitJobFields([&](const JobField& f, auto of) {
    if (f.isOf(OperationKind::kFlute)) all.push_back({of, f.low().si, f.high().si});
  });
  return all;
}

/// A job of which every number is within its range, and which is allowed more often than not: small, and drawn to where
/// cones close.
GrindJob allowedJob(Dice& dice) {
  GrindJob job = paperJob();
  for (const Number& n : numbers()) n.of(job) = anyWithin(dice, n.min, n.max);
  CutterGeometry& g = job.cutter;
  GrindProcess& p = job.process();
  g.end_diameter = dice.scaled(0.1e-3, 10e-3);
  if (dice.once(2)) g.spiral_angle *= dice.scaled(1e-12, 1);
  if (dice.once(2)) g.cone_angle *= dice.scaled(1e-12, 1);
  const double apex = -g.end_diameter / 2 / std::tan(g.cone_angle);
  const double close = 1 - dice.scaled(1e-15, 1);
  test_support::askForRakeAlone(g);
  g.chordal_rake_depth = 0;
  g.flute_length = dice.scaled(0.1e-3, 3e-3);
  p.overtravel_shank = dice.within(0, 1e-3);
  p.overtravel_end = dice.within(0, 1e-3);
  p.setup_x_shift = dice.once(2) ? std::min(std::abs(apex), 5e-3) * dice.within(-0.5, 0.5) : 0;
  const double closes = apex + (apex < 0 ? std::max(0.0, p.setup_x_shift) : std::min(0.0, p.setup_x_shift));
  if (apex < 0) p.overtravel_end = std::min(-closes * close, 5e-3);
  if (apex > 0) p.overtravel_shank = std::max(0.0, std::min(closes * close - g.flute_length, 5e-3));
  p.depth = dice.scaled(1e-6, g.end_diameter / 4);
  p.removal = 0;
  p.infeed = dice.once(4) ? p.depth / dice.below(4) : p.depth;
  p.finish_infeed = dice.once(3) ? p.depth * dice.within(0, 1) : 0;
  p.clearance = dice.scaled(0.1e-3, 2e-3);
  p.depth_end = dice.once(3) ? p.depth * dice.within(0.1, 2) : 0;
  p.wheel_angle = p.wheel_corner_radius_lower = p.wheel_corner_radius_upper = p.wheel_rim = 0;
  p.wheel_diameter = 0.1;
  p.wheel_wear = 0;
  p.wheel_wear_per_pass = dice.once(3) ? dice.scaled(1e-9, 1e-6) : 0;
  // A second or so for each tooth and pass, more often than not.
  const double way = p.clearance + (g.flute_length + p.overtravel_end + p.overtravel_shank) / std::cos(g.spiral_angle);
  p.feed =
      dice.once(10) ? dice.scaled(kMinFeed, 10.0 / 60) : std::clamp(way / dice.within(0.1, 2), kMinFeed, 10.0 / 60);
  job.interpolation.even_step = dice.of({EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact});
  p.direction = dice.of({StrokeDirection::kFromEnd, StrokeDirection::kToEnd});
  if (dice.once(4)) job.tooth_angles = {0, dice.within(0.1, 6)};
  if (job.tooth_angles.size() == 2 && dice.once(2)) job.spiral_angles = {g.spiral_angle, dice.within(-1, 1)};
  return job;
}

/// A machine that may have any limits, the impossible included; jobs of a second at the most.
Machine anyMachine(Dice& dice) {
  Machine m = plainMachine();
  if (dice.once(3)) {
    for (int axis = 0; axis < kAxisCount; ++axis) {
      for (Axes* limit : {&m.limits.max_velocity, &m.limits.max_acceleration, &m.limits.max_jerk}) {
        if (dice.once(3)) (*limit)[axis] = hostileOrAny(dice, kMinFigure, kMaxFigure);
      }
    }
  } else if (dice.once(2)) {
    m.limits.max_velocity *= 50;
    m.limits.max_acceleration *= 1000;
    m.limits.max_jerk *= 100000;
  }
  const int axis = dice.below(kAxisCount);
  if (dice.once(10)) m.limits.min_position[axis] = hostileOrAny(dice, -kMaxFigure, kMaxFigure);
  if (dice.once(10)) m.limits.max_position[axis] = hostileOrAny(dice, -kMaxFigure, kMaxFigure);
  if (dice.once(10)) m.park[axis] = hostileOrAny(dice, -kMaxFigure, kMaxFigure);
  m.period = dice.once(10) ? hostileOrAny(dice, 50e-6, 0.1) : 1 / dice.within(200, 1000);
  m.max_job_duration = dice.once(40) ? dice.of({kNaN, kInf, -kInf, 0.0, -1.0, kTiny}) : 2.5;
  return m;
}

struct Case {
  GrindJob job;
  Machine machine;
  Axes start;
  ToothPass first;

  JobPlan plan(const std::function<void(const Setpoint&)>& visit = {}) const {
    try {
      return planJob(ValidJob(job), machine, {start, first}, visit);
    } catch (const InvalidJob& invalid) {
      JobPlan refused;
      refused.fault = PlanFault::kInvalidJob;
      refused.reasons = invalid.reasons();
      return refused;
    }
  }
};

Case anyCase(Dice& dice, const GrindJob& job) {
  Case c{job, anyMachine(dice), Axes::Zero(), {}};
  c.start = c.machine.park;
  if (dice.once(10)) c.start[dice.below(kAxisCount)] = hostileOrAny(dice, -kMaxFigure, kMaxFigure);
  const auto whole = [&] {
    return dice.of({-1, 0, 1, 64, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()});
  };
  if (dice.once(10)) c.first = {whole(), whole()};
  return c;
}

/// Whether a reason names something, and says something of it. That a setpoint is not a number is the last resort,
/// which nothing comes to.
bool sane(const std::string& reason) {
  const auto has = [&](const char* part) { return reason.find(part) != std::string::npos; };
  return reason.size() > 10 && reason.size() < 1000 && has(" ") && !has("not a finite number");
}

/// Plans a case and looks at every setpoint by itself.
/// @return whether it is a good plan.
bool planAndJudge(const Case& c) {
  bool finite = true;
  bool in_range = true;
  std::uint64_t count = 0;
  const AxisLimits& l = c.machine.limits;
  const JobPlan plan = c.plan([&](const Setpoint& p) {
    ++count;
    finite &= p.position.isFinite().all() && p.velocity.isFinite().all() && std::isfinite(p.feed) &&
              std::isfinite(p.path_error);
    in_range &= (p.position >= l.min_position).all() && (p.position <= l.max_position).all();
  });
  EXPECT_TRUE(finite);
  EXPECT_EQ(plan.good(), plan.reasons.empty());
  EXPECT_TRUE(in_range || !plan.good());
  for (const Reason& reason : plan.reasons) {
    EXPECT_TRUE(sane(text(reason))) << text(reason);
  }
  if (!plan.good()) return false;
  EXPECT_EQ(count, plan.statistics.setpoints);
  EXPECT_LE(plan.statistics.duration, c.machine.max_job_duration);
  EXPECT_TRUE((plan.statistics.max_velocity <= l.max_velocity * (1 + 1e-6) + 1e-9).all());
  return true;
}

/// Plans a case twice and judges the first answer; some of them by what comes of it.
struct Tally {
  int good = 0;
  int refused = 0;

  void judge(const Case& c) {
    SCOPED_TRACE(testing::Message() << c.job << "; " << c.machine << "; start " << c.start.transpose() << "; first "
                                    << c.first.tooth << " " << c.first.pass);
    ++(planAndJudge(c) ? good : refused);
    if ((good + refused) % 16 != 0) return;
    const JobPlan one = c.plan();
    const JobPlan other = c.plan();
    EXPECT_EQ(one.fault, other.fault);
    EXPECT_EQ(text(one.reasons), text(other.reasons));
    EXPECT_EQ(one.move_ends, other.move_ends);
    EXPECT_EQ(one.statistics.setpoints, other.statistics.setpoints);
  }
};

TEST(JobFuzz, EveryHostileValueOfEveryFieldIsAnswered) {
  Tally tally;
  for (const Number& n : numbers()) {
    for (const double value : hostileValues(n.min, n.max)) {
      GrindJob job = paperJob();
      n.of(job) = value;
      Machine machine = plainMachine();
      machine.max_job_duration = 2;
      tally.judge({job, machine, machine.park, {}});
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(tally.refused, 100);
}

TEST(JobFuzz, AllowedJobsOfAllKindsAreAnswered) {
  Dice dice(3);
  Tally tally;
  for (int i = 0; i < 2500 && !HasFailure(); ++i) tally.judge(anyCase(dice, allowedJob(dice)));
  EXPECT_GT(tally.good, 150);
  EXPECT_GT(tally.refused, 150);
}

}  // namespace test_job_fuzz
}  // namespace grinder
