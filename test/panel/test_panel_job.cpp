// The panel against the grinder's node with the simulated drive: an operator's day.

#include "flute_grinder/InjectFault.h"
#include "panel_fixture.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <QCheckBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QProgressBar>
#include <QTemporaryDir>

#include <cmath>
#include <utility>
#include <vector>

namespace grinder {
namespace test_panel_job {

const QString kJobs = QString::fromStdString(ros::package::getPath("flute_grinder")) + "/test/jobs/";

/// A copy of test/jobs/paper.yaml with other values.
QString jobFile(const QTemporaryDir& folder, const QString& name,
                const std::vector<std::pair<QByteArray, QByteArray>>& changes) {
  return changedJob(kJobs + "paper.yaml", folder.filePath(name), changes);
}

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
    panel.click("choose");
    QFileDialog* dialog = nullptr;
    WAIT_FOR(dialog = panel.widget().findChild<QFileDialog*>());
    EXPECT_EQ(dialog->windowTitle(), "Choose a job file for /grinder");
    auto* name = dialog->findChild<QLineEdit*>("fileNameEdit");
    ASSERT_TRUE(name);
    name->setText(file);
    QTest::keyClick(name, Qt::Key_Return);
    WAIT_FOR(!panel.widget().findChild<QFileDialog*>());
  }
  void plan() {
    WAIT_FOR(panel.enabled("plan"));
    panel.click("plan");
    WAIT_FOR(panel.text("verdict").find("Takes ") == 0);
  }
  void enable() {
    WAIT_FOR(panel.enabled("enable"));
    panel.click("enable");
    WAIT_FOR(panel.state() == "Ready");
  }
  /// Gives up a job that a test before has left, leaves the zero points, which nobody has set, and confirms the swivel
  /// if it is asked for.
  static void startAndDiscard(Panel& of) {
    of.click("start");
    if (of.the<QPushButton>("discard").isVisible()) of.answer("discard");
    if (of.the<QPushButton>("ignore_offset_check").isVisible()) of.answer("ignore_offset_check");
    if (of.the<QPushButton>("confirm_swivel").isVisible()) of.answer("confirm_swivel");
  }
  void start() {
    WAIT_FOR(panel.enabled("start"));
    startAndDiscard(panel);
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
  const QString slow = jobFile(folder, "slow.yaml", {{"feed_mm_min: 600", "feed_mm_min: 300"}});
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
  EXPECT_TRUE(panel.says("verdict", "Feed 300.0 mm/min; no axis limits it.")) << panel.text("verdict");
  EXPECT_EQ(panel.enabledRequests(), (Names{"enable", "reset"}));
  enable();
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "home", "start"}));
  panel.picture("planned");
  start();
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "cancel"}));
  EXPECT_EQ(panel.label("place"), "slow.yaml, tooth 1, pass 1");
  WAIT_FOR(panel.label("feed") == "300 mm/min");
  panel.picture("grinding");

  panel.click("hold");
  WAIT_FOR(panel.state() == "Held");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "resume", "retract", "cancel"}));
  const double x = position('x');
  const double y = position('y');
  EXPECT_TRUE(0 < x && x < 30) << x;
  // On the cone of 5 deg, 1.6 mm deep.
  EXPECT_NEAR(y, x * std::tan(5 * M_PI / 180) - 1.6, 0.01);
  EXPECT_GT(position('a'), 10);
  EXPECT_EQ(panel.label("meaning"), "The job is held with the wheel in the work. Resume continues; Retract lifts it.");
  panel.picture("held_in_the_stroke");
  panel.click("retract");
  WAIT_FOR(panel.state() == "Retracted");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "resume", "cancel"}));
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
  EXPECT_TRUE(panel.says("messages", "Planned and checked; nothing moved")) << panel.text("messages");
  start();
  panel.click("cancel");
  WAIT_FOR(panel.says("messages", "The job has ended: canceled; stopped on the path"));
  WAIT_FOR(panel.state() == "Ready");
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text(), "Continue at tooth 1, pass 1");
  EXPECT_FALSE(panel.enabled("start"));
  QTest::mouseClick(&go_on, Qt::LeftButton, {}, QPoint(8, go_on.height() / 2));
  EXPECT_TRUE(go_on.isChecked());
  plan();
  panel.picture("continue");
  start();
  inject("emergency_stop");
  WAIT_FOR(panel.state() == "Fault");
  WAIT_FOR(panel.says("messages", "The job has ended: emergency stop"));
  WAIT_FOR(panel.enabledRequests() == Names{"reset"});
  EXPECT_TRUE(panel.shows("meaning", "Fault: emergency stop. The emergency stop is pressed."))
      << panel.label("meaning");
  panel.picture("emergency_stop");
  panel.click("reset");
  WAIT_FOR(panel.says("messages", "Reset refused"));
  EXPECT_EQ(panel.state(), "Fault");
  inject("none");
  panel.click("reset");
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_EQ(panel.label("meaning"), "The wheel is in the work: enable, then lift it.");
  enable();
  WAIT_FOR(panel.enabled("lift"));
  EXPECT_FALSE(panel.enabled("home"));
  const double y = position('y');
  panel.click("lift");
  WAIT_FOR(!panel.enabled("lift") && panel.state() == "Ready" && panel.enabled("home"));
  WAIT_FOR(position('y') > y + 1);
}

TEST_F(WithGrinder, AnErrorInAJobFileIsShown) {
  WAIT_FOR(panel.state() == "Disabled");
  open(jobFile(folder, "wrong.yaml", {{"spiral_angle_deg: 30", "spiral_angle_deg: 300"}}));
  EXPECT_TRUE(panel.says("verdict", "wrong.yaml:5")) << panel.text("verdict");
  EXPECT_TRUE(panel.says("verdict", "spiral_angle_deg = 300")) << panel.text("verdict");
  EXPECT_EQ(panel.text("verdict").find(folder.path().toStdString()), std::string::npos) << panel.text("verdict");
  panel.picture("wrong_job_file");
  open(folder.filePath("slow.yaml"));
  EXPECT_EQ(panel.text("verdict").find("Not planned yet."), 0U);
}

}  // namespace test_panel_job
}  // namespace grinder
