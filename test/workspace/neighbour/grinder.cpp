// Waits for the grinder's state, prints with the grinder's libraries where its axes are, a point of the curve,
// and the first setpoint of a job, whose file is the argument.

#include <flute_grinder/GrinderState.h>
#include <flute_grinder/curve/log_curve.h>
#include <flute_grinder/job/grind_job.h>
#include <flute_grinder/job/job_file.h>
#include <flute_grinder/motion/setpoint_stream.h>

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
    std::cout << "; axis_" << axis << ' ' << state->position[axis];
  }
  std::cout << "; A(1 m) = " << LogCurve(0, 2).a(1) << " rad";

  Machine machine;
  machine.period = 0.001;
  machine.limits = {Axes::Constant(-100), Axes::Constant(100), Axes::Constant(1), Axes::Constant(10),
                    Axes::Constant(100)};
  machine.park = Axes(-0.05, 0.05, 0, 0);
  SetpointStream stream(GrindProgram(ValidJob(readJobFile(argv[1])), machine, machine.park));
  Setpoint setpoint;
  stream.next(setpoint);
  std::cout << "; Y of the first setpoint = " << setpoint.position[kY] << " m\n";
  return 0;
}
