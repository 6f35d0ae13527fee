#include "flute_grinder/base/quantity.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <array>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

struct ShopUnit {
  const char* symbol;
  double scale;  ///< SI value divided by shop value
};

using namespace units;

constexpr std::array<ShopUnit, kUnitCount> kShopUnits{{
    {"", 1},
    {"mm", kMillimetre},
    {"mm/s", kMillimetre},
    {"mm/s^2", kMillimetre},
    {"mm/s^3", kMillimetre},
    {"deg", kDegree},
    {"deg/s", kDegree},
    {"deg/s^2", kDegree},
    {"deg/s^3", kDegree},
    {"s", 1},
    {"mm/min", kMillimetrePerMinute},
    {"um", kMicrometre},
    {"mm/rad", kMillimetrePerRadian},
    {"mm^3/s", kMillimetre3},
}};

const ShopUnit& shopUnitOf(Unit unit) { return kShopUnits[static_cast<std::size_t>(unit)]; }

std::string number(const Quantity& quantity, int digits) {
  // A zero loses its sign.
  return format("%.*g", digits, quantity.si / shopScale(quantity.unit) + 0.0);
}

}  // namespace

std::string text(const Quantity& quantity, int digits) {
  const std::string symbol = shopUnit(quantity.unit);
  return number(quantity, digits) + (symbol.empty() ? "" : " " + symbol);
}

std::string text(const Quantity& from, const Quantity& to, int digits) {
  return number(from, digits) + " to " + text(to, digits);
}

const char* shopUnit(Unit unit) noexcept { return shopUnitOf(unit).symbol; }

double shopScale(Unit unit) noexcept { return shopUnitOf(unit).scale; }

double shopNumber(double si, Unit unit) {
  const double scale = shopScale(unit);
  const double quotient = si / scale;
  constexpr int all_digits = std::numeric_limits<double>::max_digits10;
  for (int digits = 1; digits <= all_digits; ++digits) {
    const double rounded = parseNumber(format("%.*g", digits, quotient).c_str());
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

std::string axisName(int axis) { return std::string("axis ") + axisLetter(axis); }

}  // namespace grinder
