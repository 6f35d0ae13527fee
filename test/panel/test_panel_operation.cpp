// The panel with a job of several operations, of which it guesses none.

#include "flute_grinder/network/user_at_host.h"
#include "stage.h"

namespace grinder::test_panel_operation {

const QString kReamer = kPackage + "/jobs/taper_reamer_d6_t6.yaml";

class Operation : public Staged {
 protected:
  void SetUp() override {
    stage.change([&] { stage.planned.plan.valid = 1, stage.state.swivel = 13.104 * M_PI / 180; });
    stage.be("ready");
  }
  bool says(const std::string& begin) { return panel.text("plan_report").find(begin) == 0; }

  /// Loads a copy of the reamer.
  void loadCopy() {
    changedJob(kReamer, copy, {});
    config.mapSetValue("Node", "cell/stage");
    config.mapSetValue("Job", copy);
    panel.widget().load(config);
  }
  /// The text of the reamer's last operation.
  static QByteArray lastOperation() {
    QFile reamer(kReamer);
    EXPECT_TRUE(reamer.open(QFile::ReadOnly));
    const QByteArray all = reamer.readAll();
    const int from = all.indexOf("  - kind: relief\n    relief: secondary\n");
    return all.mid(from, all.indexOf("interpolation:") - from);
  }

  const QTemporaryDir folder;
  const QString copy = folder.filePath("job.yaml");
  rviz::Config config;
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
  for (const char* name : {"plan", "setup", "start"}) EXPECT_FALSE(panel.enabled(name)) << name;
  EXPECT_EQ(panel.text("plan_report"), "Choose the operation first.");
  panel.picture("operation_to_choose");
  Panel single("cell/stage", kPaper);
  WAIT_FOR(single.enabled("plan"));
  EXPECT_FALSE(single.isVisible("operation"));
  WAIT_FOR(single.the<QWidget>("hold").pos() == panel.the<QWidget>("hold").pos());
}

TEST_F(Operation, ThatIsChosenIsPlannedAndStarted) {
  panel.chooseOperation("2 primary relief");
  EXPECT_TRUE(says("Not planned yet."));
  panel.plan();
  panel.picture("operation_chosen");
  flute_grinder::GrindGoal primary = goalFromFile(kReamer.toStdString(), "primary");
  primary.dry_run = 1;
  primary.sent_by = userAtHost();
  ASSERT_EQ(primary.operation, 1);
  EXPECT_EQ(stage.get(&Stage::plans).back().goal, primary);
  panel.chooseOperation("3 secondary relief");
  WAIT_FOR(!panel.enabled("start"));
  EXPECT_TRUE(says("Not planned yet."));
  panel.plan();
  panel.click("start");
  WAIT_FOR(goals().size() == 1);
  EXPECT_EQ(goals().at(0).goal.operation, 2);
}

TEST_F(Operation, IsChosenAnewWithAnotherFileOrAnotherListOnly) {
  loadCopy();
  panel.chooseOperation("2 primary relief");
  panel.plan();
  changedJob(kReamer, copy, {{"feed_mm_min: 700", "feed_mm_min: 701"}});
  panel.click("plan");
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  EXPECT_DOUBLE_EQ(stage.get(&Stage::plans).at(1).goal.operations.at(0).feed, 701e-3 / 60);
  EXPECT_EQ(box.currentText(), "2 primary relief");
  WAIT_FOR(says("Takes "));
  changedJob(kReamer, copy, {{lastOperation(), ""}, {"  second_clearance_deg: 22\n", ""}});
  panel.click("start");
  EXPECT_EQ(panel.text("plan_report"), "Choose the operation first.");
  EXPECT_EQ(box.currentText(), "choose");
  EXPECT_EQ(box.count(), 3);
  WAIT_FOR(!panel.enabled("start") && !panel.enabled("plan"));
  panel.chooseOperation("2 primary relief");
  panel.widget().load(config);  // the same file, as it was opened once more
  EXPECT_EQ(box.currentText(), "choose");
  EXPECT_EQ(goals().size(), 0U);
}

/// The last operation of the reamer becomes a gash, and so the third in its list.
TEST_F(Operation, IsNumberedByItsPlaceAndChosenAnewWithOtherKinds) {
  loadCopy();
  panel.chooseOperation("3 secondary relief");
  panel.plan();
  const QByteArray relief = lastOperation();
  QByteArray gash = relief;
  gash.replace("kind: relief\n    relief: secondary\n", "kind: gash\n    angle_deg: 30\n    past_mm: 0\n");
  gash.replace("roughing_passes: 6", "infeed_mm: 0.05");
  gash.replace("{file: taper_reamer_d6_t6.setup.yaml}", "{swivel_deg: 0, height_mm: 0}");
  changedJob(kReamer, copy, {{relief, gash}, {"  second_clearance_deg: 22\n", "  end: {rake_tolerance_deg: 1}\n"}});
  panel.click("start");
  EXPECT_EQ(panel.text("plan_report"), "Choose the operation first.");
  EXPECT_EQ(box.currentText(), "choose");
  EXPECT_EQ(box.itemText(box.count() - 1), "3 gash");
  panel.chooseOperation("3 gash");
  panel.plan();
  EXPECT_EQ(stage.get([&] { return stage.plans.back().goal.operation; }), 2);
}

TEST_F(Operation, ThatWasLeftIsTakenByAClick) {
  stage.leave(kReamer, "primary");
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text(), "Continue primary at tooth 2, pass 3");
  panel.picture("operation_unfinished");
  panel.tick("continue");
  EXPECT_EQ(box.currentText(), "2 primary relief");
  WAIT_FOR(go_on.text() == "Continue at tooth 2, pass 3");
  EXPECT_TRUE(go_on.isChecked());
  panel.plan();
  EXPECT_EQ(stage.get([&] { return stage.plans.back().goal.operation; }), 1);
  EXPECT_EQ(stage.get([&] { return stage.plans.back().goal.first_pass; }), 2);
}

TEST_F(Operation, DecidesForWhichWheelAnAxisIsTouchedOff) {
  stage.publishOffsets({});
  panel.openTab("Zero");
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  panel.press("touch_off");
  WAIT_FOR(panel.says("messages", "Touch-off: choose the operation of the job first"));
  panel.openTab("Job");
  panel.chooseOperation("3 secondary relief");
  panel.openTab("Zero");
  panel.click("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 1);
  EXPECT_NEAR(touches().at(0).basis.height, -3.648e-3, 1e-12);
}

}  // namespace grinder::test_panel_operation
