// The panel and zero points that were set for another job, against a grinder of the test's own.

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/record/measured.h"
#include "stage.h"

#include <QDir>
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

/// Where the grinder keeps its records there is one tool of the paper's job.
class MeasuredTool : public ZeroPoints {
 protected:
  MeasuredTool() {
    ros::param::set("/cell/stage/history", folder_.path().toStdString() + "/");
    for (const char* axis : {"axis_y", "axis_z"}) {
      ros::param::set(std::string("/cell/stage/offset_change_limit/") + axis, 0.005);
    }
    QDir(folder_.path()).mkpath("cell/stage");
    Record record;
    record.head.digest = digestOf(kPaper);
    record.head.outcome = "done";
    record.head.ended = "2026-11-22T17:05:13.123Z";
    const Json zero = {{"found_at", utcText(kFoundAt)}};
    record.body = {{"work_offsets", {{"y_mm", 1.5}, {"z_mm", -7.0}}}, {"zero_points", {{"y", zero}, {"z", zero}}}};
    QFile file(path());
    file.open(QFile::WriteOnly);
    file.write(QByteArray::fromStdString(grinder::text(record)));
    publishZeros(kFoundAt);
  }
  ~MeasuredTool() override {
    for (const char* name : {"history", "offset_change_limit"}) ros::param::del(std::string("/cell/stage/") + name);
  }

  QString path() const { return folder_.filePath("cell/stage/0000000007_20261122T170413.123Z.json"); }
  void publishZeros(double y_found_at, double y = 0.0015, double z = -0.007, std::uint32_t mounting = 0) {
    WorkOffsets zeros;
    zeros.axes[kY].value = y, zeros.axes[kZ].value = z;
    zeros.axes[kY].found_at = y_found_at, zeros.axes[kZ].found_at = kFoundAt;
    for (const int axis : {kY, kZ}) {
      WorkOffset& offset = zeros.axes[static_cast<std::size_t>(axis)];
      offset.set_at = offset.found_at;
      offset.basis = basisOf(goalFromFile(kPaper.toStdString()), OffsetMethod::kTouchOff);
    }
    zeros.wheel.mounting = mounting;
    stage.publishOffsets(toMessage(zeros));
  }
  void open() {
    panel.openTab("Zero");
    WAIT_FOR(panel.enabled("measured"));
    panel.click("measured");
    WAIT_FOR(panel.widget().findChild<QLineEdit*>("measured_rake@2"));
  }
  void enter(const char* box, const char* figure) { panel.the<QLineEdit>(box).setText(figure); }

  static constexpr double kFoundAt = 1.7e9;
  const QTemporaryDir folder_;
};

TEST_F(MeasuredTool, CorrectsTheZeroPointsOnceItIsConfirmedAndTheyAreSetBack) {
  ASSERT_NO_FATAL_FAILURE(open());
  EXPECT_FALSE(panel.enabled("apply_correction")) << "nothing is measured";
  EXPECT_TRUE(panel.shows("measured_tool", "Tool 7, the last of this job"));
  EXPECT_TRUE(panel.shows("correction", "no tool has been measured"));
  panel.picture("nothing_measured", "correction_dialog");
  // The core in the middle, too thick by 0.05 mm, half the tolerance.
  enter("measured_core_diameter@15", "9,8");
  panel.press("keep_measured");
  WAIT_FOR(panel.enabled("apply_correction"));
  const std::vector<MeasuredFigure> kept = measuredOf(readRecord(path().toStdString()));
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_NEAR(kept[0].value, 9.8e-3, 1e-12);
  EXPECT_NEAR(kept[0].x, 15e-3, 1e-12);
  panel.picture("measured_tool", "correction_dialog");
  panel.press("apply_correction");
  panel.picture("correction_question", "correction_dialog");
  panel.press("confirm_correction");
  WAIT_FOR(panel.shows("correction", "The work offsets of Y and Z are set."));
  auto set = stage.get(&Stage::offsets_set);
  ASSERT_EQ(set.size(), 1U) << "both or none";
  EXPECT_EQ(set[0].axes, (std::vector<std::uint8_t>{kY, kZ}));
  ASSERT_EQ(set[0].values.size(), 2U);
  EXPECT_LT(set[0].values[0], 0.0015) << "the wheel goes deeper";
  EXPECT_EQ(set[0].basis.method, flute_grinder::OffsetBasis::CORRECTION);
  EXPECT_EQ(set[0].basis.job_name, "paper.yaml");
  publishZeros(kFoundAt, set[0].values[0], set[0].values[1]);
  WAIT_FOR(!panel.enabled("apply_correction"));  // it is set
  panel.press("correct_back");
  panel.press("confirm_correction");
  WAIT_FOR(stage.get(&Stage::offsets_set).size() == 2);
  set = stage.get(&Stage::offsets_set);
  EXPECT_EQ(set[1].values, (std::vector<double>{0.0015, -0.007}));
  EXPECT_EQ(set[1].basis.method, flute_grinder::OffsetBasis::CORRECTION);
}

TEST_F(MeasuredTool, KeepsWhatWasEnteredOfItWhileTheNextOneIsGround) {
  ASSERT_NO_FATAL_FAILURE(open());
  enter("measured_core_diameter@15", "9.8");
  stage.be("running", panel);
  const QString next = folder_.filePath("cell/stage/0000000008_20261122T170513.123Z.json");
  QFile::copy(path(), next);
  stage.be("ready", panel);
  WAIT_FOR(panel.shows("measured_tool", "Tool 7, of which figures are entered. Tool 8 has been ground since"));
  EXPECT_EQ(panel.the<QLineEdit>("measured_core_diameter@15").text(), "9.8");
  panel.picture("entered_of_an_earlier_tool", "correction_dialog");
  panel.press("keep_measured");
  WAIT_FOR(panel.shows("measured_tool", "Tool 8, the last of this job"));
  EXPECT_EQ(panel.the<QLineEdit>("measured_core_diameter@15").text(), "");
  EXPECT_EQ(measuredOf(readRecord(path().toStdString())).size(), 1U);
  EXPECT_TRUE(measuredOf(readRecord(next.toStdString())).empty());
}

TEST_F(MeasuredTool, SetsNothingByAWrongEntryOrForZeroPointsFoundAnew) {
  ASSERT_NO_FATAL_FAILURE(open());
  for (const char* wrong : {"98", "9.8 mm", "nan"}) {
    enter("measured_core_diameter@15", wrong);
    panel.press("keep_measured");
    EXPECT_TRUE(panel.shows("correction", std::string("core = ") + wrong + "; allowed: "));
  }
  EXPECT_TRUE(measuredOf(readRecord(path().toStdString())).empty());
  enter("measured_core_diameter@15", "8.8");  // a digit
  panel.press("keep_measured");
  WAIT_FOR(panel.shows("correction", "no correction: measure the tool again"));
  EXPECT_TRUE(panel.shows("correction", "tool 7: core_diameter@15 = 8.8 mm; allowed: "));
  EXPECT_FALSE(panel.enabled("apply_correction"));
  enter("measured_core_diameter@15", "9.8");
  panel.press("keep_measured");
  WAIT_FOR(panel.enabled("apply_correction"));
  publishZeros(kFoundAt, 0.0015, -0.007, 1);
  WAIT_FOR(!panel.enabled("apply_correction"));
  EXPECT_NE(panel.the<QPushButton>("apply_correction").toolTip().indexOf("another wheel has been mounted since"), -1);
  publishZeros(kFoundAt);
  WAIT_FOR(panel.enabled("apply_correction"));
  publishZeros(kFoundAt + 60);
  WAIT_FOR(!panel.enabled("apply_correction"));
  EXPECT_NE(
      panel.the<QPushButton>("apply_correction").toolTip().indexOf("the zero point of Y is not the one of tool 7"), -1);
}

}  // namespace grinder::test_panel_offsets
