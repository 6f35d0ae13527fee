#include "flute_grinder/machine/machine_state.h"

#include <gtest/gtest.h>

#include <optional>

namespace grinder {
namespace test_machine_state {

// What holds whatever the table says; where each event leads, test/control sees in the loop.
using S = MachineState;
using E = MachineEvent;

// Power comes back on after a fault by two requests only, and motion by a third.
TEST(MachineState, NothingButResetLeavesFault) {
  for (const EventRow& event : kMachineEvents) {
    const bool leaves = after(S::kFault, event.value).value_or(S::kFault) != S::kFault;
    EXPECT_EQ(leaves, event.value == E::kReset) << event.name;
  }
}

TEST(MachineState, EveryStateHasItsEvents) {
  for (const StateRow& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    const S state = row.value;
    EXPECT_TRUE(after(state, E::kDisable));
    for (const E event : {E::kStart, E::kHome, E::kLift})
      EXPECT_EQ(after(state, event).has_value(), state == S::kReady);
    const bool powered = state != S::kDisabled && state != S::kFault;
    EXPECT_EQ(isPowered(state), powered);
    EXPECT_EQ(after(state, E::kFault).has_value(), powered);
  }
}

TEST(MachineState, AJogLeadsBackToWhereItWasBegun) {
  for (const StateRow& row : kMachineStates) {
    const S from = row.value;
    const std::optional<S> jogging = after(from, E::kJog);
    EXPECT_EQ(jogging.has_value(),
              from == S::kReady || from == S::kRetracted || from == S::kJogging || from == S::kJoggingRetracted)
        << row.name;
    if (from == S::kReady || from == S::kRetracted) {
      EXPECT_EQ(after(*jogging, E::kAtRest), from);
    }
    if (jogging) {
      EXPECT_EQ(after(*jogging, E::kJog), jogging);
    }
  }
  EXPECT_FALSE(isInJob(S::kJogging));
  EXPECT_TRUE(isInJob(S::kJoggingRetracted));
}

TEST(MachineState, WhatIsNoStateOrEventIsRefused) {
  EXPECT_FALSE(after(static_cast<S>(99), E::kEnable));
  EXPECT_FALSE(after(S::kReady, static_cast<E>(99)));
  EXPECT_EQ(allowedIn(static_cast<S>(99)), "");
  EXPECT_STREQ(toString(static_cast<S>(99)), "unknown");
  EXPECT_STREQ(toString(static_cast<E>(99)), "unknown");
}

}  // namespace test_machine_state
}  // namespace grinder
