// Streams one flute as CSV: a setpoint for each cycle of 1 ms, from rest to rest, at a constant feed along the cutting
// edge.

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/s_curve_profile.h"

#include <cstdio>

using namespace grinder;

int main() {
  constexpr double kPeriod = 0.001;  // of the control cycle [s]
  constexpr double kFeed = 0.010;    // along the edge: 600 mm/min [m/s]

  Cone cone;
  cone.end_diameter = 10 * units::kMillimetre;
  cone.cone_angle = 5 * units::kDegree;
  cone.spiral_angle = 30 * units::kDegree;
  cone.rake_angle = 8 * units::kDegree;
  cone.flute_length = 30 * units::kMillimetre;
  const ConicalCutter cutter(cone);
  const LogCurve curve(cutter);
  OddEvenInterpolator interpolator(curve, units::kMillimetrePerRadian, EvenStepRule::kThirdOrder, 0);

  // On a cone of constant spiral angle, a constant feed along the edge is a constant speed of X.
  const double speed = kFeed / cutter.edgePerTravel();
  SCurveProfile law({speed, 0.5, 50}, cone.flute_length, speed);  // m/s, m/s^2, m/s^3

  unsigned long cycle = 0;
  const auto print = [&](const CurvePoint& point) {
    std::printf("%lu,%.9f,%.9f,%.9f,%.12f,%.3e\n", cycle++, point.x, cutter.y(point.x), cutter.z(point.x), point.a,
                curve.a(point.x) - point.a);
  };
  std::printf("cycle,x_m,y_m,z_m,a_rad,error_rad\n");
  print(interpolator.position());
  while (!law.finished()) {
    // A pair takes two cycles. The law says how far X is at its end; both steps of the pair have the same length.
    law.advance(2 * kPeriod);
    const OddEvenPair pair = interpolator.advance(law.position() - interpolator.position().x);
    print(pair.odd);
    print(pair.even);
  }
}
