#pragma once

#include "flute_grinder/motion/grind_program.h"
#include "second_opinion.h"

#include <random>

namespace grinder::test_support {

using Random = std::mt19937_64;

/// From 0 to below 1, or between two numbers; of the latter, as likely in each decade.
double fraction(Random& random);
double between(Random& random, double low, double high);
double acrossDecades(Random& random, double low, double high);
bool flip(Random& random, double chance);

/// A job, and a machine that can grind it.
struct RideJob {
  ValidJob job;
  Machine machine;
  Axes offset = Axes::Zero();  ///< of the work [m], A [rad]
  double cycles = 0;           ///< that it takes at most, undisturbed
  second_opinion::Asked asked;
};

/// A random job of any operation whose strokes take some hundreds of cycles: one that a plan accepts.
RideJob randomJob(Random& random);

}  // namespace grinder::test_support
