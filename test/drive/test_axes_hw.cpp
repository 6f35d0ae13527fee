#include "flute_grinder/drive/axes_hw.h"
#include "flute_grinder/drive/export_drive.h"

#include <gtest/gtest.h>

#include <cstddef>

// The base class of a drive, as a third-party package uses it: by its header alone.
namespace grinder {
namespace test_axes_hw {

class MinimalDrive : public AxesHW {
 public:
  bool init(ros::NodeHandle&, ros::NodeHandle&) override { return true; }
  void read(const ros::Time&, const ros::Duration&) override {
    for (std::size_t i = 0; i < position_.size(); ++i) {
      position_[i] = command_[i];
      velocity_[i] = 10 + static_cast<double>(i);
      effort_[i] = 20 + static_cast<double>(i);
    }
    status_.enabled = drive_command_.enable;
  }
  void write(const ros::Time&, const ros::Duration&) override {}
};

TEST(AxesHW, RegistersTheFourJointsOnItsBuffers) {
  MinimalDrive drive;
  auto* states = drive.get<JointStateInterface>();
  auto* joints = drive.get<PositionJointInterface>();
  ASSERT_TRUE(states && joints);
  EXPECT_EQ(states->getNames(), (std::vector<std::string>{"axis_a", "axis_x", "axis_y", "axis_z"}));
  EXPECT_EQ(joints->getNames(), states->getNames());
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    joints->getHandle(kJointNames[i]).setCommand(static_cast<double>(i) + 1);
  }
  drive.read(ros::Time(1), ros::Duration(0.001));
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const auto n = static_cast<double>(i);
    const JointStateHandle state = states->getHandle(kJointNames[i]);
    EXPECT_EQ(state.getPosition(), n + 1);
    EXPECT_EQ(state.getVelocity(), n + 10);
    EXPECT_EQ(state.getEffort(), n + 20);
  }
}

TEST(AxesHW, RegistersTheDriveHandle) {
  MinimalDrive drive;
  auto* drives = drive.get<DriveInterface>();
  ASSERT_TRUE(drives);
  DriveHandle handle = drives->getHandle("drive");
  EXPECT_FALSE(handle.getStatus().enabled);
  DriveCommand command;
  command.enable = true;
  handle.setCommand(command);
  drive.read(ros::Time(1), ros::Duration(0.001));
  EXPECT_TRUE(handle.getStatus().enabled);
}

// What plugins of this version have compiled in, on a 64-bit computer. A change of it needs another version.
TEST(DriveAbi, LayoutOfTheVersion) {
  EXPECT_EQ(kDriveAbi, 3U);
  EXPECT_EQ(sizeof(DriveStatus), 144U);
  EXPECT_EQ(offsetof(DriveStatus, swivel), 136U);
  EXPECT_EQ(sizeof(DriveCommand), 5U);
  EXPECT_EQ(sizeof(JointHandle), 64U);
  EXPECT_EQ(sizeof(DriveHandle), 48U);
  EXPECT_EQ(sizeof(RobotHW), 72U);
  EXPECT_EQ(sizeof(AxesHW), 496U);
}

}  // namespace test_axes_hw
}  // namespace grinder
