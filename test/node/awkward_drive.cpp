// A drive that is not as simple as the simulated one; ~hardware/awkward says how: `hangs in <function>`, `throws in
// <function>`, or as below.

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/export_drive.h"

#include <ros/ros.h>
#include <std_msgs/Empty.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

constexpr std::uint64_t kGoodReadings = 100;

class AwkwardDrive : public grinder::Drive {
 public:
  AwkwardDrive() { misbehave("constructor"); }
  ~AwkwardDrive() override { misbehave("destructor"); }

  void init(ros::NodeHandle&, ros::NodeHandle& nh) override {
    misbehave("init");
    const ros::Subscriber go =
        nh.subscribe<std_msgs::Empty>("go", 1, [this](const std_msgs::Empty::ConstPtr&) { go_ = true; });
    if (how_ != "waits") return;
    while (!go_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  grinder::DriveCapabilities capabilities() const override {
    misbehave("capabilities");
    grinder::DriveCapabilities can;
    can.prepares = how_ == "hangs in prepare";
    if (how_ == "slow bus") can.shortest_period = 0.002;
    if (how_ == "no figure") can.shortest_period = std::numeric_limits<double>::quiet_NaN();
    if (how_ == "long buffer") can.buffer = 5000;
    return can;
  }
  void prepare() override { misbehave("prepare"); }
  void read(const grinder::DriveCycle&, grinder::DriveFeedback& feedback) override {
    if (++feedback.status.feedback_count > kGoodReadings) misbehave("read");
  }
  void write(const grinder::DriveCycle&, const grinder::DriveCommand&) override {}
  bool powerOff() override {
    misbehave("powerOff");
    return true;
  }

 private:
  void misbehave(const std::string& function) const {
    const auto is_to = [&](const std::string& how) { return how_.find(how + " in " + function) != std::string::npos; };
    if (is_to("throws")) throw 7;
    if (is_to("throws no text")) throw std::runtime_error("");
    if (is_to("hangs")) ROS_WARN("hangs now");
    while (is_to("hangs")) std::this_thread::sleep_for(std::chrono::seconds(1));
  }

  const std::string how_ = ros::param::param<std::string>("~hardware/awkward", "");
  std::atomic<bool> go_{false};
};

}  // namespace

FLUTE_GRINDER_EXPORT_DRIVE(AwkwardDrive)
