#include "cli/zeros.h"

#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/offsets.h"
#include "cli/online.h"
#include "cli/waiting.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/messages/offset_basis.h"

#include <cstdio>
#include <stdexcept>

namespace grinder {

namespace {

using units::kMillimetre;

/// The zero point [m]; nothing, with the reason on stderr, if the cutter does not stand out far enough.
std::optional<Eigen::Vector3d> zeroOf(const ZerosOptions& options, const MachineGeometry& geometry) {
  const JobFile file = openJobFile(options.job, options.operation);
  const GrindJob& job = file.job;
  const double flange = flangeOf(file, options.flange_mm);
  const double stickout = options.stickout_mm * kMillimetre;
  if (stickout >= job.cutter.flute_length) return workZero(geometry, job, {flange, stickout});
  std::fprintf(stderr, "--stickout = %.10g mm; allowed: the flutes' length or more, %.10g mm\n", options.stickout_mm,
               job.cutter.flute_length / kMillimetre);
  return std::nullopt;
}

void printZero(const Eigen::Vector3d& metres, bool json) {
  const Eigen::Vector3d zero = metres / kMillimetre;
  if (json) {
    print(Json{{"x_mm", zero.x()}, {"y_mm", zero.y()}, {"z_mm", zero.z()}});
  } else {
    std::printf("%-20s X %s  Y %s  Z %s mm\n", "work zero", fixed(zero.x(), 4).c_str(), fixed(zero.y(), 4).c_str(),
                fixed(zero.z(), 4).c_str());
  }
}

}  // namespace

double flangeOf(const JobFile& job, const std::optional<double>& flange_mm) {
  if (flange_mm) return *flange_mm * kMillimetre;
  if (!job.wheel) throw std::invalid_argument("--flange is missing, and " + job.path + " names no wheel file");
  if (!job.wheel->flange) {
    throw std::invalid_argument("--flange is missing, and " + job.wheel_path + " has no flange_mm");
  }
  return *job.wheel->flange;
}

int printZeros(const ZerosOptions& options) {
  const MachineGeometry geometry = readMachineFiles({options.parameters}, options.urdf).config.loop.geometry;
  const std::optional<Eigen::Vector3d> zero = zeroOf(options, geometry);
  if (!zero) return 1;
  printZero(*zero, options.json);
  return 0;
}

int setZeros(const std::string& node, const ZerosOptions& options) {
  ros::NodeHandle nh(node);
  if (!await(kPatience, [&] { return nh.hasParam("geometry"); })) return noGrinder(nh);
  const std::optional<Eigen::Vector3d> zero = zeroOf(options, readMachineGeometry(ParameterReader(nh)));
  if (!zero) return 1;
  const OffsetBasis basis = basisOf(goalFromFile(options.job, options.operation), OffsetMethod::kComputed);
  const OffsetValues values{{kX, zero->x()}, {kY, zero->y()}, {kZ, zero->z()}};
  if (const int status = setWorkOffsets(nh, values, basis, options.answers)) return status;
  printZero(*zero, options.json);
  return 0;
}

}  // namespace grinder
