// A drive that is not as simple as the simulated one; ~hardware/awkward says how.

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/export_drive.h"
#include "flute_grinder/drive/parameters.h"

#include <std_msgs/Empty.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace {

class AwkwardDrive : public grinder::Drive {
 public:
  void init(ros::NodeHandle&, ros::NodeHandle& nh) override {
    how_ = grinder::ParameterReader(nh).text("awkward");
    const ros::Subscriber go =
        nh.subscribe<std_msgs::Empty>("go", 1, [this](const std_msgs::Empty::ConstPtr&) { go_ = true; });
    if (how_ != "waits") return;
    while (!go_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  grinder::DriveCapabilities capabilities() const override {
    grinder::DriveCapabilities can;
    can.prepares = how_ == "hangs in prepare";
    if (how_ == "slow bus") can.shortest_period = 0.002;
    if (how_ == "long buffer") can.buffer = 5000;
    return can;
  }
  void prepare() override {
    while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  void read(const grinder::DriveCycle&, grinder::DriveFeedback& feedback) override { ++feedback.status.feedback_count; }
  void write(const grinder::DriveCycle&, const grinder::DriveCommand&) override {}

 private:
  std::string how_;
  std::atomic<bool> go_{false};
};

}  // namespace

FLUTE_GRINDER_EXPORT_DRIVE(AwkwardDrive)
