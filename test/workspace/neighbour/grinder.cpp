// Waits for the grinder's state, prints with the grinder's libraries where its axes are, and a point of the curve.

#include <flute_grinder/GrinderState.h>
#include <flute_grinder/curve/log_curve.h>
#include <flute_grinder/drive/robot_hw.h>
#include <flute_grinder/job/axes.h>

#include <ros/ros.h>

#include <iostream>
#include <string>

int main(int argc, char** argv) {
  using namespace grinder;
  ros::init(argc, argv, "neighbour");
  ros::NodeHandle nh;
  const auto state = ros::topic::waitForMessage<flute_grinder::GrinderState>("grinder/state", nh, ros::Duration(60));
  if (!state) {
    std::cerr << "no state of a grinder within 60 s\n";
    return 1;
  }
  std::cout << state->state_name;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double rest = 0;
    const JointStateHandle joint("axis_" + std::to_string(axis), &state->position[axis], &rest, &rest);
    std::cout << "; " << joint.getName() << ' ' << joint.getPosition();
  }
  std::cout << "; A(1 m) = " << LogCurve(0, 2).a(1) << " rad";
  std::cout << '\n';
  return 0;
}
