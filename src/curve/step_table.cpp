#include "flute_grinder/curve/step_table.h"

#include <cmath>

namespace grinder {

namespace {

constexpr double kRounding = 1e-12;  ///< relative distance from the flute's end that counts as its end

void add(StepTable& table, const LogCurve& curve, const CurvePoint& point) {
  double& max = table.rows.size() % 2 == 1 ? table.max_odd_error : table.max_even_error;
  table.rows.push_back({point, curve.a(point.x)});
  max = std::max(max, std::abs(table.rows.back().error()));
}

}  // namespace

StepTable interpolateBySteps(const ConicalCutter& cutter, double rotary_scale, EvenStepRule rule, double step_length) {
  const LogCurve curve(cutter);
  OddEvenInterpolator interpolator(curve, rotary_scale, rule, 0);
  StepTable table;
  add(table, curve, interpolator.position());
  const double end = cutter.cone().flute_length * (1 - kRounding);
  while (interpolator.position().x < end) {
    const double x = interpolator.position().x;
    const OddEvenPair pair = interpolator.next(step_length);
    if (!(pair.even.x > x && curve.u(pair.odd.x) > 0 && curve.u(pair.even.x) > 0 && std::isfinite(pair.even.a))) {
      return table;
    }
    add(table, curve, pair.odd);
    add(table, curve, pair.even);
  }
  table.complete = true;
  return table;
}

}  // namespace grinder
