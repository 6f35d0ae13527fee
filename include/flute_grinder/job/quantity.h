#pragma once

#include <cstdint>
#include <string>

namespace grinder {

/// The units of quantities. Each stands for one SI unit, in which values are, and one shop unit, in which texts are.
enum class Unit : std::uint8_t {
  kNone,                  ///< a plain number
  kMetre,                 ///< mm
  kMetrePerSecond,        ///< of an axis; mm/s
  kMetrePerSecond2,       ///< mm/s^2
  kMetrePerSecond3,       ///< mm/s^3
  kRadian,                ///< deg
  kRadianPerSecond,       ///< deg/s
  kRadianPerSecond2,      ///< deg/s^2
  kRadianPerSecond3,      ///< deg/s^3
  kSecond,                ///< s
  kFeedMetrePerSecond,    ///< mm/min
  kDeviationMetre,        ///< of the path deviation and its tolerance; um
  kRotaryMetrePerRadian,  ///< mm/rad
};
constexpr int kUnitCount = 13;

/// A number with its unit.
struct Quantity {
  double si = 0;
  Unit unit = Unit::kNone;
};

/// A number and its unit as text in shop units, e.g. "301 mm".
/// @param digits number of significant digits.
std::string text(const Quantity& quantity, int digits = 6);

/// A range as text, e.g. "0.1 to 100 mm". @param to has the unit of `from`.
std::string text(const Quantity& from, const Quantity& to, int digits = 6);

/// SI value divided by shop value, e.g. 0.001 for millimetres.
double shopScale(Unit unit) noexcept;

/// The number of shop units that stands for an SI value in a file: times shopScale() it is that value, to the last bit
/// if any number is, and of those numbers it is one of the fewest digits.
double shopNumber(double si, Unit unit);

/// The unit of an axis position (derivative 0), velocity (1), acceleration (2) or jerk (3).
Unit unitOf(int axis, int derivative) noexcept;

/// The axis name in texts, e.g. "axis X".
std::string axisName(int axis);

}  // namespace grinder
