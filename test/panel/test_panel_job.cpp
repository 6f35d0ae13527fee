// The panel against the grinder's node with the simulated drive: a job, and the set-up sheet, which is solved for this
// machine, and written into the job file.

#include "flute_grinder/messages/offset_basis.h"
#include "german.h"
#include "panel_fixture.h"

#include <QDialog>
#include <QRegularExpression>

namespace grinder::test_panel_job {

TEST(WithGrinder, AWholeJobIsClickedThrough) {
  Panel panel("grinder");
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_EQ(panel.text("plan_report"), "Open a job file first.");
  EXPECT_FALSE(panel.enabled("plan"));
  WAIT_FOR(panel.label("position_x") == "X   -50.000 mm");
  QFileDialog* dialog = panel.fileDialog();
  ASSERT_TRUE(dialog);
  EXPECT_EQ(dialog->windowTitle(), "Choose a job file for /grinder");
  Panel::enter(*dialog, kPaper);
  WAIT_FOR(!panel.widget().findChild<QFileDialog*>());
  EXPECT_EQ(panel.label("job_file"), "paper.yaml");
  EXPECT_FALSE(panel.enabled("start"));
  panel.press("plan");
  WAIT_FOR(panel.text("plan_report").find("Takes ") == 0);
  EXPECT_TRUE(panel.says("plan_report", "Feed 600.0 mm/min; no axis limits it."));
  panel.press("enable");
  WAIT_FOR(panel.state() == "Ready");
  panel.picture("planned");
  panel.press("start");
  panel.press("confirm-wheel");
  WAIT_FOR(panel.text("plan_report").find("Takes ") == 0);
  panel.press("start");
  for (const char* answer : {"ignore-offsets", "confirm-swivel"}) panel.press(answer);
  WAIT_FOR(panel.state() == "Running" && panel.the<QProgressBar>("stroke").value() > 100);
  EXPECT_EQ(panel.label("place"), "paper.yaml, tooth 1, pass 1");
  EXPECT_FALSE(panel.isVisible("other_job")) << "it was started here";
  WAIT_FOR(panel.label("feed") == "600 mm/min");
  panel.click("hold");
  WAIT_FOR(panel.state() == "Held");
  panel.picture("held_in_the_stroke");
  panel.click("retract");
  WAIT_FOR(panel.state() == "Retracted");
  panel.click("resume");
  WAIT_FOR(panel.state() == "Running");
  WAIT_FOR(panel.says("messages", "The job is done"));
  WAIT_FOR(panel.state() == "Ready" && panel.label("place") == "No job runs");
  EXPECT_EQ(panel.the<QProgressBar>("job").text(), "Job 100 %");
  EXPECT_FALSE(panel.enabled("start")) << "a plan is for one start";
  WAIT_FOR(!panel.the<QCheckBox>("continue").isEnabled());
  panel.picture("done");
  panel.click("disable");
  WAIT_FOR(panel.state() == "Disabled");
}

// ---------------------------------------------------------------------------------------------------------------------

const QString kJob = kPackage + "/jobs/paper.yaml";

class SetupSheet : public ::testing::Test {
 protected:
  void open(const std::vector<std::pair<QByteArray, QByteArray>>& changes, const QString& source = kJob) {
    panel = std::make_unique<Panel>("grinder", changedJob(source, folder.filePath("job.yaml"), changes));
    WAIT_FOR(panel->state() != "");
    if (!panel->isVisible("operation")) openSheet();
  }
  void openSheet() {
    panel->press("setup");
    WAIT_FOR(dialog());
    WAIT_FOR(sheet() != "Solving ...");
  }
  void write(const char* setup) {
    panel->press("write_setup");
    EXPECT_TRUE(panel->says("write_question", "Write this set-up into " + folder.filePath(setup).toStdString() + "?"));
    panel->press("write_over");
    WAIT_FOR(sheet().find("Written into ") != std::string::npos);
    EXPECT_EQ(panel->text("plan_report").find("Not planned yet."), 0U) << panel->text("plan_report");
  }
  void closeSheet() {
    panel->click("close_setup");
    WAIT_FOR(!dialog());
  }
  QDialog* dialog() { return panel->widget().findChild<QDialog*>("setup_dialog"); }
  std::string sheet() { return panel->text("setup_sheet"); }
  /// The number behind these words of the sheet.
  double figure(const QString& words) {
    const auto match = QRegularExpression(words + R"( +(-?\d+\.\d+))").match(QString::fromStdString(sheet()));
    EXPECT_TRUE(match.hasMatch()) << words.toStdString() << '\n' << sheet();
    return match.captured(1).toDouble();
  }

  const QTemporaryDir folder;
  std::unique_ptr<Panel> panel;
};

TEST_F(SetupSheet, KeepsTheFigureThatTheJobAsksForAndIsWrittenOnlyIfTheOperatorSaysSoTwice) {
  ASSERT_TRUE(test_support::hasComma()) << "Qt has given this process the desktop's locale, here a German one";
  // On a cylinder, of which one figure may stay.
  open({{"roughing_d10_t4.setup.yaml", "roughing_d10_t4.setup.yaml, swivel_deg: 43.32"}},
       QString(kJob).replace("paper", "roughing_d10_t4"));
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml for /grinder");
  EXPECT_TRUE(panel->says("setup_sheet", "height_mm         -1.366 before, "));
  EXPECT_EQ(figure("swivel"), 43.32);
  panel->press("write_setup");
  panel->press("decline_write");
  QTest::keyClick(dialog(), Qt::Key_Return);
  WAIT_FOR(!dialog());
  const auto height = [&] { return processOf(goalFromFile(folder.filePath("job.yaml").toStdString())).setup_height; };
  EXPECT_DOUBLE_EQ(height(), -1.366e-3) << "Enter closes it";
  ASSERT_NO_FATAL_FAILURE(openSheet());
  ASSERT_NO_FATAL_FAILURE(write("roughing_d10_t4.setup.yaml"));
  EXPECT_FALSE(panel->enabled("write_setup"));
  EXPECT_NEAR(height(), 0, 1e-6);
  closeSheet();
}

TEST_F(SetupSheet, IsNotWrittenIntoTheFileOfTheJobThatRuns) {
  open({{"feed_mm_min: 600", "feed_mm_min: 100"}});
  WAIT_FOR(panel->enabled("write_setup"));
  panel->press("enable");
  WAIT_FOR(panel->state() == "Ready");
  panel->plan();
  panel->press("start");
  const auto asks_for_wheel = [&] { return panel->isVisible("confirm-wheel"); };
  WAIT_FOR(asks_for_wheel() || panel->isVisible("ignore-offsets"));
  // Another test may have confirmed it.
  if (asks_for_wheel()) {
    panel->press("confirm-wheel");
    WAIT_FOR(panel->text("plan_report").find("Takes ") == 0);
    panel->press("start");
  }
  for (const char* answer : {"ignore-offsets", "confirm-swivel"}) panel->press(answer);
  WAIT_FOR(panel->state() == "Running" && !panel->enabled("write_setup"));
  EXPECT_EQ(panel->label("why_not_written"), "This job runs: its set-up file is not written.");
  panel->click("cancel");
  WAIT_FOR(panel->state() == "Ready");
  panel->press("write_setup");
  EXPECT_TRUE(panel->says("write_question", "The job of this file is not finished, and cannot be continued"));
  panel->press("decline_write");
  closeSheet();
  panel->click("disable");
  WAIT_FOR(panel->state() == "Disabled");
}

TEST_F(SetupSheet, IsNotWrittenForAJobWithFigures) {
  open({}, kPaper);
  EXPECT_TRUE(panel->says("setup_sheet", "The figures of the set-up are written by hand in the job file"));
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, IsNotWrittenIfAPlanWouldRefuseItAndCountsTheWheelsPlaceOnTheSpindle) {
  double flange = 0;
  ASSERT_TRUE(ros::param::get("/grinder/geometry/flange", flange));
  ros::param::set("/grinder/geometry/flange", 0);  // as YAML reads it without a decimal point
  // Each tooth has a helix of its own, and the set-up is for the middle.
  open({{"roughing_d10_t4.setup.yaml", "job.setup.yaml"},
        {"teeth: 4", "teeth: 2"},
        {"spiral_angle_deg: 35", "spiral_angles_deg: [32, 38]"},
        {"wheel:\n    diameter_mm: 100\n    width_mm: 3\n    profile: straight\n    corner_radius_mm: [0, 0]\n"
         "    wear_mm: 0\n    wear_per_pass_mm: 0.0002\n",
         "wheel: {file: ../wheels/straight_d100_w3.yaml}\n"}},
       QString(kJob).replace("paper", "roughing_d10_t4"));
  ros::param::set("/grinder/geometry/flange", flange);
  EXPECT_NE(figure("with the wheel's middle"), 0);
  EXPECT_TRUE(panel->says("setup_sheet", "a plan would refuse this tool: cutter.rake_angle_deg = 8 deg"));
  EXPECT_TRUE(panel->says("setup_sheet", "It is not written."));
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, NeedsTheMachinesSwivel) {
  std::string description;
  ASSERT_TRUE(ros::param::get("/robot_description", description));
  ros::param::del("/robot_description");
  open({{"paper.setup.yaml", "job.setup.yaml"}});
  ros::param::set("/robot_description", description);
  EXPECT_TRUE(panel->says("plan_report", "'grind setup --write' solves it"));
  EXPECT_EQ(sheet(), "the machine's swivel is not known: no parameter /robot_description from the ROS master");
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, OfAReliefGoesToItsOperation) {
  open({}, QString(kJob).replace("paper", "taper_reamer_d6_t6"));
  QFile solved(folder.filePath("taper_reamer_d6_t6.setup.yaml"));
  ASSERT_TRUE(solved.open(QFile::ReadOnly));
  QByteArray others = solved.readAll();
  solved.close();
  const auto primary = others.indexOf("primary:");
  others.remove(primary, others.indexOf("secondary:") - primary);
  ASSERT_TRUE(solved.open(QFile::WriteOnly) && solved.write(others) == others.size());
  solved.close();
  EXPECT_FALSE(panel->enabled("setup"));
  panel->chooseOperation("2 primary relief");
  WAIT_FOR(panel->enabled("setup"));
  EXPECT_TRUE(panel->says("plan_report", "'grind setup --operation primary --write' solves it"));
  ASSERT_NO_FATAL_FAILURE(openSheet());
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml, 2 primary relief for /grinder");
  ASSERT_NO_FATAL_FAILURE(write("taper_reamer_d6_t6.setup.yaml"));
  EXPECT_EQ(panel->the<QComboBox>("operation").currentText(), "2 primary relief");
  closeSheet();
}

}  // namespace grinder::test_panel_job
