#pragma once

#include "flute_grinder/tool/cutter_solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

namespace grinder::test_support {

/// How many edges are not passed as often in one direction as in the other.
inline std::size_t openEdges(const CutterSolid& solid) {
  std::map<std::array<double, 3>, std::size_t> places;  // of the vertices, several of which may be at one
  std::vector<std::size_t> place;
  for (const Eigen::Vector3d& v : solid.vertices) {
    place.push_back(places.try_emplace({v.x(), v.y(), v.z()}, places.size()).first->second);
  }
  std::vector<std::pair<std::size_t, std::size_t>> up, down, open;
  for (const SolidTriangle& t : solid.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = place[t.vertices[i]], b = place[t.vertices[(i + 1) % 3]];
      EXPECT_NE(a, b);
      a < b ? up.emplace_back(a, b) : down.emplace_back(b, a);
    }
  }
  std::sort(up.begin(), up.end());
  std::sort(down.begin(), down.end());
  std::set_symmetric_difference(up.begin(), up.end(), down.begin(), down.end(), std::back_inserter(open));
  return open.size();
}

}  // namespace grinder::test_support
