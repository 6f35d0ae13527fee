#include "flute_grinder/cli/zeros.h"

#include "flute_grinder/cli/json_output.h"
#include "flute_grinder/cli/machine_file.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/core/wheel_file.h"

#include <cstdio>

namespace flute_grinder {

namespace {

using units::kMillimetre;

/// From the flange's face to the wheel [m]; nothing, and a reason on stderr, if it is not known.
std::optional<double> flangeOf(const ZerosOptions& options) {
  if (options.flange_mm) return *options.flange_mm * kMillimetre;
  const std::string wheel = wheelFileOf(options.job);
  if (wheel.empty()) {
    std::fprintf(stderr, "--flange is missing, and %s names no wheel file\n", options.job.c_str());
    return std::nullopt;
  }
  const std::optional<double> flange = readWheelFile(wheel).flange;
  if (!flange) std::fprintf(stderr, "--flange is missing, and %s has no flange_mm\n", wheel.c_str());
  return flange;
}

}  // namespace

int printZeros(const ZerosOptions& options) {
  const GrindJob job = readJobFile(options.job);
  const MachineGeometry geometry = readMachineFiles(options.parameters, options.urdf).geometry;
  const std::optional<double> flange = flangeOf(options);
  if (!flange) return 2;
  const double stickout = options.stickout_mm * kMillimetre;
  if (!(stickout >= job.cutter.flute_length)) {
    std::fprintf(stderr, "--stickout = %.10g mm; allowed: the flutes' length or more, %.10g mm\n", options.stickout_mm,
                 job.cutter.flute_length / kMillimetre);
    return 1;
  }
  const Eigen::Vector3d zero = workZero(geometry, job, {*flange, stickout}) / kMillimetre;
  if (options.json) {
    print(Json{{"x_mm", zero.x()}, {"y_mm", zero.y()}, {"z_mm", zero.z()}});
  } else {
    std::printf("%-20s X %.4f  Y %.4f  Z %.4f mm\n", "work zero", zero.x(), zero.y(), zero.z());
  }
  return 0;
}

}  // namespace flute_grinder
