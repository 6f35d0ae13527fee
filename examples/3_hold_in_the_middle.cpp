// Holds a flute in the middle, and continues it: the axes come to rest on the curve, and nothing of the path is lost.

#include "flute_grinder/curve/stroke.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace grinder;

int main() {
  const Cone cone{0.010, 5 * units::kDegree, 30 * units::kDegree, 8 * units::kDegree, 0.030};
  Stroke stroke(cone, 0, cone.flute_length, {0.010, 0.5, 50});

  StrokePoint p;
  double max = 0;  // error [rad]
  // Until X has come so far, or the axes are at rest: at the end, or held.
  const auto ride = [&](double until) {
    while (p.x < until && stroke.next(p)) max = std::max(max, std::abs(p.error));
  };

  ride(cone.flute_length / 2);
  std::printf("at X = %.3f mm: hold\n", p.x / units::kMillimetre);
  stroke.setFeedOverride(0);
  ride(cone.flute_length);
  std::printf("at rest at X = %.3f mm, %.0e rad off the curve\n", p.x / units::kMillimetre, std::abs(p.error));
  stroke.setFeedOverride(1);
  ride(cone.flute_length);
  std::printf("end at X = %.3f mm; maximum error: %.0e rad\n", p.x / units::kMillimetre, max);
}
