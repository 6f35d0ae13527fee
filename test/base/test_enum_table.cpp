#include "flute_grinder/base/enum_table.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_enum_table {

enum class Wheel { kPlain, kCup, kDish };

struct WheelRow : EnumRow<Wheel> {
  bool hollow = false;
};
constexpr WheelRow kWheels[]{
    {{Wheel::kPlain, "plain"}, false}, {{Wheel::kCup, "cup"}, true}, {{Wheel::kDish, "dish"}, true}};
constexpr auto& rowsOf(Wheel) noexcept { return kWheels; }

bool isHollow(Wheel wheel) { return rowOf(wheel).hollow; }

TEST(EnumTable, NamesEveryValueAndFindsItByItsName) {
  EXPECT_STREQ(toString(Wheel::kPlain), "plain");
  EXPECT_STREQ(toString(Wheel::kDish), "dish");
  EXPECT_EQ(countOf<Wheel>(), 3);
  EXPECT_EQ(valueOf<Wheel>("cup"), Wheel::kCup);
  for (const char* name : {"", "cu", "cups", "Cup", "unknown"}) EXPECT_EQ(valueOf<Wheel>(name), std::nullopt) << name;
  for (const Wheel wheel : {static_cast<Wheel>(3), static_cast<Wheel>(-1)}) {
    EXPECT_STREQ(toString(wheel), "unknown");
    EXPECT_FALSE(isHollow(wheel));
  }
}

TEST(EnumTable, ListsTheNamesOfSomeOrAll) {
  EXPECT_EQ(namesOf<Wheel>(), "plain, cup, dish");
  EXPECT_EQ(namesOf<Wheel>(isHollow), "cup, dish");
  EXPECT_EQ(namesOf<Wheel>([](Wheel) { return false; }), "");
}

TEST(EnumTable, IsInOrderWithARowForEachValueAtItsPlace) {
  constexpr EnumRow<Wheel> swapped[]{{Wheel::kCup, "cup"}, {Wheel::kPlain, "plain"}};
  constexpr EnumRow<Wheel> gap[]{{Wheel::kPlain, "plain"}, {Wheel::kDish, "dish"}};
  EXPECT_TRUE(isInOrder(kWheels));
  EXPECT_FALSE(isInOrder(swapped));
  EXPECT_FALSE(isInOrder(gap));
}

}  // namespace test_enum_table
}  // namespace grinder
