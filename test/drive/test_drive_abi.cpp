#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/export_drive.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace grinder {
namespace test_drive_abi {

// What plugins of this version have compiled in, on a 64-bit computer. A change of it needs another version.
TEST(DriveAbi, LayoutOfTheVersion) {
  EXPECT_EQ(kDriveAbi, 4U);
  EXPECT_EQ(sizeof(DriveStatus), 144U);
  EXPECT_EQ(offsetof(DriveStatus, swivel), 136U);
  EXPECT_EQ(sizeof(DriveCapabilities), 24U);
  EXPECT_EQ(sizeof(DriveFeedback), 208U);
  EXPECT_EQ(sizeof(DriveCommand), 40U);
  EXPECT_EQ(sizeof(DriveCycle), 24U);
  EXPECT_EQ(sizeof(Drive), 24U);
}

TEST(DriveAbi, NothingGoodIsSaidNorStatedUnlessADriveDoesSo) {
  const DriveStatus status;
  EXPECT_FALSE(status.enabled || status.homed || status.spindle_at_speed || status.coolant_on);
  const DriveCapabilities can;
  EXPECT_FALSE(can.homing || can.spindle || can.coolant || can.probe || can.swivel);
}

}  // namespace test_drive_abi
}  // namespace grinder
