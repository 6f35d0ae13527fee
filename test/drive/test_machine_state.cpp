#include "flute_grinder/drive/machine_state.h"

#include <gtest/gtest.h>

#include <optional>
#include <ostream>
#include <string>

namespace flute_grinder {
namespace {

using ::testing::TestParamInfo;
using ::testing::TestWithParam;
using ::testing::Values;

using S = MachineState;
using E = MachineEvent;

constexpr std::optional<S> kRefused = std::nullopt;

struct Row {
  S from;
  E event;
  std::optional<S> to;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << toString(row.from) << " + " << toString(row.event);
}

class Table : public TestWithParam<Row> {};

TEST_P(Table, Holds) {
  const std::optional<S> to = after(GetParam().from, GetParam().event);
  ASSERT_EQ(to.has_value(), GetParam().to.has_value()) << (to ? toString(*to) : "refused");
  if (to) {
    EXPECT_EQ(*to, *GetParam().to) << toString(*to);
  }
}

INSTANTIATE_TEST_SUITE_P(, Table,
                         Values(Row{S::kDisabled, E::kEnable, S::kReady},       //
                                Row{S::kDisabled, E::kDisable, S::kDisabled},   //
                                Row{S::kDisabled, E::kStart, kRefused},         //
                                Row{S::kDisabled, E::kCancel, kRefused},        //
                                Row{S::kDisabled, E::kReset, S::kDisabled},     //
                                Row{S::kDisabled, E::kFinished, kRefused},      //
                                Row{S::kDisabled, E::kFault, kRefused},         //
                                Row{S::kReady, E::kEnable, S::kReady},          //
                                Row{S::kReady, E::kDisable, S::kDisabled},      //
                                Row{S::kReady, E::kStart, S::kRunning},         //
                                Row{S::kReady, E::kCancel, kRefused},           //
                                Row{S::kReady, E::kReset, kRefused},            //
                                Row{S::kReady, E::kFinished, kRefused},         //
                                Row{S::kReady, E::kFault, S::kFault},           //
                                Row{S::kRunning, E::kEnable, kRefused},         //
                                Row{S::kRunning, E::kDisable, kRefused},        //
                                Row{S::kRunning, E::kStart, kRefused},          //
                                Row{S::kRunning, E::kCancel, S::kCanceling},    //
                                Row{S::kRunning, E::kReset, kRefused},          //
                                Row{S::kRunning, E::kFinished, S::kReady},      //
                                Row{S::kRunning, E::kFault, S::kFault},         //
                                Row{S::kCanceling, E::kEnable, kRefused},       //
                                Row{S::kCanceling, E::kDisable, kRefused},      //
                                Row{S::kCanceling, E::kStart, kRefused},        //
                                Row{S::kCanceling, E::kCancel, S::kCanceling},  //
                                Row{S::kCanceling, E::kReset, kRefused},        //
                                Row{S::kCanceling, E::kFinished, S::kReady},    //
                                Row{S::kCanceling, E::kFault, S::kFault},       //
                                Row{S::kFault, E::kEnable, kRefused},           //
                                Row{S::kFault, E::kDisable, kRefused},          //
                                Row{S::kFault, E::kStart, kRefused},            //
                                Row{S::kFault, E::kCancel, kRefused},           //
                                Row{S::kFault, E::kReset, S::kDisabled},        //
                                Row{S::kFault, E::kFinished, kRefused},         //
                                Row{S::kFault, E::kFault, kRefused}),
                         [](const TestParamInfo<Row>& info) {
                           return std::string(toString(info.param.from)) + "_" + toString(info.param.event);
                         });

// Power comes back on after a fault by two requests only, and motion by a third.
TEST(MachineState, NothingButResetLeavesFault) {
  for (const E event : {E::kEnable, E::kDisable, E::kStart, E::kCancel, E::kFinished, E::kFault}) {
    EXPECT_FALSE(after(S::kFault, event)) << toString(event);
  }
}

TEST(MachineState, OnlyReadyStartsAJob) {
  for (const S state : {S::kDisabled, S::kRunning, S::kCanceling, S::kFault}) {
    EXPECT_FALSE(after(state, E::kStart)) << toString(state);
  }
  EXPECT_TRUE(after(S::kReady, E::kStart));
}

TEST(MachineState, AllowedInListsTheRequestsOfTheState) {
  EXPECT_EQ(allowedIn(S::kDisabled), "enable, disable, reset");
  EXPECT_EQ(allowedIn(S::kReady), "enable, disable, start");
  EXPECT_EQ(allowedIn(S::kRunning), "cancel");
  EXPECT_EQ(allowedIn(S::kCanceling), "cancel");
  EXPECT_EQ(allowedIn(S::kFault), "reset");
}

TEST(MachineState, AllowedInLeavesOutWhatTheLoopAloneSees) {
  for (const S state : {S::kDisabled, S::kReady, S::kRunning, S::kCanceling, S::kFault}) {
    EXPECT_EQ(allowedIn(state).find("finished"), std::string::npos) << toString(state);
    EXPECT_EQ(allowedIn(state).find("fault"), std::string::npos) << toString(state);
  }
}

TEST(MachineState, StatesHaveNames) {
  EXPECT_STREQ(toString(S::kDisabled), "disabled");
  EXPECT_STREQ(toString(S::kReady), "ready");
  EXPECT_STREQ(toString(S::kRunning), "running");
  EXPECT_STREQ(toString(S::kCanceling), "canceling");
  EXPECT_STREQ(toString(S::kFault), "fault");
}

TEST(MachineState, EventsHaveNames) {
  EXPECT_STREQ(toString(E::kEnable), "enable");
  EXPECT_STREQ(toString(E::kDisable), "disable");
  EXPECT_STREQ(toString(E::kStart), "start");
  EXPECT_STREQ(toString(E::kCancel), "cancel");
  EXPECT_STREQ(toString(E::kReset), "reset");
  EXPECT_STREQ(toString(E::kFinished), "finished");
  EXPECT_STREQ(toString(E::kFault), "fault");
}

TEST(MachineState, WhatIsNoStateOrEventIsRefused) {
  EXPECT_FALSE(after(static_cast<S>(99), E::kEnable));
  EXPECT_FALSE(after(S::kReady, static_cast<E>(99)));
  EXPECT_EQ(allowedIn(static_cast<S>(99)), "");
}

}  // namespace
}  // namespace flute_grinder
