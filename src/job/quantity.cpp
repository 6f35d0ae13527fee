#include "flute_grinder/job/quantity.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/axes.h"
#include "flute_grinder/job/format.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace grinder {

namespace {

struct Symbols {
  const char* si;
  const char* shop;
  double scale;  ///< SI value divided by shop value
};

using namespace units;

constexpr std::array<Symbols, kUnitCount> kSymbols{{
    {"", "", 1},
    {" m", " mm", kMillimetre},
    {" m/s", " mm/s", kMillimetre},
    {" m/s^2", " mm/s^2", kMillimetre},
    {" m/s^3", " mm/s^3", kMillimetre},
    {" rad", " deg", kDegree},
    {" rad/s", " deg/s", kDegree},
    {" rad/s^2", " deg/s^2", kDegree},
    {" rad/s^3", " deg/s^3", kDegree},
    {" s", " s", 1},
    {" m/s", " mm/min", kMillimetrePerMinute},
    {" m", " um", kMicrometre},
    {" m/rad", " mm/rad", kMillimetrePerRadian},
}};

const Symbols& symbolsOf(Unit unit) { return kSymbols[static_cast<std::size_t>(unit)]; }

std::string number(const Quantity& quantity, UnitSystem units, int digits) {
  const double value = units == UnitSystem::kSi ? quantity.si : quantity.si / shopScale(quantity.unit);
  return format("%.*g", digits, value);
}

}  // namespace

std::string text(const Quantity& quantity, UnitSystem units, int digits) {
  const Symbols& symbols = symbolsOf(quantity.unit);
  return number(quantity, units, digits) + (units == UnitSystem::kSi ? symbols.si : symbols.shop);
}

std::string text(const Quantity& from, const Quantity& to, UnitSystem units, int digits) {
  return number(from, units, digits) + " to " + text(to, units, digits);
}

double shopScale(Unit unit) noexcept { return symbolsOf(unit).scale; }

double shopNumber(double si, Unit unit) {
  const double scale = shopScale(unit);
  const double quotient = si / scale;
  constexpr int all_digits = std::numeric_limits<double>::max_digits10;
  for (int digits = 1; digits <= all_digits; ++digits) {
    const double rounded = std::strtod(format("%.*g", digits, quotient).c_str(), nullptr);
    if (rounded * scale == si) return rounded;
  }
  // The quotient is rounded too.
  for (const double way : {-HUGE_VAL, HUGE_VAL}) {
    const double neighbour = std::nextafter(quotient, way);
    if (neighbour * scale == si) return neighbour;
  }
  return quotient;
}

Unit unitOf(int axis, int derivative) noexcept {
  const Unit position = axis == kA ? Unit::kRadian : Unit::kMetre;
  return static_cast<Unit>(static_cast<int>(position) + derivative);
}

std::string axisName(int axis, UnitSystem units) {
  const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
  return units == UnitSystem::kSi ? joint : std::string("axis ") + "XYZA"[axis];
}

}  // namespace grinder
