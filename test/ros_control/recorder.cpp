// Hardware as ros_control knows it, for tests: its joints stand where they are commanded to, it records every command
// that it has got while switched over, and fails as its parameter `fails` and the topic `now` say.

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace hi = hardware_interface;
constexpr std::size_t kMost = 100000;  ///< commands

class Recorder : public hi::RobotHW {
 public:
  bool init(ros::NodeHandle& root, ros::NodeHandle& nh) override {
    fails_ = nh.param<std::string>("fails", "");
    blocks_ = nh.param("blocks", false);
    record_.reserve(kMost);
    const bool lacks = fails_ == "joint";
    const std::array<const char*, 4> names{"x_slide", "y_slide", "z_slide", lacks ? "other" : "work_head"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      states_.registerHandle({names[i], &shown_[i], &velocity_[i], &effort_[i]});
      const hi::JointStateHandle state = states_.getHandle(names[i]);
      positions_.registerHandle({state, &command_[i]});
      with_velocity_.registerHandle({state, &command_[i], &command_velocity_[i]});
    }
    registerInterface(&states_);
    if (fails_ != "interface") registerInterface(&positions_);
    if (nh.param("with_velocity", false)) registerInterface(&with_velocity_);
    position_ = {-0.05, 0.05, 0, 0};  // where the machine parks
    now_subscriber_ = nh.subscribe<std_msgs::String>(
        "now", 1, [this](const std_msgs::String::ConstPtr& message) { now_.set(message->data); });
    write_record_ = nh.advertiseService("write_record", &Recorder::onWrite, this);
    file_ = nh.param<std::string>("record", "");
    names_ = root.getNamespace() + " " + nh.getNamespace();
    return fails_ != "init";
  }

  bool checkForConflict(const std::list<hi::ControllerInfo>&) const override { return fails_ == "conflict"; }
  bool prepareSwitch(const std::list<hi::ControllerInfo>& start, const std::list<hi::ControllerInfo>&) override {
    if (!start.empty()) interface_ = start.front().claimed_resources.front().hardware_interface;
    return fails_ != "prepare";
  }
  void doSwitch(const std::list<hi::ControllerInfo>& start, const std::list<hi::ControllerInfo>& stop) override {
    ++switches_;
    on_ = !start.empty();
    cycles_ = 0;
    wrong_ = start.size() + stop.size() != 1;
  }
  SwitchState switchResult(const hi::ControllerInfo&) const override {
    if (fails_ == "switch") return SwitchState::ERROR;
    return ++cycles_ > (fails_ == "late switch" ? 100 : 3) ? SwitchState::DONE : SwitchState::ONGOING;
  }

  void read(const ros::Time&, const ros::Duration&) override {
    if (blocks_) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // a bus with a cycle of its own
    if (now_ == "read") throw std::runtime_error("E17: encoder");
    while (now_ == "hang") std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (written_ && on_) position_ = command_;
    if (now_ == "drift") position_[0] += 1e-6;  // a new reference, bit by bit
    shown_ = position_;
  }
  void write(const ros::Time&, const ros::Duration& period) override {
    if (period.toNSec() != 1000000) wrong_ = true;
    written_ = true;
    if (on_ && record_.size() < kMost) record_.push_back({command_, command_velocity_});
    if (now_ == "limit") command_[0] *= 0.5;
  }

 private:
  bool onWrite(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    std::ofstream file(file_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(record_.data()),
               static_cast<std::streamsize>(record_.size() * sizeof(Row)));
    response.success = !wrong_;
    response.message = names_ + " " + interface_ + " " + std::to_string(switches_);
    return true;
  }

  /// One of the words that the cycle compares with, without a lock.
  class Word {
   public:
    void set(const std::string& word) {
      for (const char* known : {"", "read", "hang", "limit", "drift"}) {
        if (word == known) word_ = known;
      }
    }
    bool operator==(const std::string& word) const { return word == word_.load(); }

   private:
    std::atomic<const char*> word_{""};
  };
  struct Row {
    std::array<double, 4> position, velocity;
  };

  std::string fails_, file_, names_, interface_;
  Word now_;
  std::array<double, 4> position_{}, shown_{}, velocity_{}, effort_{}, command_{}, command_velocity_{};
  std::vector<Row> record_;
  std::atomic<bool> on_{false}, wrong_{false};
  bool written_ = false, blocks_ = false;
  std::atomic<int> switches_{0};
  mutable int cycles_ = 0;
  hi::JointStateInterface states_;
  hi::PositionJointInterface positions_;
  hi::PosVelJointInterface with_velocity_;
  ros::Subscriber now_subscriber_;
  ros::ServiceServer write_record_;
};

}  // namespace

PLUGINLIB_EXPORT_CLASS(Recorder, hardware_interface::RobotHW)
