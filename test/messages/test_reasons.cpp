#include "flute_grinder/messages/reasons.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <string>

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

RC_GTEST_PROP(ReasonMessage, HasAllOfAReason, ()) {
  const Reason r = anyReason();
  const flute_grinder::Reason m = toMessage(r);
  RC_ASSERT(m.kind == static_cast<int>(r.kind));
  RC_ASSERT(m.axis == r.axis);
  RC_ASSERT(m.field == r.field);
  RC_ASSERT(m.detail == r.detail);
  RC_ASSERT(m.unit == static_cast<int>(r.unit));
  RC_ASSERT(sameBits(m.value, r.value));
  RC_ASSERT(sameBits(m.low, r.low));
  RC_ASSERT(sameBits(m.limit, r.limit));
  RC_ASSERT((m.has_place != 0) == r.has_place);
  RC_ASSERT(m.move == static_cast<int>(r.move));
  RC_ASSERT(m.tooth == r.tooth);
  RC_ASSERT(m.pass == r.pass);
  RC_ASSERT(sameBits(m.x, r.x));
  RC_ASSERT(m.cycle == r.cycle);
  RC_ASSERT(m.count == r.count);
}

}  // namespace test_reasons
}  // namespace grinder
