#include "flute_grinder/machine/machine_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace flute_grinder {
namespace test_machine_state {

using ::testing::Combine;
using ::testing::Range;
using ::testing::TestParamInfo;
using ::testing::TestWithParam;

using S = MachineState;
using E = MachineEvent;

/// The state after every event; "-" where it is refused.
constexpr const char* kTable = R"(
state             enable disable   home   start    hold              resume   retract    lift    jog               cancel    reset    done    at_rest   fault   spindle_on spindle_off coolant_on coolant_off
disabled          ready  disabled  -      -        -                 -        -          -       -                 -         disabled -       -         - -          disabled    -          disabled
ready             ready  disabled  homing starting -                 -        -          lifting jogging           -         -        -       -         fault ready      ready       ready      ready
homing            -      disabled  -      -        disabled          -        -          -       -                 disabled  -        ready   -         fault -          homing      -          homing
starting          -      canceling -      -        starting          starting -          -       -                 canceling -        running ready     fault -          -           -          -
running           -      canceling -      -        holding           -        -          -       -                 canceling -        -       ready     fault -          -           -          -
holding           -      canceling -      -        holding           resuming -          -       -                 canceling -        -       held      fault -          -           -          -
held              -      canceling -      -        held              resuming retracting -       -                 canceling -        -       -         fault -          -           -          -
retracting        -      canceling -      -        holding           -        -          -       -                 canceling -        -       retracted fault -          -           -          -
retracted         -      canceling -      -        -                 resuming -          -       jogging_retracted canceling -        -       -         fault -          -           -          -
resuming          -      canceling -      -        holding           -        -          -       -                 canceling -        running -         fault -          -           -          -
canceling         -      canceling -      -        canceling         -        -          -       -                 canceling -        -       ready     fault -          -           -          -
fault             -      fault     -      -        -                 -        -          -       -                 -         disabled -       -         - -          fault       -          fault
lifting           -      lifting   -      -        lifting           -        -          -       -                 lifting   -        -       ready     fault -          lifting     -          lifting
jogging           -      jogging   -      -        jogging           -        -          -       jogging           jogging   -        -       ready     fault jogging    jogging     jogging    jogging
jogging_retracted -      canceling -      -        jogging_retracted -        -          -       jogging_retracted canceling -        -       retracted fault -          -           -          -
)";
const std::vector<S> kStates{S::kDisabled,  S::kReady, S::kHoming,     S::kStarting,  S::kRunning,
                             S::kHolding,   S::kHeld,  S::kRetracting, S::kRetracted, S::kResuming,
                             S::kCanceling, S::kFault, S::kLifting,    S::kJogging,   S::kJoggingRetracted};
const std::vector<E> kEvents{E::kEnable,  E::kDisable, E::kHome,      E::kStart,      E::kHold,      E::kResume,
                             E::kRetract, E::kLift,    E::kJog,       E::kCancel,     E::kReset,     E::kDone,
                             E::kAtRest,  E::kFault,   E::kSpindleOn, E::kSpindleOff, E::kCoolantOn, E::kCoolantOff};

/// The words of the table, row by row.
std::vector<std::vector<std::string>> words() {
  std::vector<std::vector<std::string>> rows;
  std::istringstream table(kTable);
  for (std::string line; std::getline(table, line);) {
    std::istringstream row(line);
    std::vector<std::string> cells{std::istream_iterator<std::string>(row), {}};
    if (!cells.empty()) rows.push_back(std::move(cells));
  }
  return rows;
}

class Table : public TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(Table, Holds) {
  const auto [state, event] = GetParam();
  const std::optional<S> to = after(kStates[state], kEvents[event]);
  EXPECT_EQ(to ? toString(*to) : "-", words().at(state + 1).at(event + 1));
}

std::string cellName(const TestParamInfo<std::tuple<std::size_t, std::size_t>>& info) {
  return words().at(std::get<0>(info.param) + 1).front() + "_" + words().front().at(std::get<1>(info.param) + 1);
}

INSTANTIATE_TEST_SUITE_P(, Table, Combine(Range<std::size_t>(0, 15), Range<std::size_t>(0, 18)), cellName);

TEST(MachineState, StatesHaveNames) {
  for (std::size_t i = 0; i < kStates.size(); ++i) EXPECT_EQ(toString(kStates[i]), words().at(i + 1).front());
}

TEST(MachineState, EventsHaveNames) {
  for (std::size_t i = 0; i < kEvents.size(); ++i) {
    std::string name = toString(kEvents[i]);
    std::replace(name.begin(), name.end(), ' ', '_');
    EXPECT_EQ(name, words().front().at(i + 1));
  }
}

TEST(MachineState, RequestsAreWhatComesFromOutside) {
  for (const E event : {E::kEnable, E::kDisable, E::kHome, E::kStart, E::kHold, E::kResume, E::kRetract, E::kLift,
                        E::kJog, E::kCancel, E::kReset, E::kSpindleOn, E::kSpindleOff, E::kCoolantOn, E::kCoolantOff}) {
    EXPECT_TRUE(isRequest(event)) << toString(event);
  }
  for (const E event : {E::kDone, E::kAtRest, E::kFault}) EXPECT_FALSE(isRequest(event)) << toString(event);
}

// Power comes back on after a fault by two requests only, and motion by a third.
TEST(MachineState, NothingButResetLeavesFault) {
  for (const E event : kEvents) {
    const bool leaves = after(S::kFault, event).value_or(S::kFault) != S::kFault;
    EXPECT_EQ(leaves, event == E::kReset) << toString(event);
  }
}

TEST(MachineState, EveryStateCanBeDisabled) {
  for (const S state : kStates) EXPECT_TRUE(after(state, E::kDisable)) << toString(state);
}

TEST(MachineState, StopsAreHoldCancelAndDisable) {
  for (const E event : kEvents) {
    EXPECT_EQ(isStop(event), event == E::kHold || event == E::kCancel || event == E::kDisable) << toString(event);
  }
}

TEST(MachineState, TriggersAreTheRequestsThatNeitherStopNorTakeArguments) {
  for (const E event : kEvents) {
    const bool takes = event == E::kStart || event == E::kJog;
    EXPECT_EQ(isTrigger(event), isRequest(event) && !isStop(event) && !takes) << toString(event);
  }
}

TEST(MachineState, RequestsHaveServicesButThoseThatGoOtherwise) {
  for (const E event : kEvents) {
    const bool otherwise = event == E::kStart || event == E::kCancel || event == E::kJog;
    const bool by_service = isRequest(event) && !otherwise;
    std::string named = event == E::kReset ? "reset_fault" : toString(event);
    std::replace(named.begin(), named.end(), ' ', '_');
    EXPECT_STREQ(serviceOf(event), by_service ? named.c_str() : nullptr);
  }
}

TEST(MachineState, RequestsSayWhatTheyDo) {
  for (const E event : kEvents) EXPECT_EQ(std::string(rowOf(event).help).empty(), !isRequest(event)) << toString(event);
}

TEST(MachineState, OnlyReadyStartsAJobHomesOrLifts) {
  for (const S state : kStates) {
    EXPECT_EQ(after(state, E::kStart).has_value(), state == S::kReady) << toString(state);
    EXPECT_EQ(after(state, E::kHome).has_value(), state == S::kReady) << toString(state);
    EXPECT_EQ(after(state, E::kLift).has_value(), state == S::kReady) << toString(state);
  }
}

TEST(MachineState, AJogLeadsBackToWhereItWasBegun) {
  for (const S from : kStates) {
    const std::optional<S> jogging = after(from, E::kJog);
    EXPECT_EQ(jogging.has_value(),
              from == S::kReady || from == S::kRetracted || from == S::kJogging || from == S::kJoggingRetracted)
        << toString(from);
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

TEST(MachineState, EveryStateUnderPowerCanFault) {
  for (const S state : kStates) {
    const bool powered = state != S::kDisabled && state != S::kFault;
    EXPECT_EQ(isPowered(state), powered) << toString(state);
    EXPECT_EQ(after(state, E::kFault).has_value(), powered) << toString(state);
  }
}

TEST(MachineState, AllowedInListsTheRequestsOfTheState) {
  EXPECT_EQ(allowedIn(S::kDisabled), "enable, disable, reset");
  EXPECT_EQ(allowedIn(S::kReady), "enable, disable, home, start (grind run), lift, jog");
  EXPECT_EQ(allowedIn(S::kHoming), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kStarting), "disable, hold, resume, cancel");
  EXPECT_EQ(allowedIn(S::kRunning), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kHolding), "disable, hold, resume, cancel");
  EXPECT_EQ(allowedIn(S::kHeld), "disable, hold, resume, retract, cancel");
  EXPECT_EQ(allowedIn(S::kRetracting), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kRetracted), "disable, resume, cancel, jog");
  EXPECT_EQ(allowedIn(S::kResuming), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kCanceling), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kFault), "disable, reset");
  EXPECT_EQ(allowedIn(S::kLifting), "disable, hold, cancel");
  EXPECT_EQ(allowedIn(S::kJogging), "disable, hold, cancel, jog");
  EXPECT_EQ(allowedIn(S::kJoggingRetracted), "disable, hold, cancel, jog");
}

TEST(MachineState, WhatIsNoStateOrEventIsRefused) {
  EXPECT_FALSE(after(static_cast<S>(99), E::kEnable));
  EXPECT_FALSE(after(S::kReady, static_cast<E>(99)));
  EXPECT_EQ(allowedIn(static_cast<S>(99)), "");
  EXPECT_STREQ(toString(static_cast<S>(99)), "unknown");
  EXPECT_STREQ(toString(static_cast<E>(99)), "unknown");
}

}  // namespace test_machine_state
}  // namespace flute_grinder
