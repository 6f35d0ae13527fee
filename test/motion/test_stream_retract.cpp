// A stream whose wheel is retracted from wherever it rests, and comes back.

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/axis_move.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include "stream_checks.h"
#include "stream_rides.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

namespace grinder {
namespace test_stream_retract {

using namespace test_support;

/// Whether the ways off the work and back go where nothing is, and meet the strokes ahead of where those were left.
void checkDetours(const Ride& ride, const Work& work) {
  const GrindProgram program = work.program();
  const CutterGeometry& g = work.job.cutter;
  const double growth = std::tan(g.cone_angle);
  const double direction = program.strokeTo() < program.strokeFrom() ? -1 : 1;
  const Axes rounding = 2 * roundingOf(ride.seen_by_machine);
  const double clear = program.clearanceHeight() - rounding[kY];
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
      const double slope = static_cast<double>(ReferenceCurve(g, work.job.process.setup_lead).slope(start));
      const double radius = g.end_diameter / 2 + (start - work.job.process.setup_lead) * growth;
      RC_ASSERT(Deviation(work.job).of(before) <= radius * (rounding[kA] + rounding[kX] * std::abs(slope)));
      RC_ASSERT(std::abs(before.position[kY] - (start * growth - work.job.process.depth)) <= 2 * rounding[kY]);
      RC_ASSERT(std::abs(before.position[kZ] - start * growth * static_cast<double>(zPerY(g))) <= 2 * rounding[kZ]);
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

/// Whether every move was made, to its end.
void checkMoves(const Ride& ride, const GrindProgram& program, const std::vector<Setpoint>& undisturbed) {
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

RC_GTEST_PROP(SetpointStreamProperty, RetractsLeaveTheWorkRadiallyAndLeaveOutNothingWithinTheLimits, ()) {
  const Work work = *toothedWork(kCycles / 3);
  const auto undisturbed = all(work);
  const Ride ride = rideWithRetracts(work, undisturbed, 6);
  checkDetours(ride, work);
  checkMoves(ride, work.program(), undisturbed);
  const auto setpoints = ride.setpoints();
  RC_ASSERT(beyondLimits(ride.seen_by_machine, work.machine) == "");
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");
  for (std::size_t i = 0; i < setpoints.size(); ++i) RC_ASSERT(setpoints[i].cycle == i);
  checkStrokes(setpoints, work);
  RC_ASSERT(maxDeviation(setpoints, work.job) <= allowedDeviation(undisturbed, work.job));
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
}

RC_GTEST_PROP(SetpointStreamProperty, BackInTheStrokeItIsAtFeedFromThePlaceOnWhereItWasLeft, ()) {
  const Work work = *test_support::work(kCycles);
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
  const Work work = *test_support::work(kCycles);
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

/// Y at which the wheel is clear of all of the paper's work.
const double kPaperClearance = 31e-3 * std::tan(5 * units::kDegree) + 5e-3;

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
  EXPECT_NEAR(ride.last().position[kY], kPaperClearance, 1e-15);
  ride.stream().setFeedOverride(1);
  ride.runToRest();
  EXPECT_TRUE(ride.stream().finished());
}

/// Moves an axis by a distance, as by hand.
void jog(SetpointStream& stream, const Machine& machine, Setpoint& last, int axis, double distance,
         std::vector<Setpoint>* seen = nullptr) {
  AxisMove move(machine);
  move.begin(MoveKind::kPosition, last.position, axis, last.position[axis] + distance,
             machine.limits.max_velocity[axis]);
  Setpoint p;
  move.next(p);  // at rest
  while (move.next(p)) {
    stream.adopt(p);
    last = p;
    if (seen) seen->push_back(p);
  }
}

/// A retracted job that is jogged some times, and the same without.
struct Jogged {
  std::vector<Setpoint> seen;         ///< from the lift's last setpoint on
  std::size_t resumed = 0;            ///< index of the last setpoint before resume
  std::vector<Setpoint> undisturbed;  ///< from resume on, without the jogs
  Axes lifted = Axes::Zero();
};

/// Holds a job at a random moment, retracts, and jogs the axes off the work.
Jogged jogRetracted(const Work& work) {
  const auto planned = all(work);
  const auto moment = static_cast<std::size_t>(static_cast<double>(planned.size() - 1) * *uniform(0, 1));
  Jogged result;
  SetpointStream stream(work.program());
  Setpoint p;
  for (std::size_t i = 0; i <= moment; ++i) RC_ASSERT(stream.next(p));
  stream.hold();
  while (stream.next(p)) {
  }
  RC_PRE(!stream.finished());
  RC_ASSERT(!stream.lifted());
  stream.retract();
  while (stream.next(p)) {
  }
  RC_ASSERT(stream.lifted());
  result.lifted = p.position;
  result.seen.push_back(p);
  SetpointStream plain = stream;
  for (int jogs = *whole(1, 4); jogs > 0; --jogs) {
    // Above the work or, as if by the rounding of an offset, a little below.
    const int axis = *whole(kX, kA);
    const double lowest = axis == kY ? -1e-9 : -0.01;
    jog(stream, work.machine, p, axis, (axis == kA ? 30 : 1) * *uniform(lowest, 0.01), &result.seen);
    RC_ASSERT(!stream.next(p));
    RC_ASSERT(stream.lifted());
  }
  result.resumed = result.seen.size() - 1;
  for (SetpointStream* s : {&stream, &plain}) {
    s->resume();
    auto& into = s == &plain ? result.undisturbed : result.seen;
    while (s->next(p)) into.push_back(p);
    RC_ASSERT(s->finished());
  }
  return result;
}

RC_GTEST_PROP(SetpointStreamProperty, JoggedWhileRetractedItComesBackOverTheWorkAndGoesOnWithTheSameBits, ()) {
  const Work work = *test_support::work(kCycles / 3);
  const Jogged jogged = jogRetracted(work);
  const auto& seen = jogged.seen;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    RC_ASSERT(seen[i].cycle == seen[i - 1].cycle + 1);
    RC_ASSERT(seen[i].move_index >= seen[i - 1].move_index);
  }
  // Behind the way back, every setpoint is that of the job that was not jogged, but for its number.
  RC_ASSERT(seen.size() - jogged.resumed > jogged.undisturbed.size());
  const std::size_t back = seen.size() - jogged.undisturbed.size();
  for (std::size_t i = 0; i < jogged.undisturbed.size(); ++i) {
    const Setpoint& a = seen[back + i];
    const Setpoint& b = jogged.undisturbed[i];
    RC_ASSERT((a.position == b.position).all());
    RC_ASSERT(a.move == b.move && a.move_index == b.move_index && a.move_fraction == b.move_fraction);
    RC_ASSERT(a.path_error == b.path_error && a.feed == b.feed && a.step == b.step && a.at_feed == b.at_feed);
  }
  // The way back: up, across, down, each to its end, and never lower than it has to be.
  RC_ASSERT((seen[back - 1].position == jogged.lifted).all());
  const double low = std::min(seen[jogged.resumed].position[kY], jogged.lifted[kY]);
  const double high = std::max(seen[jogged.resumed].position[kY], jogged.lifted[kY]);
  for (std::size_t i = jogged.resumed + 1; i < back; ++i) {
    const Setpoint& p = seen[i];
    RC_ASSERT(p.step == StepKind::kNone && !p.at_feed && p.path_error == 0);
    const Axes step = p.position - seen[i - 1].position;
    const bool across = step[kX] != 0 || step[kZ] != 0 || step[kA] != 0;
    if (across) RC_ASSERT(p.position[kY] == high && step[kY] == 0);
    if (step[kY] < 0) {
      RC_ASSERT((p.position == Axes(jogged.lifted[kX], p.position[kY], jogged.lifted[kZ], jogged.lifted[kA])).all());
    }
    RC_ASSERT(p.position[kY] >= low);
  }
  RC_ASSERT(beyondLimits(seen, work.machine) == "");
}

TEST(SetpointStream, AdoptsNothingUnlessItRestsLifted) {
  PaperStroke ride(10e-3);
  const auto expectIgnored = [&](const char* when) {
    SetpointStream a = ride.stream(), b = ride.stream();
    EXPECT_FALSE(a.lifted()) << when;
    Setpoint other;
    other.cycle = 77;
    other.position << 0.1, 0.1, 0.1, 0.1;
    a.adopt(other);
    EXPECT_EQ(other.cycle, 77u) << when;
    a.resume();
    b.resume();
    Setpoint p, q;
    while (a.next(p)) {
      ASSERT_TRUE(b.next(q));
      ASSERT_TRUE((p.position == q.position).all() && p.cycle == q.cycle) << when;
    }
  };
  expectIgnored("running");
  ride.stream().hold();
  ride.runToRest();
  expectIgnored("held");
  ride.stream().retract();
  ride.next();
  ride.next();
  expectIgnored("lifting");
  ride.stream().hold();
  ride.runToRest();
  expectIgnored("held in the lift");
  ride.stream().retract();
  ride.runToRest();
  EXPECT_TRUE(ride.stream().lifted());
  ride.stream().resume();
  expectIgnored("resumed");
}

TEST(SetpointStream, TheWayBackFromAJogCanBeHeldAndLeftForAnotherJog) {
  PaperStroke ride(10e-3);
  SetpointStream& stream = ride.stream();
  stream.hold();
  ride.runToRest();
  stream.retract();
  ride.runToRest();
  const Axes lifted = ride.last().position;
  for (int cycles = 50; cycles < 400; cycles += 50) {
    Setpoint last = ride.last();
    jog(stream, plainMachine(), last, kX, 0.05);
    jog(stream, plainMachine(), last, kY, 0.02);
    jog(stream, plainMachine(), last, kA, -1);
    stream.resume();
    for (int i = 0; i < cycles; ++i) ASSERT_TRUE(ride.next());
    ASSERT_FALSE(stream.onPath());
    stream.hold();
    ride.runToRest();
    ASSERT_GE(ride.last().position[kY], lifted[kY]);
    stream.retract();
    ride.runToRest();
    ASSERT_TRUE(stream.lifted());
    ASSERT_GE(ride.last().position[kY], lifted[kY]);
  }
  stream.resume();
  ride.runToRest();
  EXPECT_TRUE(stream.finished());
  EXPECT_TRUE((ride.last().position == plainMachine().park).all());
}

TEST(SetpointStream, LiftedBeforeItBeginsGoesOnAsIfItWereNot) {
  Axes start = plainMachine().park;
  start[kY] = 0;
  SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), start));
  stream.retract();
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_TRUE((p.position == start).all());
  while (stream.next(p)) {
  }
  EXPECT_NEAR(p.position[kY], kPaperClearance, 1e-15);
  stream.resume();
  while (stream.next(p)) {
  }
  EXPECT_TRUE(stream.finished());
  EXPECT_TRUE((p.position == plainMachine().park).all());
}

}  // namespace test_stream_retract
}  // namespace grinder
