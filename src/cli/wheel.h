#pragma once

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind wheel show`, `measure` and `dress`.
struct WheelOptions {
  std::string file;
  bool json = false;
  double diameter_mm = 0;           ///< measured diameter
  std::optional<double> width_mm;   ///< measured width
  bool force = false;               ///< accepts a wheel that is larger than before
  std::optional<double> radial_mm;  ///< amount dressed off the radius
  std::optional<double> face_mm;    ///< amount dressed off the width
};

/// Prints a wheel file. @return the exit status.
int showWheel(const WheelOptions& options);

/// Writes a measurement into a wheel file. @return the exit status.
int measureWheel(const WheelOptions& options);

/// Writes a wheel's sizes after dressing into its file. @return the exit status.
int dressWheel(const WheelOptions& options);

}  // namespace grinder
