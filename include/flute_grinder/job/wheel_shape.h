#pragma once

#include "flute_grinder/base/enum_table.h"

namespace grinder {

/// The shape of a grinding wheel.
enum class WheelShape { kStraight, kAngled, kFullRadius, kCup, kPoints };
/// The face of a wheel, as the machine carries it.
enum class WheelFace { kUpper, kLower };
inline constexpr EnumRow<WheelShape> kWheelShapes[]{
    {WheelShape::kStraight, "straight"}, {WheelShape::kAngled, "angled"}, {WheelShape::kFullRadius, "full_radius"},
    {WheelShape::kCup, "cup"},           {WheelShape::kPoints, "points"},
};
inline constexpr EnumRow<WheelFace> kWheelFaces[]{
    {WheelFace::kUpper, "upper"},
    {WheelFace::kLower, "lower"},
};
constexpr auto& rowsOf(WheelShape) noexcept { return kWheelShapes; }
constexpr auto& rowsOf(WheelFace) noexcept { return kWheelFaces; }
/// Whether a wheel of the shape has one face larger than the other.
constexpr bool isTapered(WheelShape shape) noexcept {
  return shape == WheelShape::kAngled || shape == WheelShape::kCup;
}

/// A corner of a wheel's profile.
struct ProfilePoint {
  double w = 0;       ///< position along the spindle, from the middle of the width [m]
  double radius = 0;  ///< distance from the spindle's axis [m]
};

}  // namespace grinder
