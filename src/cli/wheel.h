#pragma once

#include <optional>
#include <string>

namespace grinder {

/// Arguments of `grind wheel show`, `measure` and `dress`.
struct WheelOptions {
  std::string file;
  bool json = false;
  double diameter_mm = 0;           ///< measured
  std::optional<double> width_mm;   ///< measured
  bool force = false;               ///< takes a wheel that is larger than before
  std::optional<double> radial_mm;  ///< dressed off the radius
  std::optional<double> face_mm;    ///< dressed off the width
};

/// Prints a wheel file. @return the exit status.
int showWheel(const WheelOptions& options);

/// Writes a measurement into a wheel file. @return the exit status.
int measureWheel(const WheelOptions& options);

/// Writes into a wheel file what the wheel is after dressing. @return the exit status.
int dressWheel(const WheelOptions& options);

}  // namespace grinder
