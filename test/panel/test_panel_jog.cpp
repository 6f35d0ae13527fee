// The jog buttons of the panel, against a grinder of the test's own.

#include "flute_grinder/base/axes.h"
#include "stage.h"

#include <QAbstractScrollArea>
#include <QDateTime>
#include <QTabWidget>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <functional>
#include <map>
#include <optional>
#include <thread>

namespace grinder::test_panel_jog {

const Names kButtons{"jog_x_plus", "jog_x_minus", "jog_y_plus", "jog_y_minus",
                     "jog_z_plus", "jog_z_minus", "jog_a_plus", "jog_a_minus"};

/// Without a job.
class Jogging : public Staged {
 protected:
  Jogging() {
    stage.be("ready");
    panel.openTab("Jog");
  }
  Names enabledButtons() { return panel.enabledOf(kButtons); }
  void choose(const QString& step) { panel.the<QComboBox>("jog_step").setCurrentText(step); }
  std::vector<flute_grinder::Jog> jogs() { return stage.get(&Stage::jogs); }
  std::vector<flute_grinder::JogStep::Request> steps() { return stage.get(&Stage::steps); }
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

  Panel panel{"cell/stage"};
};

TEST_F(Jogging, AxesMayBeJoggedAndTouchedOffWhereTheStateAllows) {
  for (const StateRow& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    stage.be(row.name, panel);
    EXPECT_EQ(enabledButtons(), after(row.value, MachineEvent::kJog) ? kButtons : Names());
    EXPECT_EQ(panel.enabled("touch_off"), row.value == MachineState::kReady || row.value == MachineState::kDisabled);
  }
  stage.be("ready");
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(enabledButtons() == Names{"jog_y_plus"});
  stage.change([&] { stage.state.wheel_backs_off = 1; });
  WAIT_FOR(enabledButtons() == Names{"jog_x_minus"});
  stage.change([&] { stage.state.wheel_in_work = stage.state.wheel_backs_off = 0, stage.state.homed = 0; });
  WAIT_FOR(enabledButtons().empty());
  EXPECT_FALSE(panel.enabled("touch_off"));
}

TEST_F(Jogging, ItsButtonsAreLargeAndApartAndDoNotScroll) {
  stage.be("ready", panel);
  std::map<std::string, QRect> places;
  for (const std::string& name : kButtons) {
    auto& button = panel.the<QPushButton>(name.c_str());
    places[name] = QRect(button.mapTo(&panel.widget(), QPoint()), button.size());
    EXPECT_GE(button.height(), 40);
    EXPECT_GE(button.width(), 60);
    // Scrolled, the opposite one would be where a button was.
    for (auto* page : panel.widget().findChildren<QAbstractScrollArea*>()) EXPECT_FALSE(page->isAncestorOf(&button));
  }
  for (const auto& [name, place] : places) {
    for (const auto& [other, its] : places) {
      const int apart = name.substr(0, 5) == other.substr(0, 5) ? 20 : 8;
      if (name == other) continue;
      EXPECT_FALSE(place.adjusted(-apart, -apart, apart, apart).intersects(its)) << name << other;
    }
  }
}

/// As the operator sees it.
using Lamps = std::vector<std::string>;

TEST_F(Jogging, LampsTellWhatIsCommandedFromWhatIsReported) {
  flute_grinder::MachineInfo able;
  able.spindle = able.coolant = able.probe = 1;
  stage.publishMachine(able);
  const auto lamps = [&] {
    Lamps seen;
    for (const char* name : {"spindle_lamp", "coolant_lamp", "probe_lamp"}) {
      if (panel.isVisible(name)) seen.push_back(panel.label(name));
    }
    return seen;
  };
  const auto set = [&](bool commanded, bool reported) {
    stage.change([&] {
      stage.state.spindle_commanded = stage.state.coolant_commanded = commanded;
      stage.state.spindle_at_speed = stage.state.coolant_on = stage.state.probe_contact = reported;
    });
  };
  WAIT_FOR(lamps() == (Lamps{"○ Spindle off", "○ Coolant off", "○ Probe free"}));
  set(true, false);
  WAIT_FOR(lamps() == (Lamps{"◐ Spindle runs up", "◐ Coolant asked", "○ Probe free"}));
  set(true, true);
  WAIT_FOR(lamps() == (Lamps{"● Spindle at speed", "● Coolant on", "● Probe touches"}));
  panel.picture("lamps_on");
  set(false, true);
  WAIT_FOR(lamps() == (Lamps{"◐ Spindle turns", "◐ Coolant flows", "● Probe touches"}));
  able.coolant = able.probe = 0;
  stage.publishMachine(able);
  WAIT_FOR(lamps() == Lamps{"◐ Spindle turns"});
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(lamps().empty());
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

TEST_F(Jogging, ATouchOffShowsWhatItChangesBeforeItCountsAndIsTakenBack) {
  panel.openTab("Zero");
  auto& at = panel.the<QDoubleSpinBox>("touch_at");
  flute_grinder::WorkOffsets offsets;
  offsets.values = {-0.002866, 0, 0, 0};
  offsets.set_at[kX] = offsets.set_at[kA] = ros::Time(1.7e9);
  offsets.basis[kX].method = flute_grinder::OffsetBasis::TOUCH_OFF;
  offsets.basis[kX].job_name = "before.yaml";
  stage.publishOffsets(offsets);
  stage.change([&] { stage.state.position[kX] = 0.001134; });
  stage.be("ready", panel);
  WAIT_FOR(panel.enabled("touch_off"));
  EXPECT_FALSE(panel.enabled("touch_back")) << "nothing was touched off from here";
  at.setValue(1.5);
  panel.click("touch_off");
  for (const char* shown : {"-2.866 mm", "-0.366 mm", "2.5 mm"}) {
    EXPECT_TRUE(panel.says("touch_question", shown)) << shown;
  }
  WAIT_FOR(panel.enabled("confirm_touch"));
  for (const char* answer : {"confirm_touch", "decline_touch"}) {
    const auto& button = panel.the<QPushButton>(answer);
    WAIT_FOR(button.visibleRegion() == QRegion(button.rect()));  // without scrolling
  }
  panel.picture("touch_off_asked");
  EXPECT_TRUE(touches().empty());
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 1);
  EXPECT_EQ(touches()[0].axis, kX);
  EXPECT_DOUBLE_EQ(touches()[0].position, 1.5e-3);
  EXPECT_EQ(touches()[0].basis.wheel_digest, "") << "without a job";
  EXPECT_NE(touches()[0].set_by.find('@'), std::string::npos) << touches()[0].set_by;
  WAIT_FOR(panel.says("messages", "Touch-off: the work offset of axis X is set"));
  offsets.values[kX] = -0.000366;
  stage.publishOffsets(offsets);
  WAIT_FOR(panel.enabled("touch_back") && panel.the<QPushButton>("touch_back").text() == "Back, X");
  panel.click("touch_back");
  EXPECT_TRUE(panel.says("touch_question", "-2.5 mm"));
  panel.press("confirm_touch");
  WAIT_FOR(stage.get(&Stage::offsets_set).size() == 1);
  const auto set = stage.get(&Stage::offsets_set)[0];
  EXPECT_EQ(set.axes, std::vector<std::uint8_t>{kX});
  EXPECT_EQ(set.values, std::vector<double>{-0.002866});
  EXPECT_EQ(set.basis.job_name, "before.yaml") << "with what it was set for";
  WAIT_FOR(!panel.enabled("touch_back"));

  panel.the<QComboBox>("touch_axis").setCurrentText("A");
  EXPECT_EQ(at.value(), 0) << "that was X";
  at.setValue(-30);
  WAIT_FOR(panel.shows("work_offset", "Work offset of A: 0.0000 deg"));
  panel.click("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(touches().size() == 2 && panel.enabled("touch_back"));
  EXPECT_EQ(touches()[1].axis, kA);
  EXPECT_DOUBLE_EQ(touches()[1].position, -M_PI / 6);
  // Set back with another wheel, it would count for that one.
  offsets.wheel.mounting = 1;
  offsets.values[kA] = 0.25;
  stage.publishOffsets(offsets);
  WAIT_FOR(panel.shows("work_offset", "14.32"));
  panel.click("touch_back");
  WAIT_FOR(panel.says("messages", "Touch-off: another wheel has been mounted since"));
  EXPECT_FALSE(panel.isVisible("confirm_touch"));
  WAIT_FOR(!panel.enabled("touch_back"));
}

TEST_F(Jogging, ANewClampingIsAskedForAndARefusalSaid) {
  panel.openTab("Zero");
  flute_grinder::WorkOffsets offsets;
  offsets.tool.digest = std::string(64, 'a');
  offsets.tool.job_name = "reamer.yaml";
  offsets.tool.ground = 0b1;
  stage.publishOffsets(offsets);
  WAIT_FOR(panel.the<QLabel>("tool").toolTip() == "reamer.yaml with flute");
  panel.click("reclamped");
  EXPECT_TRUE(panel.says("touch_question", "reamer.yaml with flute"));
  EXPECT_EQ(stage.get(&Stage::reclamped), 0);
  panel.press("confirm_touch");
  WAIT_FOR(stage.get(&Stage::reclamped) == 1);
  stage.change([&] { stage.touch_refusal = "the axes are not homed"; });
  panel.press("touch_off");
  panel.press("confirm_touch");
  WAIT_FOR(panel.says("messages", "Touch-off: the axes are not homed"));
}

TEST_F(Jogging, TouchOffOfYAndZNeedsTheJob) {
  panel.openTab("Zero");
  auto& axes = panel.the<QComboBox>("touch_axis");
  axes.setCurrentText("Y");
  stage.publishOffsets({});
  WAIT_FOR(panel.enabled("jog_x_plus"));
  EXPECT_FALSE(panel.enabled("touch_off")) << "without a diameter";
  panel.the<QDoubleSpinBox>("touch_at").setValue(12.02);
  panel.press("touch_off");
  WAIT_FOR(panel.says("messages", "the small end of a job's cutter; open the job first"));
  axes.setCurrentText("Z");
  panel.press("touch_off");
  WAIT_FOR(panel.says("messages", "the height of a job's set-up; open the job first"));
  EXPECT_TRUE(touches().empty());
}

TEST_F(Jogging, ShowsWhoHasSetAnOffsetWhenAndForWhat) {
  const auto offset = [&] { return panel.label("work_offset"); };
  auto& axes = panel.the<QComboBox>("touch_axis");
  EXPECT_TRUE(offset().empty());
  flute_grinder::WorkOffsets offsets;
  offsets.values = {-0.0515, 0.00149, std::nan(""), -M_PI / 2};
  offsets.set_by[kY] = "anna@cell-3";
  const QDateTime when(QDate(2024, 2, 29), QTime(23, 59, 1));
  offsets.set_at[kY] = ros::Time(static_cast<double>(when.toSecsSinceEpoch()));
  offsets.basis[kY] = toMessage(basisOf(goalFromFile(kPaper.toStdString()), OffsetMethod::kTouchOff));
  offsets.error = "its file is damaged";
  stage.publishOffsets(offsets);
  WAIT_FOR(offset() == "Work offset of X: -51.5000 mm, never set");
  axes.setCurrentText("Y");
  WAIT_FOR(offset() ==
           "Work offset of Y: 1.4900 mm, set by anna@cell-3, 2024-02-29 23:59:01; "
           "touched off for D 10 mm, wheel straight, 3 mm wide, D 100 mm (paper.yaml)");
  axes.setCurrentText("Z");
  WAIT_FOR(offset() == "Work offset of Z is unknown: its file is damaged");
  axes.setCurrentText("A");
  WAIT_FOR(offset() == "Work offset of A: -90.0000 deg, never set");
  axes.setCurrentText("Y");
  panel.the<QDoubleSpinBox>("touch_at").setValue(12.02);
  panel.picture("jog");
  panel.openTab("Zero");
  panel.picture("zero_points");
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(offset().empty());
}

TEST_F(Jogging, SpindleAndCoolantAreSwitchedWhereTheStateAllowsAndTheDriveHasThem) {
  const auto enabled = [&] { return panel.enabledOf({"spindle_on", "spindle_off", "coolant_on", "coolant_off"}); };
  const auto command = [&](bool spindle, bool coolant) {
    stage.change([&] { stage.state.spindle_commanded = spindle, stage.state.coolant_commanded = coolant; });
  };
  const auto begins = [&](const char* meaning) { return panel.label("meaning").find(meaning) == 0; };
  WAIT_FOR(enabled() == (Names{"spindle_on", "coolant_on"}));
  panel.click("coolant_on");
  WAIT_FOR(stage.get(&Stage::triggers) == Names{"coolant_on"});
  panel.click("spindle_on");
  WAIT_FOR(enabled() == (Names{"spindle_off", "coolant_on"}));
  EXPECT_TRUE(begins("The spindle is on. ")) << panel.label("meaning");
  WAIT_FOR(panel.says("messages", "The spindle is on; keep clear of the wheel"));
  panel.picture("spindle_on");
  panel.click("spindle_off");
  WAIT_FOR(enabled() == (Names{"spindle_on", "coolant_on"}));
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(enabled().empty());
  stage.change([&] { stage.state.wheel_in_work = 0; });
  // While a job runs they are its own.
  command(true, true);
  stage.be("running", panel);
  EXPECT_TRUE(enabled().empty());
  // With its wheel lifted the tool may be looked at.
  for (const char* lifted : {"retracted", "jogging_retracted"}) {
    command(true, true);
    stage.be(lifted, panel);
    EXPECT_EQ(enabled(), (Names{"spindle_off", "coolant_off"}));
    EXPECT_EQ(panel.label("meaning").find("is off: "), std::string::npos) << panel.label("meaning");
    command(false, false);
    WAIT_FOR(enabled() == (Names{"spindle_on", "coolant_on"}));
    EXPECT_TRUE(begins("The spindle is off: switch it on first. ")) << panel.label("meaning");
  }
  panel.picture("spindle_and_coolant_off");
  command(true, true);
  stage.be("disabled", panel);
  EXPECT_EQ(enabled(), (Names{"spindle_off", "coolant_off"})) << "off is never refused";
  command(false, false);
  stage.be("ready", panel);
  EXPECT_TRUE(panel.enabled("home"));
  flute_grinder::MachineInfo without;
  without.coolant = 1;
  stage.publishMachine(without);
  WAIT_FOR(enabled() == Names{"coolant_on"} && !panel.enabled("home"));
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
  stage.refuseJog("jog refused: axis Y is at machine position -20 mm, the end of its travel");
  WAIT_FOR(panel.says("messages", "Jog refused: axis Y is at machine position -20 mm"));
  QTest::mouseRelease(&panel.the<QPushButton>("jog_y_minus"), Qt::LeftButton);
  expectStopped();
  EXPECT_TRUE(steps().empty());
}

TEST_F(Jogging, EndsWhenTheButtonIsHiddenDisabledOrWithoutFocus) {
  WAIT_FOR(panel.enabled("jog_x_plus"));
  choose("while pressed");
  auto& button = panel.the<QPushButton>("jog_x_plus");
  const std::map<std::string, std::function<void()>> ways{
      {"another tab is shown", [&] { panel.the<QTabWidget>("tabs").setCurrentIndex(0); }},
      {"the window loses the focus",
       [&] {
         QFocusEvent out(QEvent::FocusOut, Qt::ActiveWindowFocusReason);
         QCoreApplication::sendEvent(&button, &out);
       }},
      {"the mouse is moved away",
       [&] {
         QTest::mouseMove(&button, QPoint(-100, -100));
         QMouseEvent away(QEvent::MouseMove, QPointF(-100, -100), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
         QCoreApplication::sendEvent(&button, &away);
       }},
      {"the grinder reports a fault", [&] { stage.be("fault"); }}};
  for (const auto& [how, end] : ways) {
    SCOPED_TRACE(how);
    stage.be("ready", panel);
    panel.openTab("Jog");
    ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
    end();
    ASSERT_NO_FATAL_FAILURE(expectStopped());
    QTest::mouseRelease(&button, Qt::LeftButton, Qt::NoModifier, QPoint(-100, -100));
  }
}

TEST_F(Jogging, AMessageThatWouldComeTooLateStopsAndTheButtonMustBePressedAnew) {
  WAIT_FOR(panel.enabled("jog_x_plus"));
  choose("while pressed");
  auto& button = panel.the<QPushButton>("jog_x_plus");
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  flute_grinder::MachineInfo machine;
  for (const double timeout : {0.001, kPatience * 1e-3}) {  // at first shorter than the pause between two messages
    machine.jog_timeout = timeout;
    stage.publishMachine(machine);
    ASSERT_NO_FATAL_FAILURE(expectStopped());
    EXPECT_TRUE(button.isDown());
  }
  const std::vector<flute_grinder::Jog> sent = jogs();
  EXPECT_NE(sent[sent.size() - 2].velocity, 0) << "it is stopped once";
  QTest::mouseRelease(&button, Qt::LeftButton);
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  EXPECT_GT(jogs().back().velocity, 0);
  QTest::mouseRelease(&button, Qt::LeftButton);
  expectStopped();
}

/// The process id of the X server; nothing if it is on another computer.
std::optional<pid_t> xServer() {
  const std::string display = qgetenv("DISPLAY").toStdString();
  if (display.empty() || display[0] != ':') return std::nullopt;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = "/tmp/.X11-unix/X" + display.substr(1, display.find('.') - 1);
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int socket_to_it = socket(AF_UNIX, SOCK_STREAM, 0);
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known = connect(socket_to_it, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                     getsockopt(socket_to_it, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
  close(socket_to_it);
  return known ? std::optional<pid_t>(peer.pid) : std::nullopt;
}

TEST_F(Jogging, NothingIsSentWhileTheDisplayStandsStill) {
  const std::optional<pid_t> server = xServer();
  if (!server) GTEST_SKIP() << "the X server is none of this computer";
  WAIT_FOR(panel.enabled("jog_x_plus"));
  choose("while pressed");
  ASSERT_NO_FATAL_FAILURE(hold("jog_x_plus"));
  panel.widget().setUpdatesEnabled(false);  // What is drawn may wait for the X server, too.
  std::size_t at_first = 0, in_the_end = 0;
  std::atomic<bool> over{false};
  std::thread stopper([&] {
    kill(*server, SIGSTOP);
    ros::WallDuration(0.5).sleep();  // What was on its way has come.
    at_first = jogs().size();
    ros::WallDuration(1).sleep();
    in_the_end = jogs().size();
    kill(*server, SIGCONT);
    over = true;
  });
  const bool came_back = QTest::qWaitFor([&] { return over.load(); }, kPatience);
  stopper.join();
  ASSERT_TRUE(came_back);
  EXPECT_EQ(in_the_end, at_first);
  WAIT_FOR(jogs().size() > in_the_end);
  QTest::mouseRelease(&panel.the<QPushButton>("jog_x_plus"), Qt::LeftButton);
  expectStopped();
}

}  // namespace grinder::test_panel_jog
