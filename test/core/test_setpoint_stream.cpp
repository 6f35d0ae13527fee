#include "flute_grinder/core/setpoint_stream.h"

#include "generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
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

TEST(SetpointStream, StoppedBeforeItBeginsDoesNotMove) {
  SetpointStream stream(GrindProgram(paperJob(), plainMachine(), plainMachine().park));
  stream.stop();
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
    if (p.move != q.move || p.pass != q.pass || p.tooth != q.tooth) RC_ASSERT(p.cycle % 2 == 0u);
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
  const Work work = *testing::work(kCycles);
  const GrindProgram program = work.program();
  const auto setpoints = all(work);
  const ReferenceCurve curve(work.job.cutter);
  const bool cone = work.job.interpolation.even_step != EvenStepRule::kExact;
  std::size_t move = 0;
  std::vector<Setpoint> ends;
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const bool last = i + 1 == setpoints.size();
    const Setpoint& p = setpoints[i];
    if (last || setpoints[i + 1].move != p.move || setpoints[i + 1].pass != p.pass) ends.push_back(p);
  }
  for (const Setpoint& p : ends) {
    // Moves of no length take no cycle.
    while (move < program.moves().size() && program.moves()[move].kind != p.move) ++move;
    RC_ASSERT(move < program.moves().size());
    const Axes& to = program.moves()[move++].to;
    if (p.move == MoveKind::kStroke) {
      RC_ASSERT(std::abs(p.position[kX] - to[kX]) <= 1e-12);
      RC_ASSERT(std::abs(p.position[kY] - to[kY]) <= 1e-12);
      RC_ASSERT(std::abs(p.position[kZ] - to[kZ]) <= 1e-12);
      if (!cone) RC_ASSERT(std::abs(p.position[kA] - to[kA]) <= 1e-12 * (1 + static_cast<double>(std::abs(curve.k))));
    } else {
      RC_ASSERT((p.position == to).all());
    }
  }
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
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
  const double speed = program.schedule().limits().velocity;
  if (program.schedule().limitedBy().empty()) {
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
  const double step = work.program().schedule().limits().velocity * work.machine.period;
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

RC_GTEST_PROP(SetpointStreamProperty, StopsOnThePathUnderTheLimits, ()) {
  const Work work = *testing::work(kCycles);
  const auto undisturbed = all(work);
  SetpointStream stream(work.program());
  std::vector<Setpoint> setpoints;
  Setpoint p;
  const auto stop_at = static_cast<std::size_t>(static_cast<double>(undisturbed.size()) * *uniform(0, 1));
  for (std::size_t i = 0; i < stop_at && stream.next(p); ++i) setpoints.push_back(p);
  stream.stop();
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

RC_GTEST_PROP(SetpointStreamProperty, AStopInTheStrokeStaysInTheStroke, ()) {
  const Work work = *testing::work(kCycles);
  const GrindProgram program = work.program();
  const auto undisturbed = all(work);
  std::size_t first = 0;
  while (undisturbed[first].step == StepKind::kNone) ++first;
  std::size_t last = first;
  while (undisturbed[last].step != StepKind::kNone) ++last;
  const auto stop_at = first + static_cast<std::size_t>(static_cast<double>(last - first) * *uniform(0, 1));
  SetpointStream stream(program);
  Setpoint p;
  for (std::size_t i = 0; i < stop_at; ++i) {
    stream.next(p);
    RC_ASSERT((p.position == undisturbed[i].position).all());
  }
  stream.stop();
  const double direction = program.strokeTo() > program.strokeFrom() ? 1 : -1;
  double x = stop_at > first ? p.position[kX] : program.strokeFrom();
  while (stream.next(p)) {
    if (stop_at == first) continue;  // in front of the stroke it rests already
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

}  // namespace
}  // namespace flute_grinder
