// The panel against the grinder's node with the simulated drive: an operator's day, and the set-up sheet, which is
// solved for this machine, and written into the job file.

#include "flute_grinder/InjectFault.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/messages/offset_basis.h"
#include "panel_fixture.h"

#include <QDialog>
#include <QRegularExpression>

#include <cmath>

namespace grinder::test_panel_job {

class WithGrinder : public ::testing::Test {
 protected:
  void TearDown() override {
    inject("none");
    if (panel.enabled("cancel")) panel.click("cancel");
    WAIT_FOR(!panel.enabled("cancel"));
    WAIT_FOR(panel.state() != "No answer");
    if (panel.enabled("reset")) panel.click("reset");
    if (panel.enabled("disable")) panel.click("disable");
    WAIT_FOR(panel.state() == "Disabled");
  }

  void open(const QString& file) {
    WAIT_FOR(panel.enabled("choose"));
    QFileDialog* dialog = panel.fileDialog();
    ASSERT_TRUE(dialog);
    EXPECT_EQ(dialog->windowTitle(), "Choose a job file for /grinder");
    Panel::enter(*dialog, file);
    WAIT_FOR(!panel.widget().findChild<QFileDialog*>());
  }
  void plan() {
    panel.press("plan");
    WAIT_FOR(panel.text("verdict").find("Takes ") == 0);
  }
  void enable() {
    panel.press("enable");
    WAIT_FOR(panel.state() == "Ready");
  }
  /// Gives up a job that a test before has left, leaves the zero points, which nobody has set, and confirms the swivel
  /// if it is asked for.
  void start() {
    panel.press("start");
    for (const char* answer : {"discard", "ignore_offset_check", "confirm_swivel"}) {
      if (panel.isVisible(answer)) panel.press(answer);
    }
    // Not the stroke that the job before has ended with.
    WAIT_FOR(panel.state() == "Running" && 100 < stroke() && stroke() < 1000);
  }
  int stroke() { return panel.the<QProgressBar>("stroke").value(); }
  /// [mm], A [deg]
  double position(char axis) {
    const QStringList words =
        panel.the<QLabel>((std::string("position_") + axis).c_str()).text().simplified().split(' ');
    EXPECT_EQ(words.size(), 3);
    return words.value(1).toDouble();
  }
  static void inject(const std::string& fault) {
    flute_grinder::InjectFault call;
    call.request.fault = fault;
    // Persistent, since roscpp may lose the answer of any other (ros_comm #1976).
    auto client = ros::NodeHandle().serviceClient<flute_grinder::InjectFault>("grinder/hardware/inject_fault", true);
    ASSERT_TRUE(client.call(call) && call.response.success);
  }

  const QTemporaryDir folder;
  // Long enough to press buttons.
  const QString slow = changedJob(kPaper, folder.filePath("slow.yaml"), {{"feed_mm_min: 600", "feed_mm_min: 300"}});
  Panel panel{"grinder"};
};

TEST_F(WithGrinder, AWholeJobIsClickedThrough) {
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_EQ(panel.text("verdict"), "Open a job file first.");
  EXPECT_FALSE(panel.enabled("plan"));
  WAIT_FOR(panel.label("position_x") != "X         - mm");
  EXPECT_NEAR(position('x'), -50, 0.01);
  EXPECT_NEAR(position('y'), 50, 0.01);
  open(slow);
  EXPECT_EQ(panel.label("job_file"), "slow.yaml");
  EXPECT_FALSE(panel.enabled("start"));
  plan();
  EXPECT_TRUE(panel.says("verdict", "Feed 300.0 mm/min; no axis limits it."));
  enable();
  panel.picture("planned");
  start();
  EXPECT_EQ(panel.label("place"), "slow.yaml, tooth 1, pass 1");
  EXPECT_FALSE(panel.isVisible("other_job")) << "it was started here";
  WAIT_FOR(panel.label("feed") == "300 mm/min");
  panel.picture("grinding");

  panel.click("hold");
  WAIT_FOR(panel.state() == "Held");
  const double x = position('x');
  const double y = position('y');
  EXPECT_TRUE(0 < x && x < 30) << x;
  // On the cone of 5 deg, 1.6 mm deep.
  EXPECT_NEAR(y, x * std::tan(5 * M_PI / 180) - 1.6, 0.01);
  EXPECT_GT(position('a'), 10);
  panel.picture("held_in_the_stroke");
  panel.click("retract");
  WAIT_FOR(panel.state() == "Retracted");
  EXPECT_NEAR(position('x'), x, 0.01);
  EXPECT_GT(position('y'), y + 4);
  panel.click("resume");
  WAIT_FOR(panel.state() == "Running" && position('x') > x + 1);
  WAIT_FOR(panel.says("messages", "The job is done"));
  WAIT_FOR(panel.state() == "Ready" && panel.label("place") == "No job runs");
  EXPECT_EQ(panel.the<QProgressBar>("job").text(), "Job 100 %");
  EXPECT_FALSE(panel.enabled("start")) << "a plan is for one start";
  WAIT_FOR(!panel.the<QCheckBox>("continue").isEnabled());
  panel.picture("done");
}

TEST_F(WithGrinder, AJobThatWasCanceledIsContinuedAndEndsWithAFault) {
  open(slow);
  enable();
  panel.click("dry_run");
  WAIT_FOR(panel.enabled("start"));
  EXPECT_TRUE(panel.says("messages", "Planned and checked; nothing moved"));
  start();
  panel.click("cancel");
  WAIT_FOR(panel.says("messages", "The job has ended: canceled; stopped on the path"));
  WAIT_FOR(panel.state() == "Ready");
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text(), "Continue at tooth 1, pass 1");
  EXPECT_FALSE(panel.enabled("start"));
  panel.tick("continue");
  EXPECT_TRUE(go_on.isChecked());
  plan();
  panel.picture("continue");
  start();
  inject("emergency_stop");
  WAIT_FOR(panel.state() == "Fault");
  WAIT_FOR(panel.says("messages", "The job has ended: emergency stop"));
  EXPECT_TRUE(panel.shows("meaning", "Fault: emergency stop. The emergency stop is pressed."));
  panel.picture("emergency_stop");
  panel.click("reset");
  WAIT_FOR(panel.says("messages", "Reset refused"));
  inject("none");
  panel.click("reset");
  WAIT_FOR(panel.state() == "Disabled");
  enable();
  const double y = position('y');
  panel.press("lift");
  WAIT_FOR(!panel.enabled("lift") && panel.state() == "Ready" && position('y') > y + 1);
}

TEST_F(WithGrinder, AnErrorInAJobFileIsShown) {
  WAIT_FOR(panel.state() == "Disabled");
  open(changedJob(kPaper, folder.filePath("wrong.yaml"), {{"spiral_angle_deg: 30", "spiral_angle_deg: 300"}}));
  EXPECT_TRUE(panel.says("verdict", "wrong.yaml:5"));
  EXPECT_TRUE(panel.says("verdict", "spiral_angle_deg = 300"));
  EXPECT_EQ(panel.text("verdict").find(folder.path().toStdString()), std::string::npos) << panel.text("verdict");
  panel.picture("wrong_job_file");
  open(folder.filePath("slow.yaml"));
  EXPECT_EQ(panel.text("verdict").find("Not planned yet."), 0U);
}

// ---------------------------------------------------------------------------------------------------------------------

const QString kJob = kPackage + "/jobs/paper.yaml";
const QByteArray kSetup = "  setup: {swivel_deg: 32.34, height_mm: 5.882, lead_mm: 11.853}";

class SetupSheet : public ::testing::Test {
 protected:
  void open(const std::vector<std::pair<QByteArray, QByteArray>>& changes, const QString& source = kJob) {
    file = changedJob(source, folder.filePath("job.yaml"), changes);
    panel = std::make_unique<Panel>("grinder", file);
    WAIT_FOR(panel->state() != "");
    if (!panel->isVisible("operation")) openSheet();
  }
  void openSheet() {
    panel->press("setup");
    WAIT_FOR(dialog());
    WAIT_FOR(sheet() != "Solving ...");
  }
  void write() {
    panel->press("write_setup");
    WAIT_FOR(sheet().find("Written into ") != std::string::npos);
  }
  void closeSheet() {
    panel->click("close_setup");
    WAIT_FOR(!dialog());
  }
  /// The file has the figures of the sheet.
  void expectWritten(const std::string& operation = "") {
    EXPECT_EQ(panel->text("verdict").find("Not planned yet."), 0U) << panel->text("verdict");
    const flute_grinder::Process written = goalFromFile(file.toStdString(), operation).process;
    EXPECT_NEAR(written.setup_swivel, figure("swivel") * units::kDegree, 0.00051 * units::kDegree);
    EXPECT_NEAR(written.setup_height, figure("height") * units::kMillimetre, 0.00051 * units::kMillimetre);
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
  QString file;
  std::unique_ptr<Panel> panel;
};

TEST_F(SetupSheet, IsShownAndWritten) {
  open({{kSetup, ""}});
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml for /grinder");
  EXPECT_TRUE(panel->says("verdict", "'grind setup --write' finds it"));
  EXPECT_NEAR(figure("swivel"), 32.350, 0.02);
  ASSERT_NO_FATAL_FAILURE(write());
  EXPECT_FALSE(panel->enabled("write_setup"));
  expectWritten();
  const flute_grinder::Process written = goalFromFile(file.toStdString()).process;
  EXPECT_NEAR(written.setup_lead, figure("lead") * units::kMillimetre, 0.0005 * units::kMillimetre);
  closeSheet();
}

TEST_F(SetupSheet, KeepsTheFigureThatIsChosen) {
  // On a cylinder, of which one figure may stay.
  open({{"swivel_deg: 43.32", "swivel_deg: 43"}}, QString(kJob).replace("paper", "roughing_d10_t4"));
  EXPECT_NEAR(figure("upper face"), 5 * std::sin(8 * units::kDegree), 0.00051) << "where nothing is kept: R sin r";
  auto& keep = panel->the<QComboBox>("keep_figure");
  ASSERT_EQ(keep.currentText(), "nothing");
  QTest::keyClick(&keep, Qt::Key_Down);
  EXPECT_EQ(keep.currentText(), "swivel");
  EXPECT_FALSE(panel->enabled("write_setup"));
  WAIT_FOR(panel->enabled("write_setup"));
  EXPECT_EQ(figure("swivel"), 43);
  EXPECT_NE(figure("height"), -1.366);
  ASSERT_NO_FATAL_FAILURE(write());
  expectWritten();
  EXPECT_DOUBLE_EQ(goalFromFile(file.toStdString()).process.setup_swivel, 43 * units::kDegree);
  QTest::keyClick(&keep, Qt::Key_Down);  // and once more
  WAIT_FOR(panel->enabled("write_setup"));
  closeSheet();
}

TEST_F(SetupSheet, WithoutASolutionSaysWhy) {
  open({{"teeth: 1", "teeth: 8"}});
  EXPECT_EQ(sheet().find("no land is left: "), 0u) << sheet();
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, IsNotWrittenIfAPlanWouldRefuseIt) {
  // Each tooth has a helix of its own, and the set-up is for the middle.
  open({{kSetup, ""}, {"teeth: 1", "teeth: 2"}, {"spiral_angle_deg: 30", "spiral_angles_deg: [27, 33]"}});
  EXPECT_TRUE(panel->says("setup_sheet", "a plan would refuse this tool: cutter.rake_angle_deg = 8 deg"));
  EXPECT_TRUE(panel->says("setup_sheet", "It is not written."));
  EXPECT_FALSE(panel->enabled("write_setup"));
}

TEST_F(SetupSheet, CountsTheWheelsPlaceOnTheSpindle) {
  open(
      {{"wheel:\n    diameter_mm: 100\n    width_mm: 3\n    profile: straight\n"
        "    corner_radius_mm: [0, 0]    # at the lower and the upper face\n    wear_mm: 0\n",
        "wheel: {file: " + kPackage.toUtf8() + "/wheels/straight_d100_w3.yaml}\n"}});
  EXPECT_TRUE(panel->says("setup_sheet", "with the wheel's middle 0.000 mm above the swivel's centre"));
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
  const QByteArray wheels = kPackage.toUtf8() + "/wheels";
  const QByteArray secondary = "/straight_d100_w6.yaml}\n    setup: {swivel_deg: 13.104, height_mm: -3.548}";
  open({{"    setup: {swivel_deg: 13.104, height_mm: -3.658}\n", ""},
        {"file: ../wheels" + secondary, "file: " + wheels + secondary},
        {"mm: 0.01\n    wheel: {file: ../wheels", "mm: 0.01\n    wheel: {file: " + wheels}},
       QString(kJob).replace("paper", "taper_reamer_d6_t6"));
  auto& operation = panel->the<QComboBox>("operation");
  ASSERT_TRUE(operation.isVisible()) << panel->text("verdict");
  EXPECT_FALSE(panel->enabled("setup"));
  QTest::keyClick(&operation, Qt::Key_Down);
  QTest::keyClick(&operation, Qt::Key_Down);
  WAIT_FOR(panel->enabled("setup"));
  EXPECT_TRUE(panel->says("verdict", "'grind setup --write' finds it"));
  ASSERT_NO_FATAL_FAILURE(openSheet());
  EXPECT_EQ(dialog()->windowTitle(), "Set-up of job.yaml, 2 primary relief for /grinder");
  ASSERT_NO_FATAL_FAILURE(write());
  EXPECT_EQ(operation.currentText(), "2 primary relief");
  expectWritten("primary");
  closeSheet();
}

}  // namespace grinder::test_panel_job
