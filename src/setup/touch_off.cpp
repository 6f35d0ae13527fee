#include "flute_grinder/setup/touch_off.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr double kTouchTolerance = 1e-6;  ///< tolerance of the touching place on the wheel, and of its radius [m]

}  // namespace

TouchReadings touchReadings(const GrindJob& job, double above_swivel) {
  const GrindProcess& p = job.process();
  const WheelProfile wheel = wheelOf(job);
  TouchReadings touch;
  touch.y = 0 - p.wheel_wear;
  const Range& widest = wheel.maxPlace();
  touch.z_for_y = -(p.setup_height + (widest.from + widest.to) / 2 * std::cos(p.setup_swivel));
  touch.z = -wheel.lowerFace() - p.setup_height - above_swivel * (1 - std::cos(p.setup_swivel));
  return touch;
}

std::optional<double> wheelAboveSwivel(const std::optional<WheelFile>& wheel, const GrindJob& job,
                                       const MachineGeometry& machine) {
  if (!wheel || !wheel->flange) return std::nullopt;
  GrindProcess upright = job.process();
  upright.setup_swivel = 0;
  return (wheelCentre(machine, upright, *wheel->flange) - machine.swivel_centre).z();
}

double touchX(const GrindJob& job, double diameter) {
  const GrindProcess& p = job.process();
  return (p.setup_height - diameter / 2) / std::tan(p.setup_swivel) +
         wheelOf(job).lowerFace() / std::sin(p.setup_swivel) - p.stock;
}

double touchY(const GrindJob& job, double diameter) {
  return (diameter - job.cutter.end_diameter) / 2 + touchReadings(job).y;
}

std::string heightRefusal(const GrindJob& job, double z) {
  const WheelProfile wheel = wheelOf(job);
  const double height = job.process().setup_height + z;
  const double w = -height / std::cos(job.process().setup_swivel);
  const double on_wheel = std::clamp(w, wheel.lowerFace(), wheel.upperFace());
  const bool meets =
      std::abs(w - on_wheel) <= kTouchTolerance && wheel.radius(on_wheel) >= wheel.maxRadius() - kTouchTolerance;
  if (meets) return "";
  const auto shown = [](double si) { return text(Quantity{si, Unit::kMetre}); };
  return "the wheel's centre is " + shown(height) +
         " above the cutter's axis: there the wheel does not touch a blank with its maximum diameter; move Z to " +
         shown(touchReadings(job).z_for_y) + ", and touch again";
}

}  // namespace grinder
