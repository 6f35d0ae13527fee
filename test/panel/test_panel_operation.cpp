// The panel with a job of several operations, of which it guesses none.

#include "flute_grinder/messages/offset_basis.h"
#include "panel_fixture.h"
#include "stage.h"

#include <ros/package.h>
#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QTemporaryDir>

namespace grinder {
namespace test_panel_operation {

const QString kPackage = QString::fromStdString(ros::package::getPath("flute_grinder"));
const QString kReamer = kPackage + "/jobs/taper_reamer_d6_t6.yaml";
const QStringList kOperations{"choose", "1 flute", "2 primary relief", "3 secondary relief"};

class Operation : public ::testing::Test {
 protected:
  void SetUp() override {
    stage.change([&] { stage.plan.valid = 1, stage.state.swivel = 13.104 * M_PI / 180; });
    stage.be("ready");
  }
  static QComboBox& box(Panel& panel) { return panel.the<QComboBox>("operation"); }
  static void choose(Panel& panel, const QString& operation) {
    while (box(panel).currentText() != operation) {
      const int before = box(panel).currentIndex();
      QTest::keyClick(&box(panel), Qt::Key_Down);
      ASSERT_NE(box(panel).currentIndex(), before) << operation.toStdString();
    }
  }
  static void plan(Panel& panel) { panel.plan(); }
  static bool says(Panel& panel, const std::string& begin) { return panel.text("verdict").find(begin) == 0; }

  Stage stage;
  const QTemporaryDir folder;
};

TEST_F(Operation, NoneIsChosenAtFirst) {
  Panel panel("cell/stage", kReamer);
  WAIT_FOR(panel.state() == "Ready" && panel.enabled("choose"));
  ASSERT_TRUE(box(panel).isVisible());
  QStringList offered;
  for (int i = 0; i < box(panel).count(); ++i) offered << box(panel).itemText(i);
  EXPECT_EQ(offered, kOperations);
  EXPECT_EQ(box(panel).currentText(), "choose");
  for (const char* name : {"plan", "dry_run", "setup", "start"}) EXPECT_FALSE(panel.enabled(name)) << name;
  EXPECT_EQ(panel.text("verdict"), "Choose the operation first.");
  EXPECT_EQ(panel.label("zero_points"), "Zero points: not known");
  panel.picture("operation_to_choose");
  Panel single("cell/stage", kPackage + "/test/jobs/paper.yaml");
  WAIT_FOR(single.enabled("plan"));
  EXPECT_FALSE(box(single).isVisible());
  WAIT_FOR(single.the<QWidget>("hold").pos() == panel.the<QWidget>("hold").pos());
}

TEST_F(Operation, ThatIsChosenIsPlannedAndStarted) {
  Panel panel("cell/stage", kReamer);
  choose(panel, "2 primary relief");
  EXPECT_TRUE(says(panel, "Not planned yet."));
  plan(panel);
  panel.picture("operation_chosen");
  const flute_grinder::GrindGoal primary = goalFromFile(kReamer.toStdString(), "primary");
  ASSERT_EQ(primary.operation, 1);
  EXPECT_EQ(stage.get(&Stage::plans).back(), primary);
  choose(panel, "3 secondary relief");
  WAIT_FOR(!panel.enabled("start"));
  EXPECT_TRUE(says(panel, "Not planned yet."));
  plan(panel);
  panel.click("start");
  WAIT_FOR(stage.get(&Stage::goals).size() == 1);
  EXPECT_EQ(stage.get(&Stage::goals).at(0).goal, goalFromFile(kReamer.toStdString(), "secondary"));
}

TEST_F(Operation, IsChosenAnewWithAnotherFileOrAnotherListOnly) {
  const QByteArray wheel = "file: " + kPackage.toUtf8() + "/wheels/straight_d100_w6.yaml";
  const auto write = [&](bool secondary, const QByteArray& infeed) {
    QFile original(kReamer);
    ASSERT_TRUE(original.open(QFile::ReadOnly));
    QByteArray text = original.readAll();
    text.replace("file: ../wheels/straight_d100_w6.yaml", wheel);
    text.replace("    infeed_mm: 0.05", "    infeed_mm: " + infeed);
    if (!secondary) {
      const int from = text.lastIndexOf("  - kind: relief");
      text.remove(from, text.indexOf("interpolation:") - from);
      text.replace("  second_clearance_deg: 22\n", "");
    }
    QFile file(folder.filePath("job.yaml"));
    ASSERT_TRUE(file.open(QFile::WriteOnly) && file.write(text) == text.size());
  };
  write(true, "0.05");
  Panel panel("cell/stage", folder.filePath("job.yaml"));
  choose(panel, "2 primary relief");
  plan(panel);
  write(true, "0.04");
  panel.click("plan");
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  EXPECT_EQ(stage.get(&Stage::plans).at(1).process.infeed, 0.04e-3);
  EXPECT_EQ(box(panel).currentText(), "2 primary relief");
  WAIT_FOR(says(panel, "Takes "));
  write(false, "0.04");
  panel.click("start");
  EXPECT_EQ(panel.text("verdict"), "Choose the operation first.");
  EXPECT_EQ(box(panel).currentText(), "choose");
  EXPECT_EQ(box(panel).count(), 3);
  WAIT_FOR(!panel.enabled("start") && !panel.enabled("plan"));
  choose(panel, "2 primary relief");
  rviz::Config config;
  panel.widget().save(config);
  panel.widget().load(config);  // the same file, as it was opened once more
  EXPECT_EQ(box(panel).currentText(), "choose");
  EXPECT_EQ(stage.get(&Stage::goals).size(), 0U);
}

TEST_F(Operation, ThatRunsIsNamed) {
  Panel panel("cell/stage");
  flute_grinder::GrindActionGoal job;
  job.goal_id.id = "from a terminal";
  job.goal = goalFromFile(kReamer.toStdString(), "secondary");
  stage.publishJob(job);
  stage.change([&] { stage.progress.tooth = 4, stage.progress.pass = 11; });
  stage.be("running");
  WAIT_FOR(panel.isVisible("other_job"));
  EXPECT_EQ(panel.text("other_job").find("Running: taper_reamer_d6_t6.yaml, secondary relief (D 6 mm, "), 0U)
      << panel.text("other_job");
  EXPECT_TRUE(panel.shows("place", ", secondary, tooth 5, pass 12")) << panel.label("place");
  EXPECT_EQ(panel.the<QLabel>("place").toolTip(), "taper_reamer_d6_t6.yaml, 3 secondary relief");
  panel.picture("operation_running");
}

TEST_F(Operation, ThatWasLeftIsTakenByAClick) {
  stage.change([&] {
    flute_grinder::JobProgress& left = stage.state.progress;
    left.job_digest = digestOf(kReamer, "primary");
    left.job_name = "taper_reamer_d6_t6.yaml";
    left.cutter = goalFromFile(kReamer.toStdString(), "primary").cutter;
    left.tooth = 1;
    left.pass = 2;
  });
  Panel panel("cell/stage", kReamer);
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text(), "Continue primary at tooth 2, pass 3");
  panel.picture("operation_unfinished");
  QTest::mouseClick(&go_on, Qt::LeftButton, {}, QPoint(8, go_on.height() / 2));
  EXPECT_EQ(box(panel).currentText(), "2 primary relief");
  WAIT_FOR(go_on.text() == "Continue at tooth 2, pass 3");
  EXPECT_TRUE(go_on.isChecked());
  plan(panel);
  EXPECT_EQ(stage.get([&] { return stage.plans.back().operation; }), 1);
  EXPECT_EQ(stage.get([&] { return stage.plans.back().first_pass; }), 2);
}

TEST_F(Operation, DecidesForWhichWheelAnAxisIsTouchedOff) {
  flute_grinder::WorkOffsets offsets;
  stage.publishOffsets(offsets);
  Panel panel("cell/stage", kReamer);
  panel.openTab("Jog");
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  WAIT_FOR(panel.enabled("touch_off"));
  panel.click("touch_off");
  WAIT_FOR(panel.says("messages", "Touch-off: choose the operation of the job first"));
  panel.openTab("Job");
  choose(panel, "3 secondary relief");
  panel.openTab("Jog");
  panel.click("touch_off");
  WAIT_FOR(stage.get(&Stage::touches).size() == 1);
  EXPECT_NEAR(stage.get(&Stage::touches).at(0).basis.height, -3.548e-3, 1e-12);
}

}  // namespace test_panel_operation
}  // namespace grinder
