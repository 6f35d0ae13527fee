#pragma once

#include "flute_grinder/base/enum_table.h"

namespace grinder {

/// How Z follows X along a stroke.
enum class ZLaw {
  kPublished,     ///< Z = X tan C sin r, mirrored for a left-hand cutter
  kConstantRake,  ///< the published law with a smooth correction that keeps the rake constant over the whole flute
};
inline constexpr EnumRow<ZLaw> kZLaws[]{
    {ZLaw::kPublished, "published"},
    {ZLaw::kConstantRake, "constant_rake"},
};
constexpr auto& rowsOf(ZLaw) noexcept { return kZLaws; }

}  // namespace grinder
