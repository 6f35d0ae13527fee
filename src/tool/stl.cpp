#include "flute_grinder/tool/stl.h"

#include "flute_grinder/base/units.h"

#include <Eigen/Geometry>
#include <boost/endian/conversion.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace grinder {

namespace {

constexpr std::size_t kHeadSize = 84;  ///< with the number of triangles
constexpr std::size_t kTriangleSize = 50;

/// Appends numbers in little-endian order.
template <std::size_t N>
void append(std::string& bytes, std::array<std::uint32_t, N> numbers) {
  for (std::uint32_t& number : numbers) boost::endian::native_to_little_inplace(number);
  bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
}

}  // namespace

std::string stlOf(const CutterSolid& solid) {
  if (solid.open_edges > 0) {
    throw std::invalid_argument("the solid has " + std::to_string(solid.open_edges) +
                                " open edges; allowed: 0 in an STL file");
  }
  // A header that begins with "solid" would be taken for the text form of STL.
  std::string bytes = "flute_grinder, lengths in mm";
  bytes.reserve(kHeadSize + solid.triangles.size() * kTriangleSize);
  bytes.resize(kHeadSize, ' ');
  for (const SolidTriangle& t : solid.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3f {
      return (solid.vertices[t.vertices[i]] / units::kMillimetre).cast<float>();
    };
    const Eigen::Vector3f a = corner(0), b = corner(1), c = corner(2);
    if (a == b || b == c || c == a) continue;
    Eigen::Matrix<float, 3, 4> facet;
    facet << (b - a).cross(c - a).normalized(), a, b, c;
    std::array<std::uint32_t, 12> bits{};
    std::memcpy(bits.data(), facet.data(), sizeof bits);
    append(bytes, bits);
    bytes.append(2, '\0');
  }
  std::string count;
  append(count, std::array{static_cast<std::uint32_t>((bytes.size() - kHeadSize) / kTriangleSize)});
  bytes.replace(kHeadSize - count.size(), count.size(), count);
  return bytes;
}

}  // namespace grinder
