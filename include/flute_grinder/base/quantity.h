#pragma once

#include <cstdint>
#include <string>

namespace grinder {

/// The units of quantities. Each stands for one SI unit, used for values, and one shop unit, used in texts.
enum class Unit : std::uint8_t {
  kNone,                  ///< a plain number
  kMetre,                 ///< mm
  kMetrePerSecond,        ///< axis speed; mm/s
  kMetrePerSecond2,       ///< mm/s^2
  kMetrePerSecond3,       ///< mm/s^3
  kRadian,                ///< deg
  kRadianPerSecond,       ///< deg/s
  kRadianPerSecond2,      ///< deg/s^2
  kRadianPerSecond3,      ///< deg/s^3
  kSecond,                ///< s
  kFeedMetrePerSecond,    ///< mm/min
  kDeviationMetre,        ///< path deviation and its tolerance; um
  kRotaryMetrePerRadian,  ///< mm/rad
  kCubicMetrePerSecond,   ///< volume removed per second; mm^3/s
};
constexpr int kUnitCount = 14;

/// A number with its unit.
struct Quantity {
  double si = 0;
  Unit unit = Unit::kNone;
};

/// A number and its unit as text in shop units, e.g. "301 mm".
/// @param digits number of significant digits.
std::string text(const Quantity& quantity, int digits = 6);

/// A range as text, e.g. "0.1 to 100 mm".
/// @param to upper end, in the unit of `from`.
std::string text(const Quantity& from, const Quantity& to, int digits = 6);

/// The symbol of the shop unit, e.g. "mm"; empty for a plain number.
const char* shopUnit(Unit unit) noexcept;

/// SI value divided by shop value, e.g. 0.001 for millimetres.
double shopScale(Unit unit) noexcept;

/// The number in shop units that stands for an SI value in a file. Multiplied by shopScale() it gives the SI value to
/// the last bit, if any number does; of these numbers, it has the fewest digits.
double shopNumber(double si, Unit unit);

/// The unit of an axis position (derivative 0), velocity (1), acceleration (2) or jerk (3).
Unit unitOf(int axis, int derivative) noexcept;

/// The axis name in texts, e.g. "axis X".
std::string axisName(int axis);

}  // namespace grinder
