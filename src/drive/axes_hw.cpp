#include "flute_grinder/drive/axes_hw.h"

namespace grinder {

AxesHW::AxesHW() { registerHandles(); }

void AxesHW::registerHandles() {
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const JointStateHandle state(kJointNames[i], &position_[i], &velocity_[i], &effort_[i]);
    joint_states_.registerHandle(state);
    joint_commands_.registerHandle(JointHandle(state, &command_[i]));
  }
  drive_.registerHandle(DriveHandle("drive", &status_, &drive_command_));
  registerInterface(&joint_states_);
  registerInterface(&joint_commands_);
  registerInterface(&drive_);
}

}  // namespace grinder
