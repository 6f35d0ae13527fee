#include "drive/mode_switch.h"
#include "drive/remote_signals.h"
#include "drive/ros_control_parameters.h"
#include "refusal.h"
#include "soon.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

// What the drive for ros_control's RobotHW does without a RobotHW: signals, commands to other programs, switching over.
namespace grinder::test_support {
namespace test_ros_control {

using Clock = SignalInput::Clock;
using std::chrono::milliseconds;

const Clock::time_point kNow = Clock::time_point(std::chrono::hours(100));

TEST(SignalInput, IsWhatWasStated) {
  for (const bool safe : {true, false}) {
    EXPECT_TRUE(SignalInput("always", safe, 1).at(kNow));
    EXPECT_FALSE(SignalInput("never", safe, 1).at(kNow));
    EXPECT_EQ(SignalInput("always", safe, 1).topic(), "");
  }
}

TEST(SignalInput, IsSafeUntilAMessageComesAndWhenNoneComesAnyMoreUnlessItHasNoTimeout) {
  for (const bool safe : {true, false}) {
    SignalInput signal("/cell/emergency_stop", safe, 0.5), lasting("/homed", safe, 0);
    EXPECT_EQ(signal.topic(), "/cell/emergency_stop");
    EXPECT_EQ(signal.at(kNow), safe);
    EXPECT_EQ(lasting.at(kNow), safe);
    signal.receive(!safe, kNow);
    lasting.receive(!safe, kNow);
    EXPECT_EQ(signal.at(kNow + milliseconds(500)), !safe);
    EXPECT_EQ(signal.at(kNow + milliseconds(501)), safe);
    signal.receive(!safe, kNow + milliseconds(900));
    EXPECT_EQ(signal.at(kNow + milliseconds(901)), !safe);
    EXPECT_EQ(lasting.at(kNow + std::chrono::hours(1000)), !safe);
  }
}

/// Another program: it takes what it is sent, refuses it, throws, or hangs until it is no longer wanted.
class Receiver {
 public:
  bool take(char what, const std::function<bool()>& still_wanted) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      got_ += what;
    }
    while (hangs && still_wanted()) std::this_thread::sleep_for(milliseconds(1));
    if (throws) throw std::runtime_error("of the test");
    return !hangs && !refuses;
  }
  std::string got() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return got_;
  }
  std::atomic<bool> hangs{false}, refuses{false}, throws{false};

 private:
  std::mutex mutex_;
  std::string got_;
};

class Switch : public testing::Test {
 protected:
  Switch() {
    EXPECT_FALSE(output->isOn());
    EXPECT_TRUE(soon([&] { return output->isOff(); })) << "nothing is known of before: it begins with off";
  }
  static SwitchOutput::Send to(Receiver& receiver) {
    return [&](bool on, const std::function<bool()>& wanted) { return receiver.take(on ? '1' : '0', wanted); };
  }

  Receiver receiver;
  std::optional<SwitchOutput> output{std::in_place, to(receiver)};
};

TEST_F(Switch, IsOnOnceItHasBeenTaken) {
  receiver.hangs = true;
  output->set(true);
  EXPECT_TRUE(soon([&] { return receiver.got() == "01"; }));
  EXPECT_FALSE(output->isOn() || output->isOff() || output->hasFailed());
  receiver.hangs = false;
  EXPECT_TRUE(soon([&] { return output->isOn(); }));
  output->set(false);
  EXPECT_FALSE(output->isOn());
  EXPECT_TRUE(soon([&] { return output->isOff(); }));
}

TEST_F(Switch, IsTriedAgainUntilItIsTakenAfterARefusalAsAfterAnException) {
  receiver.refuses = true;
  output->set(true);
  EXPECT_TRUE(soon([&] { return receiver.got() == "0111"; }));
  EXPECT_TRUE(output->hasFailed());
  receiver.refuses = false;
  EXPECT_TRUE(soon([&] { return output->isOn() && !output->hasFailed(); }));
  receiver.throws = true;
  output->set(false);
  EXPECT_TRUE(soon([&] { return output->hasFailed(); }));
}

TEST_F(Switch, OnThatWasWithdrawnIsNeverSentAgain) {
  receiver.refuses = true;
  output->set(true);
  EXPECT_TRUE(soon([&] { return output->hasFailed(); }));
  const std::size_t tries = receiver.got().size();
  output->set(false);
  receiver.refuses = false;
  EXPECT_TRUE(soon([&] { return output->isOff(); }));
  EXPECT_EQ(receiver.got(), "0" + std::string(tries - 1, '1') + "0");
}

TEST_F(Switch, NeitherOffNorTheEndWaitsForAnOnThatHangs) {
  receiver.hangs = true;
  output->set(true);
  EXPECT_TRUE(soon([&] { return receiver.got() == "01"; }));
  output->set(false);
  EXPECT_TRUE(soon([&] { return receiver.got() == "010"; }));
  output.reset();
}

TEST_F(Switch, IsPassedOnBeforeTheEnd) {
  output->set(true);
  EXPECT_TRUE(soon([&] { return output->isOn(); }));
  output->set(false);
  output.reset();
  EXPECT_EQ(receiver.got(), "010");
}

TEST(TriggerOutput, AsksOnceForEveryTimeItIsFiredAndCanBeGivenUp) {
  Receiver receiver;
  TriggerOutput output([&](const std::function<bool()>& wanted) { return receiver.take('!', wanted); });
  EXPECT_FALSE(output.isBusy());
  for (const bool refuses : {false, true, false}) {
    receiver.refuses = refuses;
    output.fire();
    EXPECT_TRUE(soon([&] { return !output.isBusy(); }));
    EXPECT_EQ(output.hasFailed(), refuses);
  }
  receiver.hangs = true;
  output.fire();
  EXPECT_TRUE(soon([&] { return receiver.got() == "!!!!"; }));
  EXPECT_TRUE(output.isBusy());
  output.giveUp();
  EXPECT_TRUE(soon([&] { return !output.isBusy(); }));
  EXPECT_TRUE(output.hasFailed());
}

TEST(ModeSwitch, SwitchesOnceForEveryChangeAndAsksForTheResultUntilItIsThere) {
  using Result = ModeSwitch::Result;
  struct Hardware {
    std::string calls;
    Result result = Result::kDone;
    void doSwitch(bool on) { calls += on ? "on " : "off "; }
    Result switchResult() {
      calls += "result ";
      return result;
    }
  };
  const struct {
    bool wanted;
    Result result;
    const char* calls;  ///< of three cycles
    bool on, refused;
  } rows[]{{false, Result::kDone, "", false, false},
           {true, Result::kDone, "on result ", true, false},
           {false, Result::kDone, "off ", false, false},
           {true, Result::kOngoing, "on result result result ", false, false},
           {true, Result::kDone, "result ", true, false},
           {false, Result::kDone, "off ", false, false},
           {true, Result::kOngoing, "on result result result ", false, false},
           {false, Result::kOngoing, "off ", false, false},
           {true, Result::kError, "on result ", false, true},
           {true, Result::kDone, "", false, true},
           {false, Result::kDone, "off ", false, false},
           {true, Result::kDone, "on result ", true, false}};
  ModeSwitch mode;
  for (const auto& row : rows) {
    SCOPED_TRACE(&row - rows);
    Hardware hardware{"", row.result};
    for (int i = 0; i < 3; ++i) mode.update(row.wanted, hardware);
    EXPECT_EQ(hardware.calls, row.calls);
    EXPECT_EQ(mode.isOn(), row.on);
    EXPECT_EQ(mode.isRefused(), row.refused);
  }
}

class Parameters : public testing::Test {
 protected:
  Parameters() {
    all["robot_hw"]["type"] = "maker/Machine";
    all["clock"] = "monotonic";
    all["signal_timeout"] = 0.5;
    all["commands"]["power"] = "none";
    for (const char* signal : {"emergency_stop", "homed", "spindle_at_speed", "coolant_on"}) {
      all["signals"][signal] = "never";
    }
  }
  RosControlParameters read() const { return readRosControlParameters(ParameterReader(all, "/grinder/hardware")); }
  std::string refusal() const {
    return test_support::refusalOf<ParameterError>([&] { read(); });
  }
  /// Without one of them.
  void remove(const std::string& group, const std::string& name) {
    XmlRpc::XmlRpcValue kept;
    for (auto& [key, value] : all[group]) {
      if (key != name) kept[key] = value;
    }
    all[group] = kept;
  }

  XmlRpc::XmlRpcValue all;
};

TEST_F(Parameters, HaveJointsOfTheAxesNamesAndNothingElseUnlessStated) {
  RosControlParameters p = read();
  EXPECT_EQ(p.robot_hw, "maker/Machine");
  EXPECT_EQ(p.joints, (std::array<std::string, 4>{"axis_x", "axis_y", "axis_z", "axis_a"}));
  EXPECT_EQ(p.signals.enabled, "always");
  EXPECT_EQ(p.signals.fault, "never");
  EXPECT_EQ(p.signals.probe_free, "always");
  EXPECT_EQ(p.signals.probe_contact, "never");
  EXPECT_FALSE(p.commands.power || p.commands.home || p.commands.spindle || p.commands.coolant || p.commands.reset);
  EXPECT_FALSE(p.read_is_clock);
  all["joints"]["axis_a"] = "work_head";
  all["clock"] = "read";
  all["signals"]["fault"] = "/plc/fault";
  all["commands"]["spindle"]["topic"] = "/plc/spindle";
  all["commands"]["power"] = XmlRpc::XmlRpcValue();
  all["commands"]["power"]["service"] = "/plc/power";
  p = read();
  EXPECT_EQ(p.joints, (std::array<std::string, 4>{"axis_x", "axis_y", "axis_z", "work_head"}));
  EXPECT_TRUE(p.read_is_clock);
  EXPECT_EQ(p.signals.fault, "/plc/fault");
  EXPECT_EQ(p.commands.spindle.topic, "/plc/spindle");
  EXPECT_EQ(p.commands.power.service, "/plc/power");
}

TEST_F(Parameters, MustStateWhatNoRobotHwHas) {
  const XmlRpc::XmlRpcValue good = all;
  for (const std::string signal : {"emergency_stop", "homed", "spindle_at_speed", "coolant_on"}) {
    remove("signals", signal);
    EXPECT_EQ(refusal(), "parameter /grinder/hardware/signals/" + signal +
                             " is missing; allowed: always, never, or a topic of std_msgs/Bool");
    all = good;
  }
  remove("commands", "power");
  EXPECT_EQ(refusal(), "parameter /grinder/hardware/commands/power is missing; allowed: a service, a topic, or none");
}

TEST_F(Parameters, AreRefusedByName) {
  all["commands"]["power"] = "off";
  EXPECT_EQ(refusal(), "parameter /grinder/hardware/commands/power = off; allowed: a service, a topic, or none");
  all["commands"]["power"] = "none";
  all["clock"] = "write";
  EXPECT_EQ(refusal(), "parameter /grinder/hardware/clock = write; allowed: monotonic or read");
  all["clock"] = "read";
  all["commands"]["home"]["topic"] = "/plc/home";
  EXPECT_EQ(refusal(), "parameter /grinder/hardware/commands/home/topic; allowed: a service of std_srvs/Trigger");
  all["commands"]["home"]["service"] = "/plc/home";
  EXPECT_EQ(refusal(), "parameter /grinder/hardware/commands/home; allowed: either a service or a topic");
}

}  // namespace test_ros_control
}  // namespace grinder::test_support
