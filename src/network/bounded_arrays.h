#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace ros::serialization {

/// Reads an array of doubles, such as tooth angles, only if the message is long enough for the claimed count; roscpp
/// would allocate first. Otherwise identical to roscpp's own. Every file that reads or writes messages must see it:
/// CMakeLists.txt includes it in all files of the node.
template <>
struct VectorSerializer<double, std::allocator<double>, void> {
  using Doubles = std::vector<double>;

  template <typename Stream>
  static void write(Stream& stream, const Doubles& numbers) {
    stream.next(static_cast<std::uint32_t>(numbers.size()));
    const auto size = static_cast<std::uint32_t>(numbers.size() * sizeof(double));
    if (size > 0) std::memcpy(stream.advance(size), numbers.data(), size);
  }

  /// @throw StreamOverrunException if the message ends before the array does.
  template <typename Stream>
  static void read(Stream& stream, Doubles& numbers) {
    std::uint32_t count = 0;
    stream.next(count);
    if (count > stream.getLength() / sizeof(double)) throwStreamOverrun();
    numbers.resize(count);
    const auto size = static_cast<std::uint32_t>(count * sizeof(double));
    if (size > 0) std::memcpy(numbers.data(), stream.advance(size), size);
  }

  static std::uint32_t serializedLength(const Doubles& numbers) {
    return static_cast<std::uint32_t>(sizeof(std::uint32_t) + numbers.size() * sizeof(double));
  }
};

}  // namespace ros::serialization
