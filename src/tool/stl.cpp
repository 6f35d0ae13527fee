#include "flute_grinder/tool/stl.h"

#include "flute_grinder/base/units.h"

#include <Eigen/Geometry>
#include <boost/endian/conversion.hpp>

#include <cstring>
#include <stdexcept>
#include <string>

namespace grinder {

namespace {

constexpr std::size_t kHeaderSize = 80;
constexpr std::size_t kTriangleSize = 50;

/// Appends a number in little-endian order.
void append(std::string& bytes, std::uint32_t number) {
  boost::endian::native_to_little_inplace(number);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void append(std::string& bytes, const Eigen::Vector3f& v) {
  for (int i = 0; i < 3; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &v[i], sizeof bits);
    append(bytes, bits);
  }
}

}  // namespace

void writeStl(std::ostream& out, const CutterSolid& solid) {
  if (solid.open_edges > 0) {
    throw std::invalid_argument("the solid has " + std::to_string(solid.open_edges) +
                                " open edges; allowed: 0 in an STL file");
  }
  std::string bytes;
  bytes.reserve(solid.triangles.size() * kTriangleSize);
  std::uint32_t count = 0;
  for (const SolidTriangle& t : solid.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3f {
      return (solid.vertices[t.vertices[i]] / units::kMillimetre).cast<float>();
    };
    const Eigen::Vector3f a = corner(0), b = corner(1), c = corner(2);
    if (a == b || b == c || c == a) continue;
    ++count;
    append(bytes, (b - a).cross(c - a).normalized());
    for (const auto& v : {a, b, c}) append(bytes, v);
    bytes.append(2, '\0');
  }
  // A header that begins with "solid" would be taken for the text form of STL.
  std::string head = "flute_grinder, lengths in mm";
  head.resize(kHeaderSize, ' ');
  append(head, count);
  out << head << bytes;
}

}  // namespace grinder
