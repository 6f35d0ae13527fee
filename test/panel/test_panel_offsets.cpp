// The panel and zero points that were set for another job, against a grinder of the test's own.

#include "flute_grinder/messages/conversions.h"
#include "stage.h"

#include <QScrollBar>
#include <QTextEdit>

namespace grinder::test_panel_offsets {

/// With the paper's job, of D 10 mm, planned.
class ZeroPoints : public OnStage {
 protected:
  void SetUp() override {
    stage.change([&] { stage.planned.plan.statistics.duration = 12; });
    panel.plan();
  }

  /// Offsets of 1, 2, 3 mm that were set for the paper's job with another end diameter and height [m].
  void setFor(double diameter, double height = 0.002788) {
    flute_grinder::GrindGoal goal = goalFromFile(kPaper.toStdString());
    goal.cutter.end_diameter = diameter;
    processOf(goal).setup_height = height;
    goal.job_name = "other.yaml";
    setFor(goal);
  }
  void setFor(const flute_grinder::GrindGoal& goal) {
    flute_grinder::WorkOffsets offsets;
    offsets.values = {0.001, 0.002, 0.003, 0};
    for (const int axis : {kX, kY, kZ}) {
      const auto i = static_cast<std::size_t>(axis);
      offsets.set_by[i] = "anna@cell-3";
      offsets.set_at[i] = ros::Time(1.7e9);
      offsets.basis[i] = toMessage(basisOf(goal, OffsetMethod::kTouchOff));
    }
    stage.publishOffsets(offsets, goalFromFile(kPaper.toStdString()));
  }
  /// Waits until the panel shows which axes do not fit, and starts.
  void startAndBeAskedFor(const std::string& axes) {
    WAIT_FOR(panel.label("zero_points") == "Zero points: not of this job: " + axes);
    startAndBeAsked("ignore_offset_check");
  }
  std::vector<flute_grinder::SetOffset::Request> offsetsSet() { return stage.get(&Stage::offsets_set); }
};

TEST_F(ZeroPoints, AreAskedForBesideWhatTheJobHas) {
  setFor(0.006);
  ASSERT_NO_FATAL_FAILURE(startAndBeAskedFor("Y"));
  for (const char* shown : {"paper.yaml (D 10 mm, ", "touched off for D 6 mm (other.yaml)", "2 mm"}) {
    EXPECT_TRUE(panel.says("offsets_question", shown)) << shown;
  }
  panel.picture("offset_question");
}

TEST_F(ZeroPoints, OfAnotherWheelAreAskedForOnceTheWheelIsConfirmed) {
  flute_grinder::GrindGoal other = goalFromFile(kPaper.toStdString());
  other.wheel_name = "other.yaml";
  stage.publishOffsets({}, other);
  WAIT_FOR(panel.label("zero_points") == "Zero points: not of this job: wheel, X, Y, Z");
  startAndBeAsked("confirm_wheel");
  for (const char* shown : {"paper.yaml (D 10 mm, ", "other.yaml, D 100 mm"}) {
    EXPECT_TRUE(panel.says("wheel_question", shown)) << shown;
  }
  panel.picture("wheel_question");
  panel.press("confirm_wheel");
  WAIT_FOR(stage.get(&Stage::wheels).size() == 1);
  EXPECT_EQ(stage.get(&Stage::wheels)[0].job.wheel_name, "straight, 3 mm wide");
  EXPECT_FALSE(stage.get(&Stage::wheels)[0].again);
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  EXPECT_TRUE(goals().empty()) << "only planned";
  setFor(0.006);
  startAndBeAskedFor("Y");
}

TEST_F(ZeroPoints, OfTheJobAreNotAskedFor) {
  setFor(0.01);
  WAIT_FOR(panel.label("zero_points") == "Zero points: set for this job");
  panel.click("start");
  WAIT_FOR(goals().size() == 1);
  EXPECT_FALSE(goals()[0].goal.ignore_offset_check);
}

TEST_F(ZeroPoints, OfAJobThatIsContinuedAreThoseWithWhichItBegan) {
  setFor(0.006);
  stage.change([&] { stage.state.progress.job_digest = digestOf(kPaper); });
  WAIT_FOR(panel.enabled("continue") && panel.label("zero_points") == "Zero points: not of this job: Y");
  const auto& zeros = panel.the<QLabel>("zero_points");
  const auto room = [&] { return std::pair(zeros.geometry(), panel.the<QWidget>("verdict").geometry()); };
  const auto before = room();
  panel.tick("continue");
  WAIT_FOR(panel.label("zero_points") == "Zero points: as when the job began;\nnot of this job: Y");
  EXPECT_EQ(room(), before) << "it moves";
  panel.picture("zero_points_of_a_continued_job");
  setFor(0.01);
  WAIT_FOR(panel.label("zero_points") == "Zero points: as when the job began");
  panel.widget().resize(1, panel.widget().height());
  stage.publishOffsets({}, goalFromFile(kPaper.toStdString()));
  WAIT_FOR(panel.label("zero_points") == "Zero points: as when the job began;\nnot of this job: X, Y, Z");
  const QSize text = zeros.fontMetrics().size(0, zeros.text());
  EXPECT_EQ(zeros.size().expandedTo(text), zeros.size()) << "it is clipped where the panel is narrow";
}

TEST_F(ZeroPoints, AreFittedByOneKeyAndShownWithWhatTheyWereBesideANewPlan) {
  setFor(0.006, 0.001788);
  ASSERT_NO_FATAL_FAILURE(startAndBeAskedFor("Y, Z"));
  EXPECT_EQ(panel.the<QPushButton>("fit_offsets").text(), "Fit Y and Z");
  panel.press("fit_offsets");
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  WAIT_FOR(panel.text("messages").size() > 9 && panel.text("verdict").find("Takes 12.0 s.") == 0);
  EXPECT_EQ(panel.text("messages").substr(9),
            "Work offset of axis Y: 4 mm, was 2 mm; computed\nwork offset of axis Z: 4 mm, was 3 mm; computed");
  panel.picture("fitted");
  const auto all = offsetsSet();
  ASSERT_EQ(all.size(), 2U);
  // One request may overtake the other.
  const flute_grinder::SetOffset::Request& set = all[0].axis == kY ? all[0] : all[1];
  EXPECT_EQ(set.axis, kY);
  EXPECT_NEAR(set.value, 0.004, 1e-15);
  EXPECT_EQ(set.basis.job_name, "paper.yaml");
  EXPECT_EQ(set.basis.end_diameter, 0.01);
  EXPECT_EQ(set.basis.method, flute_grinder::OffsetBasis::COMPUTED);
  EXPECT_TRUE(panel.enabled("start"));
  EXPECT_TRUE(goals().empty()) << "only planned";
}

TEST_F(ZeroPoints, ThatWereNeverSetCannotBeComputed) {
  stage.publishOffsets({}, goalFromFile(kPaper.toStdString()));
  ASSERT_NO_FATAL_FAILURE(startAndBeAskedFor("X, Y, Z"));
  EXPECT_FALSE(panel.isVisible("fit_offsets"));
  EXPECT_TRUE(panel.says("offsets_question", "never set"));
  EXPECT_FALSE(panel.says("offsets_question", "off by")) << "a column with nothing in it";
  panel.picture("offset_question_never");
  setFor(0.01);
  WAIT_FOR(!panel.isVisible("ignore_offset_check"));
}

TEST_F(ZeroPoints, OfALongQuestionMustHaveBeenInSightBeforeTheyAreIgnored) {
  flute_grinder::GrindGoal goal = goalFromFile(kPaper.toStdString());
  goal.cutter.end_diameter = 0.006;
  processOf(goal).setup_swivel = 0.3;
  setFor(goal);
  WAIT_FOR(panel.label("zero_points") == "Zero points: not of this job: X, Y, Z");
  panel.click("start");
  WAIT_FOR(panel.enabled("decline_offsets"));
  QScrollBar& bar = *panel.the<QTextEdit>("offsets_question").verticalScrollBar();
  ASSERT_LT(bar.value(), bar.maximum());
  EXPECT_FALSE(panel.enabled("ignore_offset_check"));
  EXPECT_TRUE(panel.isVisible("offsets_more"));
  panel.picture("offset_question_to_scroll");
  bar.setValue(bar.maximum());
  EXPECT_TRUE(panel.enabled("ignore_offset_check"));
  EXPECT_FALSE(panel.isVisible("offsets_more"));
  bar.setValue(0);
  EXPECT_TRUE(panel.enabled("ignore_offset_check")) << "it was in sight";
}

TEST_F(ZeroPoints, AreTouchedOffForTheJobAndALargeChangeIsAskedFor) {
  const auto asks = [&] { return panel.isVisible("confirm_touch"); };
  stage.publishOffsets({});
  panel.openTab("Zero");
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  WAIT_FOR(panel.enabled("touch_off"));
  stage.change([&] { stage.touch_refusal = "it would change by much", stage.large_change = true; });
  panel.click("touch_off");
  WAIT_FOR(asks());
  EXPECT_TRUE(panel.says("touch_question", "For paper.yaml, wheel straight, 3 mm wide, D 100 mm."));
  panel.press("decline_touch");
  EXPECT_TRUE(touches().empty());
  panel.click("touch_off");
  WAIT_FOR(asks());
  stage.change([&] { stage.state.position[kZ] += 0.001; });
  WAIT_FOR(!asks());
  panel.click("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(panel.says("touch_question", "Touch-off: it would change by much"));
  EXPECT_EQ(touches().at(0).basis.job_name, "paper.yaml");
  EXPECT_NEAR(touches().at(0).basis.height, 0.002788, 1e-12);
  EXPECT_FALSE(touches().at(0).large_change_ok);
  panel.picture("touch_off_question");
  stage.change([&] { stage.touch_refusal = "", stage.large_change = false; });
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 2);
  EXPECT_TRUE(touches()[1].large_change_ok);
  EXPECT_FALSE(asks());
}

TEST_F(ZeroPoints, OfYNeedTheJobsHeightAndAreAskedForWhereTheDiameterIsFar) {
  stage.publishOffsets({});
  panel.openTab("Zero");
  panel.the<QComboBox>("touch_axis").setCurrentText("Y");
  auto& at = panel.the<QDoubleSpinBox>("touch_at");
  at.setValue(16.9);
  panel.press("touch_off");
  WAIT_FOR(panel.says("messages", "move Z to -2.788 mm, and touch again"));
  // The wheel's middle at the height of the axis, where it touches.
  publish([&] { stage.state.work_position[kZ] = -0.002788; });
  // The cone ends with D 15.249 mm; the shank has D 16 mm.
  panel.press("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 1);
  EXPECT_EQ(touches()[0].axis, kY);
  EXPECT_NEAR(touches()[0].position, 0.00345, 1e-12);
  at.setValue(110);
  panel.click("touch_off");
  WAIT_FOR(panel.isVisible("confirm_touch"));
  EXPECT_TRUE(panel.says("touch_question",
                         "D 110 mm was entered. The largest blank of this job has D 15.249 mm, its shank D 16 mm."));
  panel.picture("touch_off_diameter");
  panel.press("decline_touch");
  panel.click("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 2);
  EXPECT_NEAR(touches()[1].position, 0.05, 1e-12);
  EXPECT_FALSE(touches()[1].large_change_ok) << "the limit of a change is another question";
}

}  // namespace grinder::test_panel_offsets
