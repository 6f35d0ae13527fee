#include "flute_grinder/core/setpoint_stream.h"

#include "flute_grinder/core/limit_check.h"

#include "generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace flute_grinder {
namespace {

using testing::paperJob;
using testing::plainMachine;
using testing::Real;
using testing::ReferenceCurve;
using testing::ReferencePair;
using testing::uniform;
using testing::Work;

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kCycles = 1500;  ///< of a stroke: long enough for all phases, short enough for a hundred jobs

std::vector<Setpoint> all(SetpointStream& stream) {
  std::vector<Setpoint> setpoints;
  Setpoint p;
  while (stream.next(p)) setpoints.push_back(p);
  return setpoints;
}

std::vector<Setpoint> all(const Work& work) {
  SetpointStream stream(work.program());
  return all(stream);
}

/// A step of a stroke seen from the even point before its pair.
struct SeenPair {
  Setpoint start, odd, even;
};

/// All pairs of all strokes.
std::vector<SeenPair> pairsOf(const std::vector<Setpoint>& setpoints) {
  std::vector<SeenPair> pairs;
  for (std::size_t i = 2; i < setpoints.size(); i += 2) {
    if (setpoints[i].move == MoveKind::kStroke) pairs.push_back({setpoints[i - 2], setpoints[i - 1], setpoints[i]});
  }
  return pairs;
}

/// What rounding makes of an axis: some sums of numbers as large as those seen.
Axes roundingOf(const std::vector<Setpoint>& setpoints) {
  Axes largest = Axes::Zero();
  for (const Setpoint& p : setpoints) largest = largest.max(p.position.abs());
  return 2 * kEps * largest;
}

/// How far the setpoints go beyond a limit, as text; empty where they do not. Position and speed at every one,
/// acceleration and jerk by differences of the pair ends, with rest before the first and after the last.
std::string beyondLimits(std::vector<Setpoint> setpoints, const Machine& machine) {
  const Axes noise = roundingOf(setpoints);
  const AxisLimits& l = machine.limits;
  const double t = machine.period;
  for (int i = 0; i < 8; ++i) {
    setpoints.push_back(setpoints.back());
    ++setpoints.back().cycle;
  }
  setpoints.insert(setpoints.begin(), 6, setpoints.front());
  const auto text = [&](const char* what, std::size_t i, const Axes& value, const Axes& limit) {
    std::string axes;
    for (int axis = 0; axis < kAxisCount; ++axis) {
      axes += " " + ::testing::PrintToString(value[axis]) + "/" + ::testing::PrintToString(limit[axis]);
    }
    return std::string(what) + axes + " at cycle " + std::to_string(setpoints[i].cycle) + " " +
           toString(setpoints[i].move);
  };
  const auto within = [&](const Axes& value, const Axes& limit, double noise_factor) {
    return (value.abs() <= limit * (1 + 1e-9) + noise * noise_factor).all();
  };
  for (std::size_t i = 6; i < setpoints.size(); ++i) {
    const auto p = [&](std::size_t back) { return setpoints[i - back].position; };
    if (!((p(0) >= l.min_position).all() && (p(0) <= l.max_position).all()))
      return text("position", i, p(0), l.max_position);
    const Axes velocity = (p(0) - p(1)) / t;
    if (!within(velocity, l.max_velocity, 2 / t)) return text("velocity", i, velocity, l.max_velocity);
    if (i % 2 != 0) continue;
    const double pair = 2 * t;
    const Axes acceleration = (p(0) - 2 * p(2) + p(4)) / (pair * pair);
    if (!within(acceleration, l.max_acceleration, 4 / (pair * pair)))
      return text("acceleration", i, acceleration, l.max_acceleration);
    const Axes jerk = (p(0) - 3 * p(2) + 3 * p(4) - p(6)) / (pair * pair * pair);
    if (!within(jerk, l.max_jerk, 8 / (pair * pair * pair))) return text("jerk", i, jerk, l.max_jerk);
  }
  return "";
}

/// Y over that of the surface at X = 0 at which the wheel is clear of the whole stroke. [m]
double clearHeight(const GrindJob& job) {
  const double growth = std::tan(job.cutter.cone_angle);
  const double ends[]{-job.process.overtravel_end, job.cutter.flute_length + job.process.overtravel_shank};
  return std::max(ends[0] * growth, ends[1] * growth) + job.process.clearance;
}

/// How far the strokes' points are off what the paper's construction gives, as text; empty where they are not.
std::string offTheConstruction(const std::vector<Setpoint>& setpoints, const GrindJob& job, std::size_t every) {
  const ReferenceCurve curve(job.cutter);
  const Real scale = job.interpolation.rotary_scale;
  const Axes noise = 4 * roundingOf(setpoints);
  const Real x_noise = noise[kX];
  const Real a_noise = noise[kA] + x_noise * std::abs(curve.k) / 0.2L;
  const auto pairs = pairsOf(setpoints);
  for (std::size_t i = 0; i < pairs.size(); i += every) {
    const SeenPair& s = pairs[i];
    const Real x = s.start.position[kX];
    const Real slope = scale * curve.slope(x);
    const Real l = (s.odd.position[kX] - x) * std::sqrt(1 + slope * slope);
    if (l == 0) continue;
    const ReferencePair expected = testing::referencePair(job.interpolation.even_step, curve, scale, x, l);
    const Real x2 = s.even.position[kX] - x;
    const Real a1 = Real(s.odd.position[kA]) - s.start.position[kA];
    const Real a2 = Real(s.even.position[kA]) - s.start.position[kA];
    const bool good = std::abs(x2 - expected.x2) <= 4 * x_noise + 1e-12L * std::abs(x2) &&
                      std::abs(a1 - expected.a1) <= 1e-11L + a_noise && std::abs(a2 - expected.a2) <= 1e-11L + a_noise;
    if (!good) {
      return "cycle " + std::to_string(s.odd.cycle) + ": x2 off by " +
             std::to_string(static_cast<double>((x2 - expected.x2) * 1e15L)) + "e-15, a by " +
             std::to_string(static_cast<double>((a1 - expected.a1) * 1e12L)) + "e-12, " +
             std::to_string(static_cast<double>((a2 - expected.a2) * 1e12L)) + "e-12";
    }
  }
  return "";
}

/// Whether every odd point leaves the curve from where its pair starts by the tangent's error k b dX^2 / (2 u^2), up to
/// the next orders, of which 2/3 b dX/u is the largest.
std::string offTheTangent(const std::vector<Setpoint>& setpoints, const GrindJob& job) {
  const ReferenceCurve curve(job.cutter);
  const Axes noise = 4 * roundingOf(setpoints);
  for (const SeenPair& s : pairsOf(setpoints)) {
    const Real x = s.start.position[kX];
    const Real dx = s.odd.position[kX] - x;
    const Real growth = curve.b * dx / curve.u(x);
    const Real leading = curve.k * curve.b * dx * dx / (2 * curve.u(x) * curve.u(x));
    const Real before = s.start.step == StepKind::kEven ? s.start.path_error : 0;
    const Real rounding = noise[kA] + noise[kX] * std::abs(curve.slope(x)) + 1e-15L;
    if (!(std::abs(s.odd.path_error - before + leading) <= std::abs(leading * growth) + rounding)) {
      return "cycle " + std::to_string(s.odd.cycle) + " odd error " + ::testing::PrintToString(s.odd.path_error);
    }
  }
  return "";
}

TEST(SetpointStream, StartsAtRestWhereTheAxesStand) {
  Axes start;
  start << 0.01, 0.04, -0.002, 0.3;
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), start));
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_EQ(p.cycle, 0u);
  EXPECT_TRUE((p.position == start).all());
  EXPECT_TRUE((p.velocity == 0).all());
  EXPECT_EQ(p.feed, 0);
  EXPECT_EQ(p.path_error, 0);
  EXPECT_EQ(p.step, StepKind::kNone);
  EXPECT_FALSE(p.at_feed);
}

TEST(SetpointStream, LeavesTheSetpointAsItWasAtTheEnd) {
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
  Setpoint p;
  while (stream.next(p)) {
  }
  const Setpoint last = p;
  EXPECT_FALSE(stream.next(p));
  EXPECT_EQ(p.cycle, last.cycle);
  EXPECT_TRUE((p.position == last.position).all());
}

TEST(SetpointStream, HeldBeforeItBeginsDoesNotMove) {
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
  stream.hold();
  const auto setpoints = all(stream);
  ASSERT_EQ(setpoints.size(), 1u);
  EXPECT_TRUE((setpoints[0].position == plainMachine().park).all());
}

TEST(SetpointStream, KeepsThePapersCutterWithinAMicroradianAt60MillimetresPerMinute) {
  GrindJob job = paperJob();
  job.process.feed = 60 * units::kMillimetrePerMinute;
  for (const EvenStepRule rule : {EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    SCOPED_TRACE(toString(rule));
    job.interpolation.even_step = rule;
    SetpointStream stream(GrindProgram(job, plainMachine(), plainMachine().park));
    const ReferenceCurve curve(job.cutter);
    double whole_stroke = 0;
    double flute = 0;
    for (const Setpoint& p : all(stream)) {
      if (p.step != StepKind::kOdd) continue;
      const double x = p.position[kX];
      const double error = static_cast<double>(std::abs(curve.a(x) - Real(p.position[kA])));
      whole_stroke = std::max(whole_stroke, error);
      if (x >= 0 && x <= 30e-3) flute = std::max(flute, error);
    }
    // k b dX^2 / (2 u^2) with dX = 1 mm/s * 1 ms / 1.158: 7.53e-10 rad at X = 0, 7.80e-10 at the overtravel's end.
    EXPECT_LT(whole_stroke, 7.9e-10);
    EXPECT_GT(whole_stroke, 7.7e-10);
    EXPECT_LT(flute, 7.6e-10);
    EXPECT_GT(flute, 7.5e-10);
  }
}

TEST(SetpointStream, YAndZFollowXInTheStroke) {
  GrindJob job = paperJob();
  job.process.wheel_wear = 0.2e-3;
  SetpointStream stream(GrindProgram(job, plainMachine(), plainMachine().park));
  const double growth = std::tan(5 * units::kDegree);
  for (const Setpoint& p : all(stream)) {
    if (p.move != MoveKind::kStroke) continue;
    const double x = p.position[kX];
    ASSERT_NEAR(p.position[kY], x * growth - 0.5e-3 - 0.2e-3, 1e-15);
    ASSERT_NEAR(p.position[kZ], x * growth * std::sin(8 * units::kDegree), 1e-15);
  }
}

TEST(SetpointStream, EveryToothStandsAtItsAngle) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1.5, 3.3};
  SetpointStream stream(GrindProgram(job, plainMachine(), plainMachine().park));
  const ReferenceCurve curve(job.cutter);
  std::map<int, int> seen;
  for (const Setpoint& p : all(stream)) {
    if (p.step != StepKind::kEven) continue;
    ++seen[p.tooth];
    ASSERT_NEAR(p.position[kA] - job.tooth_angles[p.tooth], static_cast<double>(curve.a(p.position[kX])), 1e-6);
  }
  EXPECT_EQ(seen.size(), 3u);
}

RC_GTEST_PROP(SetpointStreamProperty, CyclesCountFromZeroWithoutGap, ()) {
  std::uint64_t expected = 0;
  for (const Setpoint& p : all(*testing::work(kCycles))) RC_ASSERT(p.cycle == expected++);
  RC_ASSERT(expected % 2 == 1u);  // the start and then pairs
}

RC_GTEST_PROP(SetpointStreamProperty, EveryMoveTakesAnEvenNumberOfCycles, ()) {
  const auto setpoints = all(*testing::work(kCycles));
  for (std::size_t i = 1; i + 1 < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    const Setpoint& q = setpoints[i + 1];
    if (p.move_index != q.move_index) RC_ASSERT(p.cycle % 2 == 0u);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, StrokesGoOddAndEvenByTurnsAndOtherMovesDoNot, ()) {
  for (const Setpoint& p : all(*testing::work(kCycles))) {
    if (p.cycle == 0 || p.move != MoveKind::kStroke) {
      RC_ASSERT(p.step == StepKind::kNone);
      RC_ASSERT(p.path_error == 0);
      RC_ASSERT(!p.at_feed);
    } else {
      RC_ASSERT(p.step == (p.cycle % 2 == 1 ? StepKind::kOdd : StepKind::kEven));
    }
  }
}

RC_GTEST_PROP(SetpointStreamProperty, MovesEndWhereTheProgramSays, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const GrindProgram program = work.program();
  const auto setpoints = all(work);
  const ReferenceCurve curve(work.job.cutter);
  const bool exact = work.job.interpolation.even_step == EvenStepRule::kExact;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    const Move& move = program.moves().at(p.move_index);
    RC_ASSERT(p.move == move.kind);
    RC_ASSERT(p.tooth == move.tooth);
    RC_ASSERT(p.pass == move.pass);
    const bool ends = i + 1 == setpoints.size() || setpoints[i + 1].move_index != p.move_index;
    RC_ASSERT(p.move_fraction >= 0);
    RC_ASSERT(p.move_fraction <= 1);
    if (!ends) continue;
    RC_ASSERT(p.move_fraction == 1);
    if (p.move == MoveKind::kStroke) {
      RC_ASSERT(std::abs(p.position[kX] - move.to[kX]) <= 1e-12);
      RC_ASSERT(std::abs(p.position[kY] - move.to[kY]) <= 1e-12);
      RC_ASSERT(std::abs(p.position[kZ] - move.to[kZ]) <= 1e-12);
      if (exact) {
        RC_ASSERT(std::abs(p.position[kA] - move.to[kA]) <= 1e-12 * (1 + static_cast<double>(std::abs(curve.k))));
      }
    } else {
      RC_ASSERT((p.position == move.to).all());
    }
  }
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
}

RC_GTEST_PROP(SetpointStreamProperty, IndexesAAloneAndThenRunsInAboveTheWork, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const auto setpoints = all(work);
  const double clear = clearHeight(work.job) - 1e-15;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    const Axes way = p.position - setpoints[i - 1].position;
    if (p.move == MoveKind::kIndex) {
      RC_ASSERT(way[kX] == 0 && way[kY] == 0 && way[kZ] == 0);
      RC_ASSERT(p.position[kY] >= clear);
    }
    if (p.move == MoveKind::kPosition) {
      RC_ASSERT(way[kY] == 0 && way[kA] == 0);
      RC_ASSERT(p.position[kY] >= clear);
    }
  }
}

RC_GTEST_PROP(SetpointStreamProperty, WearNeverMovesYWithinAPass, ()) {
  Work work = *testing::toothedWork(kCycles / 3);
  work.job.process.wheel_wear = *uniform(0, 1e-3);
  work.job.process.wheel_wear_per_pass = *uniform(1e-6, 1e-4);
  const auto setpoints = all(work);
  const double growth = std::tan(work.job.cutter.cone_angle);
  const double rounding = 4 * roundingOf(setpoints)[kY];
  double deeper = work.job.process.depth + work.job.process.wheel_wear;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    if (p.step != StepKind::kNone) RC_ASSERT(std::abs(p.position[kY] - p.position[kX] * growth + deeper) <= rounding);
    const bool pass_ends = p.move == MoveKind::kRetract && setpoints[i - 1].move == MoveKind::kStroke;
    if (pass_ends) deeper += work.job.process.wheel_wear_per_pass;
  }
}

RC_GTEST_PROP(SetpointStreamProperty, KeepsAllLimitsOfAllAxes, ()) {
  const Work work = *testing::work(kCycles);
  RC_ASSERT(beyondLimits(all(work), work.machine) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, TellsTheMeanVelocityOfTheCycle, ()) {
  const Work work = *testing::work(kCycles);
  const auto setpoints = all(work);
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Axes moved = setpoints[i].position - setpoints[i - 1].position;
    RC_ASSERT(((setpoints[i].velocity * work.machine.period - moved).abs() <= 4 * kEps * moved.abs()).all());
  }
}

RC_GTEST_PROP(SetpointStreamProperty, TellsTheoryMinusCommandedAsPathError, ()) {
  const Work work = *testing::work(kCycles);
  const ReferenceCurve curve(work.job.cutter);
  const auto setpoints = all(work);
  const Axes noise = roundingOf(setpoints);
  for (const Setpoint& p : setpoints) {
    if (p.step == StepKind::kNone) continue;
    const Real error = curve.a(p.position[kX]) - Real(p.position[kA]);
    RC_ASSERT(std::abs(p.path_error - error) <= Real(4 * noise[kA] + 1e-15));
  }
}

RC_GTEST_PROP(SetpointStreamProperty, StrokesFollowThePapersConstruction, ()) {
  const Work work = *testing::work(kCycles);
  RC_ASSERT(offTheConstruction(all(work), work.job, 37) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, OddPointsLeaveTheCurveByTheTangentsErrorOnly, ()) {
  const Work work = *testing::work(kCycles);
  RC_ASSERT(offTheTangent(all(work), work.job) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, ExactEvenPointsAreOnTheCurve, ()) {
  Work work = *testing::work(kCycles);
  work.job.interpolation.even_step = EvenStepRule::kExact;
  const auto setpoints = all(work);
  const double rounding = 4 * roundingOf(setpoints)[kA] + 1e-15;
  for (const Setpoint& p : setpoints) {
    if (p.step == StepKind::kEven) RC_ASSERT(std::abs(p.path_error) <= rounding);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, ExactNeverLeavesTheTolerance, ()) {
  Work work = *testing::work(kCycles);
  work.job.interpolation.even_step = EvenStepRule::kExact;
  const CutterGeometry& g = work.job.cutter;
  const Real normal = std::cos(std::atan(std::tan(Real(g.spiral_angle)) * std::cos(Real(g.cone_angle))));
  for (const Setpoint& p : all(work)) {
    if (p.step == StepKind::kNone) continue;
    const Real radius = Real(g.end_diameter) / 2 + p.position[kX] * std::tan(Real(g.cone_angle));
    RC_ASSERT(std::abs(p.path_error) * radius * normal <= work.job.interpolation.tolerance * Real(1 + 1e-9));
  }
}

RC_GTEST_PROP(SetpointStreamProperty, AtFeedEveryPairGoesAtTheFeed, ()) {
  const Work work = *testing::work(kCycles);
  const GrindProgram program = work.program();
  const double edge = testing::edgePerTravel(work.job.cutter);
  const double speed = program.schedule().feedSpeed();
  if (program.schedule().feedLimits().empty()) {
    RC_ASSERT(std::abs(speed * edge - work.job.process.feed) <= 1e-12 * work.job.process.feed);
  }
  const auto setpoints = all(work);
  const double rounding = roundingOf(setpoints)[kX];
  for (const SeenPair& s : pairsOf(setpoints)) {
    RC_ASSERT(s.odd.at_feed == s.even.at_feed);
    if (!s.odd.at_feed) continue;
    const double pair = 2 * speed * work.machine.period;
    RC_ASSERT(std::abs(std::abs(s.even.position[kX] - s.start.position[kX]) - pair) <= 1e-6 * pair + 2 * rounding);
    RC_ASSERT(std::abs(s.even.feed - speed * edge) <= 1e-9 * speed * edge);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, AtFeedTheTwoStepsDifferByTheTurnOfThePathOnly, ()) {
  const Work work = *testing::work(kCycles);
  const double step = work.program().schedule().feedSpeed() * work.machine.period;
  const auto setpoints = all(work);
  const double rounding = 2 * roundingOf(setpoints)[kX];
  const ReferenceCurve curve(work.job.cutter);
  for (const SeenPair& s : pairsOf(setpoints)) {
    if (!s.odd.at_feed) continue;
    // 2 |kappa| dl tan theta = 2 sin^2 theta |b| dX / u
    const Real u = curve.u(s.start.position[kX]);
    const Real slope = work.job.interpolation.rotary_scale * curve.k / u;
    const Real growth = std::abs(curve.b) * step / u;
    const Real bound = 2 * slope * slope / (1 + slope * slope) * growth * (1 + 4 * growth) + 1e-6L;
    RC_ASSERT(std::abs(std::abs(s.odd.position[kX] - s.start.position[kX]) / step - 1) <= bound + rounding / step);
    RC_ASSERT(std::abs(std::abs(s.even.position[kX] - s.odd.position[kX]) / step - 1) <= bound + rounding / step);
  }
}

TEST(SetpointStream, GoesAtFeedForMostOfThePapersStroke) {
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
  std::size_t strokes = 0;
  std::size_t at_feed = 0;
  for (const Setpoint& p : all(stream)) {
    if (p.move == MoveKind::kStroke) ++strokes;
    if (p.at_feed) ++at_feed;
  }
  EXPECT_GT(at_feed, strokes * 9 / 10);
  EXPECT_LT(at_feed, strokes);
}

RC_GTEST_PROP(SetpointStreamProperty, HeldItStopsOnThePathUnderTheLimits, ()) {
  const Work work = *testing::work(kCycles);
  const auto undisturbed = all(work);
  SetpointStream stream(work.program());
  std::vector<Setpoint> setpoints;
  Setpoint p;
  const auto hold_at = static_cast<std::size_t>(static_cast<double>(undisturbed.size()) * *uniform(0, 1));
  for (std::size_t i = 0; i < hold_at && stream.next(p); ++i) setpoints.push_back(p);
  stream.hold();
  while (stream.next(p)) {
    setpoints.push_back(p);
    RC_ASSERT(setpoints.size() <= undisturbed.size() + 2);  // a stop is never longer than the way to the end
  }
  if (setpoints.empty()) return;
  RC_ASSERT(!stream.next(p));
  RC_ASSERT(setpoints.back().cycle % 2 == 0u);
  for (std::size_t i = 0; i < setpoints.size(); ++i) RC_ASSERT(setpoints[i].cycle == i);
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");
  RC_ASSERT(offTheConstruction(setpoints, work.job, 1 + setpoints.size() / 200) == "");
  RC_ASSERT(offTheTangent(setpoints, work.job) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, HeldInTheStrokeItStaysInTheStroke, ()) {
  const Work work = *testing::work(kCycles);
  const GrindProgram program = work.program();
  const auto undisturbed = all(work);
  std::size_t first = 0;
  while (undisturbed[first].step == StepKind::kNone) ++first;
  std::size_t last = first;
  while (undisturbed[last].step != StepKind::kNone) ++last;
  const auto hold_at = first + static_cast<std::size_t>(static_cast<double>(last - first) * *uniform(0, 1));
  SetpointStream stream(program);
  Setpoint p;
  for (std::size_t i = 0; i < hold_at; ++i) {
    stream.next(p);
    RC_ASSERT((p.position == undisturbed[i].position).all());
  }
  stream.hold();
  const double direction = program.strokeTo() > program.strokeFrom() ? 1 : -1;
  double x = hold_at > first ? p.position[kX] : program.strokeFrom();
  // The acceleration is taken back, and then it is braked, as from full speed at the most.
  const MotionLimits l = program.schedule().limits();
  const double back = l.acceleration / l.jerk;
  const double full = l.velocity * l.jerk > l.acceleration * l.acceleration ? l.velocity / l.acceleration + back
                                                                            : 2 * std::sqrt(l.velocity / l.jerk);
  const double cycles = (std::min(back, std::sqrt(2 * l.velocity / l.jerk)) + full) / work.machine.period + 4;
  int count = 0;
  while (stream.next(p)) {
    RC_ASSERT(++count <= cycles);
    if (hold_at == first) continue;  // in front of the stroke it rests already
    RC_ASSERT(p.move == MoveKind::kStroke);
    RC_ASSERT(direction * (p.position[kX] - x) >= -1e-15);
    RC_ASSERT(direction * (program.strokeTo() - p.position[kX]) >= -1e-15);
    x = p.position[kX];
  }
}

RC_GTEST_PROP(SetpointStreamProperty, TwoStreamsGiveTheSameBits, ()) {
  const Work work = *testing::work(kCycles);
  const auto one = all(work);
  const auto other = all(work);
  RC_ASSERT(one.size() == other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    RC_ASSERT(std::memcmp(one[i].position.data(), other[i].position.data(), sizeof(double) * kAxisCount) == 0);
    RC_ASSERT(std::memcmp(one[i].velocity.data(), other[i].velocity.data(), sizeof(double) * kAxisCount) == 0);
    RC_ASSERT(std::memcmp(&one[i].path_error, &other[i].path_error, sizeof(double)) == 0);
    RC_ASSERT(std::memcmp(&one[i].feed, &other[i].feed, sizeof(double)) == 0);
  }
}

/// How far a point of a stroke is off the theoretical curve, at the cutter's surface and normal to the helix. [m]
class Deviation {
 public:
  explicit Deviation(const GrindJob& job)
      : curve_(job.cutter),
        teeth_(job.tooth_angles),
        end_radius_(Real(job.cutter.end_diameter) / 2),
        growth_(std::tan(Real(job.cutter.cone_angle))),
        normal_(std::cos(std::atan(std::tan(Real(job.cutter.spiral_angle)) * std::cos(Real(job.cutter.cone_angle))))) {}

  double of(const Setpoint& p) const {
    const Real x = p.position[kX];
    const Real error = curve_.a(x) - (Real(p.position[kA]) - teeth_[p.tooth]);
    return static_cast<double>(std::abs(error) * (end_radius_ + x * growth_) * normal_);
  }

 private:
  ReferenceCurve curve_;
  std::vector<double> teeth_;
  Real end_radius_, growth_, normal_;
};

/// What somebody got from a stream of whom things were asked on the way.
struct Ride {
  struct Given {
    Setpoint p;
    bool on_path;
  };
  std::vector<Given> given;
  std::vector<Setpoint> seen_by_machine;  ///< with those of the rests, which hold the last position
  int requests_in_strokes = 0;

  std::vector<Setpoint> setpoints() const {
    std::vector<Setpoint> all;
    for (const Given& g : given) all.push_back(g.p);
    return all;
  }
};

/// Takes setpoints from a stream, and keeps them.
class Rider {
 public:
  Rider(const Work& work, std::uint64_t seed) : work_(work), stream_(work.program()), random_(seed) {}

  SetpointStream& stream() { return stream_; }
  Ride& ride() { return ride_; }
  const Setpoint& last() const { return last_; }
  double fraction() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  bool flip(double chance) { return fraction() < chance; }

  /// @return false at a rest, of which the machine then sees some cycles.
  bool next() {
    const Setpoint before = last_;
    if (stream_.next(last_)) {
      ride_.given.push_back({last_, stream_.onPath()});
      ride_.seen_by_machine.push_back(last_);
      return true;
    }
    RC_ASSERT(last_.cycle == before.cycle);
    RC_ASSERT((last_.position == before.position).all());
    RC_ASSERT(last_.cycle % 2 == 0u);
    RC_ASSERT(last_.feed <= 1e-12);  // by its own account too
    const auto cycles = 2 * static_cast<std::size_t>(fraction() * 5);
    if (!ride_.given.empty()) ride_.seen_by_machine.insert(ride_.seen_by_machine.end(), cycles, last_);
    return false;
  }

  void runToRest() {
    for (std::size_t i = 0; next(); ++i) RC_ASSERT(i < 1000000u);
  }

  /// A few cycles, or up to a rest.
  void runSome(int most) {
    for (int i = static_cast<int>(fraction() * most); i > 0 && next();) --i;
  }

 private:
  Work work_;
  SetpointStream stream_;
  std::mt19937_64 random_;
  Ride ride_;
  Setpoint last_;
};

/// For every stroke, by its move, some X in the order of the stroke: those at random cycles of the undisturbed one.
std::map<std::uint32_t, std::vector<double>> momentsInStrokes(const std::vector<Setpoint>& undisturbed,
                                                              int per_stroke) {
  std::map<std::uint32_t, std::vector<double>> strokes;
  for (const Setpoint& p : undisturbed) {
    if (p.step != StepKind::kNone) strokes[p.move_index].push_back(p.position[kX]);
  }
  for (auto& [index, xs] : strokes) {
    std::vector<std::size_t> cycles;
    for (int i = 0; i < per_stroke; ++i) {
      cycles.push_back(static_cast<std::size_t>(static_cast<double>(xs.size() - 1) * *uniform(0, 1)));
    }
    std::sort(cycles.begin(), cycles.end());
    std::vector<double> chosen;
    for (const std::size_t cycle : cycles) chosen.push_back(xs[cycle]);
    xs = chosen;
  }
  return strokes;
}

/// Asks for one thing or another: hold, go on, another feed, no feed, things that are not taken.
void askForSomething(Rider& rider) {
  SetpointStream& stream = rider.stream();
  switch (static_cast<int>(rider.fraction() * 8)) {
    case 0:
    case 1: stream.hold(); break;
    case 2: stream.resume(); break;
    case 3: stream.setFeedOverride(std::max(0.05, kMaxFeedOverride * rider.fraction())); break;
    case 4: stream.setFeedOverride(kMaxFeedOverride); break;
    case 5: stream.setFeedOverride(0); break;
    case 6:
      stream.hold();
      stream.resume();
      break;
    default: stream.setFeedOverride(1);
  }
}

/// A ride with holds and feed overrides at the moments given, and at more that follow them by chance.
Ride rideWithHoldsAndOverrides(const Work& work, std::map<std::uint32_t, std::vector<double>> moments) {
  Rider rider(work, *rc::gen::arbitrary<std::uint64_t>());
  SetpointStream& stream = rider.stream();
  const double direction = stream.program().strokeTo() < stream.program().strokeFrom() ? -1 : 1;
  int spare_requests = 100;
  int rests = 0;
  while (!stream.finished()) {
    if (!rider.next()) {
      if (stream.finished()) break;
      RC_ASSERT(++rests < 5000);
      if (rider.flip(0.3)) stream.hold();  // though it rests
      if (rider.flip(0.5) || --spare_requests < 0) {
        stream.resume();
        stream.setFeedOverride(rider.flip(0.5) ? 1 : 0.1 + 1.1 * rider.fraction());
      }
      continue;
    }
    const Setpoint& p = rider.last();
    bool ask = spare_requests > 0 && rider.flip(0.01);
    if (ask && --spare_requests == 0) {
      stream.resume();
      stream.setFeedOverride(1);
      ask = false;
    }
    if (p.step != StepKind::kNone) {
      auto& xs = moments[p.move_index];
      while (!xs.empty() && direction * (p.position[kX] - xs.front()) >= 0) {
        xs.erase(xs.begin());
        ask = true;
        ++rider.ride().requests_in_strokes;
      }
    }
    if (ask) askForSomething(rider);
    RC_ASSERT(rider.ride().given.size() < 500000u);
  }
  return rider.ride();
}

/// Lifts the wheel from where it rests, and brings it back on its way; now and then with a rest in the midst of it, or
/// with another lift from the way back.
void liftAndComeBack(Rider& rider) {
  SetpointStream& stream = rider.stream();
  stream.retract();
  RC_ASSERT(!stream.onPath());
  RC_ASSERT(!stream.finished());
  const bool to_the_top = rider.flip(0.5);
  if (to_the_top) {
    rider.runToRest();
    RC_ASSERT(!rider.next());
  } else {
    rider.runSome(100);
    if (rider.flip(0.6)) {
      stream.hold();
      rider.runToRest();
      if (rider.flip(0.5)) stream.retract();
    }
  }
  stream.resume();
  if (rider.flip(0.3)) stream.setFeedOverride(0.1 + 1.1 * rider.fraction());
  if (!rider.flip(0.5)) return;
  rider.runSome(rider.flip(0.5) ? 2000 : 100);
  stream.hold();
  rider.runToRest();
  if (!stream.finished() && rider.flip(0.7)) {
    stream.retract();
    rider.runToRest();
  }
  stream.resume();
}

/// A ride with lifts at some random moments of the job, in whatever move.
Ride rideWithRetracts(const Work& work, const std::vector<Setpoint>& undisturbed, int count) {
  std::vector<std::size_t> cycles;
  for (int i = 0; i < count; ++i) {
    cycles.push_back(static_cast<std::size_t>(static_cast<double>(undisturbed.size() - 1) * *uniform(0, 1)));
  }
  std::sort(cycles.begin(), cycles.end());
  Rider rider(work, *rc::gen::arbitrary<std::uint64_t>());
  SetpointStream& stream = rider.stream();
  for (const std::size_t cycle : cycles) {
    const Setpoint& moment = undisturbed[cycle];
    const auto before = [&](const Setpoint& p) {
      return p.move_index < moment.move_index ||
             (p.move_index == moment.move_index && p.move_fraction < moment.move_fraction);
    };
    while (rider.ride().given.empty() || before(rider.last())) {
      if (!rider.next()) break;
    }
    if (rider.last().cycle % 2 == 1) {
      const bool on_path = stream.onPath();
      stream.retract();
      RC_ASSERT(stream.onPath() == on_path);
    }
    stream.hold();
    rider.runToRest();
    if (stream.finished()) break;
    liftAndComeBack(rider);
  }
  stream.resume();
  rider.runToRest();
  RC_ASSERT(stream.finished());
  return rider.ride();
}

/// What every move was for, in the order in which they came.
std::vector<std::string> movesOf(const std::vector<Setpoint>& setpoints) {
  std::vector<std::string> moves;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    const std::string move = std::to_string(p.move_index) + " " + toString(p.move) + " of tooth " +
                             std::to_string(p.tooth) + ", pass " + std::to_string(p.pass);
    if (moves.empty() || moves.back() != move) moves.push_back(move);
  }
  return moves;
}

/// The largest deviation of the strokes' points. [m]
double largestDeviation(const std::vector<Setpoint>& setpoints, const GrindJob& job) {
  const Deviation deviation(job);
  double largest = 0;
  for (const Setpoint& p : setpoints) {
    if (p.step != StepKind::kNone) largest = std::max(largest, deviation.of(p));
  }
  return largest;
}

/// What the rounding of A makes of a deviation. [m]
double noiseOfDeviation(const std::vector<Setpoint>& setpoints, const GrindJob& job) {
  const double shank = job.cutter.flute_length + job.process.overtravel_shank;
  const double x = std::max(shank, job.process.overtravel_end);
  const double radius = job.cutter.end_diameter / 2 + x * std::abs(std::tan(job.cutter.cone_angle));
  return (8 * roundingOf(setpoints)[kA] + 1e-15) * radius;
}

/// What a deviation may be: the tolerance, or what the plan of the undisturbed job reports and refuses. [m]
double allowedDeviation(const std::vector<Setpoint>& undisturbed, const GrindJob& job) {
  return std::max(job.interpolation.tolerance, largestDeviation(undisturbed, job)) * (1 + 1e-9) +
         noiseOfDeviation(undisturbed, job);
}

/// Whether every setpoint of a stroke is where the cutter's equations say, goes on from the one before by no more than
/// the feed override allows, and the strokes begin and end where they are to.
void checkStrokes(const std::vector<Setpoint>& setpoints, const Work& work) {
  const GrindProgram program = work.program();
  const CutterGeometry& g = work.job.cutter;
  const double from = program.strokeFrom();
  const double to = program.strokeTo();
  const double direction = to < from ? -1 : 1;
  const Axes rounding = 2 * roundingOf(setpoints);
  const double growth = std::tan(g.cone_angle);
  const double sin_rake = std::sin(g.rake_angle);
  const double feed = kMaxFeedOverride * work.job.process.feed / testing::edgePerTravel(g);
  const double step = feed * work.machine.period;
  const ReferenceCurve curve(g);
  const auto thin = static_cast<double>(std::min(curve.u(from), curve.u(to)));
  const double uneven = 4 * std::abs(static_cast<double>(curve.b)) * step / thin;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    if (p.step == StepKind::kNone) continue;
    const Setpoint& before = setpoints[i - 1];
    const double x = p.position[kX];
    RC_ASSERT(p.cycle == before.cycle + 1);
    const double way = direction * (x - before.position[kX]);
    RC_ASSERT(way >= -rounding[kX]);
    RC_ASSERT(way <= step * (1 + uneven) + rounding[kX]);
    if (p.step == StepKind::kEven) {
      RC_ASSERT(direction * (x - setpoints[i - 2].position[kX]) <= 2 * step * (1 + 1e-9) + rounding[kX]);
    }
    RC_ASSERT(direction * (to - x) >= -rounding[kX]);
    RC_ASSERT(std::abs(p.position[kY] - (x * growth - work.job.process.depth)) <= 2 * rounding[kY]);
    RC_ASSERT(std::abs(p.position[kZ] - x * growth * sin_rake) <= 2 * rounding[kZ] + 1e-18);
    const bool ends = i + 1 == setpoints.size() || setpoints[i + 1].move_index != p.move_index;
    if (ends) RC_ASSERT(direction * (to - x) <= rounding[kX]);
    if (ends) RC_ASSERT(p.move_fraction == 1);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, HoldsAndOverridesLeaveTheStrokesWhole, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const auto undisturbed = all(work);
  const auto moments = momentsInStrokes(undisturbed, 3);
  const Ride ride = rideWithHoldsAndOverrides(work, moments);
  RC_ASSERT(ride.requests_in_strokes >= 6);  // three for each of two teeth at least: some hundreds in all
  const auto setpoints = ride.setpoints();
  for (std::size_t i = 0; i < setpoints.size(); ++i) RC_ASSERT(setpoints[i].cycle == i);
  RC_ASSERT(movesOf(setpoints) == movesOf(undisturbed));
  checkStrokes(setpoints, work);
  RC_ASSERT(largestDeviation(setpoints, work.job) <= allowedDeviation(undisturbed, work.job));
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
}

RC_GTEST_PROP(SetpointStreamProperty, HoldsOverridesAndRetractsKeepToATightTolerance, ()) {
  Work work = *testing::work(kCycles / 3);
  work.job.interpolation.even_step = *rc::gen::element(EvenStepRule::kThirdOrder, EvenStepRule::kExact);
  const double without = largestDeviation(all(work), work.job);
  RC_PRE(without > 1e-12);
  work.job.interpolation.tolerance = without * *uniform(0.3, 3);  // at a third it cuts the feed to some half
  const auto undisturbed = all(work);
  const double allowed = work.job.interpolation.tolerance * (1 + 1e-9) + noiseOfDeviation(undisturbed, work.job);
  RC_ASSERT(largestDeviation(undisturbed, work.job) <= allowed);
  const Ride ride = rideWithHoldsAndOverrides(work, momentsInStrokes(undisturbed, 3));
  RC_ASSERT(largestDeviation(ride.setpoints(), work.job) <= allowed);
  RC_ASSERT(largestDeviation(rideWithRetracts(work, undisturbed, 3).setpoints(), work.job) <= allowed);
}

RC_GTEST_PROP(SetpointStreamProperty, HoldsAndOverridesKeepAllLimitsOfAllAxes, ()) {
  const Work work = *testing::work(kCycles);
  const Ride ride = rideWithHoldsAndOverrides(work, momentsInStrokes(all(work), 4));
  RC_ASSERT(ride.requests_in_strokes >= 4);
  RC_ASSERT(beyondLimits(ride.seen_by_machine, work.machine) == "");  // so that each hold comes to rest
  RC_ASSERT(beyondLimits(ride.setpoints(), work.machine) == "");      // and none needs a rest to be gone on from
}

/// Slowed down at random moments, held and brought up again now and then.
RC_GTEST_PROP(SetpointStreamProperty, SlowedDownAtAnyMomentItKeepsTheLimitsOfAxesThatStood, ()) {
  const Work work = *testing::work(kCycles);
  SetpointStream stream(work.program());
  LimitCheck check(work.machine.limits, work.machine.period);
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> chance(0, 1), periods(2, 10);
  const double share = *testing::logUniform(1e-3, 0.3);
  std::vector<Setpoint> setpoints;
  Setpoint p;
  for (int cycle = 0; cycle < 100000 && !stream.finished(); ++cycle) {
    const bool calm = cycle > 2000;
    if (!setpoints.empty() && !calm && chance(random) < share) {
      const double factor = 1 / periods(random);
      stream.slowDown(factor);
      check.slowDown(factor);
    }
    if (!calm && chance(random) < share / 10) stream.hold();
    if (!stream.next(p)) {
      stream.resume();
      continue;
    }
    setpoints.push_back(p);
    const auto violation = check.check(p);
    RC_ASSERT(!violation || violation->quantity == LimitedQuantity::kPosition);
  }
  RC_ASSERT(stream.finished());
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
  RC_ASSERT(offTheConstruction(setpoints, work.job, 1 + setpoints.size() / 200) == "");
}

TEST(SetpointStream, SlowedDownAmidAPairItSlowsDownWithTheNext) {
  GrindJob job = paperJob();
  Axes start = plainMachine().park;
  SetpointStream stream(GrindProgram(job, plainMachine(), start));
  SetpointStream undisturbed(stream.program());
  Setpoint p, q;
  const auto step = [&] {
    ASSERT_TRUE(stream.next(p));
    ASSERT_TRUE(undisturbed.next(q));
  };
  while (!(p.at_feed && p.step == StepKind::kOdd)) step();
  const Axes even_before = p.position;
  stream.slowDown(0.2);
  step();
  EXPECT_TRUE((p.position == q.position).all()) << "its second step is made as planned";
  const double x = p.position[kX];
  const double full = 2 * (x - even_before[kX]);
  step();
  step();
  // Then a fifth, and what the jerk adds in two cycles.
  EXPECT_NEAR(p.position[kX] - x, full / 5, 0.02 * full);
}

RC_GTEST_PROP(SetpointStreamProperty, HoldsAndOverridesLeaveThePapersConstruction, ()) {
  const Work work = *testing::work(kCycles);
  const auto setpoints = rideWithHoldsAndOverrides(work, momentsInStrokes(all(work), 4)).setpoints();
  RC_ASSERT(offTheConstruction(setpoints, work.job, 1 + setpoints.size() / 200) == "");
  RC_ASSERT(offTheTangent(setpoints, work.job) == "");
}

/// Whether the ways off the work and back go where nothing is, and meet the strokes ahead of where those were left.
void checkDetours(const Ride& ride, const Work& work) {
  const GrindProgram program = work.program();
  const CutterGeometry& g = work.job.cutter;
  const double growth = std::tan(g.cone_angle);
  const double direction = program.strokeTo() < program.strokeFrom() ? -1 : 1;
  const Axes rounding = 2 * roundingOf(ride.seen_by_machine);
  const double clear = clearHeight(work.job) - rounding[kY];
  std::map<std::uint32_t, std::pair<double, double>> strokes;  // where left, and the farthest reached, by move
  for (std::size_t i = 1; i < ride.given.size(); ++i) {
    const Setpoint& p = ride.given[i].p;
    const Setpoint& before = ride.given[i - 1].p;
    const Axes way = p.position - before.position;
    const bool radial = way[kX] == 0 && way[kZ] == 0 && way[kA] == 0;
    if (!ride.given[i].on_path) {
      RC_ASSERT(p.step == StepKind::kNone);
      RC_ASSERT(p.path_error == 0);
      RC_ASSERT(!p.at_feed);
      RC_ASSERT(p.move_index == before.move_index);
      RC_ASSERT(p.tooth == before.tooth);
      RC_ASSERT(p.pass == before.pass);
      RC_ASSERT(p.move_fraction == before.move_fraction);
      RC_ASSERT(p.move == MoveKind::kLift || p.move == MoveKind::kPosition || p.move == MoveKind::kInfeed);
      if (p.move == MoveKind::kLift) RC_ASSERT(radial && way[kY] >= -rounding[kY]);
      if (p.move == MoveKind::kInfeed) RC_ASSERT(radial && way[kY] <= rounding[kY]);
      if (p.move == MoveKind::kPosition) RC_ASSERT(way[kY] == 0 && p.position[kY] >= clear);
      const bool leaves_the_top = before.move == MoveKind::kLift && p.move != MoveKind::kLift;
      if (leaves_the_top) RC_ASSERT(before.position[kY] >= clear);
    }
    if (p.step == StepKind::kNone) continue;
    const double x = p.position[kX];
    if (before.step == StepKind::kNone) {
      const double start = before.position[kX];
      if (strokes.count(p.move_index) == 0) {
        RC_ASSERT(start == program.strokeFrom());
      } else {
        const auto [left, reached] = strokes[p.move_index];
        RC_ASSERT(direction * (left - start) >= -rounding[kX]);
        RC_ASSERT(direction * (left - start) <= program.schedule().runUp() + rounding[kX]);
        RC_ASSERT(direction * (reached - start) >= -rounding[kX]);  // nothing is left out
      }
      const double slope = static_cast<double>(ReferenceCurve(g).slope(start));
      const double radius = g.end_diameter / 2 + start * growth;
      RC_ASSERT(Deviation(work.job).of(before) <= radius * (rounding[kA] + rounding[kX] * std::abs(slope)));
      RC_ASSERT(std::abs(before.position[kY] - (start * growth - work.job.process.depth)) <= 2 * rounding[kY]);
      RC_ASSERT(std::abs(before.position[kZ] - start * growth * std::sin(g.rake_angle)) <= 2 * rounding[kZ]);
      strokes.emplace(p.move_index, std::make_pair(start, start));
    }
    auto& [left, reached] = strokes[p.move_index];
    left = x;
    reached = direction * (x - reached) > 0 ? x : reached;
  }
  for (const auto& [index, stroke] : strokes) {
    RC_ASSERT(std::abs(stroke.second - program.strokeTo()) <= rounding[kX]);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, RetractsLeaveTheWorkRadiallyAndComeBackAheadOfThePlace, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const auto undisturbed = all(work);
  const Ride ride = rideWithRetracts(work, undisturbed, 6);
  checkDetours(ride, work);
  const auto setpoints = ride.setpoints();
  for (std::size_t i = 0; i < setpoints.size(); ++i) RC_ASSERT(setpoints[i].cycle == i);
  checkStrokes(setpoints, work);
  RC_ASSERT(largestDeviation(setpoints, work.job) <= allowedDeviation(undisturbed, work.job));
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
}

RC_GTEST_PROP(SetpointStreamProperty, RetractsLeaveOutNoMove, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const GrindProgram program = work.program();
  const auto undisturbed = all(work);
  const Ride ride = rideWithRetracts(work, undisturbed, 6);
  std::vector<Setpoint> on_path;
  for (const Ride::Given& g : ride.given) {
    if (g.on_path) on_path.push_back(g.p);
  }
  RC_ASSERT(movesOf(on_path) == movesOf(undisturbed));
  for (std::size_t i = 1; i < ride.given.size(); ++i) {
    const Setpoint& p = ride.given[i].p;
    const bool ends = i + 1 == ride.given.size() || ride.given[i + 1].p.move_index != p.move_index;
    if (!ends) continue;
    const Axes& to = program.moves().at(p.move_index).to;
    RC_ASSERT(((p.position - to).abs().head<3>() <= 1e-12).all());
    if (p.move != MoveKind::kStroke) RC_ASSERT(std::abs(p.position[kA] - to[kA]) <= 1e-12);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, RetractsKeepAllLimitsOfAllAxes, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  const Ride ride = rideWithRetracts(work, all(work), 6);
  RC_ASSERT(beyondLimits(ride.seen_by_machine, work.machine) == "");
  RC_ASSERT(beyondLimits(ride.setpoints(), work.machine) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, BackInTheStrokeItIsAtFeedFromThePlaceOnWhereItWasLeft, ()) {
  const Work work = *testing::work(kCycles);
  const GrindProgram program = work.program();
  const auto undisturbed = all(work);
  std::vector<Setpoint> at_feed;
  for (const Setpoint& p : undisturbed) {
    if (p.at_feed && p.pass == 0) at_feed.push_back(p);
  }
  RC_PRE(at_feed.size() > 8u);
  const auto hold_at = static_cast<std::size_t>(static_cast<double>(at_feed.size() - 1) * *uniform(0, 1));
  Rider rider(work, 0);
  while (rider.ride().given.empty() || rider.last().cycle < at_feed[hold_at].cycle) RC_ASSERT(rider.next());
  rider.stream().hold();
  rider.runToRest();
  const double left = rider.last().position[kX];
  rider.stream().retract();
  rider.runToRest();
  rider.stream().resume();
  rider.runToRest();
  const double direction = program.strokeTo() < program.strokeFrom() ? -1 : 1;
  const double pair = 2 * program.schedule().feedSpeed() * work.machine.period;
  const double first = std::max(direction * left, direction * at_feed.front().position[kX]) + pair;
  const double last = direction * at_feed.back().position[kX] - pair;
  bool back = false;
  for (const Ride::Given& g : rider.ride().given) {
    back = back || !g.on_path;
    if (!back || g.p.step != StepKind::kEven || g.p.pass != 0) continue;
    const double x = direction * g.p.position[kX];
    if (x - pair >= first && x <= last) RC_ASSERT(g.p.at_feed);
  }
  RC_ASSERT(back);
}

RC_GTEST_PROP(SetpointStreamProperty, ARetractWhileItMovesIsNotTaken, ()) {
  const Work work = *testing::work(kCycles);
  const auto undisturbed = all(work);
  SetpointStream stream(work.program());
  Setpoint p;
  std::size_t i = 0;
  for (; stream.next(p); ++i) {
    RC_ASSERT(i < undisturbed.size());
    RC_ASSERT(std::memcmp(p.position.data(), undisturbed[i].position.data(), sizeof(double) * kAxisCount) == 0);
    if (p.cycle % 2 == 1 || p.feed > 0) stream.retract();
    RC_ASSERT(stream.onPath());
  }
  RC_ASSERT(i == undisturbed.size());
}

/// The paper's job, gone through up to a place in its stroke.
class PaperStroke {
 public:
  explicit PaperStroke(double x) : stream_(GrindProgram(paperJob(), plainMachine(), plainMachine().park)) {
    while (p_.move != MoveKind::kStroke || p_.position[kX] < x || p_.cycle % 2 == 1) next();
  }

  SetpointStream& stream() { return stream_; }
  const Setpoint& last() const { return p_; }
  bool next() { return stream_.next(p_); }
  void runToRest() {
    while (next()) {
    }
  }

 private:
  SetpointStream stream_;
  Setpoint p_;
};

TEST(SetpointStream, HeldItRestsAsSoonAsTheLimitsAllow) {
  PaperStroke ride(10e-3);
  const MotionLimits limits = ride.stream().program().schedule().limits();
  const double speed = 0.01 / testing::edgePerTravel(paperJob().cutter);
  ASSERT_LT(speed, limits.acceleration * limits.acceleration / limits.jerk);
  const double way = speed * std::sqrt(speed / limits.jerk);
  const double x = ride.last().position[kX];
  const std::uint64_t cycle = ride.last().cycle;
  ride.stream().hold();
  ride.runToRest();
  EXPECT_NEAR(ride.last().position[kX] - x, way, 1e-12);
  EXPECT_EQ(ride.last().cycle - cycle, 2 * std::ceil(2 * std::sqrt(speed / limits.jerk) / 2e-3));
}

TEST(SetpointStream, LiftsToTheClearanceAboveTheHighestOfTheWork) {
  PaperStroke ride(10e-3);
  ride.stream().hold();
  ride.runToRest();
  const Setpoint held = ride.last();
  EXPECT_EQ(held.move, MoveKind::kStroke);
  EXPECT_TRUE(ride.stream().onPath());
  ride.stream().retract();
  ride.runToRest();
  EXPECT_FALSE(ride.stream().onPath());
  EXPECT_FALSE(ride.stream().finished());
  EXPECT_EQ(ride.last().move, MoveKind::kLift);
  EXPECT_EQ(ride.last().move_index, held.move_index);
  EXPECT_NEAR(ride.last().position[kY], 31e-3 * std::tan(5 * units::kDegree) + 5e-3, 1e-15);
  for (const int axis : {kX, kZ, kA}) EXPECT_EQ(ride.last().position[axis], held.position[axis]);
}

TEST(SetpointStream, ComesBackAboveTheWorkThenDownAtFeedThenAlong) {
  PaperStroke ride(10e-3);
  ride.stream().hold();
  ride.runToRest();
  const double left = ride.last().position[kX];
  ride.stream().retract();
  ride.runToRest();
  ride.stream().resume();
  std::vector<MoveKind> kinds;
  double fastest_plunge = 0;
  double entry = 0;
  while (ride.next()) {
    const Setpoint& p = ride.last();
    if (kinds.empty() || kinds.back() != p.move) kinds.push_back(p.move);
    if (kinds.size() == 2) {
      fastest_plunge = std::max(fastest_plunge, p.feed);
      entry = p.position[kX];
    }
  }
  EXPECT_EQ(kinds, (std::vector<MoveKind>{MoveKind::kPosition, MoveKind::kInfeed, MoveKind::kStroke, MoveKind::kRetract,
                                          MoveKind::kReturn}));
  EXPECT_NEAR(fastest_plunge, 0.01, 1e-12);
  // 600 mm/min along the edge are v = 8.637 mm/s in X. A's jerk, 5000 rad/s^3, leaves X some 40 m/s^3 on this cone: the
  // feed is reached in 2 sqrt(v/j) = 29 ms, over v sqrt(v/j) = 0.13 mm.
  EXPECT_NEAR(left - entry, 0.13e-3, 0.02e-3);
  EXPECT_TRUE(ride.stream().finished());
}

TEST(SetpointStream, WithoutFeedItComesBackAboveTheWorkOnly) {
  PaperStroke ride(10e-3);
  ride.stream().setFeedOverride(0);
  ride.runToRest();
  const double left = ride.last().position[kX];
  ride.stream().retract();  // though it was not held
  ride.stream().resume();
  ride.runToRest();
  EXPECT_FALSE(ride.stream().onPath());
  EXPECT_EQ(ride.last().move, MoveKind::kPosition);
  EXPECT_LT(ride.last().position[kX], left);
  EXPECT_NEAR(ride.last().position[kY], 31e-3 * std::tan(5 * units::kDegree) + 5e-3, 1e-15);
  ride.stream().setFeedOverride(1);
  ride.runToRest();
  EXPECT_TRUE(ride.stream().finished());
}

TEST(SetpointStream, AWayThatWasInterruptedInTheAirIsBegunAgain) {
  for (const MoveKind kind : {MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed, MoveKind::kReturn}) {
    SCOPED_TRACE(toString(kind));
    Axes start = plainMachine().park;
    start[kX] = -0.1;
    SetpointStream stream(GrindProgram(paperJob(), plainMachine(), start));
    Setpoint p;
    while (p.move != kind || p.move_fraction < 0.3) ASSERT_TRUE(stream.next(p));
    stream.hold();
    while (stream.next(p)) {
    }
    const Setpoint held = p;
    ASSERT_LT(held.move_fraction, 1);
    stream.retract();
    while (stream.next(p)) {
    }
    EXPECT_EQ(p.position[kX], held.position[kX]);
    EXPECT_GE(p.position[kY], 31e-3 * std::tan(5 * units::kDegree) + 5e-3 - 1e-15);
    stream.resume();
    ASSERT_TRUE(stream.next(p));
    EXPECT_TRUE(stream.onPath());
    EXPECT_EQ(p.move, kind);
    EXPECT_EQ(p.move_index, held.move_index);
    EXPECT_LT(p.move_fraction, 0.1);
    while (stream.next(p)) {
    }
    EXPECT_TRUE(stream.finished());
    EXPECT_TRUE((p.position == plainMachine().park).all());
  }
}

TEST(SetpointStream, LiftedBeforeItBeginsGoesOnAsIfItWereNot) {
  Axes start = plainMachine().park;
  start[kY] = 0;
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), start));
  stream.retract();
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_TRUE((p.position == start).all());
  while (stream.next(p)) {
  }
  EXPECT_NEAR(p.position[kY], 31e-3 * std::tan(5 * units::kDegree) + 5e-3, 1e-15);
  stream.resume();
  while (stream.next(p)) {
  }
  EXPECT_TRUE(stream.finished());
  EXPECT_TRUE((p.position == plainMachine().park).all());
}

TEST(SetpointStream, IsFinishedAtItsEndOnly) {
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
  Setpoint p;
  EXPECT_FALSE(stream.finished());
  while (stream.next(p))
    EXPECT_EQ(stream.finished(), p.move == MoveKind::kReturn && p.move_fraction == 1 && p.cycle % 2 == 0);
  EXPECT_TRUE(stream.finished());
  stream.resume();
  EXPECT_FALSE(stream.next(p));
}

/// The paper's job at a feed, on a machine with gentle limits.
Work gentleWork(double feed) {
  Work work{paperJob(), plainMachine(), plainMachine().park};
  work.job.process.feed = feed;
  work.machine.limits.max_velocity << 0.2, 0.2, 0.2, 20;
  work.machine.limits.max_acceleration << 0.5, 0.5, 0.5, 62.83;
  work.machine.limits.max_jerk << 10, 10, 10, 1257;
  return work;
}

class EvenFeed : public ::testing::TestWithParam<int> {};  // [mm/min]

TEST_P(EvenFeed, IsHeldOverTheMiddleHalfOfTheStroke) {
  const Work work = gentleWork(GetParam() * units::kMillimetrePerMinute);
  double slowest_pair = 1e9;
  double fastest_pair = 0;
  double slowest_step = 1e9;
  double fastest_step = 0;
  for (const SeenPair& s : pairsOf(all(work))) {
    const double x[]{s.start.position[kX], s.odd.position[kX], s.even.position[kX]};
    if (x[0] < 7e-3 || x[2] > 23e-3) continue;  // of -1 mm to 31 mm
    slowest_pair = std::min(slowest_pair, x[2] - x[0]);
    fastest_pair = std::max(fastest_pair, x[2] - x[0]);
    for (const double step : {x[1] - x[0], x[2] - x[1]}) {
      slowest_step = std::min(slowest_step, step);
      fastest_step = std::max(fastest_step, step);
    }
  }
  ASSERT_GT(fastest_pair, 0);
  RecordProperty("pairs", ::testing::PrintToString(fastest_pair / slowest_pair - 1));
  RecordProperty("steps", ::testing::PrintToString(fastest_step / slowest_step - 1));
  EXPECT_LT(fastest_pair / slowest_pair, 1.000001);
  EXPECT_LT(fastest_step / slowest_step, 1.0001);
}

TEST_P(EvenFeed, TakesHardlyLongerThanTheQuickestStrokeThereIs) {
  const Work work = gentleWork(GetParam() * units::kMillimetrePerMinute);
  // The quickest way from rest to rest over 32 mm that X's limits allow: full acceleration is reached at both feeds or
  // not by v j against a^2. The other axes' limits can only make it slower.
  const double v = work.job.process.feed / testing::edgePerTravel(work.job.cutter);
  const double a = 0.5;
  const double j = 10;
  const double ramp = v * j >= a * a ? v / a + a / j : 2 * std::sqrt(v / j);
  ASSERT_LT(ramp * v, 32e-3);
  const double quickest = 32e-3 / v + ramp;
  std::size_t cycles = 0;
  for (const Setpoint& p : all(work)) cycles += p.step != StepKind::kNone ? 1 : 0;
  const double duration = static_cast<double>(cycles) * work.machine.period;
  RecordProperty("excess", ::testing::PrintToString(duration / quickest - 1));
  EXPECT_GE(duration, quickest * (1 - 1e-9));
  EXPECT_LE(duration, quickest * 1.01);
}

INSTANTIATE_TEST_SUITE_P(MillimetresPerMinute, EvenFeed, ::testing::Values(600, 1800));

/// Of the paper's job where nothing cuts the feed, in X. [m/s]
double paperSpeed() { return 0.01 / testing::edgePerTravel(paperJob().cutter); }

TEST(SetpointStream, AnotherFeedTakesEffectWithTheNextPair) {
  for (const bool at_pair_end : {true, false}) {
    PaperStroke ride(10e-3);
    PaperStroke undisturbed(10e-3);
    if (!at_pair_end) {
      ride.next();
      undisturbed.next();
    }
    ASSERT_TRUE(ride.last().at_feed);
    ride.stream().setFeedOverride(0.5);
    if (!at_pair_end) {
      ride.next();
      undisturbed.next();
      EXPECT_EQ(ride.last().position[kX], undisturbed.last().position[kX]);
    }
    // The speed falls with the law's jerk j: the pair of 2 T falls short by j (2 T)^3 / 6.
    const double pair = 2e-3;
    const double jerk = ride.stream().program().schedule().limits().jerk;
    const double before = ride.last().position[kX];
    ride.next();
    ride.next();
    EXPECT_NEAR(ride.last().position[kX] - before, paperSpeed() * pair - jerk * pair * pair * pair / 6, 1e-14);
    EXPECT_FALSE(ride.last().at_feed);
  }
}

TEST(SetpointStream, AnotherFeedIsReachedAsSoonAsTheLimitsAllow) {
  for (const double fraction : {0.1, 0.5, 0.9, 1.1, 1.2}) {
    SCOPED_TRACE(fraction);
    PaperStroke ride(10e-3);
    const MotionLimits limits = ride.stream().program().schedule().limits();
    const double change = std::abs(fraction - 1) * paperSpeed();
    ASSERT_LT(change, limits.acceleration * limits.acceleration / limits.jerk);
    const double time = 2 * std::sqrt(change / limits.jerk);
    ride.stream().setFeedOverride(fraction);
    int pairs = 0;
    for (; !ride.last().at_feed || pairs == 0; ++pairs) {
      const double before = ride.last().position[kX];
      ASSERT_TRUE(ride.next() && ride.next());
      const double speed = (ride.last().position[kX] - before) / 2e-3;
      EXPECT_GE(speed, std::min(1.0, fraction) * paperSpeed() * (1 - 1e-9));  // neither past the one nor the other
      EXPECT_LE(speed, std::max(1.0, fraction) * paperSpeed() * (1 + 1e-9));
    }
    EXPECT_LE(pairs, static_cast<int>(std::ceil(time / 2e-3)) + 1);
    const double before = ride.last().position[kX];
    ASSERT_TRUE(ride.next() && ride.next());
    EXPECT_NEAR((ride.last().position[kX] - before) / 2e-3, fraction * paperSpeed(), 1e-9 * paperSpeed());
    EXPECT_NEAR(ride.last().feed, fraction * 0.01, 1e-12);
    EXPECT_TRUE(ride.last().at_feed);
  }
}

TEST(SetpointStream, NoFeedRestsOnThePathUntilThereIsFeedAgain) {
  PaperStroke ride(10e-3);
  ride.stream().setFeedOverride(0);
  ride.runToRest();
  const Setpoint rest = ride.last();
  EXPECT_EQ(rest.move, MoveKind::kStroke);
  EXPECT_LT(rest.position[kX], 11e-3);
  EXPECT_FALSE(ride.stream().finished());
  EXPECT_TRUE(ride.stream().onPath());
  EXPECT_FALSE(ride.next());
  ride.stream().resume();  // which is for holds
  EXPECT_FALSE(ride.next());
  ride.stream().setFeedOverride(1e-3);
  ASSERT_TRUE(ride.next());
  EXPECT_EQ(ride.last().cycle, rest.cycle + 1);
  ride.stream().setFeedOverride(1);
  ride.runToRest();
  EXPECT_TRUE(ride.stream().finished());
}

TEST(SetpointStream, AFeedThatThereIsNotIsNotTaken) {
  const double not_taken[]{
      std::numeric_limits<double>::quiet_NaN(), -1e-9, -1, 1.2 + 1e-9, 100, std::numeric_limits<double>::infinity(),
      -std::numeric_limits<double>::infinity()};
  for (const double fraction : not_taken) {
    SCOPED_TRACE(fraction);
    PaperStroke ride(10e-3);
    PaperStroke untouched(10e-3);
    ride.stream().setFeedOverride(0.7);
    untouched.stream().setFeedOverride(0.7);
    ride.stream().setFeedOverride(fraction);
    while (untouched.next()) {
      ASSERT_TRUE(ride.next());
      ASSERT_TRUE((ride.last().position == untouched.last().position).all());
    }
    EXPECT_FALSE(ride.next());
  }
}

TEST(SetpointStream, TheInfeedGoesAtTheOverriddenFeedToo) {
  for (const double fraction : {0.25, 1.0, 1.2}) {
    SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
    stream.setFeedOverride(fraction);
    double fastest = 0;
    Setpoint p;
    while (stream.next(p)) {
      if (p.move == MoveKind::kInfeed) fastest = std::max(fastest, -p.velocity[kY]);
    }
    EXPECT_NEAR(fastest, fraction * 0.01, 1e-12);
  }
}

/// The number of cycles of every rapid of a job, by its move.
std::map<std::uint32_t, int> rapidsOf(const std::vector<Setpoint>& setpoints) {
  std::map<std::uint32_t, int> rapids;
  for (const Setpoint& p : setpoints) {
    if (p.move != MoveKind::kInfeed && p.move != MoveKind::kStroke) ++rapids[p.move_index];
  }
  return rapids;
}

RC_GTEST_PROP(SetpointStreamProperty, RapidsKeepTheirSpeedWhateverTheFeed, ()) {
  const Work work = *testing::toothedWork(kCycles / 3);
  SetpointStream stream(work.program());
  stream.setFeedOverride(*uniform(0.1, 1.2));
  RC_ASSERT(rapidsOf(all(stream)) == rapidsOf(all(work)));
}

RC_GTEST_PROP(SetpointStreamProperty, AtAnotherFeedEveryPairGoesAtThatFeed, ()) {
  const Work work = *testing::work(kCycles);
  SetpointStream stream(work.program());
  const double fraction = *uniform(0.1, 1.2);
  stream.setFeedOverride(fraction);
  const FeedSchedule& schedule = stream.program().schedule();
  const double most = schedule.limits().velocity;
  const double speed = std::min(fraction * schedule.feedSpeed(), most);
  const auto setpoints = all(stream);
  const double rounding = roundingOf(setpoints)[kX];
  for (const SeenPair& s : pairsOf(setpoints)) {
    if (!s.odd.at_feed) continue;
    const double pair = 2 * speed * work.machine.period;
    RC_ASSERT(std::abs(std::abs(s.even.position[kX] - s.start.position[kX]) - pair) <= 1e-6 * pair + 2 * rounding);
  }
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, WhereNoAxisHindersTheFeedItGoesAsFastAsAskedFor, ()) {
  Work work = *testing::work(kCycles);
  work.machine.limits.max_velocity.setConstant(1e3);
  work.machine.limits.max_acceleration.setConstant(1e6);
  work.machine.limits.max_jerk.setConstant(1e9);
  work.job.interpolation.tolerance = 1e-3;
  SetpointStream stream(work.program());
  RC_PRE(stream.program().schedule().feedLimits().empty());
  const double fraction = *uniform(0.1, 1.2);
  stream.setFeedOverride(fraction);
  const double feed = fraction * work.job.process.feed;
  int at_feed = 0;
  double fastest = 0;
  for (const Setpoint& p : all(stream)) {
    if (p.step == StepKind::kNone) continue;
    fastest = std::max(fastest, p.feed);
    if (!p.at_feed) continue;
    ++at_feed;
    RC_ASSERT(std::abs(p.feed - feed) <= 1e-9 * feed);
  }
  RC_ASSERT(at_feed > 0);
  RC_ASSERT(fastest <= feed * (1 + 1e-9));
}

TEST(SetpointStream, WhereACutsTheFeedNoOverrideMakesItFaster) {
  Work work{paperJob(), plainMachine(), plainMachine().park};
  work.machine.limits.max_velocity[kA] = 0.95;  // 8.637 mm/s ask for 1.015 rad/s at X = -1 mm, and for 0.653 at 31 mm
  const auto largestTurn = [&](double fraction) {
    SetpointStream stream(work.program());
    stream.setFeedOverride(fraction);
    double turn = 0;
    double speed = 0;
    Setpoint p;
    while (stream.next(p)) {
      if (p.step == StepKind::kNone) continue;
      turn = std::max(turn, std::abs(p.velocity[kA]));
      speed = std::max(speed, p.velocity[kX]);
    }
    return std::make_pair(turn, speed);
  };
  const auto [turn, speed] = largestTurn(1);
  EXPECT_LE(turn, 0.95);
  EXPECT_GT(turn, 0.94);
  EXPECT_NEAR(speed, paperSpeed(), 1e-4 * paperSpeed());
  const auto [faster_turn, faster_speed] = largestTurn(1.2);
  EXPECT_LE(faster_turn, 0.95);
  EXPECT_NEAR(faster_speed, speed, 1e-9);
  const auto [slower_turn, slower_speed] = largestTurn(0.5);
  EXPECT_LE(slower_turn, 0.95 / 2 * (1 + 1e-3));
  EXPECT_NEAR(slower_speed, speed / 2, 1e-4 * speed);
}

TEST(SetpointStream, GoesAsFarTowardTheOverrideAsAnAxisAllows) {
  Work work{paperJob(), plainMachine(), plainMachine().park};
  work.machine.limits.max_velocity[kX] = 1.1 * paperSpeed();
  SetpointStream stream(work.program());
  stream.setFeedOverride(1.2);
  double fastest = 0;
  for (const Setpoint& p : all(stream)) fastest = std::max(fastest, p.step == StepKind::kNone ? 0 : p.velocity[kX]);
  EXPECT_LE(fastest, 1.1 * paperSpeed());
  EXPECT_GT(fastest, 1.099 * paperSpeed());
}

TEST(SetpointStream, TellsMoveAndProgress) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  SetpointStream stream(GrindProgram(job, plainMachine(), plainMachine().park));
  const auto moves = stream.program().moves();
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_EQ(p.move_index, 0u);
  EXPECT_EQ(p.move_fraction, 0);
  Setpoint before = p;
  for (; stream.next(p); before = p) {
    if (p.move_index == before.move_index) {
      ASSERT_GE(p.move_fraction, before.move_fraction);
    } else {
      ASSERT_EQ(p.move_index, before.move_index + 1);
      ASSERT_LT(p.move_fraction, 0.5);
    }
    // Of a stroke that is not cut for an axis it is the way in X.
    if (p.step == StepKind::kEven) {
      ASSERT_NEAR(p.move_fraction, (p.position[kX] + 1e-3) / 32e-3, 1e-12);
    }
    if (p.move == MoveKind::kApproach) {
      const double from = moves[p.move_index - 1].to[kY];
      ASSERT_NEAR(p.move_fraction, (p.position[kY] - from) / (moves[p.move_index].to[kY] - from), 1e-12);
    }
  }
  EXPECT_EQ(p.move_index, moves.size() - 1);
}

// planJob() refuses every program that comes to this: a tooth that is nowhere.
TEST(SetpointStream, ThatCannotGoOnGivesWhatEveryCheckRefuses) {
  GrindJob job = paperJob();
  job.tooth_angles = {std::numeric_limits<double>::quiet_NaN()};
  const Machine machine = plainMachine();
  SetpointStream stream(GrindProgram(job, machine, machine.park));
  LimitCheck check(machine.limits, machine.period);
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_FALSE(check.check(p));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(stream.next(p));
    stream.hold();
    stream.retract();
    stream.resume();
    const auto violation = check.check(p);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->quantity, LimitedQuantity::kNotFinite);
    ASSERT_FALSE(stream.finished());
  }
}

TEST(SetpointStream, SharesItsProgram) {
  const Machine machine = plainMachine();
  const auto program = std::make_shared<const GrindProgram>(paperJob(), machine, machine.park);
  SetpointStream shared(program);
  SetpointStream owned(*program);
  EXPECT_EQ(&shared.program(), program.get());
  Setpoint p, q;
  while (shared.next(p)) {
    ASSERT_TRUE(owned.next(q));
    ASSERT_TRUE((p.position == q.position).all());
  }
  EXPECT_FALSE(owned.next(q));
}

}  // namespace
}  // namespace flute_grinder
