// Where a ball touches the first tooth's rake face, against a plane and against membership in the swept wheel.

#include "brute_force.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/rake_touch.h"
#include "flute_grinder/tool/z_law.h"
#include "jobs.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <random>
#include <tuple>

namespace grinder {
namespace test_rake_touch {

using test_support::jobOf;
using test_support::paper;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

constexpr double kNearly = 1e-5;  ///< 0.1 um at the largest cutter's edge [rad]

/// A ball at a distance and an angle about the axis.
struct Ball {
  double x, from_axis, angle, diameter;

  Eigen::Vector3d centre() const { return {x, from_axis * std::cos(angle), from_axis * std::sin(angle)}; }
};

double touch(const ValidJob& job, const Ball& ball) { return rakeTouchAngle(job, ball.centre(), ball.diameter); }

/// Why a ball is refused.
std::optional<Reason> refusal(const ValidJob& job, const Ball& ball) {
  try {
    touch(job, ball);
    return std::nullopt;
  } catch (const ReasonError& error) {
    return error.reason();
  }
}

/// A cutter with straight flutes on a cylinder of 10 mm under an upright straight wheel: both walls are planes.
GrindJob straight(CutDirection cut) {
  GrindJob job = paper();
  job.cutter.cone_angle = job.cutter.spiral_angle = 0;
  job.cutter.cut = cut;
  job.process().wheel_diameter = 100 * kMillimetre;
  job.process().wheel_width = 4 * kMillimetre;
  job.process().depth = 2 * kMillimetre;
  job.process().setup_swivel = 0;
  job.process().setup_height = (cut == CutDirection::kRightHand ? -1.3 : 1.3) * kMillimetre;
  return job;
}

/// Whether a ball is free in the groove of the first tooth, by trying: points of the ball against the wheel at many
/// places of the stroke.
class Groove {
 public:
  explicit Groove(const ValidJob& job) : job_(job), bench_(brute::benchOf(*job, 0, 0, job.zCorrectionOf(0))) {}

  /// The minimum depth in the wheel's way of the ball's points within the blank, while A is as given; negative if the
  /// ball is in the cutter [m].
  /// @param rows of points, from which the point that is deepest in the cutter is refined.
  double room(const Ball& ball, double a, int rows) const {
    double best = std::numeric_limits<double>::infinity(), best_up = 0, best_around = 0;
    const auto look = [&](double up, double around) {
      const double value = roomAt(ball, a, up, around);
      if (value < best) best = value, best_up = up, best_around = around;
    };
    for (int i = 0; i <= rows; ++i) {
      for (int k = 0; k < 2 * rows; ++k) look((1.0 * i / rows - 0.5) * kPi, kPi * k / rows);
    }
    for (double step = kPi / rows / 2; step > 1e-5; step /= 2) {
      const double up = best_up, around = best_around;
      for (const int i : {-1, 0, 1}) {
        for (const int k : {-1, 0, 1}) look(up + i * step, around + k * step);
      }
    }
    return best;
  }

 private:
  double roomAt(const Ball& ball, double a, double up, double around) const {
    const double r = ball.diameter / 2;
    // The pole is along the radius, toward the axis or away from it.
    const double x = ball.x + r * std::cos(up) * std::cos(around);
    const double out = ball.from_axis + r * std::sin(up), aside = r * std::cos(up) * std::sin(around);
    const double from_axis = std::hypot(out, aside);
    if (from_axis > bench_.radius(x)) return std::numeric_limits<double>::infinity();
    return depthInWay(x, from_axis, ball.angle + a + std::atan2(aside, out));
  }

  /// How deep a point of the cutter comes to lie in the wheel along the stroke.
  double depthInWay(double x, double from_axis, double angle) const {
    const GrindProcess& p = job_->process();
    const double step = (job_->cutter.flute_length + p.overtravel_shank + p.overtravel_end) / kPlaces;
    const auto depth = [&](double i) { return bench_.depthOf(x, from_axis, angle, i * step - p.overtravel_end); };
    std::array<double, kPlaces + 1> values;
    for (int i = 0; i <= kPlaces; ++i) values[i] = depth(i);
    double best = -std::numeric_limits<double>::infinity();
    // The deepest place may be beside any peak.
    for (int i = 0; i <= kPlaces; ++i) {
      const int before = std::max(0, i - 1), after = std::min(kPlaces, i + 1);
      if (values[i] < std::max(values[before], values[after])) continue;
      double from = before, to = after;
      const double golden = 0.6180339887498949;
      for (int k = 0; k < 28; ++k) {
        const double left = to - golden * (to - from), right = from + golden * (to - from);
        const double one = depth(left), other = depth(right);
        best = std::max({best, one, other});
        one > other ? to = right : from = left;
      }
    }
    return best;
  }

  static constexpr int kPlaces = 100;
  const ValidJob job_;
  const brute::Bench bench_;
};

/// Expects that the ball is free a little before A, and in the cutter a little beyond.
void expectTouch(const ValidJob& job, const Ball& ball, double a, int rows = 16) {
  const Groove groove(job);
  const double side = job->cutter.cut == CutDirection::kRightHand ? 1 : -1;
  EXPECT_GT(groove.room(ball, a - side * kNearly, rows), 0);
  EXPECT_LT(groove.room(ball, a + side * kNearly, rows), 0);
}

/// A right-hand or left-hand cutter, cylindrical or conical, with a wheel swivelled somewhat beyond its spiral angle.
class RandomJobs {
 public:
  GrindJob job() {
    GrindJob job = paper();
    const double side = flag() ? 1 : -1;
    job.cutter.cut = side > 0 ? CutDirection::kRightHand : CutDirection::kLeftHand;
    job.cutter.end_diameter = between(3, 20) * kMillimetre;
    job.cutter.cone_angle = flag() ? 0 : between(-1, 8) * kDegree;
    job.cutter.spiral_angle = between(-10, 45) * side * kDegree;
    job.cutter.rake_angle = between(0, 15) * kDegree;
    GrindProcess& p = job.process();
    p.depth = between(0.1, 0.25) * job.cutter.end_diameter;
    if (flag()) p.depth_end = between(0.9, 1.1) * p.depth;
    if (flag()) p.setup_x_shift = between(-1, 0) * kMillimetre;
    p.overtravel_end = p.overtravel_shank = 10 * kMillimetre;
    p.wheel_profile = flag() ? WheelShape::kStraight : WheelShape::kFullRadius;
    p.wheel_diameter = between(60, 125) * kMillimetre;
    p.wheel_width = between(0.1, 0.5) * job.cutter.end_diameter;
    p.wheel_wear = flag() ? 0 : 0.05 * kMillimetre;
    p.setup_swivel = job.cutter.spiral_angle + side * between(0, 9) * kDegree;
    const double face = job.cutter.end_diameter / 2 * std::sin(between(0, 25) * kDegree);
    p.setup_height = side * (face - p.wheel_width / 2 / std::cos(p.setup_swivel));
    return job;
  }

  Ball ball(const GrindJob& job) {
    const double diameter = between(0.1, 0.6) * job.process().depth, length = job.cutter.flute_length;
    const double x = between(diameter / 2, length - diameter / 2);
    const double outer = job.cutter.end_diameter / 2 + x * std::tan(job.cutter.cone_angle);
    return {x, outer - between(0.05, 0.5) * job.process().depth, between(-1, 1) * kPi, diameter};
  }

 private:
  double between(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  bool flag() { return random_() % 2 == 0; }

  std::mt19937 random_{5};
};

TEST(RakeTouch, APlaneRakeFaceIsTouchedAtTheBallsRadiusFromIt) {
  for (const auto& [angle, diameter, from_axis] : {std::tuple{0.0, 0.2, 4.2}, {0.0, 1.5, 4.5}, {-2.5, 1.5, 4.2}}) {
    const Ball ball{10 * kMillimetre, from_axis * kMillimetre, angle, diameter * kMillimetre};
    // The upper face stands by 2 mm above the wheel's middle, the lower one by 2 mm below.
    const double high = std::asin((0.7 - diameter / 2) / from_axis) - angle;
    EXPECT_NEAR(touch(ValidJob(straight(CutDirection::kRightHand)), ball), high, 1e-9);
    EXPECT_NEAR(touch(ValidJob(straight(CutDirection::kLeftHand)), ball), -high - 2 * angle, 1e-9);
  }
}

TEST(RakeTouch, TheBallIsFreeBeforeItTouchesAndInTheCutterBeyond) {
  RandomJobs random;
  int touched = 0, of_hand[2] = {0, 0};
  const int cases = test_support::randomCases(16);
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(i);
    const ValidJob job(random.job());
    const Ball ball = random.ball(*job);
    try {
      expectTouch(job, ball, touch(job, ball));
      ++touched, ++of_hand[job->cutter.cut == CutDirection::kRightHand];
    } catch (const ReasonError&) {
      continue;  // the ball lies badly
    }
  }
  EXPECT_GT(touched, cases / 2);
  EXPECT_GT(std::min(of_hand[0], of_hand[1]), cases / 6);
}

TEST(RakeTouch, FollowsTheLawOfZ) {
  GrindJob asked = jobOf("taper_d6_t6");
  asked.process().wheel_wear_per_pass = 0;
  asked.process().z_law = ZLaw::kConstantRake;
  const ValidJob job = withLaws(ValidJob(asked));
  const Ball ball{6 * kMillimetre, brute::benchOf(*job, 0, 0).radius(6 * kMillimetre) - 0.5 * kMillimetre, 0,
                  0.6 * kMillimetre};
  expectTouch(job, ball, touch(job, ball));
}

TEST(RakeTouch, NearTheCornerOfTheFloorTheBallIsRefusedUntilItTouchesTheRakeFaceFirst) {
  GrindJob asked = paper();
  asked.process().wheel_wear_per_pass = 0;
  const ValidJob job(asked);
  int touched = 0, refused = 0;
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const Ball ball{job->cutter.flute_length / 2, (6.0155 + 0.0025 * i) * kMillimetre, 0, 0.8 * kMillimetre};
    if (refusal(job, ball)) {
      ++refused;
      EXPECT_EQ(touched, 0);
    } else {
      ++touched;
      expectTouch(job, ball, touch(job, ball), 24);
    }
  }
  EXPECT_GT(touched, 1);
  EXPECT_GT(refused, 1);
}

/// One tooth of the shipped job: the others make no difference.
ValidJob leftHand() {
  GrindJob job = jobOf("left_hand_d8_t3");
  job.tooth_angles = {0};
  return ValidJob(job);
}

TEST(RakeTouch, ABallThatTouchesAnythingElseIsRefusedWithTheDistancesAtWhichItWouldNot) {
  const ValidJob job = leftHand();
  struct Wrong {
    double from_axis_mm;
    const char* what;
    bool at_limit;
  };
  for (const Wrong& wrong : {Wrong{3.2, "else it touches the flute's floor first", false},
                             Wrong{4.1, "else it touches the cutting edge", true},
                             Wrong{4.6, "else it touches nothing of the flute", false}}) {
    SCOPED_TRACE(wrong.from_axis_mm);
    Ball ball{10 * kMillimetre, wrong.from_axis_mm * kMillimetre, 0, 0.5 * kMillimetre};
    const auto reason = refusal(job, ball);
    ASSERT_TRUE(reason);
    EXPECT_EQ(reason->kind, ReasonKind::kOutOfRange);
    EXPECT_EQ(reason->field, "ball's distance from the axis");
    EXPECT_EQ(reason->detail, wrong.what);
    EXPECT_NEAR(reason->value, ball.from_axis, 1e-6);
    ball.from_axis = wrong.at_limit ? reason->limit : reason->low;
    EXPECT_FALSE(refusal(job, ball));
  }
}

TEST(RakeTouch, InASlotTheOtherWallIsTouchedFirstByABallThatIsWiderThanTheSlot) {
  GrindJob job = straight(CutDirection::kRightHand);
  job.process().depth = 3 * kMillimetre;
  job.process().wheel_width = kMillimetre;
  job.process().setup_height = 0;
  Ball ball{10 * kMillimetre, 3.5 * kMillimetre, 0, 0.99 * kMillimetre};
  EXPECT_NEAR(touch(ValidJob(job), ball), std::asin(0.005 / 3.5), 1e-9);
  ball.diameter = 1.01 * kMillimetre;
  const auto reason = refusal(ValidJob(job), ball);
  ASSERT_TRUE(reason);
  EXPECT_EQ(reason->field, "ball diameter");
  EXPECT_EQ(reason->detail, "else it touches the flute's other wall first");
}

TEST(RakeTouch, WhatIsNoBallOrNoPlaceIsRefusedByName) {
  const ValidJob job(straight(CutDirection::kRightHand));
  const double length = job->cutter.flute_length, nan = std::numeric_limits<double>::quiet_NaN();
  const Ball good{length / 2, 4.5 * kMillimetre, 0, kMillimetre};
  const auto refused = [&](double Ball::*figure, std::initializer_list<double> values, const char* field) {
    Reason last;
    for (const double value : values) {
      Ball ball = good;
      ball.*figure = value;
      last = refusal(job, ball).value_or(Reason{});
      EXPECT_EQ(last.field, field) << value;
    }
    return last;
  };
  // The whole ball must be within the flute's length.
  const Reason x = refused(&Ball::x, {-1e-3, 0.49e-3, length - 0.49e-3, length + 1e-3, nan}, "ball's X");
  EXPECT_DOUBLE_EQ(x.low, 0.5e-3);
  EXPECT_DOUBLE_EQ(x.limit, length - 0.5e-3);
  for (const double end : {x.low, x.limit}) EXPECT_FALSE(refusal(job, {end, good.from_axis, 0, good.diameter})) << end;
  refused(&Ball::diameter, {0, -1e-3, 1, nan}, "ball diameter");
  const double infinite = std::numeric_limits<double>::infinity();
  const Reason from_axis = refused(&Ball::from_axis, {nan, infinite, 0}, "ball's distance from the axis");
  EXPECT_EQ(from_axis.detail, "else it touches the flute's floor first");

  GrindJob above = straight(CutDirection::kRightHand);
  above.process().setup_height = 20 * kMillimetre;  // the wheel passes above the cutter
  EXPECT_EQ(text(refusal(ValidJob(above), {10e-3, 4.5e-3, 0, 1e-3}).value_or(Reason{})),
            "ball's X = 10 mm; allowed: where the first tooth has a rake face");
}

}  // namespace test_rake_touch
}  // namespace grinder
