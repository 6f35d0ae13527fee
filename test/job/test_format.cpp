#include "flute_grinder/job/format.h"

#include <gtest/gtest.h>

#include <string>

namespace grinder {
namespace test_format {

TEST(Format, IsAsByPrintf) {
  EXPECT_EQ(format("X %.3f mm, %zu %s", 1.23456, std::size_t{2}, "teeth"), "X 1.235 mm, 2 teeth");
  EXPECT_EQ(format("%s", ""), "");
}

TEST(Format, CutsNothingOff) {
  const std::string name(100000, 'n');
  EXPECT_EQ(format("<%s>", name.c_str()), "<" + name + ">");
}

}  // namespace test_format
}  // namespace grinder
