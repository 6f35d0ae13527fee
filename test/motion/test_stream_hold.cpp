// A stream that is held and retracted, and comes back. test/rides does so at random moments of random jobs.

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/axis_move.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include "stream_checks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace grinder {
namespace test_stream_hold {

using namespace test_support;

TEST(SetpointStream, HeldBeforeItBeginsDoesNotMove) {
  SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park));
  stream.hold();
  const auto setpoints = all(stream);
  ASSERT_EQ(setpoints.size(), 1u);
  EXPECT_EQ(stream.rest(), Rest::kHeld);
  EXPECT_TRUE((setpoints[0].position == plainMachine().park).all());
}

TEST(SetpointStream, HeldItRestsAsSoonAsTheLimitsAllow) {
  PaperStroke ride(10e-3);
  const MotionLimits limits = ride.stream().program().schedule().limits();
  const double speed = 0.01 / edgePerTravel(paperJob().cutter);
  ASSERT_LT(speed, limits.acceleration * limits.acceleration / limits.jerk);
  const double way = speed * std::sqrt(speed / limits.jerk);
  const double x = ride.last().position[kX];
  const std::uint64_t cycle = ride.last().cycle;
  ride.stream().hold();
  ride.runToRest();
  EXPECT_NEAR(ride.last().position[kX] - x, way, 1e-12);
  EXPECT_EQ(ride.last().cycle - cycle, 2 * std::ceil(2 * std::sqrt(speed / limits.jerk) / 2e-3));
}

RC_GTEST_PROP(SetpointStreamProperty, BackInTheStrokeItIsAtFeedFromThePlaceOnWhereItWasLeft, ()) {
  const Work work = *test_support::work(kCycles);
  SetpointStream stream(work.program());
  std::vector<Setpoint> at_feed;
  for (const Setpoint& p : all(work)) {
    if (p.at_feed && p.pass == 0) at_feed.push_back(p);
  }
  RC_PRE(at_feed.size() > 8u);
  const auto hold_at = static_cast<std::size_t>(static_cast<double>(at_feed.size() - 1) * *uniform(0, 1));
  Setpoint p;
  do {
    RC_ASSERT(stream.next(p));
  } while (p.cycle < at_feed[hold_at].cycle);
  stream.hold();
  all(stream, p);
  const Setpoint left = p;
  stream.retract();
  all(stream, p);
  stream.resume();

  const double direction = stream.program().strokeTo() < stream.program().strokeFrom() ? -1 : 1;
  while (stream.next(p) && !stream.onPath()) {
    RC_ASSERT(p.step == StepKind::kNone && p.path_error == 0 && !p.at_feed);
    RC_ASSERT(p.move_index == left.move_index && p.move_fraction == left.move_fraction);
    RC_ASSERT(p.tooth == left.tooth && p.pass == left.pass);
  }
  const double run_up = direction * (left.position[kX] - p.position[kX]);
  RC_ASSERT(run_up <= stream.program().schedule().runUp() + 2 * roundingOf(at_feed)[kX]);
  const double pair = 2 * stream.program().schedule().feedSpeed() * work.machine.period;
  const double first = direction * std::max(direction * left.position[kX], direction * at_feed.front().position[kX]);
  const double last = at_feed.back().position[kX];
  do {
    const double x = p.position[kX];
    const bool between = direction * (x - first) >= 2 * pair && direction * (last - x) >= pair;
    if (p.pass == 0 && p.step == StepKind::kEven && between) RC_ASSERT(p.at_feed);
  } while (stream.next(p));
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
  EXPECT_EQ(ride.stream().rest(), Rest::kEnd);
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
    const Axes velocity = p.velocity;
    stream.adopt(p);
    EXPECT_TRUE((p.velocity == velocity).all());
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
  RC_PRE(stream.rest() != Rest::kEnd);
  RC_ASSERT(stream.rest() == Rest::kHeld);
  stream.retract();
  while (stream.next(p)) {
  }
  RC_ASSERT(stream.rest() == Rest::kLifted);
  result.lifted = p.position;
  result.seen.push_back(p);
  SetpointStream plain = stream;
  for (int jogs = *whole(1, 4); jogs > 0; --jogs) {
    // Above the work or, as if by the rounding of an offset, a little below.
    const int axis = *whole(kX, kA);
    const double lowest = axis == kY ? -1e-9 : -0.01;
    jog(stream, work.machine, p, axis, (axis == kA ? 30 : 1) * *uniform(lowest, 0.01), &result.seen);
    RC_ASSERT(!stream.next(p));
    RC_ASSERT(stream.rest() == Rest::kLifted);
  }
  result.resumed = result.seen.size() - 1;
  for (SetpointStream* s : {&stream, &plain}) {
    s->resume();
    auto& into = s == &plain ? result.undisturbed : result.seen;
    while (s->next(p)) into.push_back(p);
    RC_ASSERT(s->rest() == Rest::kEnd);
  }
  return result;
}

RC_GTEST_PROP(SetpointStreamProperty, JoggedWhileRetractedItComesBackOverTheWorkAndGoesOnWithTheSameBits, ()) {
  const Work work = *test_support::work(kCycles / 3);
  const Jogged jogged = jogRetracted(work);
  const auto& seen = jogged.seen;
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
}

TEST(SetpointStream, AdoptsNothingUnlessItRestsLifted) {
  PaperStroke ride(10e-3);
  const auto expectIgnored = [&](const char* when) {
    SetpointStream a = ride.stream(), b = ride.stream();
    EXPECT_NE(a.rest(), Rest::kLifted) << when;
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
  EXPECT_EQ(ride.stream().rest(), Rest::kLifted);
  EXPECT_NEAR(ride.last().position[kY], kPaperClearance, 1e-15) << "all of the lift";
  ride.stream().resume();
  expectIgnored("resumed");
}

TEST(SetpointStream, ARetractAboveTheWorkMovesNothing) {
  Setpoint p;
  // On the way from a park position above the clearance.
  SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park));
  while (p.cycle < 20) stream.next(p);
  stream.hold();
  all(stream, p);
  ASSERT_GT(p.position[kY], kPaperClearance + 0.01);
  const Axes held = p.position;
  stream.retract();
  all(stream, p);
  EXPECT_EQ(stream.rest(), Rest::kLifted);
  EXPECT_TRUE((p.position == held).all());
  stream.resume();
  all(stream, p);
  EXPECT_EQ(stream.rest(), Rest::kEnd);
  // On the way back from a jog.
  PaperStroke ride(10e-3);
  ride.stream().hold();
  ride.runToRest();
  ride.stream().retract();
  ride.runToRest();
  p = ride.last();
  jog(ride.stream(), plainMachine(), p, kX, 0.01);
  ride.stream().resume();
  for (int i = 0; i < 20; ++i) ride.next();
  ride.stream().hold();
  ride.runToRest();
  ASSERT_EQ(ride.stream().rest(), Rest::kHeld);
  ride.stream().retract();
  EXPECT_EQ(ride.stream().rest(), Rest::kLifted);
  EXPECT_FALSE(ride.next());
}

}  // namespace test_stream_hold
}  // namespace grinder
