#include "flute_grinder/messages/reasons.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>

namespace grinder {
namespace test_reasons {

bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(ReasonMessage, HasAllOfAReason) {
  std::mt19937_64 dice(1);
  const auto any = [&](int count) { return static_cast<int>(dice() % static_cast<unsigned>(count)); };
  const auto number = [&] {
    const std::uint64_t bits = dice();
    double number;
    std::memcpy(&number, &bits, sizeof number);
    return number;
  };
  const auto word = [&] { return std::string(dice() % 20, static_cast<char>(dice())); };
  for (int i = 0; i < 1000; ++i) {
    Reason r;
    r.kind = static_cast<ReasonKind>(any(kReasonKindCount));
    r.axis = any(4);
    r.field = word();
    r.detail = word();
    r.unit = static_cast<Unit>(any(kUnitCount));
    r.value = number();
    r.low = number();
    r.limit = number();
    r.has_place = any(2) == 0;
    r.move = static_cast<MoveKind>(any(kMoveKindCount));
    r.tooth = any(65536);
    r.pass = any(65536);
    r.x = number();
    r.cycle = dice();
    r.count = dice();
    const flute_grinder::Reason m = toMessage(r);
    EXPECT_EQ(m.kind, static_cast<int>(r.kind));
    EXPECT_EQ(m.axis, r.axis);
    EXPECT_EQ(m.field, r.field);
    EXPECT_EQ(m.detail, r.detail);
    EXPECT_EQ(m.unit, static_cast<int>(r.unit));
    EXPECT_TRUE(sameBits(m.value, r.value) && sameBits(m.low, r.low) && sameBits(m.limit, r.limit));
    EXPECT_EQ(m.has_place != 0, r.has_place);
    EXPECT_EQ(m.move, static_cast<int>(r.move));
    EXPECT_EQ(m.tooth, r.tooth);
    EXPECT_EQ(m.pass, r.pass);
    EXPECT_TRUE(sameBits(m.x, r.x));
    EXPECT_EQ(m.cycle, r.cycle);
    EXPECT_EQ(m.count, r.count);
  }
}

}  // namespace test_reasons
}  // namespace grinder
