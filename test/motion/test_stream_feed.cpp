// The feed of a stream's strokes, as planned and overridden.

#include "flute_grinder/motion/setpoint_stream.h"

#include "stream_checks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

namespace grinder {
namespace test_stream_feed {

using namespace test_support;

RC_GTEST_PROP(SetpointStreamProperty, AtFeedEveryPairGoesAtTheFeedAsOverridden, ()) {
  const Work work = *test_support::work(kCycles);
  SetpointStream stream(work.program());
  const FeedSchedule& schedule = stream.program().schedule();
  const double edge = edgePerTravel(work.job.cutter);
  if (schedule.feedLimits().empty()) {
    RC_ASSERT(std::abs(schedule.feedSpeed() * edge - work.job.process().feed) <= 1e-12 * work.job.process().feed);
  }
  const double fraction = *rc::gen::oneOf(rc::gen::just(1.0), uniform(0.1, 1.2));
  stream.setFeedOverride(fraction);
  const double speed = std::min(fraction * schedule.feedSpeed(), schedule.limits().velocity);
  const double pair = 2 * speed * work.machine.period;
  const auto setpoints = all(stream);
  const double rounding = roundingOf(setpoints)[kX];
  for (const SeenPair& s : pairsOf(setpoints)) {
    RC_ASSERT(s.odd.at_feed == s.even.at_feed);
    RC_ASSERT(s.even.feed <= speed * edge * (1 + 1e-9));
    if (!s.odd.at_feed) continue;
    RC_ASSERT(std::abs(std::abs(s.even.position[kX] - s.start.position[kX]) - pair) <= 1e-6 * pair + 2 * rounding);
    RC_ASSERT(std::abs(s.even.feed - speed * edge) <= 1e-9 * speed * edge);
  }
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");
}

/// Of the paper's job where nothing cuts the feed, in X. [m/s]
double paperSpeed() { return 0.01 / edgePerTravel(paperJob().cutter); }

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
    SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park));
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
  const Work work = *toothedWork(kCycles / 3);
  SetpointStream stream(work.program());
  stream.setFeedOverride(*uniform(0.1, 1.2));
  RC_ASSERT(rapidsOf(all(stream)) == rapidsOf(all(work)));
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

}  // namespace test_stream_feed
}  // namespace grinder
