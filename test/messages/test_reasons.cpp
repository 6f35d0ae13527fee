#include "flute_grinder/messages/reasons.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace grinder {
namespace test_reasons {

bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Reason anyReason() {
  const auto number = [] { return *rc::gen::arbitrary<double>(); };
  Reason r;
  r.kind = static_cast<ReasonKind>(*rc::gen::inRange(0, kReasonKindCount));
  r.axis = *rc::gen::inRange(0, 4);
  r.field = *rc::gen::arbitrary<std::string>();
  r.detail = *rc::gen::arbitrary<std::string>();
  r.unit = static_cast<Unit>(*rc::gen::inRange(0, kUnitCount));
  r.value = number();
  r.low = number();
  r.limit = number();
  r.has_place = *rc::gen::arbitrary<bool>();
  r.move = static_cast<MoveKind>(*rc::gen::inRange(0, kMoveKindCount));
  r.tooth = *rc::gen::inRange(0, 65536);
  r.pass = *rc::gen::inRange(0, 65536);
  r.x = number();
  r.cycle = *rc::gen::arbitrary<std::uint64_t>();
  r.count = *rc::gen::arbitrary<std::uint64_t>();
  return r;
}

RC_GTEST_PROP(ReasonMessage, GoesThereAndBack, ()) {
  const Reason r = anyReason();
  const Reason back = fromMessage(toMessage(r));
  RC_ASSERT(back.kind == r.kind);
  RC_ASSERT(back.axis == r.axis);
  RC_ASSERT(back.field == r.field);
  RC_ASSERT(back.detail == r.detail);
  RC_ASSERT(back.unit == r.unit);
  RC_ASSERT(sameBits(back.value, r.value));
  RC_ASSERT(sameBits(back.low, r.low));
  RC_ASSERT(sameBits(back.limit, r.limit));
  RC_ASSERT(back.has_place == r.has_place);
  RC_ASSERT(back.move == r.move);
  RC_ASSERT(back.tooth == r.tooth);
  RC_ASSERT(back.pass == r.pass);
  RC_ASSERT(sameBits(back.x, r.x));
  RC_ASSERT(back.cycle == r.cycle);
  RC_ASSERT(back.count == r.count);
  for (const UnitSystem units : {UnitSystem::kSi, UnitSystem::kShop}) RC_ASSERT(text(back, units) == text(r, units));
}

TEST(ReasonMessage, ThatIsNoReasonSaysNothing) {
  flute_grinder::Reason good;
  good.kind = flute_grinder::Reason::FOLLOWING_ERROR;
  EXPECT_NE(text(fromMessage(good), UnitSystem::kShop), "");
  for (std::uint8_t flute_grinder::Reason::*member : {&flute_grinder::Reason::kind, &flute_grinder::Reason::axis,
                                                      &flute_grinder::Reason::unit, &flute_grinder::Reason::move}) {
    flute_grinder::Reason message = good;
    message.*member = 200;
    EXPECT_EQ(text(fromMessage(message), UnitSystem::kShop), "");
  }
}

flute_grinder::Reason followingError() {
  flute_grinder::Reason reason;
  reason.kind = flute_grinder::Reason::FOLLOWING_ERROR;
  reason.axis = 1;
  reason.unit = flute_grinder::Reason::METRE;
  reason.value = 0.0012;
  reason.limit = 0.001;
  return reason;
}

constexpr const char* kFollowingError = "axis Y following error 1.2 mm is beyond its limit 1 mm";

TEST(ReasonMessage, OfAFaultIsReadInShopUnits) {
  flute_grinder::GrinderState state;
  EXPECT_EQ(faultText(state), "");
  state.fault = "in its own words";
  EXPECT_EQ(faultText(state), "in its own words");
  state.fault_reason = followingError();
  EXPECT_EQ(faultText(state), kFollowingError);
}

TEST(ReasonMessage, OfAResultIsReadInShopUnits) {
  flute_grinder::GrindResult result;
  result.error_string = "in its own words";
  EXPECT_EQ(resultText(result), "in its own words");
  result.reasons = {followingError(), followingError()};
  EXPECT_EQ(resultText(result), std::string(kFollowingError) + "; " + kFollowingError);
}

TEST(ReasonMessage, OfAPlanIsReadInShopUnits) {
  flute_grinder::Plan::Response plan;
  plan.reasons = {"busy: another job is being planned"};
  EXPECT_EQ(planTexts(plan), plan.reasons);
  plan.violations = {followingError()};
  EXPECT_EQ(planTexts(plan), std::vector<std::string>{kFollowingError});
}

}  // namespace test_reasons
}  // namespace grinder
