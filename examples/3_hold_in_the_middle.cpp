// Holds a flute in the middle, and continues it: the axes come to rest on the curve, and nothing of the path is lost.

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/s_curve_profile.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace grinder;

int main() {
  constexpr double kPeriod = 0.001;  // of the control cycle [s]
  constexpr double kSpeed = 0.0086;  // of X [m/s]
  constexpr double kLength = 0.030;  // of the flute [m]

  const LogCurve curve(2 * std::tan(5 * units::kDegree) / 0.010, 2 * std::tan(30 * units::kDegree) / 0.010);
  OddEvenInterpolator interpolator(curve, units::kMillimetrePerRadian, EvenStepRule::kThirdOrder, 0);
  SCurveProfile law({kSpeed, 0.5, 50}, kLength, kSpeed);

  double max = 0;  // error of the pairs' ends [rad]
  // Until the law is at rest: at its end, or because its target is 0.
  const auto ride = [&](double until) {
    while (!law.resting() && law.position() < until) {
      law.advance(2 * kPeriod);
      const CurvePoint even = interpolator.advance(law.position() - interpolator.position().x).even;
      max = std::max(max, std::abs(curve.a(even.x) - even.a));
    }
  };

  ride(kLength / 2);
  std::printf("at X = %.3f mm: hold\n", interpolator.position().x / units::kMillimetre);
  law.setTarget(0);
  ride(kLength);
  std::printf("at rest at X = %.3f mm, %.0e rad off the curve\n", interpolator.position().x / units::kMillimetre,
              std::abs(curve.a(interpolator.position().x) - interpolator.position().a));
  law.setTarget(kSpeed);
  ride(kLength);
  std::printf("end at X = %.3f mm; maximum error of an even point: %.0e rad\n",
              interpolator.position().x / units::kMillimetre, max);
}
