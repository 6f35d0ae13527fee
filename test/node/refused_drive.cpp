// A drive of another version of the drive interface, or of one without versions.

#include "flute_grinder/drive/axes_hw.h"
#include "flute_grinder/drive/export_drive.h"

#include <cstdlib>

namespace {

class RefusedDrive : public grinder::AxesHW {
 public:
  // Nothing may be called of a drive that sees the interface otherwise.
  RefusedDrive() { std::abort(); }
  bool init(ros::NodeHandle&, ros::NodeHandle&) override { return false; }
  void read(const ros::Time&, const ros::Duration&) override {}
  void write(const ros::Time&, const ros::Duration&) override {}
};

}  // namespace

#ifdef OTHER_VERSION
extern "C" {
extern const std::uint32_t flute_grinder_drive_abi;
const std::uint32_t flute_grinder_drive_abi = grinder::kDriveAbi + 41;
}
#endif
PLUGINLIB_EXPORT_CLASS(RefusedDrive, grinder::RobotHW)
