// Prints the paper's Table 1: the curve of its cutter, interpolated in odd-even steps of 0.2.

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/step_table.h"

#include <cstdio>

using namespace grinder;

int main() {
  Cone cone;
  cone.end_diameter = 10 * units::kMillimetre;
  cone.cone_angle = 5 * units::kDegree;
  cone.spiral_angle = 30 * units::kDegree;
  cone.rake_angle = 8 * units::kDegree;
  cone.flute_length = 30 * units::kMillimetre;

  // The paper measures X in mm and A in rad, so that one radian counts for a millimetre.
  const StepTable table = interpolateBySteps(ConicalCutter(cone), units::kMillimetrePerRadian, EvenStepRule::kPublished,
                                             0.2 * units::kMillimetre);

  std::printf("point   X [mm]  A [rad]  error [1e-4 rad]\n");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const StepTable::Row& row = table.rows[i];
    std::printf("%5zu  %7.4f  %7.4f  %16.4f\n", i, row.point.x / units::kMillimetre, row.point.a, row.error() / 1e-4);
  }
  std::printf("%zu points; maximum error %.4e rad (odd), %.4e rad (even)\n", table.rows.size() - 1, table.max_odd_error,
              table.max_even_error);
}
