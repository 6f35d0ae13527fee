// The jog buttons of the panel, against a grinder of the test's own.

#include "panel_fixture.h"
#include "stage.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QTabWidget>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace flute_grinder {
namespace {

const Names kButtons{"jog_x_plus", "jog_x_minus", "jog_y_plus", "jog_y_minus",
                     "jog_z_plus", "jog_z_minus", "jog_a_plus", "jog_a_minus"};

class Jogging : public ::testing::Test {
 protected:
  Jogging() {
    stage.be(GrinderState::READY, "ready");
    auto& tabs = panel.the<QTabWidget>("tabs");
    for (int i = 0; i < tabs.count(); ++i) {
      if (tabs.tabText(i) == "Jog") tabs.setCurrentIndex(i);
    }
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
  std::vector<Jog> jogs() {
    return stage.get([&] { return stage.jogs; });
  }
  std::vector<JogStep::Request> steps() {
    return stage.get([&] { return stage.steps; });
  }
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
  for (const auto& [state, name, allowed] : std::vector<std::tuple<std::uint8_t, const char*, bool>>{
           {GrinderState::READY, "ready", true},
           {GrinderState::HELD, "held", false},
           {GrinderState::RETRACTED, "retracted", true},
           {GrinderState::RUNNING, "running", false},
           {GrinderState::JOGGING, "jogging", true},
           {GrinderState::DISABLED, "disabled", false},
           {GrinderState::JOGGING_RETRACTED, "jogging_retracted", true}}) {
    stage.be(state, name);
    WAIT_FOR(panel.enabled("jog_x_plus") == allowed);
    WAIT_FOR(enabledButtons() == (allowed ? kButtons : Names()));
  }
  WAIT_FOR(panel.state() == "Jogging retracted");
  stage.be(GrinderState::READY, "ready");
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(enabledButtons() == Names{"jog_y_plus"});
  stage.change([&] { stage.state.wheel_in_work = 0, stage.state.homed = 0; });
  WAIT_FOR(enabledButtons() == Names());
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
  EXPECT_EQ(steps()[0].axis, JogStep::Request::X);
  EXPECT_DOUBLE_EQ(steps()[0].distance, 1e-4);
  EXPECT_DOUBLE_EQ(steps()[0].speed, 0.002);
  EXPECT_EQ(steps()[1].axis, JogStep::Request::A);
  EXPECT_DOUBLE_EQ(steps()[1].distance, -0.1 * M_PI / 180);
  EXPECT_DOUBLE_EQ(steps()[1].speed, 15 * M_PI / 180);
  EXPECT_TRUE(jogs().empty());
  EXPECT_EQ(panel.text("messages"), "");
  stage.change([&] { stage.step_refusal = "jog refused: because"; });
  panel.click("jog_z_minus");
  WAIT_FOR(panel.text("messages").find("Jog refused: because") != std::string::npos);
  panel.picture("jog");
}

TEST_F(Jogging, WhilePressedItIsRepeatedAndStopsWhenReleased) {
  WAIT_FOR(panel.enabled("jog_y_minus"));
  choose("while pressed");
  panel.the<QDoubleSpinBox>("jog_speed").setValue(300);
  ASSERT_NO_FATAL_FAILURE(hold("jog_y_minus"));
  for (const Jog& jog : jogs()) {
    EXPECT_EQ(jog.axis, Jog::Y);
    EXPECT_DOUBLE_EQ(jog.velocity, -0.005);
    EXPECT_LT(std::abs((ros::Time::now() - jog.header.stamp).toSec()), 60);
  }
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
  stage.be(GrinderState::FAULT, "fault");
  expectStopped();
  QTest::mouseRelease(&button, Qt::LeftButton);
}

}  // namespace
}  // namespace flute_grinder
