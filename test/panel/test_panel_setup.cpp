// The set-up sheet in the panel: solved for the machine of the running grinder, and written into the job file.

#include "panel_fixture.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <QComboBox>
#include <QDialog>
#include <QFile>
#include <QTemporaryDir>

namespace flute_grinder {
namespace test_panel_setup {

const QString kPackage = QString::fromStdString(ros::package::getPath("flute_grinder"));
const QString kPaper = kPackage + "/test/jobs/paper.yaml";
const QByteArray kSetup = "  setup: {swivel_deg: 31.769, height_mm: 2.788}";

class SetupSheet : public ::testing::Test {
 protected:
  void open(const std::vector<std::pair<QByteArray, QByteArray>>& changes) {
    file = changedJob(kPaper, folder.filePath("job.yaml"), changes);
    panel = std::make_unique<Panel>("grinder", file);
    WAIT_FOR(panel->state() != "" && panel->enabled("setup"));
    panel->click("setup");
    WAIT_FOR(dialog());
    WAIT_FOR(sheet() != "Solving ...");
  }
  QDialog* dialog() { return panel->widget().findChild<QDialog*>("setup_dialog"); }
  std::string sheet() { return panel->text("setup_sheet"); }
  QByteArray text() {
    QFile read(file);
    EXPECT_TRUE(read.open(QFile::ReadOnly));
    return read.readAll();
  }

  const QTemporaryDir folder;
  QString file;
  std::unique_ptr<Panel> panel;
};

TEST_F(SetupSheet, IsShownAndWritten) {
  open({{kSetup, ""}});
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml for /grinder");
  EXPECT_NE(panel->text("verdict").find("'grind setup --write' finds it"), std::string::npos) << panel->text("verdict");
  EXPECT_NE(sheet().find("31.769 deg; the machine's range is -60 to 60 deg"), std::string::npos) << sheet();
  EXPECT_NE(sheet().find("reads D/2 - 1.288 mm"), std::string::npos) << sheet();
  const QByteArray before = text();
  WAIT_FOR(panel->enabled("write_setup"));
  panel->click("write_setup");
  WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  EXPECT_FALSE(panel->enabled("write_setup"));
  EXPECT_EQ(panel->text("verdict").find("Not planned yet."), 0U);
  QByteArray after = text();
  EXPECT_EQ(after.count("setup: {swivel_deg: 31.769, height_mm: 2.78841}"), 1);
  EXPECT_EQ(after.replace("  setup: {swivel_deg: 31.769, height_mm: 2.78841}\n", "").size(), before.size());
  panel->click("close_setup");
  WAIT_FOR(!dialog());
}

TEST_F(SetupSheet, KeepsTheFigureThatIsChosen) {
  open({{"swivel_deg: 31.769", "swivel_deg: 31"}});
  EXPECT_NE(sheet().find("31.769 deg; the machine's range"), std::string::npos) << sheet();
  auto& keep = panel->the<QComboBox>("keep_figure");
  ASSERT_EQ(keep.currentText(), "nothing");
  QTest::keyClick(&keep, Qt::Key_Down);
  EXPECT_EQ(keep.currentText(), "swivel");
  EXPECT_FALSE(panel->enabled("write_setup"));
  WAIT_FOR(panel->enabled("write_setup"));
  EXPECT_NE(sheet().find("31.000 deg; the machine's range"), std::string::npos) << sheet();
  panel->click("write_setup");
  WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  EXPECT_EQ(text().count("setup: {swivel_deg: 31, height_mm: 1.64"), 1) << text().toStdString();
  QTest::keyClick(&keep, Qt::Key_Down);  // and once more
  WAIT_FOR(panel->enabled("write_setup"));
  panel->click("close_setup");
  WAIT_FOR(!dialog());
}

TEST_F(SetupSheet, WithoutASolutionSaysWhy) {
  open({{"teeth: 1", "teeth: 8"}});
  EXPECT_EQ(sheet().find("no land is left: "), 0u) << sheet();
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, IsNotWrittenIfAPlanWouldRefuseIt) {
  // Each tooth has a helix of its own, and the set-up is for the middle.
  open({{kSetup, ""}, {"teeth: 1", "teeth: 2"}, {"spiral_angle_deg: 30", "spiral_angles_deg: [27, 33]"}});
  EXPECT_NE(sheet().find("a plan would refuse this tool: cutter.rake_angle_deg = 8 deg"), std::string::npos) << sheet();
  EXPECT_NE(sheet().find("It is not written."), std::string::npos) << sheet();
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, CountsTheWheelsPlaceOnTheSpindle) {
  open(
      {{"wheel:\n    diameter_mm: 100\n    width_mm: 3\n    profile: straight\n"
        "    corner_radius_mm: [0, 0]    # at the lower and the upper face\n    wear_mm: 0\n",
        "wheel: {file: " + kPackage.toUtf8() + "/wheels/straight_d100_w3.yaml}\n"}});
  EXPECT_NE(sheet().find("with the wheel's middle 0.000 mm above the swivel's centre"), std::string::npos) << sheet();
}

TEST_F(SetupSheet, NeedsTheMachinesSwivel) {
  std::string description;
  ASSERT_TRUE(ros::param::get("/robot_description", description));
  ros::param::del("/robot_description");
  open({});
  ros::param::set("/robot_description", description);
  EXPECT_EQ(sheet(), "the machine's swivel is not known: no parameter /robot_description from the ROS master");
  EXPECT_FALSE(panel->enabled("write_setup"));
}

}  // namespace test_panel_setup
}  // namespace flute_grinder
