// Streams one flute as CSV: a position for each cycle of 1 ms, from rest to rest, at a constant feed along the cutting
// edge.

#include "flute_grinder/curve/stroke.h"

#include <cstdio>

using namespace grinder;

int main() {
  // D1, C, S, r and the flute's length; 600 mm/min along the edge, and for X 0.5 m/s^2 and 50 m/s^3.
  const Cone cone{0.010, 5 * units::kDegree, 30 * units::kDegree, 8 * units::kDegree, 0.030};
  Stroke stroke(cone, 0, cone.flute_length, {0.010, 0.5, 50});

  std::printf("cycle,x_m,y_m,z_m,a_rad,error_rad\n");
  StrokePoint p;
  for (unsigned long cycle = 0; stroke.next(p); ++cycle) {
    std::printf("%lu,%.9f,%.9f,%.9f,%.12f,%.3e\n", cycle, p.x, p.y, p.z, p.a, p.error);
  }
}
