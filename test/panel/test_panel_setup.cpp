// The set-up sheet in the panel: solved for the machine of the running grinder, and written into the job file.

#include "flute_grinder/curve/units.h"
#include "flute_grinder/messages/offset_basis.h"
#include "panel_fixture.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <QComboBox>
#include <QDialog>
#include <QFile>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <cmath>

namespace grinder {
namespace test_panel_setup {

const QString kPackage = QString::fromStdString(ros::package::getPath("flute_grinder"));
const QString kPaper = kPackage + "/jobs/paper.yaml";
const QByteArray kSetup = "  setup: {swivel_deg: 32.34, height_mm: 5.882, lead_mm: 11.853}";

class SetupSheet : public ::testing::Test {
 protected:
  void open(const std::vector<std::pair<QByteArray, QByteArray>>& changes, const QString& source = kPaper) {
    file = changedJob(source, folder.filePath("job.yaml"), changes);
    panel = std::make_unique<Panel>("grinder", file);
    WAIT_FOR(panel->state() != "" && panel->enabled("setup"));
    panel->click("setup");
    WAIT_FOR(dialog());
    WAIT_FOR(sheet() != "Solving ...");
  }
  QDialog* dialog() { return panel->widget().findChild<QDialog*>("setup_dialog"); }
  std::string sheet() { return panel->text("setup_sheet"); }
  /// The number behind these words of the sheet.
  double figure(const QString& words) {
    const auto match = QRegularExpression(words + R"( +(-?\d+\.\d+))").match(QString::fromStdString(sheet()));
    EXPECT_TRUE(match.hasMatch()) << words.toStdString() << '\n' << sheet();
    return match.captured(1).toDouble();
  }
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
  // Of another program, which is good to 0.02 deg and 0.02 mm.
  EXPECT_NEAR(figure("swivel"), 32.350, 0.02);
  EXPECT_NEAR(figure("height"), 5.880, 0.02);
  EXPECT_NEAR(figure("lead"), 11.847, 0.02);
  EXPECT_NEAR(figure("depth"), 2.656, 0.02);
  EXPECT_NEAR(figure("reads D/2 -"), figure("height") - 1.5, 0.0011) << "half of the wheel's width";
  const QByteArray before = text();
  WAIT_FOR(panel->enabled("write_setup"));
  panel->click("write_setup");
  WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  EXPECT_FALSE(panel->enabled("write_setup"));
  EXPECT_EQ(panel->text("verdict").find("Not planned yet."), 0U);
  const flute_grinder::Process written = goalFromFile(file.toStdString()).process;
  EXPECT_NEAR(written.setup_swivel, figure("swivel") * units::kDegree, 0.0005 * units::kDegree);
  EXPECT_NEAR(written.setup_height, figure("height") * units::kMillimetre, 0.0005 * units::kMillimetre);
  EXPECT_NEAR(written.setup_lead, figure("lead") * units::kMillimetre, 0.0005 * units::kMillimetre);
  // All else is as before.
  const auto rest = [](QString job) { return job.remove(QRegularExpression("\n  setup: .*|[\\d.]")); };
  EXPECT_EQ(rest(text()), rest(before));
  panel->click("close_setup");
  WAIT_FOR(!dialog());
}

TEST_F(SetupSheet, KeepsTheFigureThatIsChosen) {
  // On a cylinder, of which one figure may stay.
  open({{"swivel_deg: 43.32", "swivel_deg: 43"}}, QString(kPaper).replace("paper", "roughing_d10_t4"));
  EXPECT_NEAR(figure("upper face"), 5 * std::sin(8 * units::kDegree), 0.00051) << "where nothing is kept: R sin r";
  auto& keep = panel->the<QComboBox>("keep_figure");
  ASSERT_EQ(keep.currentText(), "nothing");
  QTest::keyClick(&keep, Qt::Key_Down);
  EXPECT_EQ(keep.currentText(), "swivel");
  EXPECT_FALSE(panel->enabled("write_setup"));
  WAIT_FOR(panel->enabled("write_setup"));
  EXPECT_EQ(figure("swivel"), 43);
  const double height = figure("height");
  EXPECT_NE(height, -1.366);
  panel->click("write_setup");
  WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  const flute_grinder::Process written = goalFromFile(file.toStdString()).process;
  EXPECT_DOUBLE_EQ(written.setup_swivel, 43 * units::kDegree);
  EXPECT_NEAR(written.setup_height, height * units::kMillimetre, 0.0005 * units::kMillimetre);
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

TEST_F(SetupSheet, OfAReliefGoesToItsOperation) {
  const QString reamer = QString(kPaper).replace("paper", "taper_reamer_d6_t6");
  const QByteArray set_up = "    setup: {swivel_deg: 13.104, height_mm: -3.658}\n";
  file = changedJob(
      reamer, folder.filePath("job.yaml"),
      {{set_up, ""},
       {"file: ../wheels/straight_d100_w6.yaml}\n    setup: {swivel_deg: 13.104, height_mm: -3.548}",
        "file: " + kPackage.toUtf8() +
            "/wheels/straight_d100_w6.yaml}\n    setup: {swivel_deg: 13.104, height_mm: -3.548}"},
       {"mm: 0.01\n    wheel: {file: ../wheels", "mm: 0.01\n    wheel: {file: " + kPackage.toUtf8() + "/wheels"}});
  panel = std::make_unique<Panel>("grinder", file);
  auto& operation = panel->the<QComboBox>("operation");
  ASSERT_TRUE(operation.isVisible()) << panel->text("verdict");
  WAIT_FOR(panel->state() != "");
  EXPECT_FALSE(panel->enabled("setup"));
  QTest::keyClick(&operation, Qt::Key_Down);
  QTest::keyClick(&operation, Qt::Key_Down);
  WAIT_FOR(panel->enabled("setup"));
  EXPECT_NE(panel->text("verdict").find("'grind setup --write' finds it"), std::string::npos) << panel->text("verdict");
  panel->click("setup");
  WAIT_FOR(dialog());
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml, 2 primary relief for /grinder");
  WAIT_FOR(panel->enabled("write_setup"));
  panel->click("write_setup");
  WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  EXPECT_EQ(operation.currentText(), "2 primary relief");
  EXPECT_EQ(panel->text("verdict").find("Not planned yet."), 0U) << panel->text("verdict");
  const flute_grinder::Process written = goalFromFile(file.toStdString(), "primary").process;
  EXPECT_NEAR(written.setup_swivel, figure("swivel") * units::kDegree, 0.00051 * units::kDegree);
  EXPECT_NEAR(written.setup_height, figure("height") * units::kMillimetre, 0.00051 * units::kMillimetre);
  panel->click("close_setup");
  WAIT_FOR(!dialog());
}

}  // namespace test_panel_setup
}  // namespace grinder
