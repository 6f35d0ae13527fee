// The panel and zero points that were set for another job, against a grinder of the test's own.

#include "flute_grinder/messages/conversions.h"
#include "stage.h"

#include <QScrollBar>
#include <QTextEdit>

namespace grinder::test_panel_offsets {

using Answers = std::vector<std::string>;

/// With the paper's job, of D 10 mm.
class ZeroPoints : public OnStage {};

TEST_F(ZeroPoints, AreAskedForBesideWhatTheJobHasAndANeedWithoutAnswersStartsNothing) {
  need({kOtherZeros});
  ASSERT_NO_FATAL_FAILURE(startAndBeAsked("ignore-offsets"));
  for (const char* shown : {"paper.yaml (D 10 mm, ", ", wheel straight, 3 mm wide, D 100 mm",
                            "not of this job:", "touched off for D 6 mm (other.yaml)", "off by", "2 mm"}) {
    EXPECT_TRUE(panel.says("job_question", shown)) << shown;
  }
  EXPECT_EQ(panel.the<QPushButton>("fit-offsets").text(), "Fit them");
  panel.picture("offset_question");
  panel.press("decline_job");
  EXPECT_TRUE(panel.enabled("start")) << "the plan is still good";
  need({kNoZeros});
  panel.press("plan");
  WAIT_FOR(panel.says("plan_report", "To start it: X was never set."));
  ASSERT_NO_FATAL_FAILURE(startAndBeAsked("ignore-offsets"));
  EXPECT_FALSE(panel.widget().findChild<QPushButton*>("fit-offsets"));
  EXPECT_FALSE(panel.says("job_question", "off by")) << "a column with nothing in it";
  panel.picture("offset_question_never");
  panel.press("decline_job");
  Need measured = kSwivelToSet;
  measured.answers.clear();
  need({measured});
  panel.press("plan");
  WAIT_FOR(panel.says("plan_report", measured.text));
  ASSERT_NO_FATAL_FAILURE(startAndBeAsked("decline_job"));
  EXPECT_TRUE(panel.says("job_question", "31.769 deg"));
  panel.press("decline_job");
  EXPECT_TRUE(panel.enabled("start"));
  EXPECT_TRUE(goals().empty());
}

TEST_F(ZeroPoints, AnAnswerOnWhichThePlanDependsIsPlannedWith) {
  for (const auto& [asked, answer] :
       {std::pair(kOtherWheel, NeedAnswer::kConfirmWheel), std::pair(kOtherZeros, NeedAnswer::kFitOffsets)}) {
    SCOPED_TRACE(asked.text);
    need({asked});
    panel.press("plan");
    WAIT_FOR(panel.says("plan_report", asked.text));
    ASSERT_NO_FATAL_FAILURE(startAndBeAsked(toString(answer)));
    need({});
    stage.change([&] { stage.plans.clear(); });
    panel.picture(toString(answer));
    panel.press(toString(answer));
    WAIT_FOR(stage.get(&Stage::plans).size() == 1);
    EXPECT_EQ(stage.get(&Stage::plans)[0].goal.answers, Answers{answerId(asked, answer)});
    WAIT_FOR(panel.text("plan_report").find("Takes ") == 0);
    EXPECT_FALSE(panel.says("plan_report", asked.text));
    EXPECT_TRUE(goals().empty()) << "only planned";
  }
  panel.press("start");
  WAIT_FOR(goals().size() == 1);
}

TEST_F(ZeroPoints, AGoalThatIsRejectedForWhatItNeedsIsAskedForAndSentAgain) {
  need({kNoZeros});
  ASSERT_NO_FATAL_FAILURE(startAndBeAsked("ignore-offsets"));
  panel.press("ignore-offsets");
  WAIT_FOR(goals().size() == 1);
  flute_grinder::GrindResult rejected;
  rejected.error_code = flute_grinder::GrindResult::NOT_READY;
  rejected.plan.needs = toMessage({kSwivelToSet});
  stage.end(goals()[0].goal_id.id, rejected);
  panel.press("confirm-swivel");
  WAIT_FOR(goals().size() == 2);
  const std::string zeros = answerId(kNoZeros, NeedAnswer::kIgnoreOffsets);
  EXPECT_EQ(goals()[0].goal.answers, Answers{zeros});
  EXPECT_EQ(goals()[1].goal.answers, (Answers{zeros, answerId(kSwivelToSet, NeedAnswer::kConfirmSwivel)}));
}

TEST_F(ZeroPoints, OfALongQuestionMustHaveBeenInSightBeforeTheyAreIgnored) {
  Need all = kNoZeros;
  for (const char* axis : {"Y", "Z", "A"}) all.figures.push_back({axis, "touched off for this job", "never set", ""});
  need({all});
  panel.plan();
  panel.click("start");
  WAIT_FOR(panel.enabled("decline_job"));
  QScrollBar& bar = *panel.the<QTextEdit>("job_question").verticalScrollBar();
  ASSERT_LT(bar.value(), bar.maximum());
  EXPECT_FALSE(panel.enabled("ignore-offsets"));
  EXPECT_TRUE(panel.isVisible("job_more"));
  panel.picture("offset_question_to_scroll");
  bar.setValue(bar.maximum());
  EXPECT_TRUE(panel.enabled("ignore-offsets"));
  EXPECT_FALSE(panel.isVisible("job_more"));
  bar.setValue(0);
  EXPECT_TRUE(panel.enabled("ignore-offsets")) << "it was in sight";
}

TEST_F(ZeroPoints, AreTouchedOffForTheJobAndALargeChangeIsAskedFor) {
  const auto asks = [&] { return panel.isVisible("confirm_touch"); };
  stage.publishOffsets({});
  panel.openTab("Zero");
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  WAIT_FOR(panel.enabled("touch_off"));
  const Need large{NeedKind::kLargeChange, "much", {{"axis Z", "3 mm", "1 mm", "2 mm"}}, {NeedAnswer::kSetOffset}};
  stage.change([&] { stage.touch_refusal = "it would change by much", stage.touch_needs = toMessage({large}); });
  panel.click("touch_off");
  WAIT_FOR(asks());
  EXPECT_TRUE(panel.says("touch_question", "For paper.yaml, wheel straight, 3 mm wide, D 100 mm."));
  stage.change([&] { stage.state.position[kZ] += 0.001; });
  WAIT_FOR(!asks());
  panel.click("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(panel.isVisible("set-offset"));
  EXPECT_TRUE(panel.says("touch_question", "Is the new work offset right?"));
  EXPECT_TRUE(panel.says("messages", "Touch-off: it would change by much"));
  EXPECT_EQ(touches().at(0).basis.job_name, "paper.yaml");
  EXPECT_NEAR(touches().at(0).basis.height, 0.002788, 1e-12);
  EXPECT_TRUE(touches().at(0).answers.empty());
  panel.picture("touch_off_question");
  stage.change([&] { stage.touch_refusal = "", stage.touch_needs.clear(); });
  panel.press("set-offset");
  WAIT_FOR(touches().size() == 2);
  EXPECT_EQ(touches()[1].answers, Answers{answerId(large, NeedAnswer::kSetOffset)});
  EXPECT_FALSE(panel.isVisible("set-offset"));
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
  EXPECT_TRUE(touches()[1].answers.empty()) << "the limit of a change is another question";
}

}  // namespace grinder::test_panel_offsets
