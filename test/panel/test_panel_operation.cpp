// The panel with a job of several operations, of which it guesses none.

#include "stage.h"

#include <QFile>

namespace grinder::test_panel_operation {

const QString kReamer = kPackage + "/jobs/taper_reamer_d6_t6.yaml";

class Operation : public Staged {
 protected:
  void SetUp() override {
    stage.change([&] { stage.plan.valid = 1, stage.state.swivel = 13.104 * M_PI / 180; });
    stage.be("ready");
  }
  void choose(const QString& operation) {
    while (box.currentText() != operation) {
      const int before = box.currentIndex();
      QTest::keyClick(&box, Qt::Key_Down);
      ASSERT_NE(box.currentIndex(), before) << operation.toStdString();
    }
  }
  bool says(const std::string& begin) { return panel.text("verdict").find(begin) == 0; }

  Panel panel{"cell/stage", kReamer};
  QComboBox& box = panel.the<QComboBox>("operation");
};

TEST_F(Operation, NoneIsChosenAtFirst) {
  WAIT_FOR(panel.state() == "Ready" && panel.enabled("choose"));
  ASSERT_TRUE(box.isVisible());
  QStringList offered;
  for (int i = 0; i < box.count(); ++i) offered << box.itemText(i);
  EXPECT_EQ(offered, (QStringList{"choose", "1 flute", "2 primary relief", "3 secondary relief"}));
  EXPECT_EQ(box.currentText(), "choose");
  for (const char* name : {"plan", "dry_run", "setup", "start"}) EXPECT_FALSE(panel.enabled(name)) << name;
  EXPECT_EQ(panel.text("verdict"), "Choose the operation first.");
  EXPECT_EQ(panel.label("zero_points"), "Zero points: not known");
  panel.picture("operation_to_choose");
  Panel single("cell/stage", kPaper);
  WAIT_FOR(single.enabled("plan"));
  EXPECT_FALSE(single.isVisible("operation"));
  WAIT_FOR(single.the<QWidget>("hold").pos() == panel.the<QWidget>("hold").pos());
}

TEST_F(Operation, ThatIsChosenIsPlannedAndStarted) {
  choose("2 primary relief");
  EXPECT_TRUE(says("Not planned yet."));
  panel.plan();
  panel.picture("operation_chosen");
  const flute_grinder::GrindGoal primary = goalFromFile(kReamer.toStdString(), "primary");
  ASSERT_EQ(primary.operation, 1);
  EXPECT_EQ(stage.get(&Stage::plans).back(), primary);
  choose("3 secondary relief");
  WAIT_FOR(!panel.enabled("start"));
  EXPECT_TRUE(says("Not planned yet."));
  panel.plan();
  panel.click("start");
  WAIT_FOR(goals().size() == 1);
  EXPECT_EQ(goals().at(0).goal, goalFromFile(kReamer.toStdString(), "secondary"));
}

TEST_F(Operation, IsChosenAnewWithAnotherFileOrAnotherListOnly) {
  const QTemporaryDir folder;
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
  rviz::Config config;
  config.mapSetValue("Node", "cell/stage");
  config.mapSetValue("Job", folder.filePath("job.yaml"));
  panel.widget().load(config);
  choose("2 primary relief");
  panel.plan();
  write(true, "0.04");
  panel.click("plan");
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  EXPECT_EQ(stage.get(&Stage::plans).at(1).process.infeed, 0.04e-3);
  EXPECT_EQ(box.currentText(), "2 primary relief");
  WAIT_FOR(says("Takes "));
  write(false, "0.04");
  panel.click("start");
  EXPECT_EQ(panel.text("verdict"), "Choose the operation first.");
  EXPECT_EQ(box.currentText(), "choose");
  EXPECT_EQ(box.count(), 3);
  WAIT_FOR(!panel.enabled("start") && !panel.enabled("plan"));
  choose("2 primary relief");
  panel.widget().load(config);  // the same file, as it was opened once more
  EXPECT_EQ(box.currentText(), "choose");
  EXPECT_EQ(goals().size(), 0U);
}

TEST_F(Operation, ThatRunsIsNamed) {
  flute_grinder::GrindActionGoal job;
  job.goal_id.id = "from a terminal";
  job.goal = goalFromFile(kReamer.toStdString(), "secondary");
  stage.publishJob(job);
  stage.change([&] { stage.progress.tooth = 4, stage.progress.pass = 11; });
  stage.be("running");
  WAIT_FOR(panel.isVisible("other_job"));
  EXPECT_EQ(panel.text("other_job").find("Running: taper_reamer_d6_t6.yaml, secondary relief (D 6 mm, "), 0U)
      << panel.text("other_job");
  EXPECT_TRUE(panel.shows("place", ", secondary, tooth 5, pass 12"));
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
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text(), "Continue primary at tooth 2, pass 3");
  panel.picture("operation_unfinished");
  panel.tick("continue");
  EXPECT_EQ(box.currentText(), "2 primary relief");
  WAIT_FOR(go_on.text() == "Continue at tooth 2, pass 3");
  EXPECT_TRUE(go_on.isChecked());
  panel.plan();
  EXPECT_EQ(stage.get([&] { return stage.plans.back().operation; }), 1);
  EXPECT_EQ(stage.get([&] { return stage.plans.back().first_pass; }), 2);
}

TEST_F(Operation, DecidesForWhichWheelAnAxisIsTouchedOff) {
  stage.publishOffsets({});
  panel.openTab("Jog");
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  panel.press("touch_off");
  WAIT_FOR(panel.says("messages", "Touch-off: choose the operation of the job first"));
  panel.openTab("Job");
  choose("3 secondary relief");
  panel.openTab("Jog");
  panel.click("touch_off");
  WAIT_FOR(touches().size() == 1);
  EXPECT_NEAR(touches().at(0).basis.height, -3.548e-3, 1e-12);
}

}  // namespace grinder::test_panel_operation
