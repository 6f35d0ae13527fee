#include "flute_grinder/cli/zeros.h"

#include "flute_grinder/cli/json_output.h"
#include "flute_grinder/cli/machine_file.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/core/wheel_file.h"

#include <cstdio>
#include <stdexcept>

namespace flute_grinder {

namespace {

using units::kMillimetre;

}  // namespace

double flangeOf(const std::string& job, const std::optional<double>& flange_mm) {
  if (flange_mm) return *flange_mm * kMillimetre;
  const std::string wheel = wheelFileOf(job);
  if (wheel.empty()) throw std::invalid_argument("--flange is missing, and " + job + " names no wheel file");
  const std::optional<double> flange = readWheelFile(wheel).flange;
  if (!flange) throw std::invalid_argument("--flange is missing, and " + wheel + " has no flange_mm");
  return *flange;
}

int printZeros(const ZerosOptions& options) {
  const GrindJob job = readJobFile(options.job);
  const MachineGeometry geometry = readMachineFiles(options.parameters, options.urdf).geometry;
  const double flange = flangeOf(options.job, options.flange_mm);
  const double stickout = options.stickout_mm * kMillimetre;
  if (!(stickout >= job.cutter.flute_length)) {
    std::fprintf(stderr, "--stickout = %.10g mm; allowed: the flutes' length or more, %.10g mm\n", options.stickout_mm,
                 job.cutter.flute_length / kMillimetre);
    return 1;
  }
  const Eigen::Vector3d zero = workZero(geometry, job, {flange, stickout}) / kMillimetre;
  if (options.json) {
    print(Json{{"x_mm", zero.x()}, {"y_mm", zero.y()}, {"z_mm", zero.z()}});
  } else {
    std::printf("%-20s X %.4f  Y %.4f  Z %.4f mm\n", "work zero", zero.x(), zero.y(), zero.z());
  }
  return 0;
}

}  // namespace flute_grinder
