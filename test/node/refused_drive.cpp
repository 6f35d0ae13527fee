// A drive of another version of the drive interface, or of one without versions.

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/export_drive.h"

#include <cstdlib>

namespace {

class RefusedDrive : public grinder::Drive {
 public:
  // Nothing may be called of a drive that sees the interface otherwise.
  RefusedDrive() { std::abort(); }
  void init(ros::NodeHandle&, ros::NodeHandle&) override {}
  grinder::DriveCapabilities capabilities() const override { return {}; }
  void read(const grinder::DriveCycle&, grinder::DriveFeedback&) override {}
  void write(const grinder::DriveCycle&, const grinder::DriveCommand&) override {}
};

}  // namespace

#ifdef OTHER_VERSION
extern "C" {
extern const std::uint32_t flute_grinder_drive_abi;
const std::uint32_t flute_grinder_drive_abi = grinder::kDriveAbi + 41;
}
#endif
PLUGINLIB_EXPORT_CLASS(RefusedDrive, grinder::Drive)
