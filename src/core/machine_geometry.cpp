#include "flute_grinder/core/machine_geometry.h"

#include <cmath>

namespace flute_grinder {

Eigen::Vector3d workZero(const MachineGeometry& machine, const GrindJob& job, const Mounting& mounting) {
  const GrindProcess& p = job.process;
  const Eigen::Vector3d spindle(-std::sin(p.setup_swivel), 0, std::cos(p.setup_swivel));
  // The wheel hangs below the flange.
  const double along = machine.flange - mounting.flange_to_wheel - p.wheel_width / 2;
  const Eigen::Vector3d wheel = machine.swivel_centre + along * spindle;
  const Eigen::Vector3d wanted(machine.collet_face - mounting.stickout,
                               machine.work_axis_y + job.cutter.end_diameter / 2 + p.wheel_diameter / 2,
                               machine.work_axis_z + p.setup_height);
  return wanted - wheel;
}

}  // namespace flute_grinder
