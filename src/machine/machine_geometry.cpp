#include "flute_grinder/machine/machine_geometry.h"

#include "flute_grinder/job/grind_job.h"

#include <cmath>

namespace grinder {

Eigen::Vector3d wheelCentre(const MachineGeometry& machine, const GrindProcess& process, double flange_to_wheel) {
  const Eigen::Vector3d spindle(-std::sin(process.setup_swivel), 0, std::cos(process.setup_swivel));
  // The wheel hangs below the flange.
  return machine.swivel_centre + (machine.flange - flange_to_wheel - process.wheel_width / 2) * spindle;
}

Eigen::Vector3d workZero(const MachineGeometry& machine, const GrindJob& job, const Mounting& mounting) {
  const GrindProcess& p = job.process();
  const Eigen::Vector3d wanted(machine.collet_face - mounting.stickout,
                               machine.work_axis_y + job.cutter.end_diameter / 2 + p.wheel_diameter / 2,
                               machine.work_axis_z + p.setup_height);
  return wanted - wheelCentre(machine, p, mounting.flange_to_wheel);
}

}  // namespace grinder
