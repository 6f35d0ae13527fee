#pragma once

/// @file
/// The factors between the operator's units (mm, deg, mm/min, um) and the SI units of the code: multiply to convert to
/// SI, divide to convert back.
namespace grinder::units {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMillimetre = 1e-3;                         ///< [m]
constexpr double kMicrometre = 1e-6;                         ///< [m]
constexpr double kDegree = kPi / 180;                        ///< [rad]
constexpr double kTurn = 2 * kPi;                            ///< [rad]
constexpr double kMillimetrePerMinute = 1e-3 / 60;           ///< [m/s]
constexpr double kMillimetrePerRadian = kMillimetre;         ///< [m/rad]
constexpr double kMillimetre2 = kMillimetre * kMillimetre;   ///< [m^2]
constexpr double kMillimetre3 = kMillimetre2 * kMillimetre;  ///< [m^3], or [m^3/s] of mm^3/s

}  // namespace grinder::units
