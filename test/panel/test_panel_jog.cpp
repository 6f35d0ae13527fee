// The jog buttons of the panel, against a grinder of the test's own.

#include "flute_grinder/job/axes.h"
#include "panel_fixture.h"
#include "stage.h"

#include <ros/package.h>
#include <QComboBox>
#include <QDateTime>
#include <QDoubleSpinBox>
#include <QTabWidget>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace grinder {
namespace test_panel_jog {

const QString kPaper = QString::fromStdString(ros::package::getPath("flute_grinder")) + "/test/jobs/paper.yaml";
const Names kButtons{"jog_x_plus", "jog_x_minus", "jog_y_plus", "jog_y_minus",
                     "jog_z_plus", "jog_z_minus", "jog_a_plus", "jog_a_minus"};

class Jogging : public ::testing::Test {
 protected:
  Jogging() {
    stage.be("ready");
    panel.openTab("Jog");
  }
  Names enabledButtons() {
    Names names;
    for (const std::string& name : kButtons) {
      if (panel.enabled(name.c_str())) names.insert(name);
    }
    return names;
  }
  void choose(const QString& step) {
    auto& steps = panel.the<QComboBox>("jog_step");
    const int index = steps.findText(step);
    ASSERT_GE(index, 0) << step.toStdString();
    steps.setCurrentIndex(index);
  }
  std::vector<flute_grinder::Jog> jogs() { return stage.get(&Stage::jogs); }
  std::vector<flute_grinder::JogStep::Request> steps() { return stage.get(&Stage::steps); }
  std::vector<flute_grinder::TouchOff::Request> touches() { return stage.get(&Stage::touches); }
  /// Presses a button until some messages have come.
  void hold(const char* name) {
    const std::size_t before = jogs().size();
    QTest::mousePress(&panel.the<QPushButton>(name), Qt::LeftButton);
    WAIT_FOR(jogs().size() >= before + 5);
  }
  /// The messages have ended with a stop.
  void expectStopped() {
    WAIT_FOR(jogs().back().velocity == 0);
    const std::size_t count = jogs().size();
    QTest::qWait(200);
    EXPECT_EQ(jogs().size(), count);
  }

  Stage stage;
  Panel panel{"cell/stage"};
};

TEST_F(Jogging, ButtonsAreEnabledWhereAnAxisMayBeJogged) {
  for (const auto& [state, allowed] : {std::pair{"ready", true},
                                       {"held", false},
                                       {"retracted", true},
                                       {"running", false},
                                       {"jogging", true},
                                       {"disabled", false},
                                       {"jogging_retracted", true}}) {
    stage.be(state);
    WAIT_FOR(panel.enabled("jog_x_plus") == allowed);
    WAIT_FOR(enabledButtons() == (allowed ? kButtons : Names()));
  }
  WAIT_FOR(panel.state() == "Jogging retracted");
  stage.be("ready");
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(enabledButtons() == Names{"jog_y_plus"});
  stage.change([&] { stage.state.wheel_in_work = 0, stage.state.homed = 0; });
  WAIT_FOR(enabledButtons().empty());
}

TEST_F(Jogging, AClickMovesByTheStepAtTheSpeed) {
  WAIT_FOR(panel.enabled("jog_x_plus"));
  choose("0.1 mm, deg");
  panel.the<QDoubleSpinBox>("jog_speed").setValue(120);
  panel.the<QDoubleSpinBox>("jog_speed_a").setValue(900);
  panel.click("jog_x_plus");
  WAIT_FOR(steps().size() == 1);
  panel.click("jog_a_minus");
  WAIT_FOR(steps().size() == 2);
  EXPECT_EQ(steps()[0].axis, flute_grinder::JogStep::Request::X);
  EXPECT_DOUBLE_EQ(steps()[0].distance, 1e-4);
  EXPECT_DOUBLE_EQ(steps()[0].speed, 0.002);
  EXPECT_EQ(steps()[1].axis, flute_grinder::JogStep::Request::A);
  EXPECT_DOUBLE_EQ(steps()[1].distance, -0.1 * M_PI / 180);
  EXPECT_DOUBLE_EQ(steps()[1].speed, 15 * M_PI / 180);
  EXPECT_TRUE(jogs().empty());
  WAIT_FOR(panel.says("messages", "Jog: axis A by -0.1 deg"));
  stage.change([&] { stage.step_refusal = "jog refused: because"; });
  panel.click("jog_z_minus");
  WAIT_FOR(panel.says("messages", "Jog refused: because"));
}

TEST_F(Jogging, TouchOffSetsTheOffsetOfTheChosenAxis) {
  auto& axes = panel.the<QComboBox>("touch_axis");
  auto& at = panel.the<QDoubleSpinBox>("touch_at");
  WAIT_FOR(panel.enabled("touch_off"));
  at.setValue(1.5);
  panel.click("touch_off");
  WAIT_FOR(touches().size() == 1);
  axes.setCurrentText("A");
  EXPECT_EQ(at.value(), 0) << "that was X";
  at.setValue(-30);
  panel.click("touch_off");
  WAIT_FOR(touches().size() == 2);
  EXPECT_EQ(touches()[0].axis, kX);
  EXPECT_DOUBLE_EQ(touches()[0].position, 1.5e-3);
  EXPECT_EQ(touches()[1].axis, kA);
  EXPECT_DOUBLE_EQ(touches()[1].position, -M_PI / 6);
  for (const flute_grinder::TouchOff::Request& touch : touches()) {
    EXPECT_NE(touch.set_by.find('@'), std::string::npos) << touch.set_by;
  }
  WAIT_FOR(panel.says("messages", "Touch-off: the work offset of axis A is set"));
  stage.change([&] { stage.touch_refusal = "the axes are not homed"; });
  panel.click("touch_off");
  WAIT_FOR(panel.says("messages", "Touch-off: the axes are not homed"));
}

TEST_F(Jogging, TouchOffOfYNeedsTheJobAndItsHeight) {
  panel.the<QComboBox>("touch_axis").setCurrentText("Y");
  auto& diameter = panel.the<QDoubleSpinBox>("touch_at");
  WAIT_FOR(panel.enabled("jog_x_plus"));
  EXPECT_FALSE(panel.enabled("touch_off")) << "without a diameter";
  diameter.setValue(12.02);
  WAIT_FOR(panel.enabled("touch_off"));
  panel.click("touch_off");
  WAIT_FOR(panel.says("messages", "open the job first"));

  Panel with_job("cell/stage", kPaper);
  with_job.the<QComboBox>("touch_axis").setCurrentText("Y");
  with_job.the<QDoubleSpinBox>("touch_at").setValue(12.02);
  WAIT_FOR(with_job.enabled("touch_off"));
  with_job.click("touch_off");
  WAIT_FOR(with_job.text("messages").find("move Z to -2.788 mm, and touch again") != std::string::npos);
  stage.change([&] { stage.state.work_position[kZ] = -2.788e-3; });
  // The job's end diameter is 10 mm.
  WAIT_FOR((with_job.click("touch_off"), !touches().empty()));
  EXPECT_EQ(touches()[0].axis, kY);
  EXPECT_NEAR(touches()[0].position, 1.01e-3, 1e-12);
}

TEST_F(Jogging, ShowsWhoHasSetAnOffsetAndWhen) {
  const auto offset = [&] { return panel.label("work_offset"); };
  auto& axes = panel.the<QComboBox>("touch_axis");
  EXPECT_TRUE(offset().empty());
  flute_grinder::WorkOffsets offsets;
  offsets.values = {-0.0515, 0.00149, std::nan(""), -M_PI / 2};
  offsets.set_by[kY] = "anna@cell-3";
  const QDateTime when(QDate(2024, 2, 29), QTime(23, 59, 1));
  offsets.set_at[kY] = ros::Time(static_cast<double>(when.toSecsSinceEpoch()));
  offsets.error = "its file is damaged";
  stage.publishOffsets(offsets);
  WAIT_FOR(offset() == "Work offset of X: -51.5000 mm, never set");
  axes.setCurrentText("Y");
  WAIT_FOR(offset() == "Work offset of Y: 1.4900 mm, set by anna@cell-3, 2024-02-29 23:59:01");
  axes.setCurrentText("Z");
  WAIT_FOR(offset() == "Work offset of Z is unknown: its file is damaged");
  axes.setCurrentText("A");
  WAIT_FOR(offset() == "Work offset of A: -90.0000 deg, never set");
  axes.setCurrentText("Y");
  panel.the<QDoubleSpinBox>("touch_at").setValue(12.02);
  stage.change([&] {
    stage.joints.name = {"axis_x", "axis_y", "axis_z", "axis_a"};
    stage.joints.position = {-0.0295, 0.0025, -0.0015, -M_PI / 2};
    std::copy(stage.joints.position.begin(), stage.joints.position.end(), stage.state.position.begin());
    stage.state.work_position = {0.022, 0.00101, 0.001184, 0};
  });
  WAIT_FOR(panel.label("position_y") == "Y     1.010 mm");
  WAIT_FOR(offset().find("set by anna") != std::string::npos);
  WAIT_FOR(panel.enabled("touch_off"));
  panel.picture("jog");
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(offset().empty());
}

TEST_F(Jogging, TouchOffIsEnabledWhereOffsetsAreSet) {
  for (const auto& [state, allowed] :
       {std::pair{"ready", true}, {"jogging", false}, {"disabled", true}, {"retracted", false}}) {
    stage.be(state);
    WAIT_FOR(panel.enabled("touch_off") == allowed);
  }
  stage.be("ready");
  WAIT_FOR(panel.enabled("touch_off"));
  stage.change([&] { stage.state.homed = 0; });
  WAIT_FOR(!panel.enabled("touch_off"));
}

TEST_F(Jogging, SpindleAndCoolantAreSwitchedWhereTheStateAllows) {
  const Names switches{"spindle_on", "spindle_off", "coolant_on", "coolant_off"};
  const auto enabled = [&] {
    Names names;
    for (const std::string& name : switches) {
      if (panel.enabled(name.c_str())) names.insert(name);
    }
    return names;
  };
  WAIT_FOR(enabled() == (Names{"spindle_on", "coolant_on"}));
  panel.click("spindle_on");
  WAIT_FOR(enabled() == (Names{"spindle_off", "coolant_on"}));
  EXPECT_EQ(panel.label("meaning").find("The spindle is on. "), 0U) << panel.label("meaning");
  WAIT_FOR(panel.says("messages", "The spindle is on; keep clear of the wheel"));
  panel.picture("spindle_on");
  panel.click("spindle_off");
  WAIT_FOR(enabled() == (Names{"spindle_on", "coolant_on"}));
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(enabled().empty());
  stage.change([&] { stage.state.wheel_in_work = 0; });
  WAIT_FOR(enabled().size() == 2);
  // While a job runs they are its own.
  stage.change([&] { stage.state.spindle_commanded = stage.state.coolant_commanded = 1; });
  stage.be("running", panel);
  EXPECT_TRUE(enabled().empty());
  stage.be("disabled", panel);
  EXPECT_EQ(enabled(), (Names{"spindle_off", "coolant_off"})) << "off is never refused";
}

TEST_F(Jogging, WhatTheDriveCannotDoIsGrey) {
  WAIT_FOR(panel.enabled("home") && panel.enabled("spindle_on") && panel.enabled("coolant_on"));
  flute_grinder::MachineInfo machine;
  machine.coolant = 1;
  stage.publishMachine(machine);
  WAIT_FOR(!panel.enabled("home") && !panel.enabled("spindle_on"));
  EXPECT_TRUE(panel.enabled("coolant_on"));
}

TEST_F(Jogging, TheDistanceToGoIsShownWhileSomethingMoves) {
  WAIT_FOR(panel.enabled("jog_x_plus"));
  EXPECT_EQ(panel.label("to_go_x"), "");
  stage.change([&] {
    stage.joints.name = {"axis_x", "axis_y", "axis_z", "axis_a"};
    stage.joints.position = {0, 0, 0, 0};
    stage.state.distance_to_go = {-0.0125, 0, 0, M_PI};
  });
  WAIT_FOR(panel.label("to_go_x") == "X -12.500");
  EXPECT_EQ(panel.label("to_go_y"), "Y 0.000");
  EXPECT_EQ(panel.label("to_go_a"), "A 180.0");
  panel.picture("to_go");
}

TEST_F(Jogging, WhilePressedItIsRepeatedAndStopsWhenReleased) {
  WAIT_FOR(panel.enabled("jog_y_minus"));
  choose("while pressed");
  panel.the<QDoubleSpinBox>("jog_speed").setValue(300);
  ASSERT_NO_FATAL_FAILURE(hold("jog_y_minus"));
  for (const flute_grinder::Jog& jog : jogs()) {
    EXPECT_EQ(jog.axis, flute_grinder::Jog::Y);
    EXPECT_DOUBLE_EQ(jog.velocity, -0.005);
    EXPECT_LT(std::abs((ros::Time::now() - jog.header.stamp).toSec()), 60);
  }
  EXPECT_EQ(panel.text("messages"), "");
  stage.refuseJog("jog refused: axis Y stands at -20 mm, the end of its way");
  WAIT_FOR(panel.says("messages", "Jog refused: axis Y stands at -20 mm"));
  QTest::mouseRelease(&panel.the<QPushButton>("jog_y_minus"), Qt::LeftButton);
  expectStopped();
  EXPECT_TRUE(steps().empty());
}

TEST_F(Jogging, EndsWhenTheButtonIsHiddenDisabledOrWithoutFocus) {
  WAIT_FOR(panel.enabled("jog_x_plus"));
  choose("while pressed");
  auto& button = panel.the<QPushButton>("jog_x_plus");
  auto& tabs = panel.the<QTabWidget>("tabs");
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  const int tab = tabs.currentIndex();
  tabs.setCurrentIndex(0);
  expectStopped();
  QTest::mouseRelease(&button, Qt::LeftButton);
  tabs.setCurrentIndex(tab);
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  QFocusEvent out(QEvent::FocusOut, Qt::ActiveWindowFocusReason);
  QCoreApplication::sendEvent(&button, &out);
  expectStopped();
  QTest::mouseRelease(&button, Qt::LeftButton);
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  QTest::mouseMove(&button, QPoint(-100, -100));
  QMouseEvent away(QEvent::MouseMove, QPointF(-100, -100), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&button, &away);
  expectStopped();
  QTest::mouseRelease(&button, Qt::LeftButton, Qt::NoModifier, QPoint(-100, -100));
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  stage.be("fault");
  expectStopped();
  QTest::mouseRelease(&button, Qt::LeftButton);
}

}  // namespace test_panel_jog
}  // namespace grinder
