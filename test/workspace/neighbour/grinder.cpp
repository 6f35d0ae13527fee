// Waits for the grinder's state, and says with the grinder's libraries where its axes stand.

#include <flute_grinder/GrinderState.h>
#include <flute_grinder/drive/robot_hw.h>
#include <flute_grinder/job/axes.h>
#include <flute_grinder/job/quantity.h>

#include <ros/ros.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace flute_grinder;
  ros::init(argc, argv, "neighbour");
  ros::NodeHandle nh;
  const auto state = ros::topic::waitForMessage<GrinderState>("grinder/state", nh, ros::Duration(60));
  if (!state) {
    std::cerr << "no state of a grinder within 60 s\n";
    return 1;
  }
  std::cout << state->state_name;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double rest = 0;
    const JointStateHandle joint(axisName(axis, UnitSystem::kShop), &state->position[axis], &rest, &rest);
    std::cout << "; " << joint.getName() << ' ' << text({joint.getPosition(), unitOf(axis, 0)}, UnitSystem::kShop);
  }
  std::cout << '\n';
  return 0;
}
