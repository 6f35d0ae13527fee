// What keys, the mouse wheel and clicks do in the panel, against a grinder of the test's own.

#include "stage.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QClipboard>
#include <QDialog>
#include <QLocale>
#include <QScreen>
#include <QScrollBar>
#include <QShortcut>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <QWindow>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace grinder::test_panel_input {

/// Makes a window take the keys.
void activate(Panel& panel) {
  panel.widget().activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&panel.widget(), kPatience));
}

constexpr std::array kTabs{"Job", "Section", "Jog", "Zero", "View"};

/// The keys that press a button, somewhere.
constexpr std::array kPressing{Qt::Key_Space, Qt::Key_Return, Qt::Key_Enter};

void pressKeys(QWidget& widget) {
  for (const Qt::Key key : kPressing) QTest::keyClick(&widget, key);
}

/// As the operator's hand does it: what blocks the window blocks the click.
void clickInWindow(Panel& panel, const char* name) {
  auto& button = panel.the<QPushButton>(name);
  QTest::mouseClick(panel.widget().windowHandle(), Qt::LeftButton, {},
                    button.mapTo(&panel.widget(), button.rect().center()));
}

/// Everything in which numbers are entered, however it is made. Touch-off has another range for each axis.
template <typename Check>
void forEachBox(Panel& panel, Check check) {
  auto& axes = panel.the<QComboBox>("touch_axis");
  int boxes = 0;
  for (int axis = 0; axis < axes.count(); ++axis) {
    axes.setCurrentIndex(axis);
    for (auto* box : panel.widget().findChildren<QAbstractSpinBox*>()) {
      SCOPED_TRACE(box->objectName().toStdString() + " of " + axes.currentText().toStdString());
      check(*box);
      ++boxes;
    }
  }
  EXPECT_GE(boxes, 4 * axes.count());
}

double valueOf(QWidget& widget) {
  if (auto* slider = qobject_cast<QAbstractSlider*>(&widget)) return slider->value();
  if (auto* choice = qobject_cast<QComboBox*>(&widget)) return choice->currentIndex();
  auto* numbers = qobject_cast<QDoubleSpinBox*>(&widget);
  EXPECT_TRUE(numbers) << "whole numbers alone would take 6,203 for 6203";
  return numbers ? numbers->value() : std::numeric_limits<double>::quiet_NaN();
}

double typed(QAbstractSpinBox& box, const QString& text) {
  box.selectAll();
  QTest::keyClicks(&box, text);
  QTest::keyClick(&box, Qt::Key_Return);
  return valueOf(box);
}

double pasted(QAbstractSpinBox& box, const QString& text) {
  box.selectAll();
  QApplication::clipboard()->setText(text);
  box.findChild<QLineEdit*>()->paste();
  QTest::keyClick(&box, Qt::Key_Return);
  return valueOf(box);
}

/// The same in the operator's language, whatever it is.
class InALanguage : public Staged, public ::testing::WithParamInterface<QLocale::Language> {
 protected:
  void SetUp() override {
    QLocale::setDefault(QLocale(GetParam()));
    panel = std::make_unique<Panel>("cell/stage", kPaper);
    stage.be("ready", *panel);
    WAIT_FOR(panel->enabled("section_x"));
    panel->openTab("Jog");
  }
  ~InALanguage() override { QLocale::setDefault(QLocale::c()); }

  std::unique_ptr<Panel> panel;
};
// English groups digits by commas, as C does.
INSTANTIATE_TEST_SUITE_P(Of, InALanguage, ::testing::Values(QLocale::English, QLocale::German));

TEST_P(InALanguage, CommaAndPointAreTheDecimalSignInEveryBoxAndWhatIsNoNumberInRangeStaysAsItWasTyped) {
  forEachBox(*panel, [](QAbstractSpinBox& box) {
    for (const auto& [text, number] : {std::pair("6,25", 6.25), {"7.25", 7.25}, {"12,5", 12.5}}) {
      EXPECT_DOUBLE_EQ(typed(box, text), number);
    }
    EXPECT_EQ(box.text().count(','), 0) << box.text().toStdString();
    for (const char* text : {"1.234,5", "1,234.5", "1.2.5", "1 000", "1'000", "1e9", "nan", "inf", "0x10", "abc", "-",
                             "500000", "-20000", "1.23456"}) {
      SCOPED_TRACE(text);
      for (const auto enter : {typed, pasted}) {
        // Space is Hold, and not typed.
        if (enter == typed && std::strchr(text, ' ')) continue;
        enter(box, text);
        QFocusEvent left(QEvent::FocusOut, Qt::TabFocusReason);
        QApplication::sendEvent(&box, &left);
        EXPECT_EQ(qobject_cast<QDoubleSpinBox*>(&box)->cleanText(), text);
        EXPECT_FALSE(box.hasAcceptableInput());
      }
    }
    EXPECT_DOUBLE_EQ(pasted(box, "8,25"), 8.25);
    EXPECT_TRUE(box.hasAcceptableInput());
  });
  panel->the<QComboBox>("touch_axis").setCurrentText("X");
  EXPECT_DOUBLE_EQ(typed(panel->the<QAbstractSpinBox>("touch_at"), "-0,5"), -0.5);
}

TEST_F(OnStage, WhatIsNoNumberInRangeIsRedAndSwitchesItsButtonsOff) {
  panel.openTab("Zero");
  auto& at = panel.the<QAbstractSpinBox>("touch_at");
  typed(at, "5");
  const QString whole = at.text();
  for (int i = 0; i < 2; ++i) {
    at.findChild<QLineEdit*>()->end(false);
    QTest::keyClick(&at, Qt::Key_Backspace);
  }
  EXPECT_EQ(at.text(), whole) << "a unit that is deleted in part comes back";
  WAIT_FOR(panel.enabled("touch_off") && panel.enabled("jog_x_plus"));
  const auto enter = [&](const char* box, const char* text) { typed(panel.the<QAbstractSpinBox>(box), text); };
  const auto red = [&](const char* box) {
    return panel.the<QAbstractSpinBox>(box).palette().color(QPalette::Text) == QColor("#b00020");
  };
  enter("touch_at", "abc");
  WAIT_FOR(!panel.enabled("touch_off") && red("touch_at"));
  panel.openTab("Jog");
  enter("jog_speed", "1e9");
  WAIT_FOR(!panel.enabled("jog_x_plus") && red("jog_speed"));
  EXPECT_TRUE(panel.enabled("jog_a_plus")) << "A has a speed of its own";
  panel.picture("no_number");
  panel.openTab("Section");
  WAIT_FOR(panel.label("section_figures").find("Rake ") == 0);
  enter("section_x", "500");
  WAIT_FOR(panel.label("section_figures") == "Allowed X: 0 to 30 mm, 2 decimals.");
  EXPECT_TRUE(red("section_x"));
  panel.openTab("Jog");
  EXPECT_FALSE(panel.enabled("touch_off")) << "it was only hidden";
  enter("jog_speed", "120");
  WAIT_FOR(panel.enabled("jog_x_plus") && !red("jog_speed"));
  panel.openTab("Zero");
  enter("touch_at", "0.5");
  WAIT_FOR(panel.enabled("touch_off") && !red("touch_at"));
  enter("touch_at", "500000");
  WAIT_FOR(red("touch_at"));
  panel.the<QComboBox>("touch_axis").setCurrentText("Z");
  WAIT_FOR(!red("touch_at") && panel.enabled("touch_off"));
}

/// Stops the job that has begun meanwhile, beside whatever is open.
class BesideADialog : public OnStage {
 protected:
  void SetUp() override { WAIT_FOR(panel.enabled("plan")); }
  void expectHoldWorks() {
    EXPECT_EQ(QGuiApplication::modalWindow(), nullptr);
    const auto& hold = panel.the<QPushButton>("hold");
    const QRect place(hold.mapToGlobal(QPoint()), hold.size());
    for (const auto* dialog : panel.widget().findChildren<QDialog*>()) {
      EXPECT_FALSE(dialog->isModal());
      if (!dialog->isVisible()) continue;
      EXPECT_FALSE(dialog->frameGeometry().intersects(place));
      EXPECT_TRUE(QGuiApplication::primaryScreen()->geometry().contains(dialog->geometry()));
    }
    stage.be("running", panel);
    WAIT_FOR(panel.enabled("hold"));
    clickInWindow(panel, "hold");
    WAIT_FOR(stops() == std::vector<int>{flute_grinder::Stop::HOLD});
  }
};

TEST_F(BesideADialog, HoldWorksWhileAJobFileIsChosenInTheOneDialogWhichNeedsNoOtherForAFileThatIsNotThere) {
  QFileDialog* dialog = panel.fileDialog();
  ASSERT_TRUE(dialog);
  panel.click("choose");
  EXPECT_EQ(panel.widget().findChildren<QFileDialog*>().size(), 1);
  ASSERT_NO_FATAL_FAILURE(expectHoldWorks());
  stage.be("ready", panel);
  Panel::enter(*dialog, "/nowhere/job.yaml");
  WAIT_FOR(panel.says("plan_report", "job.yaml"));
  EXPECT_FALSE(panel.says("plan_report", "/nowhere"));
  EXPECT_EQ(QGuiApplication::modalWindow(), nullptr);
  panel.picture("wrong_job_file");
}

TEST_F(BesideADialog, HoldWorksBesideTheSetUpOnTheLeft) {
  // As rviz docks it.
  panel.widget().move(940, 40);
  WAIT_FOR(panel.widget().mapToGlobal(QPoint()).x() == 940);
  panel.click("setup");
  WAIT_FOR(panel.widget().findChild<QDialog*>("setup_dialog"));
  expectHoldWorks();
}

TEST_F(BesideADialog, HoldStaysAndWorksBesideAQuestionWhateverTabIsOpen) {
  need({kSwivelToSet});
  panel.plan();
  const QPoint place = panel.the<QWidget>("hold").pos();
  panel.openTab("Section");
  WAIT_FOR(panel.shows("section_figures", "Rake "));
  EXPECT_EQ(panel.the<QWidget>("hold").pos(), place);
  startAndBeAsked("confirm-swivel");
  expectHoldWorks();
}

/// With a job that is planned, and three questions before its start: an unfinished job, zero points that were never
/// set, and the swivel.
class Asked : public OnStage {
 protected:
  void SetUp() override {
    activate(panel);
    need({kUnfinished, kNoZeros, kSwivelToSet});
    publish([&] { stage.state.override = 0.5; });
    startAndBeAsked("discard");
  }
};

TEST_F(Asked, AQuestionTakesNoClickAtFirstAndNoKeyAndItsAnswerLiesApartFromTheOneBefore) {
  const auto place = [&](const char* name) {
    auto& button = panel.the<QPushButton>(name);
    return QRect(button.mapTo(&panel.widget(), QPoint()), button.size());
  };
  WAIT_FOR(panel.enabled("decline_job"));
  panel.openTab("Section");
  panel.openTab("Job");
  EXPECT_FALSE(panel.enabled("discard")) << "it appears again";
  const QRect not_yet = place("decline_job");
  std::vector<QRect> before;
  for (const char* answer : {"discard", "ignore-offsets", "confirm-swivel"}) {
    SCOPED_TRACE(answer);
    WAIT_FOR(panel.enabled(answer));
    for (auto* button : panel.widget().findChildren<QAbstractButton*>()) pressKeys(*button);
    EXPECT_EQ(place("decline_job"), not_yet);
    for (const QRect& other : before) EXPECT_FALSE(place(answer).intersects(other));
    before.push_back(place(answer));
    panel.press(answer);
    if (before.size() > 1) continue;
    // Far from the answer before, long after it in the events' time, but not in the operator's.
    for (const char* early : {"ignore-offsets", "decline_job"}) panel.click(early);
    EXPECT_TRUE(panel.isVisible("ignore-offsets"));
  }
  WAIT_FOR(goals().size() == 1);
}

TEST_F(Asked, SpaceHoldsWhatTheLastAnswerHasStarted) {
  for (const char* answer : {"discard", "ignore-offsets"}) panel.press(answer);
  WAIT_FOR(panel.isVisible("confirm-swivel"));
  for (const char* shown : {"Is the swivel set to this angle and clamped?", "31.769 deg", "not known"}) {
    EXPECT_TRUE(panel.says("job_question", shown)) << shown;
  }
  panel.picture("swivel_question");
  panel.press("confirm-swivel");
  WAIT_FOR(goals().size() == 1);
  EXPECT_EQ(goals().at(0).goal.answers, (std::vector<std::string>{answerId(kUnfinished, NeedAnswer::kDiscard),
                                                                  answerId(kNoZeros, NeedAnswer::kIgnoreOffsets),
                                                                  answerId(kSwivelToSet, NeedAnswer::kConfirmSwivel)}));
  EXPECT_EQ(goals().at(0).goal.job_name, "paper.yaml");
  EXPECT_FALSE(panel.isVisible("confirm-swivel"));
  WAIT_FOR(panel.says("messages", "The job begins at a feed override of 50 %"));
  // From the goal on: a job that is still planned begins held.
  WAIT_FOR(panel.enabled("hold"));
  QTest::keyClick(panel.widget().windowHandle(), Qt::Key_Space);
  WAIT_FOR(stops() == std::vector<int>{flute_grinder::Stop::HOLD});
}

TEST_F(OnStage, ADoubleClickPressesAButtonOnce) {
  QObject receiver;
  int clicks = 0;
  for (auto* button : panel.widget().findChildren<QAbstractButton*>()) {
    // A stop may well be sent twice.
    if (Names{"hold", "cancel", "disable"}.count(button->objectName().toStdString())) continue;
    QObject::connect(button, &QAbstractButton::clicked, &receiver, [&] { ++clicks; });
  }
  Names clicked;
  for (const char* state : {"disabled", "ready", "held", "retracted", "fault"}) {
    stage.be(state, panel);
    for (const char* tab : kTabs) {
      panel.openTab(tab);
      for (auto* button : panel.widget().findChildren<QAbstractButton*>()) {
        for (const int pause : {100, 250, 400, 500}) {
          const std::string name = button->objectName().toStdString();
          const bool opens_a_dialog = Names{"choose", "setup", "choose_node", "measured"}.count(name);
          if (!button->isVisible() || !button->isEnabled() || opens_a_dialog) continue;
          SCOPED_TRACE(std::to_string(pause) + " ms on " + name);
          clicks = 0;
          panel.doubleClick(*button, pause);
          EXPECT_LE(clicks, 1);
          clicked.insert(name);
        }
      }
    }
  }
  for (const char* name :
       {"enable", "reset", "home", "resume", "retract", "jog_x_plus", "touch_off", "spindle_on", "plan"}) {
    EXPECT_TRUE(clicked.count(name)) << name;
  }
}

TEST_F(OnStage, ADoubleClickOnWhatClosesADialogPressesNothingBelow) {
  panel.plan();
  QDialog dialog(&panel.widget());
  QPushButton close("Close", &dialog);
  QObject::connect(&close, &QPushButton::clicked, &dialog, &QDialog::close);
  auto& start = panel.the<QPushButton>("start");
  const QPoint at = start.mapToGlobal(start.rect().center());
  dialog.show();
  dialog.move(at - close.rect().center());
  WAIT_FOR(close.mapToGlobal(close.rect().center()) == at);
  QTest::mouseClick(&close, Qt::LeftButton);
  WAIT_FOR(!dialog.isVisible());
  // 300 ms after the press.
  QTest::lastMouseTimestamp -= 200;
  panel.click("start");
  EXPECT_TRUE(panel.enabled("start"));
  panel.click("start");
  WAIT_FOR(goals().size() == 1);
}

void turnWheel(QWidget& over, int notches) {
  const QPointF at = over.rect().center();
  for (int i = 0; i < std::abs(notches); ++i) {
    QWheelEvent event(at, over.mapToGlobal(at.toPoint()), QPoint(), QPoint(0, notches < 0 ? -120 : 120), Qt::NoButton,
                      Qt::NoModifier, Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&over, &event);
  }
}

TEST_F(OnStage, TheMouseWheelChangesWhatHasTheFocusAloneAndNoKeyTheFeedOverride) {
  stage.be("running");
  WAIT_FOR(panel.label("override_value") == "100 %");
  panel.click("setup");
  WAIT_FOR(panel.widget().findChild<QDialog*>("setup_dialog"));
  int wheeled = 0;
  for (auto* widget : panel.widget().findChildren<QWidget*>()) {
    const bool slides = qobject_cast<QAbstractSlider*>(widget) && !qobject_cast<QScrollBar*>(widget);
    if (!slides && !qobject_cast<QAbstractSpinBox*>(widget) && !qobject_cast<QComboBox*>(widget)) continue;
    ++wheeled;
    SCOPED_TRACE(widget->objectName().toStdString());
    if (widget->hasFocus()) widget->clearFocus();
    EXPECT_FALSE(widget->focusPolicy() & Qt::WheelFocus & ~Qt::StrongFocus) << "the wheel would give it the focus";
    const double before = valueOf(*widget);
    turnWheel(*widget, -3);
    turnWheel(*widget, 2);
    EXPECT_EQ(valueOf(*widget), before);
  }
  EXPECT_GE(wheeled, 7);
  panel.click("close_setup");
  auto& slider = panel.the<QAbstractSlider>("override");
  // The dialog may still have the keys, and lose them later.
  WAIT_FOR((panel.widget().activateWindow(), slider.setFocus(), slider.hasFocus()));
  for (const Qt::Key pressed : {Qt::Key_Left, Qt::Key_Up, Qt::Key_PageUp, Qt::Key_Home, Qt::Key_End}) {
    QTest::keyClick(&slider, pressed);
    EXPECT_EQ(slider.value(), 100);
  }
  turnWheel(slider, -1);
  EXPECT_LT(slider.value(), 100);
}

class Keys : public OnStage {
 protected:
  void SetUp() override { activate(panel); }
  /// Presses a key as the keyboard does: in the active window, wherever the focus is.
  static void key(Qt::Key key) { QTest::keyClick(QApplication::focusWindow(), key); }
  /// Space holds with the focus there, or is typed there.
  void expectHold(QWidget& widget, bool holds) {
    SCOPED_TRACE(std::string(widget.metaObject()->className()) + " " + widget.objectName().toStdString());
    WAIT_FOR((widget.activateWindow(), widget.setFocus(), widget.hasFocus()));
    const std::size_t before = stops().size();
    key(Qt::Key_Space);
    // A stop that was sent after all would come before this.
    panel.click("hold");
    WAIT_FOR(stops().size() == before + (holds ? 2 : 1));
    for (const int stop : stops()) EXPECT_EQ(stop, flute_grinder::Stop::HOLD);
  }
  /// What has been asked of the grinder, other than a hold.
  std::size_t asked() {
    const std::vector<int> stops = this->stops();
    const auto holds = static_cast<std::size_t>(std::count(stops.begin(), stops.end(), flute_grinder::Stop::HOLD));
    return stage.get([&] {
      return stage.goals.size() + stage.steps.size() + stage.jogs.size() + stage.triggers.size() +
             stage.touches.size() + stage.offsets_set.size() + stage.overrides.size() +
             static_cast<std::size_t>(stage.resumes) + stage.state.spindle_commanded + stops.size() - holds;
    });
  }
};

TEST_F(Keys, PressNoButtonButHoldWhateverHasTheFocus) {
  panel.plan();
  panel.press("setup");
  WAIT_FOR(panel.widget().findChild<QDialog*>("setup_dialog"));
  ASSERT_TRUE(panel.fileDialog());
  Names pressed;
  for (const char* state : {"disabled", "ready", "held", "retracted", "fault"}) {
    stage.be(state, panel);
    for (const char* tab : kTabs) {
      panel.openTab(tab);
      for (auto* button : panel.widget().findChildren<QPushButton*>()) {
        // Qt's own, which choose a file.
        if (!button->isEnabled() || qobject_cast<QFileDialog*>(button->window())) continue;
        SCOPED_TRACE(button->objectName().toStdString());
        ASSERT_FALSE(button->objectName().isEmpty());
        int clicks = 0;
        QObject receiver;
        if (button->objectName() != "hold" && button->objectName() != "close_setup") {
          QObject::connect(button, &QPushButton::clicked, &receiver, [&] { ++clicks; });
        }
        button->setFocus();
        pressKeys(*button);
        EXPECT_EQ(clicks, 0);
        pressed.insert(button->objectName().toStdString());
      }
    }
  }
  for (const char* name : {"enable", "reset", "home", "resume", "retract", "jog_x_plus", "touch_off", "spindle_on",
                           "coolant_on", "start", "plan", "cancel", "disable"}) {
    EXPECT_TRUE(pressed.count(name)) << name;
  }
  EXPECT_EQ(asked(), 0U);
}

TEST_F(Keys, SpaceHoldsWhateverHasTheFocus) {
  stage.be("running", panel);
  int widgets = 0;
  for (const char* tab : kTabs) {
    panel.openTab(tab);
    for (auto* widget : panel.widget().findChildren<QWidget*>()) {
      if (!widget->isVisible() || !widget->isEnabled() || widget->focusPolicy() == Qt::NoFocus) continue;
      ASSERT_NO_FATAL_FAILURE(expectHold(*widget, true));
      ++widgets;
    }
  }
  EXPECT_GE(widgets, 10);
  EXPECT_EQ(asked(), 0U);
}

TEST_F(Keys, SpaceHoldsInEveryWindowButIsTypedInATextBox) {
  WAIT_FOR(panel.enabled("choose"));
  QFileDialog* dialog = panel.fileDialog();
  ASSERT_TRUE(dialog);
  stage.be("running", panel);
  dialog->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(dialog, kPatience));
  auto* name = dialog->findChild<QLineEdit*>("fileNameEdit");
  name->setText("my");
  ASSERT_NO_FATAL_FAILURE(expectHold(*name, false));
  EXPECT_EQ(name->text(), "my ");
  for (auto* button : dialog->findChildren<QPushButton*>()) ASSERT_NO_FATAL_FAILURE(expectHold(*button, true));
  ASSERT_NO_FATAL_FAILURE(expectHold(*dialog->findChild<QAbstractItemView*>("treeView"), true));
  // As there are others in rviz.
  QWidget other;
  QVBoxLayout layout(&other);
  QToolButton reset;
  QShortcut of_a_tool(Qt::Key_Space, &other);
  reset.setFocusPolicy(Qt::TabFocus);
  QDoubleSpinBox number;
  QComboBox choice, topic;
  topic.setEditable(true);
  QPlainTextEdit text;
  const std::vector<std::pair<QWidget*, bool>> widgets{
      {&reset, true}, {&number, true}, {&choice, true}, {&topic, false}, {&text, false}};
  for (const auto& [widget, holds] : widgets) layout.addWidget(widget);
  bool is_reset = false;
  QObject::connect(&reset, &QToolButton::clicked, [&] { is_reset = true; });
  QObject::connect(&of_a_tool, &QShortcut::activated, [&] { is_reset = true; });
  other.show();
  other.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&other, kPatience));
  for (const auto& [widget, holds] : widgets) ASSERT_NO_FATAL_FAILURE(expectHold(*widget, holds));
  EXPECT_FALSE(is_reset);
}

TEST_F(Keys, SpaceHeldDownHoldsOnceInEveryPanel) {
  Panel second("cell/stage");
  stage.be("running", panel);
  WAIT_FOR(second.enabled("hold"));
  QTest::keyPress(panel.widget().windowHandle(), Qt::Key_Space);
  for (int i = 0; i < 3; ++i) {
    QKeyEvent repeated(QEvent::KeyPress, Qt::Key_Space, Qt::NoModifier, " ", true);
    QApplication::sendEvent(&panel.the<QWidget>("override"), &repeated);
  }
  QTest::keyRelease(panel.widget().windowHandle(), Qt::Key_Space);
  WAIT_FOR(stops().size() == 2);
  panel.click("cancel");
  WAIT_FOR(stops().size() == 3);
  EXPECT_EQ(stops().back(), flute_grinder::Stop::CANCEL);
}

}  // namespace grinder::test_panel_input
