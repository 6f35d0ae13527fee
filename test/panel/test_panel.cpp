// The panel against a grinder of the test's own, which can be put into every state, and stay silent.

#include "german.h"
#include "stage.h"

#include <QAbstractSlider>
#include <QApplication>
#include <QDialog>
#include <QScrollBar>

#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace grinder::test_panel {

/// What the states allow, as docs/ros-interface.md draws them, without what is so already, except Hold.
struct Row {
  std::string name;
  Names allowed;
  const char* meaning;
};
const std::vector<Row> kStates{
    {"disabled", {"enable", "reset"}, "power is off"},
    {"ready", {"disable", "home", "start"}, "power is on"},
    {"homing", {"disable", "hold", "cancel"}, "homing the axes"},
    {"starting", {"disable", "hold", "resume", "cancel"}, "spindle and coolant"},
    {"running", {"disable", "hold", "cancel"}, "moves the axes"},
    {"holding", {"disable", "hold", "resume", "cancel"}, "stopping on the path"},
    {"held", {"disable", "hold", "resume", "retract", "cancel"}, "job is held, at rest"},
    {"retracting", {"disable", "hold", "cancel"}, "being lifted"},
    {"retracted", {"disable", "resume", "cancel"}, "off the work"},
    {"resuming", {"disable", "hold", "cancel"}, "returning to where"},
    {"canceling", {"disable", "hold"}, "the job ends"},
    {"fault", {"reset"}, "following error 1.2 mm"},
    {"lifting", {"disable", "hold", "cancel"}, "without a job"},
    {"jogging", {"disable", "hold", "cancel"}, "An axis is being jogged"},
    {"jogging_retracted", {"disable", "hold", "cancel"}, "the job waits"},
};

TEST_F(OnStage, ButtonsAreEnabledWhereTheStateAllowsAndCancelStandsApart) {
  WAIT_FOR(panel.state() == "Ready" && panel.enabled("plan"));
  const auto place = [&](const std::string& name) { return panel.the<QPushButton>(name.c_str()).geometry(); };
  for (const std::string& name : kRequests) {
    const int apart = name == "resume" || name == "retract" ? 40 : 12;
    EXPECT_EQ(place("cancel").adjusted(-apart, 0, apart, 0).intersects(place(name)), name == "cancel") << name;
  }
  EXPECT_FALSE(panel.enabled("start")) << "nothing is planned";
  panel.plan();
  stage.change([&] {
    stage.progress.stroke_fraction = 0.43, stage.progress.job_fraction = 0.12, stage.progress.feed = 0.6 / 60;
    stage.progress.remaining_time = 3723, stage.progress.tooth = 3, stage.progress.pass = 19;
  });
  std::optional<QPoint> place_of_hold;
  for (const Row& row : kStates) {
    SCOPED_TRACE(row.name);
    stage.change([&] {
      stage.state.fault = row.name == "fault" ? "axis X following error 1.2 mm is beyond its limit 1 mm" : "";
    });
    stage.be(row.name, panel);
    EXPECT_EQ(panel.enabledRequests(), row.allowed);
    EXPECT_EQ(panel.label("grinder"), "/cell/stage");
    EXPECT_TRUE(panel.shows("meaning", row.meaning));
    const bool in_job = Names{"disabled", "ready", "homing", "fault", "lifting", "jogging"}.count(row.name) == 0;
    for (const char* of_a_new_job : {"choose", "plan"}) EXPECT_NE(panel.enabled(of_a_new_job), in_job);
    EXPECT_EQ(panel.enabled("stroke"), in_job);
    EXPECT_EQ(panel.label("place"), in_job ? "Tooth 4, pass 20" : "No job runs");
    EXPECT_EQ(panel.label("feed"), in_job ? "600 mm/min" : "");
    EXPECT_EQ(panel.the<QProgressBar>("stroke").text(), "Stroke 43 %");
    EXPECT_EQ(panel.the<QProgressBar>("job").text(), in_job ? "Job 12 %, 1:02:03 h left" : "Job 12 %");
    panel.picture(row.name);
    const QPoint hold = panel.the<QPushButton>("hold").pos();
    EXPECT_EQ(hold, place_of_hold.value_or(hold)) << "it moves away under the mouse";
    place_of_hold = hold;
  }
  stage.be(99, "melting");
  WAIT_FOR(panel.state() == "Melting");
  EXPECT_EQ(panel.enabledRequests(), Names());
}

TEST_F(Staged, SilenceDisablesEveryButtonButTheStopsAndEndsAllProgress) {
  stage.change([&] { stage.silent = true; });
  Panel panel("cell/stage", kPaper);
  const auto progress = [&] { return panel.label("stroke_text") + ", " + panel.label("job_text"); };
  WAIT_FOR(panel.state() == "No answer");
  panel.picture("no_answer_yet");
  stage.change([&] { stage.progress.stroke_fraction = 0.43, stage.progress.job_fraction = 0.12; });
  stage.change([&] { stage.silent = false; });
  stage.be("running");
  WAIT_FOR(progress().find("Stroke 43 %, Job 12 %") == 0);
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(panel.state() == "No answer");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "cancel"}));
  for (const char* name : {"choose", "plan", "override"}) EXPECT_FALSE(panel.enabled(name)) << name;
  EXPECT_EQ(panel.label("meaning"), "No grinder answers as /cell/stage. Does its node run?");
  for (const char* unknown : {"place", "feed", "override_value"}) EXPECT_EQ(panel.label(unknown), "") << unknown;
  EXPECT_EQ(progress(), "Stroke 0 %, Job 0 %");
  panel.picture("no_answer");
  panel.click("hold");
  WAIT_FOR(stops() == std::vector<int>{flute_grinder::Stop::HOLD});
  stage.change([&] { stage.silent = false, stage.without_feedback = true; });
  WAIT_FOR(panel.state() == "Running");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "cancel"}));
  EXPECT_EQ(progress(), "Stroke 0 %, Job 0 %");
}

TEST_F(OnStage, AGrinderAnswersOnceAResultWouldBeHeard) {
  WAIT_FOR(panel.state() == "Ready");
  stage.shutResults();
  WAIT_FOR(panel.state() == "No answer");
  stage.openResults();
  WAIT_FOR(panel.state() == "Ready");
}

TEST_F(OnStage, TheWindowIsNamedAfterTheGrinder) {
  const auto title = [&] { return panel.widget().windowTitle().toStdString(); };
  WAIT_FOR(title() == "/cell/stage");
  // As rviz writes it when it has read a file.
  panel.widget().setWindowTitle("my.rviz[*] - RViz");
  WAIT_FOR(title() == "/cell/stage - my.rviz[*] - RViz");
  panel.enterNode("other");
  WAIT_FOR(title() == "/other - my.rviz[*] - RViz");
}

flute_grinder::Legend legendOf(const QString& job) {
  flute_grinder::Legend legend;
  legend.cutter = goalFromFile(job.toStdString()).cutter;
  legend.shown = "Planned: paper.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth)";
  legend.tolerance = 0.5e-6;
  legend.max_error = 0.0698e-6;
  legend.arrow_scale = 2e5;
  return legend;
}

TEST_F(OnStage, WhatTheColoursMeanIsReported) {
  panel.openTab("View");
  stage.be("ready", panel);
  const auto shown = [&] { return panel.label("shown_cutter"); };
  const auto meaning = [&](const std::string& of) {
    return panel.label(of.c_str()) + ", " + panel.label((of + "_end").c_str());
  };
  EXPECT_EQ(shown(), "No job is shown.");
  EXPECT_EQ(panel.label("max_error"), "");
  flute_grinder::Legend legend = legendOf(kPaper);
  stage.publishLegend(legend);
  WAIT_FOR(shown() == legend.shown);
  EXPECT_EQ(meaning("flutes"), "Measured error, 0.5 um");
  EXPECT_EQ(meaning("rake_faces"), "Rake error, off 8 deg, 0.5 deg");
  EXPECT_EQ(meaning("reliefs"), "Clearance error, -");
  EXPECT_EQ(meaning("arrows"), "Path error x 2e5, 0.5 um");
  EXPECT_EQ(panel.label("max_error"), "Maximum error measured: 0.0698 um");
  panel.picture("view");
  legend.arrow_scale = 0;
  legend.cutter.clearance = 10 * M_PI / 180, legend.cutter.clearance_tolerance = 0.25 * M_PI / 180;
  stage.publishLegend(legend);
  WAIT_FOR(meaning("reliefs") == "Clearance error, off 10 deg, 0.25 deg");
  EXPECT_EQ(panel.label("arrows"), "Path error");
  panel.picture("view_of_a_relief");
  // A process that has just begun shows nothing.
  stage.publishLegend(flute_grinder::Legend());
  WAIT_FOR(shown() == "No job is shown.");
  stage.publishLegend(legend);
  WAIT_FOR(shown() == legend.shown);
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(shown() == "No job is shown.");
}

TEST_F(OnStage, TheReadoutIsAsFineAsTheJob) {
  stage.standAt({-0.1000004, 0.0123456, 0, -21 * M_PI});
  WAIT_FOR(panel.label("position_x") == "X  -100.000 mm");
  flute_grinder::Legend legend = legendOf(kPaper);
  for (const auto& [tolerance, x] :
       {std::pair{0.5e-6, "X  -100.0004 mm"}, {1e-6, "X  -100.000 mm"}, {1e-9, "X  -100.0004 mm"}}) {
    legend.tolerance = tolerance;
    stage.publishLegend(legend);
    WAIT_FOR(panel.label("position_x") == x);
  }
  EXPECT_EQ(panel.label("position_a"), "A -3780.0000 deg");
  panel.picture("fine_readout");
  stage.change([&] { stage.progress.feed = 0.6e-3 / 60; });
  stage.be("running");
  WAIT_FOR(panel.label("feed") == "0.60 mm/min");
  stage.change([&] { stage.progress.feed = 0; });
  WAIT_FOR(panel.label("feed") == "0 mm/min");
}

TEST_F(OnStage, ARequestThatHangsBlocksNothingNorAPanelsEndAndIsReported) {
  stage.change([&] { stage.resume_hangs = true; });
  stage.be("held");
  panel.press("resume");
  WAIT_FOR(stage.get(&Stage::resumes) == 1);
  stage.be("resuming", panel);
  panel.click("hold");
  panel.click("cancel");
  WAIT_FOR(stops().size() == 2);
  EXPECT_TRUE(panel.says("messages", "Cancel was sent"));
  stage.be("held");
  {
    Panel closed("cell/stage");
    closed.press("resume");
    WAIT_FOR(stage.get(&Stage::resumes) == 2);
  }
  EXPECT_FALSE(panel.says("messages", "Resume")) << "its end did not wait for the answer";
  WAIT_FOR(panel.says("messages", "Resume: no answer from the grinder /cell/stage"));
}

/// What a reply says behind its time.
std::string said(Panel& panel) {
  const std::string text = panel.text("messages");
  return text.size() > 9 ? text.substr(9) : "";
}

TEST_F(OnStage, ARequestThatIsDoneOrRefusedSaysSoInPlaceOfTheReplyBefore) {
  struct Request {
    const char *state, *button, *done;
  };
  for (const Request& r : {Request{"disabled", "enable", "Enable: the power is on"},
                           Request{"ready", "home", "Home: the drive is homing the axes"},
                           Request{"fault", "reset", "Reset: the fault is cleared; the power is commanded off"},
                           Request{"held", "retract", "Retract: the wheel is being lifted"}}) {
    stage.be(r.state);
    panel.press(r.button);
    WAIT_FOR(said(panel) == r.done);
  }
  stage.be("disabled");
  stage.change([&] { stage.trigger_refusal = "enable refused: one\ntwo\nthree\nfour\nfive\nsix\nseven"; });
  panel.press("enable");
  WAIT_FOR(said(panel).find("Enable refused: one\ntwo") == 0);
  EXPECT_EQ(panel.the<QPlainTextEdit>("messages").verticalScrollBar()->value(), 0) << "the first line is not seen";
  panel.picture("refused");
}

TEST_F(OnStage, AReplyGoesWithTheStateThatItIsAbout) {
  const auto lift = [&] {
    stage.change([&] { stage.state.wheel_in_work = 1; });
    stage.be("ready");
    panel.press("lift");
    WAIT_FOR(said(panel) == "Lift: the wheel is being lifted");
    stage.be("lifting", panel);
    EXPECT_EQ(said(panel), "Lift: the wheel is being lifted");
  };
  ASSERT_NO_FATAL_FAILURE(lift());
  stage.be("ready", panel);
  EXPECT_EQ(panel.text("messages"), "");
  // Not what was said since then.
  ASSERT_NO_FATAL_FAILURE(lift());
  panel.click("hold");
  WAIT_FOR(said(panel) == "Hold was sent");
  stage.be("ready", panel);
  EXPECT_EQ(said(panel), "Hold was sent");
}

TEST_F(OnStage, TheRunningJobIsNamedWhoeverStartedIt) {
  panel.plan();
  flute_grinder::GrindGoal other =
      goalFromFile((kPackage + "/jobs/taper_reamer_d6_t6.yaml").toStdString(), "secondary");
  other.job_name = "six_teeth_of_the_night_shift.yaml";
  stage.publishJob(other);
  stage.change([&] { stage.progress.tooth = 3, stage.progress.pass = 19, stage.progress.feed = 0.01; });
  stage.be("running");
  WAIT_FOR(panel.isVisible("other_job"));
  EXPECT_EQ(panel.text("other_job"),
            "Running: six_teeth_of_the_night_shift.yaml, secondary relief (D 6 mm, cone 2 deg, spiral 12 deg, rake 6 "
            "deg, 6 teeth). It was not started in this panel.");
  EXPECT_FALSE(panel.isVisible("plan_report")) << "the time is another job's";
  EXPECT_TRUE(panel.shows("place", ", secondary, tooth 4, pass 20"));
  EXPECT_EQ(panel.the<QLabel>("place").toolTip(), "six_teeth_of_the_night_shift.yaml, 3 secondary relief");
  panel.picture("job_of_somebody_else");
  stage.be("ready");
  WAIT_FOR(panel.isVisible("plan_report"));
  EXPECT_EQ(panel.label("place"), "No job runs");
}

TEST_F(OnStage, NothingMovesAtAStart) {
  panel.widget().resize(1, panel.widget().height());
  stage.standAt({0, 0, 0, 0});
  WAIT_FOR(panel.state() == "Ready" && panel.label("position_x") == "X     0.000 mm");
  const auto lay_out = [] {  // level by level
    for (int level = 0; level < 10; ++level) QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
  };
  lay_out();
  std::map<QWidget*, QRect> before;
  for (const std::string& name : kRequests) {
    auto& button = panel.the<QPushButton>(name.c_str());
    before[&button] = button.geometry();
  }
  const int width = panel.widget().minimumSizeHint().width();
  flute_grinder::GrindGoal job = goalFromFile(kPaper.toStdString());
  job.job_name = "four_teeth_of_the_night_shift_with_a_long_name.yaml";
  stage.publishJob(job);
  flute_grinder::Legend legend = legendOf(kPaper);
  legend.tolerance = 0.1e-6;
  stage.publishLegend(legend);
  stage.change([&] {
    stage.joints.position = {-0.1234567, -0.1234567, -0.1234567, -21 * M_PI};
    stage.state.distance_to_go = {-0.1234567, -0.1234567, -0.1234567, -21 * M_PI};
    stage.state.override = 0.36;
    stage.progress.stroke_fraction = stage.progress.job_fraction = 1;
    stage.progress.remaining_time = 360000, stage.progress.tooth = 63, stage.progress.pass = 9999;
    stage.progress.feed = 10.0 / 60;
  });
  stage.be("running");
  WAIT_FOR(panel.label("feed") == "10000 mm/min" && panel.label("position_a") == "A -3780.0000 deg");
  WAIT_FOR(panel.label("to_go") == "To go" && panel.label("override_value") == "36 %");
  lay_out();
  EXPECT_EQ(panel.widget().minimumSizeHint().width(), width);
  for (const auto& [button, place] : before) EXPECT_EQ(button->geometry(), place) << button->objectName().toStdString();
  auto& place = panel.the<QLabel>("place");
  WAIT_FOR(panel.shows("place", ", tooth 64, pass 10000"));
  WAIT_FOR(place.fontMetrics().horizontalAdvance(place.text()) <= place.width());
}

TEST_F(Staged, ALongNameIsShortenedToItsRoomButNoShippedOne) {
  for (const char* shipped : {"roughing_d10_t4", "end_mill_d10_t4", "unequal_d12_t4"}) {
    Panel panel("cell/stage", kPackage + "/jobs/" + shipped + ".yaml");
    WAIT_FOR(panel.label("job_file").find(shipped) == 0);
  }
  const QTemporaryDir folder;
  const QString path = changedJob(kPaper, folder.filePath("four_teeth_of_the_night_shift_with_a_long_name.yaml"), {});
  Panel panel("cell/stage", path);
  auto& name = panel.the<QLabel>("job_file");
  WAIT_FOR(name.text().startsWith("fo") && name.text().endsWith("me") &&
           name.fontMetrics().horizontalAdvance(name.text()) <= name.width());
  EXPECT_EQ(name.toolTip(), path);
}

TEST_F(OnStage, AStopThatNobodyHearsIsReported) {
  stage.stopListening();
  stage.be("running", panel);
  panel.click("hold");
  WAIT_FOR(panel.says("messages", "Hold was not sent: the grinder /cell/stage is not connected"));
}

TEST_F(OnStage, AWheelInTheWorkIsLiftedBeforeAnythingElse) {
  panel.plan();
  EXPECT_FALSE(panel.enabled("lift"));
  stage.change([&] { stage.state.wheel_in_work = 1; });
  WAIT_FOR(panel.enabled("lift"));
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "lift"}));
  EXPECT_EQ(panel.label("meaning"), "The wheel is in the work: lift it.");
  panel.picture("wheel_in_work");
  panel.click("lift");
  WAIT_FOR(stage.get(&Stage::triggers) == Names{"lift"});
  struct Meaning {
    const char *state, *fault, *meaning;
  };
  for (const Meaning& row :
       {Meaning{"fault", "emergency stop",
                "Fault: emergency stop. The wheel is in the work: reset, enable, then lift it."},
        {"disabled", "", "The wheel is in the work: enable, then lift it."},
        {"held", "", "The job is held with the wheel in the work. Resume continues; Retract lifts it."},
        {"lifting", "", "The wheel is in the work: it is being lifted; no job runs."},
        {"jogging", "", "The wheel is in the work: it is being jogged off, along Y."},
        {"running", "", "The job moves the axes."}}) {
    stage.change([&] { stage.state.fault = row.fault; });
    stage.be(row.state);
    WAIT_FOR(panel.label("meaning") == row.meaning);
  }
  stage.be("retracted");
  WAIT_FOR(panel.enabled("resume"));
  stage.change([&] { stage.state.homed = 0; });
  WAIT_FOR(panel.label("meaning") == "The reference is lost, so the job cannot be resumed: cancel it, then home.");
  EXPECT_FALSE(panel.enabled("resume"));
  stage.change([&] {
    stage.state.homed = 1;
    stage.state.progress = flute_grinder::JobProgress();
    stage.state.journal_error = "journal /j: its checksum is wrong";
  });
  stage.be("disabled");
  WAIT_FOR(panel.label("meaning") == "It is not known whether the wheel is in the work: enable, then lift it.");
  stage.change([&] { stage.state.power_stays_on = 1; });
  WAIT_FOR(panel.label("meaning") ==
           "The drive still reports power, though it was switched off: press the emergency stop.");
}

TEST_F(OnStage, AGoalThatIsPlannedIsShownAndCanBeCanceled) {
  WAIT_FOR(panel.enabled("plan"));
  EXPECT_FALSE(panel.enabled("cancel"));
  stage.change([&] {
    stage.goal_id = "somebody's";
    stage.progress.state = "planning";
    stage.progress.planned = 0.43;
  });
  WAIT_FOR(panel.the<QProgressBar>("job").text() == "Planning 43 %");
  EXPECT_TRUE(panel.enabled("job"));
  EXPECT_TRUE(panel.enabled("cancel"));
  EXPECT_TRUE(panel.enabled("hold")) << "it would begin held";
  EXPECT_FALSE(panel.enabled("plan")) << "the grinder would be busy";
  panel.picture("planning");
  panel.click("cancel");
  WAIT_FOR(stops() == std::vector<int>{flute_grinder::Stop::CANCEL});
  stage.change([&] { stage.progress.state = "ready"; });
  WAIT_FOR(!panel.enabled("cancel"));
  EXPECT_EQ(panel.label("place"), "No job runs");
}

TEST_F(OnStage, WhatAPlanSaysIsShown) {
  const auto report = [&] { return panel.text("plan_report"); };
  const std::string shank = "\nThe first pass cuts 0.375 mm more than its infeed out of the shank.";
  flute_grinder::FeedLimit limit;
  limit.cause = "axis A velocity";
  limit.from_x = 0.003;
  limit.to_x = 0.0052;
  stage.change([&] {
    stage.planned.plan.statistics.duration = 725;
    stage.planned.plan.statistics.min_feed = 0.4 / 60;
    stage.planned.plan.statistics.max_feed = 0.6 / 60;
    stage.planned.plan.statistics.feed_limits = {limit};
    stage.planned.plan.shank_cut = 0.375e-3;
  });
  panel.plan();
  EXPECT_EQ(report(),
            "Takes 12:05 min.\nFeed 400.0 to 600.0 mm/min, limited by\naxis A velocity, X 3.000 to 5.200 mm" + shank);
  stage.change([&] {
    stage.planned = {};
    stage.planned.plan.valid = 1;
    stage.planned.plan.statistics.duration = 7.03;
    stage.planned.plan.closest_bodies = {"wheel", "collet"};
    stage.planned.plan.closest_distance = 1.4214e-3;
    stage.planned.plan.closest_x = 0.037;
    stage.planned.plan.needs = toMessage({kNoZeros});
    stage.planned.plan.shank_cut = 0.375e-3;
    stage.planned.plan.passes.resize(2);
    for (auto& pass : stage.planned.plan.passes) pass.depth = 1.2e-3;
    stage.planned.plan.passes[0].area = 0.5e-6;
    stage.planned.plan.passes[0].rate = 3e-9;
  });
  panel.press("plan");
  const std::string good =
      "Takes 7.0 s.\nClosest: wheel and collet, 1.421 mm at X 37.000 mm.\n"
      "To start it: X was never set.\nThe feed is never reached." +
      shank + "\nPasses: depth, area of a section, rate\n1: 1.2000 mm, 0.5 mm^2, 3 mm^3/s\n2: 1.2000 mm, spark-out";
  WAIT_FOR(report() == good);
  panel.picture("planned_with_passes");
  const std::vector<std::string> reasons{
      "axis X machine position 301 mm is 1 mm beyond its limit 300 mm (stroke, tooth 1, pass 2, X = 301 mm)",
      "process.feed_mm_min = 60000 mm/min; allowed: 0.1 to 10000 mm/min"};
  stage.change([&] {
    stage.planned.plan.valid = 0;
    for (const std::string& reason : reasons) stage.planned.reasons.emplace_back().text = reason;
  });
  panel.press("plan");
  WAIT_FOR(report() == "Cannot be ground:\n" + reasons[0] + '\n' + reasons[1]);
  WAIT_FOR(panel.enabledRequests() == (Names{"disable", "home"}));
  panel.picture("cannot_be_ground");
}

TEST_F(OnStage, APlanIsVoidOnceAZeroPointOrTheWheelIsAnother) {
  flute_grinder::WorkOffsets offsets;
  offsets.header.stamp = ros::Time(10);
  const auto newer = [&] {
    offsets.header.stamp += ros::Duration(1);
    stage.publishOffsets(offsets);
  };
  const std::string zero = "A zero point or the wheel has changed since it was planned. Plan it again.";
  for (const bool wheel : {false, true}) {
    stage.change([&] { stage.planned.plan.offsets = offsets; });
    panel.plan();
    newer();
    stage.be("lifting", panel);
    stage.be("ready", panel);
    EXPECT_TRUE(panel.enabled("start")) << "nothing of it has changed";
    wheel ? ++offsets.wheel.mounting : offsets.values[kY] += 1e-6;
    newer();
    WAIT_FOR(panel.text("plan_report") == zero && !panel.enabled("start"));
  }
}

TEST_F(OnStage, APlanCanBeCanceledUntilItEndsAndSaysWhyItIsRefused) {
  stage.change([&] { stage.plan_hangs = true; });
  panel.press("plan");
  WAIT_FOR(stage.get(&Stage::plans).size() == 1);
  EXPECT_EQ(panel.text("plan_report"), "Planning ...");
  const flute_grinder::GrindActionGoal goal = stage.get(&Stage::plans).at(0);
  EXPECT_EQ(goal.goal.job_name, "paper.yaml");
  WAIT_FOR(panel.enabled("cancel"));
  flute_grinder::GrindResult refused;
  refused.error_code = flute_grinder::GrindResult::BUSY;
  refused.error_string = "a goal is running";
  stage.end(goal.goal_id.id, refused);
  WAIT_FOR(panel.text("plan_report") == "Cannot be ground:\n" + refused.error_string);
  EXPECT_FALSE(panel.enabled("start"));
  WAIT_FOR(!panel.enabled("cancel"));
}

TEST_F(OnStage, WhereTheSwivelStandsIsAlwaysSeen) {
  const auto set = [&](double angle, bool measured) {
    publish([&] { stage.state.swivel = angle, stage.state.swivel_measured = static_cast<std::uint8_t>(measured); });
    return panel.label("swivel");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), angle = 43.32 * M_PI / 180;
  EXPECT_EQ(set(nan, false), "Swivel not confirmed");
  EXPECT_EQ(set(angle, false), "Swivel set to 43.32 deg");
  for (const char* tab : {"Job", "Section", "Jog", "Zero", "View"}) {
    panel.openTab(tab);
    EXPECT_TRUE(panel.isVisible("swivel"));
  }
  EXPECT_EQ(set(angle, true), "Swivel at 43.32 deg");
  EXPECT_EQ(set(nan, true), "Swivel not known");
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(panel.label("swivel").empty());
}

TEST_F(OnStage, AnotherJobThanTheOneThatWasLeftIsStartedOnlyWhereThatIsDiscarded) {
  publish([&] { stage.state.journal_error = "journal /j: its checksum is wrong", stage.state.journal_damaged = 1; });
  EXPECT_EQ(panel.text("plan_report"),
            "Not planned yet.\nD 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth.\nThere is no journal: journal "
            "/j: its checksum is wrong.");
  const QTemporaryDir folder;
  stage.leave(changedJob(kPaper, folder.filePath("published.yaml"), {{"spark_out: 0", "spark_out: 1"}}));
  publish([&] { stage.state.journal_error = "", stage.state.journal_damaged = 0; });
  EXPECT_TRUE(panel.says("plan_report", "It ended: in the middle, with the grinder's program."));
  EXPECT_FALSE(panel.enabled("continue")) << "its file is not known";
  need({kUnfinished});
  startAndBeAsked("discard");
  EXPECT_EQ(panel.text("job_question"),
            "paper.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth), wheel straight, 3 mm wide, D 100 "
            "mm\nthe journal keeps another job\nThat job cannot be continued once this one starts.");
  panel.picture("discard_question");
  EXPECT_EQ(goals().size(), 0U);
}

TEST_F(OnStage, AJobThatWasLeftIsNamedItsFileTakenByAClickAndContinuedWhereItWasLeft) {
  stage.leave(kPackage + "/jobs/paper.yaml");  // the panel looks among the jobs of the package
  stage.change([&] { stage.state.progress.end = "the drive reports a fault"; });
  Panel panel("cell/stage");  // without a job
  auto& go_on = panel.the<QCheckBox>("continue");
  WAIT_FOR(go_on.isEnabled());
  EXPECT_EQ(go_on.text().toStdString(), "Continue paper.yaml at tooth 2, pass 3");
  EXPECT_EQ(
      panel.text("plan_report"),
      "Open a job file first.\nNot finished: paper.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth), "
      "at tooth 2, pass 3. It ended: the drive reports a fault.");
  panel.picture("unfinished");
  panel.tick("continue");
  EXPECT_EQ(panel.label("job_file"), "paper.yaml");
  WAIT_FOR(go_on.text() == "Continue at tooth 2, pass 3");
  EXPECT_TRUE(go_on.isChecked());
  EXPECT_EQ(
      panel.text("plan_report")
          .find("Not planned yet.\nD 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth.\nNot finished: paper.yaml"),
      0U);
  panel.plan();
  panel.click("start");
  WAIT_FOR(goals().size() == 1);
  const flute_grinder::GrindGoal goal = goals().at(0).goal;
  EXPECT_TRUE(goal.answers.empty());
  EXPECT_EQ(goal.first_tooth, 1);
  EXPECT_EQ(goal.first_pass, 2);
}

TEST_F(OnStage, OverrideIsSentWhenTheSliderIsLetGoOf) {
  stage.be("running");
  stage.change([&] { stage.state.override = 0.8; });
  WAIT_FOR(panel.label("override_value") == "80 %");
  auto& slider = panel.the<QAbstractSlider>("override");
  EXPECT_EQ(slider.value(), 80);
  EXPECT_EQ(slider.minimum(), 0);
  EXPECT_EQ(slider.maximum(), 120);
  slider.setSliderDown(true);
  for (int percent = 80; percent >= 35; --percent) {
    slider.setSliderPosition(percent);
    slider.setValue(percent);
    QTest::qWait(5);
  }
  QTest::qWait(600);  // it rests, but is not let go of
  EXPECT_EQ(stage.get(&Stage::overrides).size(), 0U);
  EXPECT_EQ(panel.label("override_value"), "35 %");
  slider.setSliderDown(false);
  WAIT_FOR(stage.get(&Stage::overrides).size() == 1);
  EXPECT_DOUBLE_EQ(stage.get(&Stage::overrides).at(0), 0.35);
  // The grinder's own value again, and another one that it gets from elsewhere.
  WAIT_FOR(panel.the<QProgressBar>("job").text().endsWith("left at 100 %"));
  stage.change([&] { stage.state.override = 1.2; });
  WAIT_FOR(panel.label("override_value") == "120 %");
  // Without the mouse on it: sent when it rests.
  slider.setValue(0);
  WAIT_FOR(stage.get(&Stage::overrides).size() == 2);
  EXPECT_EQ(stage.get(&Stage::overrides).at(1), 0);
  WAIT_FOR(panel.shows("meaning", "override is 0 %"));
}

TEST_F(Staged, AJobFileThatChangedSinceThePlanIsNotStarted) {
  const QTemporaryDir folder;
  const QString path = changedJob(kPaper, folder.filePath("job.yaml"), {});
  Panel panel("cell/stage", path);
  stage.change([&] { stage.planned.plan.valid = 1; });
  stage.be("ready");
  panel.plan();
  changedJob(path, path, {{"depth_mm: 1.6", "depth_mm: 1.5"}});
  WAIT_FOR(panel.says("plan_report", "Plan it again") && !panel.enabled("start"));
  // A goal that was sent after all would have come before this.
  panel.click("plan");
  WAIT_FOR(stage.get(&Stage::plans).size() == 2);
  EXPECT_TRUE(goals().empty());
  EXPECT_DOUBLE_EQ(processOf(stage.get(&Stage::plans).at(1).goal).depth, 1.5e-3);
}

TEST_F(Staged, TheNodeCanBeChosenAndIsSaved) {
  Panel panel("nobody", kPaper);
  EXPECT_EQ(panel.label("job_file"), "paper.yaml");
  stage.be("disabled");
  WAIT_FOR(panel.state() == "No answer");
  EXPECT_TRUE(panel.shows("meaning", "/nobody"));
  EXPECT_EQ(panel.enabledRequests(), Names());
  for (const char* wrong : {"no name", ""}) {
    panel.enterNode(wrong);
    EXPECT_TRUE(panel.says("messages", "Grinder's node: ")) << wrong;
    EXPECT_EQ(panel.enabledRequests(), Names());
    panel.the<QPlainTextEdit>("messages").clear();
  }
  panel.enterNode("cell/stage");
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_EQ(panel.enabledRequests(), (Names{"enable", "reset"}));
  rviz::Config config;
  panel.widget().save(config);
  QString node, job;
  EXPECT_TRUE(config.mapGetString("Node", &node) && config.mapGetString("Job", &job));
  EXPECT_EQ(node, "cell/stage");
  EXPECT_EQ(job, kPaper);
}

TEST_F(OnStage, TheNodeCanBeChosenOnlyWhileNothingMoves) {
  panel.openTab("View");
  const auto may_choose = [&] { return panel.enabled("choose_node"); };
  WAIT_FOR(may_choose());
  panel.click("choose_node");
  EXPECT_TRUE(panel.isVisible("node_dialog"));
  EXPECT_FALSE(panel.the<QDialog>("node_dialog").isModal());
  EXPECT_EQ(panel.the<QLineEdit>("node").text(), "cell/stage");
  for (const StateRow& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    stage.be(row.name, panel);
    EXPECT_EQ(may_choose(), !row.moves && !isInJob(row.value));
  }
  EXPECT_FALSE(panel.isVisible("node_dialog")) << "it was open when the job began";
  stage.be("ready", panel);
  stage.change([&] { stage.state.spindle_commanded = 1; });
  WAIT_FOR(!may_choose());
  stage.change([&] { stage.state.spindle_commanded = 0; });
  WAIT_FOR(may_choose());
  // One that is not heard may go on.
  stage.be("running", panel);
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(panel.state() == "No answer");
  EXPECT_FALSE(may_choose());
  stage.stopListening();
  WAIT_FOR(may_choose());
}

TEST_F(OnStage, WhatHeldTheJobAndWhatIsNotHomedIsReported) {
  stage.change([&] { stage.state.hold_reason = "the spindle is not at speed"; });
  stage.be("retracted");
  WAIT_FOR(panel.label("meaning").find("Held because the spindle is not at speed") == 0);
  panel.picture("held_by_itself");
  stage.change([&] { stage.state.homed = 0, stage.state.emergency_stop = 1; });
  stage.be("ready");
  WAIT_FOR(panel.shows("meaning", "The emergency stop is pressed. The axes are not homed."));
}

TEST_F(OnStage, PositionsAreThoseOfTheWorkWhateverTheOrderOfTheJoints) {
  const auto positions = [&] {
    std::vector<std::string> shown;
    for (const char* name : {"position_x", "position_y", "position_z", "position_a"})
      shown.push_back(panel.label(name));
    return shown;
  };
  stage.change([&] {
    stage.joints.name = {"door", "axis_a", "axis_z", "axis_y", "axis_x"};
    stage.joints.position = {1, -21 * M_PI, 0.0000004, 0.0123456, -0.1};
  });
  WAIT_FOR(positions() ==
           (std::vector<std::string>{"X  -100.000 mm", "Y    12.346 mm", "Z     0.000 mm", "A -3780.000 deg"}));
  stage.change([&] { stage.joints.name.pop_back(); });
  WAIT_FOR(panel.label("position_x") == "X         - mm");
  stage.standAt({-0.1, 0.05, 0.02, M_PI});
  stage.change([&] {
    stage.state.position = {-0.1, 0.05, 0.02, M_PI};
    stage.state.work_position = {-0.112, 0.0125, std::nan(""), M_PI / 2};
  });
  WAIT_FOR(positions() ==
           (std::vector<std::string>{"X  -112.000 mm", "Y    12.500 mm", "Z         - mm", "A    90.000 deg"}));
  const auto tip = [&](const char* name) { return panel.the<QLabel>(name).toolTip().toStdString(); };
  EXPECT_EQ(tip("position_y"), "Position in work coordinates.\nMachine: 50.000 mm\nWork offset: 37.500 mm");
  EXPECT_EQ(tip("position_z"), "Position in work coordinates.\nMachine: 20.000 mm\nWork offset: - mm");
  EXPECT_EQ(panel.label("to_go_x"), "") << "nothing moves";
  stage.change([&] { stage.state.distance_to_go = {-0.0125, 0, 0, M_PI}; });
  WAIT_FOR(panel.label("to_go_x") == "X -12.500");
  EXPECT_EQ(panel.label("to_go_y"), "Y 0.000");
  EXPECT_EQ(panel.label("to_go_a"), "A 180.0");
  panel.picture("to_go");
}

}  // namespace grinder::test_panel

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_panel");
  grinder::test_support::setGermanEnvironment();
  const QApplication application(argc, argv);
  const ros::NodeHandle keeps_ros_up;
  return RUN_ALL_TESTS();
}
