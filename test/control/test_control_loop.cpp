#include "flute_grinder/control/control_loop.h"

#include "control/fixtures.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <thread>

namespace flute_grinder {
namespace {

using testing::allSetpoints;
using testing::bringTo;
using testing::FakeDrive;
using testing::machineConfig;
using testing::Rig;
using testing::sameBits;
using testing::sameSetpoints;
using ::testing::TestParamInfo;
using ::testing::TestWithParam;
using testing::toAxes;
using ::testing::Values;
using ::testing::ValuesIn;

using S = MachineState;
using E = MachineEvent;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ---------------------------------------------------------------------------------------------------------------------
// Construction

/// Offers only what it is told to.
class BareDrive : public RobotHW {
 public:
  bool init(ros::NodeHandle&, ros::NodeHandle&) override { return true; }
  void read(const ros::Time&, const ros::Duration&) override {}
  void write(const ros::Time&, const ros::Duration&) override {}
};

std::string constructionError(RobotHW& hw) {
  try {
    std::make_unique<ControlLoop>(hw, machineConfig());
  } catch (const HardwareInterfaceException& error) {
    return error.what();
  }
  return "";
}

TEST(ControlLoopConstruction, NamesTheInterfaceTheDriveLacks) {
  BareDrive drive;
  EXPECT_CONTAINS(constructionError(drive), "JointStateInterface");
  JointStateInterface states;
  drive.registerInterface(&states);
  EXPECT_CONTAINS(constructionError(drive), "PositionJointInterface");
}

TEST(ControlLoopConstruction, NamesTheJointTheDriveLacks) {
  BareDrive drive;
  double value = 0;
  JointStateInterface states;
  PositionJointInterface joints;
  for (const char* name : {"axis_x", "axis_y", "axis_z"}) {
    joints.registerHandle(JointHandle(JointStateHandle(name, &value, &value, &value), &value));
  }
  drive.registerInterface(&states);
  drive.registerInterface(&joints);
  EXPECT_CONTAINS(constructionError(drive), "axis_a");
}

TEST(ControlLoopConstruction, NamesTheDriveInterfaceAndHandleTheDriveLacks) {
  BareDrive drive;
  double value = 0;
  JointStateInterface states;
  PositionJointInterface joints;
  for (const char* name : kJointNames) {
    joints.registerHandle(JointHandle(JointStateHandle(name, &value, &value, &value), &value));
  }
  drive.registerInterface(&states);
  drive.registerInterface(&joints);
  EXPECT_CONTAINS(constructionError(drive), "DriveInterface");
  DriveInterface signals;
  drive.registerInterface(&signals);
  EXPECT_CONTAINS(constructionError(drive), "'drive'");
}

// ---------------------------------------------------------------------------------------------------------------------
// Disabled

TEST(ControlLoopDisabled, StartsDisabledWithoutPower) {
  Rig<FakeDrive> rig;
  rig.run(3);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  EXPECT_FALSE(rig.last().has_setpoint);
}

TEST(ControlLoopDisabled, CommandsFollowThePositions) {
  Rig<FakeDrive> rig;
  for (double step = 1; step < 5; ++step) {
    const Axes at(0.01 * step, -0.003 * step, 0.002 * step, 7.1 * step);
    rig.drive.place(at);
    rig.cycle();
    EXPECT_TRUE(sameBits(toAxes(rig.drive.written), at));
    EXPECT_TRUE(sameBits(rig.last().command, at));
  }
}

TEST(ControlLoopDisabled, CommandsKeepTheLastGoodPositionWhileOneIsNotANumber) {
  Rig<FakeDrive> rig;
  const Axes good = toAxes(rig.drive.position);
  rig.cycle();
  rig.drive.place({0.01, kNan, 0.01, 0.01});
  rig.cycle();
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), good));
}

TEST(ControlLoopDisabled, RecordsWhatWasRead) {
  Rig<FakeDrive> rig;
  rig.drive.place({0.01, 0.02, 0.03, 0.04});
  rig.drive.velocity = {1, 2, 3, 4};
  rig.drive.status.emergency_stop = true;
  const CycleRecord& record = rig.cycle();
  EXPECT_TRUE(sameBits(record.position, Axes(0.01, 0.02, 0.03, 0.04)));
  EXPECT_TRUE(sameBits(record.velocity, Axes(1, 2, 3, 4)));
  EXPECT_TRUE(record.drive.emergency_stop);
  EXPECT_TRUE(record.drive.homed);
  EXPECT_EQ(record.drive.feedback_count, 1u);
  EXPECT_DOUBLE_EQ(record.time, 1000.001);
  EXPECT_DOUBLE_EQ(record.period, 0.001);
}

TEST(ControlLoopDisabled, AnEmergencyStopWithoutPowerIsNoFault) {
  Rig<FakeDrive> rig;
  rig.drive.status.emergency_stop = true;
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled);
}

// ---------------------------------------------------------------------------------------------------------------------
// Enable

TEST(ControlLoopEnable, IsAnsweredOncePowerIsThere) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  EXPECT_EQ(rig.cycle().state, S::kDisabled);
  EXPECT_TRUE(rig.drive.written_drive.enable);
  EXPECT_FALSE(rig.loop->reply());
  EXPECT_EQ(rig.cycle().state, S::kReady);
  const auto answer = rig.loop->reply();
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted);
}

TEST(ControlLoopEnable, MovesNothing) {
  Rig<SimulatedDrive> rig;
  const Axes before = rig.run(2).position;
  rig.enable();
  rig.run(100);
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(sameBits(rig.last().position, before)) << rig.last().position.transpose();
}

TEST(ControlLoopEnable, TakesTheCommandsFromThePositionsAtTheMomentOfPower) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.cycle();
  const Axes sagged(-0.0501, 0.0502, 0.0003, 0.004);
  rig.drive.on_read = [&](FakeDrive& drive) { drive.place(sagged); };
  rig.cycle();
  ASSERT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), sagged));
}

struct RefusalCase {
  const char* name;
  std::function<void(FakeDrive&)> spoil;
  const char* reason;
};
std::ostream& operator<<(std::ostream& out, const RefusalCase& c) { return out << c.name; }

class EnableRefused : public TestWithParam<RefusalCase> {};

TEST_P(EnableRefused, WithTheReasonAndWithoutPower) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.drive.on_read = GetParam().spoil;
  rig.run(5);
  const RequestReply answer = rig.ask(E::kEnable);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "enable refused");
  EXPECT_CONTAINS(answer.text, GetParam().reason);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  rig.drive.on_read = nullptr;
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled) << "the refused request came back to life";
  EXPECT_FALSE(rig.drive.written_drive.enable);
}

INSTANTIATE_TEST_SUITE_P(
    , EnableRefused,
    Values(
        RefusalCase{"EmergencyStop", [](FakeDrive& d) { d.status.emergency_stop = true; }, "emergency stop is pressed"},
        RefusalCase{"DriveFault", [](FakeDrive& d) { d.status.fault = true; }, "the drive reports a fault"},
        RefusalCase{"NanFeedback", [](FakeDrive& d) { d.position[kA] = kNan; }, "no valid, fresh positions"},
        RefusalCase{"InfiniteFeedback", [](FakeDrive& d) { d.position[kX] = HUGE_VAL; }, "no valid, fresh positions"},
        RefusalCase{"StaleFeedback", [](FakeDrive& d) { d.status.feedback_count = 1; }, "no valid, fresh positions"}),
    [](const TestParamInfo<RefusalCase>& info) { return info.param.name; });

TEST(ControlLoopEnable, GivesUpWhenPowerDoesNotComeInTime) {
  Rig<FakeDrive> rig;  // 10.5 periods
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  for (int i = 0; i < 10; ++i) {
    rig.cycle();
    ASSERT_FALSE(rig.loop->reply()) << "after " << i + 1 << " cycles";
    ASSERT_TRUE(rig.drive.written_drive.enable);
  }
  rig.cycle();
  const auto answer = rig.loop->reply();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->accepted);
  EXPECT_CONTAINS(answer->text, "did not switch its power on in time");
  EXPECT_FALSE(rig.drive.written_drive.enable);
}

TEST(ControlLoopEnable, PowerThatComesAfterGivingUpDoesNotMakeItReady) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.run(20);
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = true; };
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled);
}

TEST(ControlLoopEnable, NeverWritesACommandThatIsNotANumber) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.cycle();
  // The encoder fails in the very cycle in which power comes.
  rig.drive.on_read = [](FakeDrive& d) { d.position[kY] = kNan; };
  for (int i = 0; i < 5; ++i) {
    rig.cycle();
    EXPECT_TRUE(toAxes(rig.drive.written).isFinite().all()) << "in cycle " << i;
  }
}

TEST(ControlLoopEnable, AnEmergencyStopWhileWaitingForPowerTakesTheEnableBack) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.run(2);
  rig.drive.on_read = [](FakeDrive& d) {
    d.status.enabled = false;
    d.status.emergency_stop = true;
  };
  rig.run(2);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = false; };
  rig.run(3);
  EXPECT_EQ(rig.last().state, S::kDisabled) << "releasing the emergency stop switched power on";
}

TEST(ControlLoopEnable, OneRequestAtATime) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  EXPECT_FALSE(rig.loop->post(E::kReset));
}

// ---------------------------------------------------------------------------------------------------------------------
// Requests against the table

struct RequestCase {
  S state;
  E event;
  const char* allowed = "";  ///< what the refusal must list
};
std::ostream& operator<<(std::ostream& out, const RequestCase& c) {
  return out << toString(c.event) << " in " << toString(c.state);
}
std::string requestName(const TestParamInfo<RequestCase>& info) {
  return std::string(toString(info.param.event)) + "_in_" + toString(info.param.state);
}

/// Every request in every state that does not list it.
std::vector<RequestCase> refusedRequests() {
  const std::vector<std::pair<S, const char*>> allowed{{S::kDisabled, "enable, disable, reset"},
                                                       {S::kReady, "enable, disable, home, start, lift"},
                                                       {S::kHoming, "disable, hold, cancel"},
                                                       {S::kStarting, "disable, hold, resume, cancel"},
                                                       {S::kRunning, "disable, hold, cancel"},
                                                       {S::kHolding, "disable, hold, resume, cancel"},
                                                       {S::kHeld, "disable, hold, resume, retract, cancel"},
                                                       {S::kRetracting, "disable, hold, cancel"},
                                                       {S::kRetracted, "disable, resume, cancel"},
                                                       {S::kResuming, "disable, hold, cancel"},
                                                       {S::kCanceling, "disable, hold, cancel"},
                                                       {S::kFault, "disable, reset"},
                                                       {S::kLifting, "disable, hold, cancel"}};
  const std::vector<std::pair<E, const char*>> requests{
      {E::kEnable, "enable"}, {E::kDisable, "disable"}, {E::kHome, "home"},       {E::kStart, "start"},
      {E::kHold, "hold"},     {E::kResume, "resume"},   {E::kRetract, "retract"}, {E::kCancel, "cancel"},
      {E::kReset, "reset"},   {E::kLift, "lift"}};
  std::vector<RequestCase> cases;
  for (const auto& [state, list] : allowed) {
    for (const auto& [event, name] : requests) {
      const bool listed = (", " + std::string(list) + ",").find(", " + std::string(name) + ",") != std::string::npos;
      if (!listed) cases.push_back({state, event, list});
    }
  }
  return cases;
}

class RequestRefused : public TestWithParam<RequestCase> {};

TEST_P(RequestRefused, WithTheStateAndWhatItAllows) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam().state));
  SetpointStream other = rig.paperStream();
  const RequestReply answer = rig.ask(GetParam().event, &other);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.text, std::string(toString(GetParam().event)) + " refused: the machine is in state " +
                             toString(GetParam().state) + "; allowed: " + GetParam().allowed);
  EXPECT_EQ(rig.last().state, GetParam().state);
}

INSTANTIATE_TEST_SUITE_P(, RequestRefused, ValuesIn(refusedRequests()), requestName);

class RequestWithoutEffect : public TestWithParam<RequestCase> {};

TEST_P(RequestWithoutEffect, IsAcceptedAndChangesNothing) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam().state));
  const bool enable = rig.drive.written_drive.enable;
  const RequestReply answer = rig.ask(GetParam().event);
  EXPECT_TRUE(answer.accepted) << answer.text;
  EXPECT_EQ(rig.last().state, GetParam().state);
  EXPECT_EQ(rig.drive.written_drive.enable, enable);
}

INSTANTIATE_TEST_SUITE_P(, RequestWithoutEffect,
                         Values(RequestCase{S::kDisabled, E::kDisable}, RequestCase{S::kReady, E::kEnable},
                                RequestCase{S::kHolding, E::kHold}, RequestCase{S::kHeld, E::kHold},
                                RequestCase{S::kStarting, E::kHold}, RequestCase{S::kStarting, E::kResume},
                                RequestCase{S::kCanceling, E::kCancel}, RequestCase{S::kCanceling, E::kDisable},
                                RequestCase{S::kCanceling, E::kHold}, RequestCase{S::kFault, E::kDisable},
                                RequestCase{S::kLifting, E::kHold}, RequestCase{S::kLifting, E::kCancel},
                                RequestCase{S::kLifting, E::kDisable}),
                         requestName);

// What the loop alone may find: taken from outside, these would part the state from the stream and from the power.
class NotARequest : public TestWithParam<E> {};

TEST_P(NotARequest, IsRefusedFromOutside) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  EXPECT_FALSE(rig.ask(GetParam()).accepted);
  EXPECT_EQ(rig.last().state, S::kRunning);
}

INSTANTIATE_TEST_SUITE_P(, NotARequest, Values(E::kDone, E::kAtRest, E::kFault), [](const TestParamInfo<E>& info) {
  const std::string name = toString(info.param);
  return name == "at rest" ? "at_rest" : name;
});

TEST(ControlLoopDisable, SwitchesPowerOffAndCommandsFollowThePositionsAgain) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  ASSERT_TRUE(rig.ask(E::kDisable).accepted);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  const Axes pushed(0.01, 0.02, 0.03, 0.4);
  rig.drive.place(pushed);
  rig.cycle();
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), pushed));
}

// ---------------------------------------------------------------------------------------------------------------------
// Start

TEST(ControlLoopStart, IsRefusedWhenTheAxesAreNotHomed) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  rig.drive.status.homed = false;
  SetpointStream stream = rig.paperStream();
  const RequestReply answer = rig.askToStart(stream);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "not homed");
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(rig.setpoints().empty());
}

class StartAfterMoving : public TestWithParam<int> {};

TEST_P(StartAfterMoving, IsRefused) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  const int axis = GetParam();
  Axes planned = rig.last().command;
  planned[axis] = std::nextafter(planned[axis], 1.0);
  SetpointStream stream(GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), machineConfig().machine, planned));
  const RequestReply answer = rig.askToStart(stream);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "do not stand where the job was planned to start");
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(rig.setpoints().empty());
}

INSTANTIATE_TEST_SUITE_P(Axis, StartAfterMoving, Values(kX, kY, kZ, kA),
                         [](const TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

// ---------------------------------------------------------------------------------------------------------------------
// A whole job

class PaperJob : public ::testing::Test {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    rig_.runToEnd();
  }

  Rig<SimulatedDrive> rig_;
};

TEST_F(PaperJob, IsStreamedBitForBitAsPlanned) {
  const LoopConfig config = machineConfig();
  const std::vector<Setpoint> planned = allSetpoints(
      SetpointStream(GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), config.machine, config.machine.park)));
  ASSERT_GT(planned.size(), 3000u);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), planned));
}

TEST_F(PaperJob, WritesEverySetpointInACycleOfItsOwnWithoutGaps) {
  std::uint64_t expected = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < rig_.log.size(); ++i) {
    const CycleRecord& record = rig_.log[i];
    if (!record.has_setpoint) continue;
    if (expected == 0) first = i;
    ASSERT_EQ(record.state, S::kRunning);
    ASSERT_EQ(i - first, expected);
    ASSERT_EQ(record.setpoint.cycle, expected++);
    ASSERT_TRUE(sameBits(record.command, record.setpoint.position));
  }
  EXPECT_GT(expected, 3000u);
}

TEST_F(PaperJob, EndsReadyAtTheParkPosition) {
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE((rig_.last().command == machineConfig().machine.park).all()) << rig_.last().command.transpose();
  rig_.run(50);
  EXPECT_TRUE((rig_.last().position == machineConfig().machine.park).all()) << rig_.last().position.transpose();
}

TEST_F(PaperJob, EndsOnce) {
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_FALSE(rig_.last().has_setpoint);
}

TEST_F(PaperJob, RunsAgain) {
  const std::vector<Setpoint> first = rig_.setpoints();
  rig_.log.erase(rig_.log.begin(), rig_.log.end() - 1);
  rig_.stream.emplace(rig_.paperStream());
  ASSERT_TRUE(rig_.askToStart(*rig_.stream).accepted);
  rig_.runToEnd();
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), first));
}

// ---------------------------------------------------------------------------------------------------------------------
// Cancel

class Cancel : public TestWithParam<std::tuple<MoveKind, int>> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runTo(std::get<0>(GetParam())));
    rig_.run(40 + std::get<1>(GetParam()));
    ASSERT_EQ(rig_.last().setpoint.move, std::get<0>(GetParam()));
    last_before_ = rig_.last().setpoint.cycle;
    ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  }

  Rig<SimulatedDrive> rig_;
  std::uint64_t last_before_ = 0;
};

TEST_P(Cancel, StopsAsAStreamHeldInTheSameCycleAndLiftsTheWheelOffTheWork) {
  EXPECT_EQ(rig_.last().state, S::kCanceling);
  rig_.runToEnd();
  const LoopConfig config = machineConfig();
  SetpointStream stream(GrindProgram(readJobFile(SOURCE_DIR "/jobs/paper.yaml"), config.machine, config.machine.park));
  EXPECT_LT(rig_.setpoints().size(), allSetpoints(stream).size());
  std::vector<Setpoint> expected;
  Setpoint p;
  while (expected.size() <= last_before_ && stream.next(p)) expected.push_back(p);
  stream.hold();
  while (stream.next(p)) expected.push_back(p);
  // 5 mm above 31 mm of 5 degrees.
  const double clear_y = 0.031 * std::tan(5 * std::acos(-1.0) / 180) + 0.005;
  if (expected.back().position[kY] < clear_y - 1e-12) {
    stream.retract();
    while (stream.next(p)) expected.push_back(p);
  }
  EXPECT_NEAR(std::min(expected.back().position[kY], clear_y), clear_y, 1e-12);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), expected));
}

TEST_P(Cancel, IsCancelingUntilTheAxesRestThenReady) {
  const std::size_t from = rig_.log.size();
  rig_.runToEnd();
  for (std::size_t i = from; i + 1 < rig_.log.size(); ++i) {
    ASSERT_EQ(rig_.log[i].state, S::kCanceling);
    ASSERT_TRUE(rig_.log[i].has_setpoint);
  }
  EXPECT_GT(rig_.log.size(), from + 2) << "a moving axis takes some cycles to stop";
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_FALSE(rig_.last().has_setpoint);
}

TEST_P(Cancel, EndsTheJobOnceAndRests) {
  rig_.runToEnd();
  const Axes rest = rig_.last().command;
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_TRUE(sameBits(rig_.last().command, rest));
  EXPECT_EQ(rig_.last().state, S::kReady);
}

TEST_P(Cancel, StopsWithinTheLimitsOfAcceleration) {
  rig_.runToEnd();
  rig_.run(4);
  // Over pairs, since within one the odd-even steps are not the path's.
  const Axes limit = machineConfig().machine.limits.max_acceleration;
  const std::size_t last = rig_.log.size() - 1;
  // An even number of setpoints after the first: the log's last setpoint ends a pair, and so does every second before.
  for (std::size_t i = last - 4; i > last - 44; i -= 2) {
    const Axes bend = rig_.log[i + 1].command - 2 * rig_.log[i - 1].command + rig_.log[i - 3].command;
    ASSERT_TRUE((bend.abs() / (0.002 * 0.002) <= limit * 1.001).all()) << bend.transpose() / (0.002 * 0.002);
  }
}

INSTANTIATE_TEST_SUITE_P(, Cancel,
                         ::testing::Combine(Values(MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach,
                                                   MoveKind::kInfeed, MoveKind::kStroke, MoveKind::kRetract,
                                                   MoveKind::kReturn),
                                            Values(0, 1)),
                         [](const TestParamInfo<std::tuple<MoveKind, int>>& info) {
                           return std::string(toString(std::get<0>(info.param))) +
                                  (std::get<1>(info.param) ? "_mid_pair" : "_pair_end");
                         });

TEST(ControlLoopCancel, RestsOnTheHelix) {
  Rig<SimulatedDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runTo(MoveKind::kStroke);
  rig.run(500);
  ASSERT_TRUE(rig.ask(E::kCancel).accepted);
  rig.runToEnd();
  const Axes rest = rig.last().command;
  ASSERT_GT(rest[kX], 0.001) << "cancelled well within the flute";
  ASSERT_LT(rest[kX], 0.030);
  // A = (k/b) ln(1 + bX) of the paper's cutter, b = 2 tan C / D1, k = 2 tan S / D1.
  const double degree = std::acos(-1.0) / 180;
  const double b = 2 * std::tan(5 * degree) / 0.010;
  const double k = 2 * std::tan(30 * degree) / 0.010;
  const double a = k / b * std::log1p(b * rest[kX]);
  // 1 um across the helix, at the largest radius of the flute, which gives the least angle.
  const double radius = 0.005 + 0.030 * std::tan(5 * degree);
  EXPECT_NEAR(rest[kA], a, 1e-6 / (radius * std::cos(30 * degree)) * 1.2);
}

// ---------------------------------------------------------------------------------------------------------------------
// Faults

struct FaultCase {
  std::string name;
  std::function<void(FakeDrive&)> spoil;
  int cycles;  ///< until it is to be seen
  FaultKind kind;
  int axis;
  std::vector<std::string> words;
};
std::ostream& operator<<(std::ostream& out, const FaultCase& c) { return out << c.name; }

std::vector<FaultCase> faultCases() {
  std::vector<FaultCase> cases{
      {"EmergencyStop",
       [](FakeDrive& d) { d.status.emergency_stop = true; },
       1,
       FaultKind::kEmergencyStop,
       0,
       {"emergency stop"}},
      {"DriveFault",
       [](FakeDrive& d) { d.status.fault = true; },
       1,
       FaultKind::kDriveFault,
       0,
       {"the drive reports a fault"}},
      {"PowerLost",
       [](FakeDrive& d) { d.status.enabled = false; },
       1,
       FaultKind::kPowerLost,
       0,
       {"switched its power off"}},
      // Fresh positions are allowed to stay away for 2.5 periods.
      {"StaleFeedback",
       [](FakeDrive& d) { --d.status.feedback_count; },
       3,
       FaultKind::kStaleFeedback,
       0,
       {"no fresh positions", "for 0.003 s", "allowed 0.0025 s"}},
      {"FullTurn",
       [](FakeDrive& d) { d.position[kA] += 2 * std::acos(-1.0); },
       1,
       FaultKind::kFollowingError,
       kA,
       {"axis_a following error 6.2831", " rad", "limit 0.05 rad"}},
      {"FullTurnBack",
       [](FakeDrive& d) { d.position[kA] -= 2 * std::acos(-1.0); },
       1,
       FaultKind::kFollowingError,
       kA,
       {"axis_a following error 6.2831", " rad", "limit 0.05 rad"}},
  };
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string letter(1, "XYZA"[axis]);
    const std::string joint = kJointNames[static_cast<std::size_t>(axis)];
    const auto n = static_cast<std::size_t>(axis);
    cases.push_back({"Nan" + letter,
                     [=](FakeDrive& d) { d.position[n] = kNan; },
                     1,
                     FaultKind::kInvalidFeedback,
                     axis,
                     {joint + " position", "nan"}});
    cases.push_back({"Infinite" + letter,
                     [=](FakeDrive& d) { d.position[n] = -HUGE_VAL; },
                     1,
                     FaultKind::kInvalidFeedback,
                     axis,
                     {joint + " position", "-inf"}});
    const double limit = axis == kA ? 0.05 : 0.001;
    const std::vector<std::string> words{joint + " following error", axis == kA ? "0.0501 rad" : "0.001002 m",
                                         axis == kA ? "limit 0.05 rad" : "limit 0.001 m"};
    for (const double side : {1.0, -1.0}) {
      cases.push_back({"Following" + letter + (side > 0 ? "Ahead" : "Behind"),
                       [=](FakeDrive& d) { d.position[n] += side * limit * 1.002; }, 1, FaultKind::kFollowingError,
                       axis, words});
    }
  }
  return cases;
}

class FaultWhileRunning : public TestWithParam<FaultCase> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runTo(MoveKind::kStroke));
    rig_.run(100);
    rig_.drive.on_read = GetParam().spoil;
    for (int i = 1; i < GetParam().cycles; ++i) {
      rig_.cycle();
      ASSERT_EQ(rig_.last().state, S::kRunning) << "seen too early, in cycle " << i;
    }
    last_written_ = toAxes(rig_.drive.written);
    rig_.cycle();
  }

  Rig<FakeDrive> rig_;
  Axes last_written_ = Axes::Zero();
};

TEST_P(FaultWhileRunning, IsSeenInTheSameCycle) {
  EXPECT_EQ(rig_.last().state, S::kFault);
  EXPECT_EQ(rig_.last().fault.kind, GetParam().kind);
  EXPECT_EQ(rig_.last().fault.axis, GetParam().axis);
}

TEST_P(FaultWhileRunning, SwitchesPowerOffInTheSameCycle) { EXPECT_FALSE(rig_.drive.written_drive.enable); }

TEST_P(FaultWhileRunning, LeavesTheCommandsAsLastWritten) {
  EXPECT_FALSE(rig_.last().has_setpoint);
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), last_written_));
  EXPECT_TRUE(sameBits(rig_.last().command, last_written_));
}

TEST_P(FaultWhileRunning, NoSetpointIsEverWrittenAfterIt) {
  for (int i = 0; i < 100; ++i) {
    rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kFault);
    ASSERT_FALSE(rig_.last().has_setpoint);
    ASSERT_FALSE(rig_.drive.written_drive.enable);
    ASSERT_TRUE(sameBits(toAxes(rig_.drive.written), last_written_));
  }
}

TEST_P(FaultWhileRunning, EndsTheJobOnce) {
  EXPECT_TRUE(rig_.last().job_ended);
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
}

TEST_P(FaultWhileRunning, IsToldInWords) {
  for (const std::string& word : GetParam().words) EXPECT_CONTAINS(rig_.last().fault.text(), word);
}

TEST_P(FaultWhileRunning, StaysWhenItsCauseGoesAway) {
  rig_.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = d.status.fault = false; };
  rig_.run(100);
  EXPECT_EQ(rig_.last().state, S::kFault);
  EXPECT_EQ(rig_.last().fault.kind, GetParam().kind);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
}

TEST_P(FaultWhileRunning, NothingMovesAfterReset) {
  rig_.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = d.status.fault = false; };
  rig_.cycle();
  ASSERT_TRUE(rig_.ask(E::kReset).accepted);
  EXPECT_EQ(rig_.last().state, S::kDisabled);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  const std::size_t written = rig_.setpoints().size();
  const Axes rest = toAxes(rig_.drive.position);
  for (int i = 0; i < 100; ++i) {
    rig_.cycle();
    ASSERT_FALSE(rig_.drive.written_drive.enable);
    ASSERT_TRUE(sameBits(toAxes(rig_.drive.written), rest) || !rest.isFinite().all());
  }
  EXPECT_EQ(rig_.setpoints().size(), written);
}

TEST_P(FaultWhileRunning, AfterResetAndEnableTheAxesStandAndANewJobRuns) {
  rig_.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = d.status.fault = false; };
  // Where a human pushed the axes meanwhile.
  const Axes pushed(-0.04, 0.04, 0.001, 0.3);
  rig_.drive.place(pushed);
  ASSERT_TRUE(rig_.ask(E::kReset).accepted);
  ASSERT_NO_FATAL_FAILURE(rig_.enable());
  rig_.run(20);
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), pushed));
  EXPECT_TRUE(sameBits(rig_.last().position, pushed));
  const std::size_t before = rig_.setpoints().size();
  SetpointStream stream = rig_.paperStream();
  const std::vector<Setpoint> planned = allSetpoints(stream);
  ASSERT_TRUE(rig_.askToStart(stream).accepted);
  rig_.runToEnd();
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.setpoints().size() - before, planned.size());
  EXPECT_EQ(rig_.jobsEnded(), 2);
}

INSTANTIATE_TEST_SUITE_P(, FaultWhileRunning, ValuesIn(faultCases()),
                         [](const TestParamInfo<FaultCase>& info) { return info.param.name; });

TEST(ControlLoopFault, IsSeenWhileCancelingToo) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kCanceling));
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
  rig.cycle();
  EXPECT_EQ(rig.last().state, S::kFault);
  EXPECT_TRUE(rig.last().job_ended);
  EXPECT_FALSE(rig.last().has_setpoint);
}

TEST(ControlLoopFault, AtRestEndsNoJob) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kReady));
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
  rig.run(10);
  EXPECT_EQ(rig.last().state, S::kFault);
  EXPECT_EQ(rig.jobsEnded(), 0);
}

TEST(ControlLoopFault, InTheCycleOfAStartRefusesIt) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kReady));
  SetpointStream stream = rig.paperStream();
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
  const RequestReply answer = rig.askToStart(stream);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "state fault");
  rig.run(10);
  EXPECT_TRUE(rig.setpoints().empty());
}

TEST(ControlLoopFault, KeepsItsFirstCause) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  rig.drive.on_read = [](FakeDrive& d) { d.position[kZ] += 0.01; };
  rig.cycle();
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
  rig.run(5);
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kFollowingError);
}

TEST(ControlLoopReset, IsRefusedWhileTheEmergencyStopIsPressed) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
  rig.cycle();
  const RequestReply answer = rig.ask(E::kReset);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "emergency stop is pressed");
  EXPECT_EQ(rig.last().state, S::kFault);
  EXPECT_FALSE(rig.drive.written_drive.reset);
}

TEST(ControlLoopReset, TellsTheDriveForOneCycle) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kFault));
  EXPECT_FALSE(rig.drive.written_drive.reset);
  ASSERT_TRUE(rig.ask(E::kReset).accepted);
  EXPECT_TRUE(rig.drive.written_drive.reset);
  rig.cycle();
  EXPECT_FALSE(rig.drive.written_drive.reset);
}

// ---------------------------------------------------------------------------------------------------------------------
// Following error, to the last bit. The limit is a power of two and the axes stand at zero: no rounding is in the way.

class FollowingErrorLimit : public TestWithParam<int> {
 protected:
  FollowingErrorLimit() : rig_(atZero()) {
    rig_.cycle();
    rig_.enable();
  }

  static LoopConfig atZero() {
    LoopConfig config = machineConfig();
    config.machine.park = Axes::Zero();
    config.following_error.setConstant(0x1p-10);
    return config;
  }

  S stateAt(double error) {
    rig_.drive.on_read = [=](FakeDrive& d) { d.position[static_cast<std::size_t>(GetParam())] = error; };
    return rig_.run(3).state;
  }

  Rig<FakeDrive> rig_;
};

TEST_P(FollowingErrorLimit, IsAllowedItself) {
  EXPECT_EQ(stateAt(0x1p-10), S::kReady);
  EXPECT_EQ(stateAt(-0x1p-10), S::kReady);
}

TEST_P(FollowingErrorLimit, NextNumberAboveIsAFault) { EXPECT_EQ(stateAt(std::nextafter(0x1p-10, 1.0)), S::kFault); }

TEST_P(FollowingErrorLimit, NextNumberBelowItsNegativeIsAFault) {
  EXPECT_EQ(stateAt(std::nextafter(-0x1p-10, -1.0)), S::kFault);
}

TEST_P(FollowingErrorLimit, IsTheAxisOwn) {
  LoopConfig config = atZero();
  config.following_error[GetParam()] = 0x1p-5;
  Rig<FakeDrive> rig(config);
  rig.cycle();
  rig.enable();
  rig.drive.on_read = [&](FakeDrive& d) { d.position[static_cast<std::size_t>(GetParam())] = 0x1p-6; };
  EXPECT_EQ(rig.run(3).state, S::kReady);
}

INSTANTIATE_TEST_SUITE_P(Axis, FollowingErrorLimit, Values(kX, kY, kZ, kA),
                         [](const TestParamInfo<int>& info) { return std::string(1, "XYZA"[info.param]); });

TEST(ControlLoopFault, FeedbackThatComesBackInTimeIsNone) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kReady));
  for (int i = 0; i < 5; ++i) {
    rig.drive.on_read = [](FakeDrive& d) { --d.status.feedback_count; };
    rig.run(2);
    rig.drive.on_read = nullptr;
    rig.cycle();
  }
  EXPECT_EQ(rig.last().state, S::kReady);
}

// ---------------------------------------------------------------------------------------------------------------------
// Faults of the simulated drive, as an operator can bring them about

struct InjectedCase {
  const char* name;
  SimulatedDrive::Fault fault;
  int axis;
  FaultKind kind;
};
std::ostream& operator<<(std::ostream& out, const InjectedCase& c) { return out << c.name; }

class InjectedFault : public TestWithParam<InjectedCase> {};

TEST_P(InjectedFault, EndsTheJobAndTheMachineRecovers) {
  Rig<SimulatedDrive> rig;
  rig.cycle();
  rig.startPaper();
  rig.runTo(MoveKind::kStroke);
  rig.run(500);
  rig.drive.inject(GetParam().fault, GetParam().axis);
  for (int i = 0; i < 1000 && rig.last().state == S::kRunning; ++i) rig.cycle();
  ASSERT_EQ(rig.last().state, S::kFault);
  EXPECT_EQ(rig.last().fault.kind, GetParam().kind);
  EXPECT_EQ(rig.last().fault.axis, GetParam().axis);
  EXPECT_EQ(rig.jobsEnded(), 1);
  rig.cycle();
  EXPECT_FALSE(rig.last().drive.enabled);

  rig.drive.inject(SimulatedDrive::Fault::kNone);
  rig.cycle();
  const Axes rest = rig.last().position;
  ASSERT_TRUE(rig.ask(E::kReset).accepted);
  rig.cycle();
  ASSERT_NO_FATAL_FAILURE(rig.enable());
  rig.run(50);
  EXPECT_TRUE(sameBits(rig.last().position, rest)) << "power on moved an axis";
  ASSERT_TRUE(rig.ask(E::kLift).accepted);
  rig.runUntil(S::kReady);
  rig.stream.emplace(rig.paperStream());
  ASSERT_TRUE(rig.askToStart(*rig.stream).accepted);
  rig.runToEnd();
  EXPECT_EQ(rig.last().state, S::kReady);
}

INSTANTIATE_TEST_SUITE_P(
    , InjectedFault,
    Values(InjectedCase{"EmergencyStop", SimulatedDrive::Fault::kEmergencyStop, 0, FaultKind::kEmergencyStop},
           InjectedCase{"StuckX", SimulatedDrive::Fault::kStuckAxis, kX, FaultKind::kFollowingError},
           InjectedCase{"StuckA", SimulatedDrive::Fault::kStuckAxis, kA, FaultKind::kFollowingError},
           InjectedCase{"StaleFeedback", SimulatedDrive::Fault::kStaleFeedback, 0, FaultKind::kStaleFeedback},
           InjectedCase{"NanZ", SimulatedDrive::Fault::kNanFeedback, kZ, FaultKind::kInvalidFeedback},
           InjectedCase{"DriveFault", SimulatedDrive::Fault::kDriveFault, 0, FaultKind::kDriveFault}),
    [](const TestParamInfo<InjectedCase>& info) { return std::string(info.param.name); });

// ---------------------------------------------------------------------------------------------------------------------
// A setpoint that a limit forbids: the stream is planned for a stronger machine than the loop's.

struct LimitCase {
  const char* name;
  std::function<void(LoopConfig&)> tighten;
  LimitedQuantity quantity;
  int axis;
  std::vector<std::string> words;
  /// Index of the first setpoint that breaks the limit, from the positions alone.
  std::function<std::size_t(const std::vector<Setpoint>&)> first;
};
std::ostream& operator<<(std::ostream& out, const LimitCase& c) { return out << c.name; }

/// The first setpoint, of every `stride`-th, whose `order`-th difference over time exceeds the limit.
std::size_t firstBeyond(const std::vector<Setpoint>& all, int axis, int order, std::size_t stride, double limit) {
  const double dt = 0.001 * static_cast<double>(stride);
  const auto at = [&](std::size_t i, std::size_t back) {
    return all[i >= back * stride ? i - back * stride : 0].position[axis];
  };
  for (std::size_t i = 0; i < all.size(); i += stride) {
    double value = at(i, 0);
    if (order == 1) value = (at(i, 0) - at(i, 1)) / dt;
    if (order == 2) value = (at(i, 0) - 2 * at(i, 1) + at(i, 2)) / dt / dt;
    if (order == 3) value = (at(i, 0) - 3 * at(i, 1) + 3 * at(i, 2) - at(i, 3)) / dt / dt / dt;
    if (std::abs(value) > limit) return i;
  }
  return all.size();
}

std::vector<LimitCase> limitCases() {
  return {
      {"PositionX",
       [](LoopConfig& c) { c.machine.limits.max_position[kX] = 0.01; },
       LimitedQuantity::kPosition,
       kX,
       {"axis_x position 0.01", "beyond its limit 0.01 m", "(stroke, cycle "},
       [](const std::vector<Setpoint>& all) {
         std::size_t i = 0;
         while (i < all.size() && all[i].position[kX] <= 0.01) ++i;
         return i;
       }},
      {"PositionY",
       [](LoopConfig& c) { c.machine.limits.min_position[kY] = 0.0213; },
       LimitedQuantity::kPosition,
       kY,
       {"axis_y position 0.021", "beyond its limit 0.0213 m", "(approach, cycle "},
       [](const std::vector<Setpoint>& all) {
         std::size_t i = 0;
         while (i < all.size() && all[i].position[kY] >= 0.0213) ++i;
         return i;
       }},
      {"VelocityX",
       [](LoopConfig& c) { c.machine.limits.max_velocity[kX] = 0.05; },
       LimitedQuantity::kVelocity,
       kX,
       {"axis_x velocity 0.05", "beyond its limit 0.05 m/s", "(position, cycle "},
       [](const std::vector<Setpoint>& all) { return firstBeyond(all, kX, 1, 1, 0.05); }},
      {"AccelerationX",
       [](LoopConfig& c) { c.machine.limits.max_acceleration[kX] = 0.21; },
       LimitedQuantity::kAcceleration,
       kX,
       {"axis_x acceleration 0.2", "beyond its limit 0.21 m/s^2", "(position, cycle "},
       [](const std::vector<Setpoint>& all) { return firstBeyond(all, kX, 2, 2, 0.21); }},
      {"JerkY",
       [](LoopConfig& c) { c.machine.limits.max_jerk[kY] = 3; },
       LimitedQuantity::kJerk,
       kY,
       {"axis_y jerk", "beyond its limit 3 m/s^3", "(approach, cycle "},
       [](const std::vector<Setpoint>& all) { return firstBeyond(all, kY, 3, 2, 3); }},
  };
}

class ForbiddenSetpoint : public TestWithParam<LimitCase> {
 protected:
  ForbiddenSetpoint() : rig_(tightened()), strong_(machineConfig().machine) {}

  void SetUp() override {
    rig_.cycle();
    rig_.enable();
    planned_ = allSetpoints(rig_.paperStream(strong_));
    rig_.stream.emplace(rig_.paperStream(strong_));
    ASSERT_NO_FATAL_FAILURE(rig_.start(*rig_.stream));
    for (std::size_t i = 0; i < planned_.size() && rig_.last().state == S::kRunning; ++i) rig_.cycle();
    ASSERT_EQ(rig_.last().state, S::kFault) << "the limit was not seen";
    forbidden_ = GetParam().first(planned_);
    ASSERT_GT(forbidden_, 0u);
    ASSERT_LT(forbidden_, planned_.size());
  }

  static LoopConfig tightened() {
    LoopConfig config = machineConfig();
    GetParam().tighten(config);
    return config;
  }

  Rig<FakeDrive> rig_;
  Machine strong_;
  std::vector<Setpoint> planned_;
  std::size_t forbidden_ = 0;
};

TEST_P(ForbiddenSetpoint, IsAFaultOfKindLimit) {
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kLimit);
  EXPECT_EQ(rig_.last().fault.axis, GetParam().axis);
  EXPECT_EQ(rig_.last().fault.violation.axis, GetParam().axis);
  EXPECT_EQ(rig_.last().fault.violation.quantity, GetParam().quantity);
  EXPECT_EQ(rig_.last().fault.violation.cycle, forbidden_);
}

TEST_P(ForbiddenSetpoint, IsNeverWrittenButAllBeforeItAre) {
  rig_.run(100);
  const std::vector<Setpoint> good(planned_.begin(), planned_.begin() + static_cast<std::ptrdiff_t>(forbidden_));
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), good));
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), good.back().position));
}

TEST_P(ForbiddenSetpoint, EndsTheJobOnceWithoutPower) {
  EXPECT_TRUE(rig_.last().job_ended);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
}

TEST_P(ForbiddenSetpoint, IsToldInWords) {
  for (const std::string& word : GetParam().words) EXPECT_CONTAINS(rig_.last().fault.text(), word);
  EXPECT_CONTAINS(rig_.last().fault.text(), "cycle " + std::to_string(forbidden_) + ",");
}

INSTANTIATE_TEST_SUITE_P(, ForbiddenSetpoint, ValuesIn(limitCases()),
                         [](const TestParamInfo<LimitCase>& info) { return std::string(info.param.name); });

// ---------------------------------------------------------------------------------------------------------------------
// Records

TEST(ControlLoopRecords, ThoseNobodyTakesAreCountedAndTheLoopGoesOn) {
  Rig<FakeDrive> rig;
  const ros::Duration period(0.001);
  ros::Time time(1000);
  for (int i = 0; i < 8192 + 7; ++i) rig.loop->cycle(time += period, period);
  EXPECT_EQ(rig.drive.status.feedback_count, 8192u + 7);
  CycleRecord record;
  int taken = 0;
  while (rig.loop->pop(record)) {
    EXPECT_EQ(record.records_lost, 0u);
    ++taken;
  }
  EXPECT_EQ(taken, 8192);
  EXPECT_EQ(rig.cycle().records_lost, 7u);
  EXPECT_EQ(rig.cycle().records_lost, 7u);
}

TEST(ControlLoopRecords, AJobIsStreamedWholeWithNobodyTakingThem) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  SetpointStream stream = rig.paperStream();
  const std::size_t planned = allSetpoints(stream).size();
  ASSERT_TRUE(rig.loop->postStart(&stream));
  const ros::Duration period(0.001);
  for (std::size_t i = 0; i < planned + 8192; ++i) rig.loop->cycle(ros::Time(2000), period);
  CycleRecord record;
  while (rig.loop->pop(record)) {
  }
  const CycleRecord& last = rig.cycle();
  EXPECT_EQ(last.state, S::kReady);
  EXPECT_GT(last.records_lost, 0u);
  EXPECT_TRUE((last.command == machineConfig().machine.park).all());
}

TEST(ControlLoopRecords, TheEndOfAJobIsToldEvenIfItsOwnRecordWasLost) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.enable();
  SetpointStream stream = rig.paperStream();
  const std::size_t planned = allSetpoints(stream).size();
  const ros::Duration period(0.001);
  for (int i = 0; i < 8192; ++i) rig.loop->cycle(ros::Time(2000), period);  // no room for any record of the job
  ASSERT_TRUE(rig.loop->postStart(&stream));
  for (std::size_t i = 0; i < planned + 10; ++i) rig.loop->cycle(ros::Time(2000), period);
  CycleRecord record;
  while (rig.loop->pop(record)) EXPECT_FALSE(record.job_ended);
  EXPECT_TRUE(rig.cycle().job_ended);
  EXPECT_FALSE(rig.cycle().job_ended);
}

// ---------------------------------------------------------------------------------------------------------------------
// The thread. Whatever is waited for comes at once; the deadline only ends a test that has failed.

class ControlLoopThread : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  ControlLoopThread() {
    testing::setUp(drive_, machineConfig());
    loop_ = std::make_unique<ControlLoop>(drive_, machineConfig());
  }

  bool popInTime(CycleRecord& record) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!loop_->pop(record)) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::yield();
    }
    return true;
  }

  FakeDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
};

TEST_F(ControlLoopThread, RunsCyclesWithMonotonicPositivePeriods) {
  loop_->startThread();
  CycleRecord record;
  double last = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(popInTime(record)) << "after " << i << " records";
    EXPECT_GT(record.period, 0);
    EXPECT_GE(record.time, last);
    last = record.time;
  }
}

TEST_F(ControlLoopThread, ThePeriodsAddUpToTheTime) {
  loop_->startThread();
  CycleRecord record;
  ASSERT_TRUE(popInTime(record));
  const double first = record.time;
  double sum = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(popInTime(record));
    sum += record.period;
  }
  // Seconds since 1970 as a double are good for a quarter of a microsecond.
  EXPECT_NEAR(record.time - first, sum, 1e-6);
}

TEST_F(ControlLoopThread, StopLeavesTheDriveWithoutPower) {
  LoopConfig config = machineConfig();
  config.following_error.setConstant(1);
  config.feedback_timeout = config.enable_timeout = 30;  // the machine may be busy with other things
  loop_ = std::make_unique<ControlLoop>(drive_, config);
  loop_->startThread();
  const RequestReply answer = loop_->request(E::kEnable);
  ASSERT_TRUE(answer.accepted) << answer.text;
  loop_->stopThread();
  EXPECT_FALSE(drive_.written_drive.enable);
  EXPECT_TRUE(sameBits(toAxes(drive_.written), machineConfig().machine.park)) << "stopping moved an axis";
}

TEST_F(ControlLoopThread, TellsTheComputersTime) {
  ros::Time::setNow(ros::Time(5));  // as of a simulation
  const double before = ros::WallTime::now().toSec();
  loop_->startThread();
  CycleRecord record;
  const bool popped = popInTime(record);
  loop_->stopThread();
  ros::Time::init();
  ASSERT_TRUE(popped);
  EXPECT_GE(record.time, before - 1e-3);
  EXPECT_LE(record.time, ros::WallTime::now().toSec());
  EXPECT_GE(loop_->status().time, record.time);
}

TEST_F(ControlLoopThread, TakesNoSignal) {
  std::atomic<int> open{-1};
  drive_.on_read = [&](FakeDrive&) {
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    int count = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGALRM, SIGUSR1}) {
      count += sigismember(&blocked, signal) == 0;
    }
    open = count;
  };
  loop_->startThread();
  CycleRecord record;
  ASSERT_TRUE(popInTime(record));
  loop_->stopThread();
  EXPECT_EQ(open, 0);
}

/// Resident memory [bytes].
std::size_t resident() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, pages = 0;
  statm >> size >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(ControlLoopThread, LockedMemoryTakesNoneThatIsOnlyClaimed) {
  loop_->startThread();
  if (!loop_->memoryLocked()) GTEST_SKIP() << "the system does not grant locked memory";
  constexpr std::size_t claim = std::size_t{1} << 28;
  const std::size_t before = resident();
  void* const memory = mmap(nullptr, claim, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  EXPECT_LT(resident(), before + claim / 4);
  munmap(memory, claim);
}

TEST_F(ControlLoopThread, AnswersAStopAndTellsItsStatus) {
  loop_->startThread();
  EXPECT_TRUE(loop_->stop(E::kDisable).accepted);
  const RequestReply answer = loop_->stop(E::kCancel);
  EXPECT_TRUE(answer.answered);
  EXPECT_EQ(answer.text, "cancel refused: the machine is in state disabled; allowed: enable, disable, reset");
  EXPECT_GT(loop_->status().cycles, 0u);
}

TEST_F(ControlLoopThread, RefusesOnEachRoadWhatBelongsOnAnother) {
  EXPECT_EQ(loop_->stop(E::kEnable).text, "enable refused: allowed: hold, cancel, disable");
  for (const E event : {E::kHold, E::kStart, E::kFault}) {
    EXPECT_CONTAINS(loop_->request(event).text, "allowed: enable, home, reset, retract, resume, lift");
  }
}

TEST_F(ControlLoopThread, AStopToALoopThatDoesNotRunIsNotAnswered) {
  const RequestReply answer = loop_->stop(E::kHold);
  EXPECT_FALSE(answer.accepted);
  EXPECT_FALSE(answer.answered);
  EXPECT_EQ(answer.text, "hold: the control loop does not answer");
}

TEST_F(ControlLoopThread, StopEndsTheCycles) {
  loop_->startThread();
  CycleRecord record;
  ASSERT_TRUE(popInTime(record));
  loop_->stopThread();
  while (loop_->pop(record)) {
  }
  const std::uint64_t cycles = drive_.status.feedback_count;
  std::this_thread::yield();
  EXPECT_FALSE(loop_->pop(record));
  EXPECT_EQ(drive_.status.feedback_count, cycles);
}

TEST_F(ControlLoopThread, RequestTellsARefusal) {
  loop_->startThread();
  const RequestReply answer = loop_->request(E::kLift);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.text, "lift refused: the machine is in state disabled; allowed: enable, disable, reset");
}

TEST_F(ControlLoopThread, StopWithoutAStartIsHarmless) {
  loop_->stopThread();
  EXPECT_FALSE(drive_.written_drive.enable);
}

}  // namespace
}  // namespace flute_grinder
