#include "node/machine_topic.h"
#include "flute_grinder/MachineInfo.h"

#include <algorithm>

namespace flute_grinder {

ros::Publisher publishMachine(ros::NodeHandle private_nh, const core::MachineInfo& info) {
  const auto copy = [](const Axes& axes, auto& array) {
    std::copy(axes.data(), axes.data() + kAxisCount, array.begin());
  };
  MachineInfo message;
  message.name = info.name;
  message.version = info.version;
  message.drive = info.drive;
  message.period = info.period;
  copy(info.max_velocity, message.max_velocity);
  copy(info.max_acceleration, message.max_acceleration);
  copy(info.max_following_error, message.max_following_error);
  ros::Publisher publisher = private_nh.advertise<MachineInfo>("machine", 1, true);
  publisher.publish(message);
  return publisher;
}

}  // namespace flute_grinder
