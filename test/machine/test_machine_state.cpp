#include "flute_grinder/machine/machine_state.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_machine_state {

// Where each event leads, and what each state allows, test/control sees in the loop.
using S = MachineState;
using E = MachineEvent;

TEST(MachineState, KnowsPowerAndJob) {
  for (const StateRow& row : kMachineStates) {
    const S state = row.value;
    const bool powered = state != S::kDisabled && state != S::kFault;
    EXPECT_EQ(isPowered(state), powered) << row.name;
    const bool alone = state == S::kReady || state == S::kHoming || state == S::kLifting || state == S::kJogging;
    EXPECT_EQ(isInJob(state), powered && !alone) << row.name;
  }
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
