#pragma once

#include "flute_grinder/tool/cutter_solid.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace grinder::test_support {

using Corner = std::array<double, 3>;

/// How many edges are not passed once in each direction.
inline std::size_t openEdges(const CutterSolid& solid) {
  std::map<std::pair<Corner, Corner>, int> passed;
  const auto corner = [&](std::uint32_t i) {
    return Corner{solid.vertices[i].x(), solid.vertices[i].y(), solid.vertices[i].z()};
  };
  for (const SolidTriangle& t : solid.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner a = corner(t.vertices[i]), b = corner(t.vertices[(i + 1) % 3]);
      EXPECT_NE(a, b);
      passed[a < b ? std::pair(a, b) : std::pair(b, a)] += a < b ? 1 : -1;
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, times] : passed) open += times != 0;
  return open;
}

}  // namespace grinder::test_support
