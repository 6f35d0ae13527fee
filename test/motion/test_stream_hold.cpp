// A stream that is held, slowed down and given other feeds at any moment.

#include "flute_grinder/motion/setpoint_stream.h"

#include "flute_grinder/motion/limit_check.h"

#include "stream_checks.h"
#include "stream_rides.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace grinder {
namespace test_stream_hold {

using namespace test_support;

TEST(SetpointStream, HeldBeforeItBeginsDoesNotMove) {
  SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park));
  stream.hold();
  const auto setpoints = all(stream);
  ASSERT_EQ(setpoints.size(), 1u);
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

RC_GTEST_PROP(SetpointStreamProperty, HoldsAndOverridesLeaveTheStrokesWholeAndKeepAllLimitsAndThePapersConstruction,
              ()) {
  const Work work = *toothedWork(kCycles / 3);
  const auto undisturbed = all(work);
  const auto moments = momentsInStrokes(undisturbed, 3);
  const Ride ride = rideWithHoldsAndOverrides(work, moments);
  RC_ASSERT(ride.requests_in_strokes >= 6);  // three for each of two teeth at least: some hundreds in all
  const auto setpoints = ride.setpoints();
  for (std::size_t i = 0; i < setpoints.size(); ++i) RC_ASSERT(setpoints[i].cycle == i);
  RC_ASSERT(movesOf(setpoints) == movesOf(undisturbed));
  checkStrokes(setpoints, work);
  RC_ASSERT(maxDeviation(setpoints, work.job) <= allowedDeviation(undisturbed, work.job));
  RC_ASSERT((setpoints.back().position == work.machine.park).all());
  RC_ASSERT(beyondLimits(ride.seen_by_machine, work.machine) == "");  // so that each hold comes to rest
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");             // and none needs a rest to be gone on from
  RC_ASSERT(offTheConstruction(setpoints, work.job, 1 + setpoints.size() / 200) == "");
}

RC_GTEST_PROP(SetpointStreamProperty, HoldsOverridesAndRetractsKeepToATightTolerance, ()) {
  Work work = *test_support::work(kCycles / 3);
  work.job.interpolation.even_step = *rc::gen::element(EvenStepRule::kThirdOrder, EvenStepRule::kExact);
  const double without = maxDeviation(all(work), work.job);
  RC_PRE(without > 1e-12);
  work.job.interpolation.tolerance = without * *uniform(0.3, 3);  // at a third it cuts the feed to some half
  const auto undisturbed = all(work);
  const double allowed = work.job.interpolation.tolerance * (1 + 1e-9) + noiseOfDeviation(undisturbed, work.job);
  RC_ASSERT(maxDeviation(undisturbed, work.job) <= allowed);
  const Ride ride = rideWithHoldsAndOverrides(work, momentsInStrokes(undisturbed, 3));
  RC_ASSERT(maxDeviation(ride.setpoints(), work.job) <= allowed);
  RC_ASSERT(maxDeviation(rideWithRetracts(work, undisturbed, 3).setpoints(), work.job) <= allowed);
}

/// Slowed down at random moments, held and brought up again now and then.
RC_GTEST_PROP(SetpointStreamProperty, SlowedDownAtAnyMomentItKeepsTheLimitsOfAxesThatStood, ()) {
  const Work work = *test_support::work(kCycles);
  SetpointStream stream(work.program());
  LimitCheck check(work.machine.limits, work.machine.period);
  check.restart(stream.program().terms());
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> chance(0, 1), periods(2, 10);
  const double share = *logUniform(1e-3, 0.3);
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

}  // namespace test_stream_hold
}  // namespace grinder
