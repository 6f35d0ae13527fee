// The panel against a grinder of the test's own, which can be put into every state, and stay silent.

#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/SetFeedOverride.h"
#include "panel_fixture.h"

#include <actionlib_msgs/GoalID.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>
#include <QAbstractSlider>
#include <QApplication>
#include <QFile>
#include <QLineEdit>
#include <QProgressBar>
#include <QTemporaryDir>

#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

namespace flute_grinder {
namespace {

const QString kPaper = QString::fromStdString(ros::package::getPath("flute_grinder")) + "/jobs/paper.yaml";

/// A grinder that is and does what a test wants.
class Stage {
 public:
  Stage() : nh_("cell/stage") {
    state_topic_ = nh_.advertise<GrinderState>("state", 10, true);
    feedback_ = nh_.advertise<GrindActionFeedback>("grind/feedback", 10);
    joint_states_ = ros::NodeHandle("cell").advertise<sensor_msgs::JointState>("joint_states", 10);
    services_.push_back(nh_.advertiseService("plan", &Stage::onPlan, this));
    services_.push_back(nh_.advertiseService("hold", &Stage::onHold, this));
    services_.push_back(nh_.advertiseService("set_feed_override", &Stage::onOverride, this));
    goals_ = nh_.subscribe("grind/goal", 10, &Stage::onGoal, this);
    cancels_ = nh_.subscribe("grind/cancel", 10, &Stage::onCancel, this);
    state.homed = 1;
    state.override = 1;
    timer_ = nh_.createSteadyTimer(ros::WallDuration(0.05), [this](const ros::SteadyTimerEvent&) { tell(); });
  }
  ~Stage() { release(); }

  void be(std::uint8_t number, const std::string& name) {
    change([&] { state.state = number, state.state_name = name; });
  }
  /// Changes what is public below, while it is not read.
  template <typename Change>
  void change(Change how) {
    const std::lock_guard<std::mutex> lock(mutex_);
    how();
  }
  template <typename Get>
  auto get(Get what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return what();
  }
  /// Lets a hold that hangs come to its end.
  void release() {
    change([&] { hold_hangs = false; });
  }

  GrinderState state;
  GrindFeedback progress;
  sensor_msgs::JointState joints;
  bool silent = false;
  bool hold_hangs = false;
  int holds = 0;
  std::vector<double> overrides;
  std::vector<GrindActionGoal> goals;
  std::vector<actionlib_msgs::GoalID> cancels;
  Plan::Response plan;

 private:
  void tell() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (silent) return;
    state_topic_.publish(state);
    GrindActionFeedback feedback;
    feedback.feedback = progress;
    feedback_.publish(feedback);
    joint_states_.publish(joints);
  }
  bool onPlan(Plan::Request&, Plan::Response& response) {
    change([&] { response = plan; });
    return true;
  }
  bool onHold(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&) {
    change([&] { ++holds; });
    while (get([&] { return hold_hangs; }) && ros::ok()) ros::WallDuration(0.01).sleep();
    return true;
  }
  bool onOverride(SetFeedOverride::Request& request, SetFeedOverride::Response& response) {
    change([&] { overrides.push_back(request.fraction), state.override = request.fraction; });
    response.success = 1;
    return true;
  }
  void onGoal(const GrindActionGoal::ConstPtr& goal) {
    change([&] { goals.push_back(*goal); });
  }
  void onCancel(const actionlib_msgs::GoalID::ConstPtr& id) {
    change([&] { cancels.push_back(*id); });
  }

  std::mutex mutex_;
  ros::NodeHandle nh_;
  ros::Publisher state_topic_, feedback_, joint_states_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber goals_, cancels_;
  ros::SteadyTimer timer_;
};

class OnStage : public ::testing::Test {
 protected:
  Stage stage;
};

/// What the states allow, as docs/ros-interface.md draws them.
struct Row {
  std::uint8_t state;
  const char* name;
  Names allowed;
  const char* meaning;
};
const std::vector<Row> kStates{
    {GrinderState::DISABLED, "disabled", {"enable", "disable", "reset"}, "power is off"},
    {GrinderState::READY, "ready", {"enable", "disable", "home", "start"}, "power is on"},
    {GrinderState::HOMING, "homing", {"disable"}, "reference"},
    {GrinderState::STARTING, "starting", {"cancel"}, "spindle and coolant"},
    {GrinderState::RUNNING, "running", {"hold", "cancel"}, "moves the axes"},
    {GrinderState::HOLDING, "holding", {"hold", "resume", "cancel"}, "stop on the path"},
    {GrinderState::HELD, "held", {"hold", "resume", "retract", "cancel"}, "rest"},
    {GrinderState::RETRACTING, "retracting", {"hold", "cancel"}, "lifted"},
    {GrinderState::RETRACTED, "retracted", {"resume", "cancel"}, "off the work"},
    {GrinderState::RESUMING, "resuming", {"hold", "cancel"}, "goes back"},
    {GrinderState::CANCELING, "canceling", {"cancel"}, "the job ends"},
    {GrinderState::FAULT, "fault", {"reset"}, "following error 1.2 mm"},
};

TEST_F(OnStage, ButtonsAreEnabledWhereTheStateAllows) {
  Panel panel("cell/stage", kPaper);
  stage.be(GrinderState::READY, "ready");
  stage.change([&] { stage.plan.valid = 1, stage.plan.duration = 7.03; });
  WAIT_FOR(panel.state() == "Ready" && panel.enabled("plan"));
  EXPECT_FALSE(panel.enabled("start")) << "nothing is planned";
  panel.click("plan");
  WAIT_FOR(panel.enabled("start"));
  stage.change([&] { stage.progress.stroke_fraction = 0.43, stage.progress.job_fraction = 0.12; });
  stage.change([&] { stage.progress.remaining_time = 3723, stage.progress.tooth = 3, stage.progress.pass = 19; });
  stage.change([&] { stage.progress.feed = 0.6 / 60; });
  std::optional<QPoint> place_of_hold;
  for (const Row& row : kStates) {
    SCOPED_TRACE(row.name);
    stage.change([&] {
      stage.state.fault =
          row.state == GrinderState::FAULT ? "axis_x following error 0.0012 m is beyond its limit 0.001 m" : "";
    });
    stage.be(row.state, row.name);
    std::string name = row.name;
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    WAIT_FOR(panel.state() == name);
    EXPECT_EQ(panel.enabledRequests(), row.allowed);
    EXPECT_NE(panel.label("meaning").find(row.meaning), std::string::npos) << panel.label("meaning");
    const bool in_job = row.allowed.count("cancel") == 1;
    for (const char* of_a_new_job : {"choose", "plan", "dry_run"}) EXPECT_NE(panel.enabled(of_a_new_job), in_job);
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
}

TEST_F(OnStage, AStateThatIsUnknownAllowsNothing) {
  Panel panel("cell/stage");
  stage.be(99, "melting");
  WAIT_FOR(panel.state() == "Melting");
  EXPECT_EQ(panel.enabledRequests(), Names());
}

TEST_F(OnStage, SilenceDisablesEveryButton) {
  Panel panel("cell/stage", kPaper);
  stage.be(GrinderState::RUNNING, "running");
  WAIT_FOR(panel.enabled("hold"));
  stage.change([&] { stage.silent = true; });
  WAIT_FOR(panel.state() == "No answer");
  EXPECT_EQ(panel.enabledRequests(), Names());
  for (const char* name : {"choose", "plan", "dry_run", "override"}) EXPECT_FALSE(panel.enabled(name)) << name;
  EXPECT_NE(panel.label("meaning").find("/cell/stage"), std::string::npos);
  for (const char* unknown : {"place", "feed", "override_value"}) EXPECT_EQ(panel.label(unknown), "") << unknown;
  panel.picture("no_answer");
  stage.change([&] { stage.silent = false; });
  WAIT_FOR(panel.state() == "Running");
  EXPECT_EQ(panel.enabledRequests(), (Names{"hold", "cancel"}));
}

TEST_F(OnStage, ARequestThatHangsBlocksNothingAndIsTold) {
  Panel panel("cell/stage");
  stage.change([&] { stage.hold_hangs = true; });
  stage.be(GrinderState::RUNNING, "running");
  WAIT_FOR(panel.enabled("hold"));
  panel.click("hold");
  WAIT_FOR(stage.get([&] { return stage.holds; }) == 1);
  stage.be(GrinderState::HOLDING, "holding");
  WAIT_FOR(panel.state() == "Holding");
  panel.click("cancel");
  WAIT_FOR(stage.get([&] { return stage.cancels.size(); }) == 1);
  EXPECT_EQ(panel.text("messages"), "");
  WAIT_FOR(panel.text("messages").find("Hold: no answer from the grinder /cell/stage") != std::string::npos);
}

TEST_F(OnStage, APanelMayBeClosedWhileARequestHangs) {
  {
    Panel panel("cell/stage");
    stage.change([&] { stage.hold_hangs = true; });
    stage.be(GrinderState::RUNNING, "running");
    WAIT_FOR(panel.enabled("hold"));
    panel.click("hold");
    WAIT_FOR(stage.get([&] { return stage.holds; }) == 1);
  }
  EXPECT_TRUE(stage.get([&] { return stage.hold_hangs; })) << "it did not wait for the answer";
}

TEST_F(OnStage, CancelIsForWhateverGoalRuns) {
  Panel panel("cell/stage");
  stage.be(GrinderState::RUNNING, "running");
  WAIT_FOR(panel.enabled("cancel"));
  panel.click("cancel");
  WAIT_FOR(stage.get([&] { return stage.cancels.size(); }) == 1);
  const auto cancel = stage.get([&] { return stage.cancels[0]; });
  EXPECT_EQ(cancel.id, "");
  EXPECT_EQ(cancel.stamp, ros::Time());
}

TEST_F(OnStage, OverrideIsSentWhenTheSliderIsLetGoOf) {
  Panel panel("cell/stage");
  stage.be(GrinderState::RUNNING, "running");
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
  EXPECT_EQ(stage.get([&] { return stage.overrides.size(); }), 0U);
  EXPECT_EQ(panel.label("override_value"), "35 %");
  slider.setSliderDown(false);
  WAIT_FOR(stage.get([&] { return stage.overrides.size(); }) == 1);
  EXPECT_DOUBLE_EQ(stage.get([&] { return stage.overrides[0]; }), 0.35);
  // The grinder's own value again, and another one that it gets from elsewhere.
  WAIT_FOR(panel.the<QProgressBar>("job").text().endsWith("left at 100 % feed"));
  stage.change([&] { stage.state.override = 1.2; });
  WAIT_FOR(panel.label("override_value") == "120 %");
  // By key: sent when it rests.
  QTest::keyClick(&slider, Qt::Key_Home);
  WAIT_FOR(stage.get([&] { return stage.overrides.size(); }) == 2);
  EXPECT_EQ(stage.get([&] { return stage.overrides[1]; }), 0);
  WAIT_FOR(panel.label("meaning").find("override is 0 %") != std::string::npos);
}

TEST_F(OnStage, WhatForbidsAJobIsShownAndTheJobIsNotStarted) {
  Panel panel("cell/stage", kPaper);
  stage.be(GrinderState::READY, "ready");
  stage.change([&] {
    stage.plan.reasons = {
        "axis_x position 0.301 m is 0.001 m beyond its limit 0.3 m (stroke, cycle 1204, X = 0.301 m)",
        "axis_a velocity -3.14159265 rad/s; allowed: 0.001 to 1e-2 m/s^2, 5 minutes, 2 ms, 1e-3 m/min"};
  });
  WAIT_FOR(panel.enabled("plan"));
  panel.click("plan");
  WAIT_FOR(panel.text("verdict").find("Cannot be ground") != std::string::npos);
  EXPECT_NE(
      panel.text("verdict").find("axis X position 301 mm is 1 mm beyond its limit 300 mm (stroke, cycle 1204, X = "
                                 "301 mm)"),
      std::string::npos)
      << panel.text("verdict");
  EXPECT_NE(
      panel.text("verdict").find("\naxis A velocity -180 deg/s; allowed: 1 to 10 mm/s^2, 5 minutes, 2 ms, 1e-3 m/min"),
      std::string::npos)
      << panel.text("verdict");
  EXPECT_EQ(panel.enabledRequests(), (Names{"enable", "disable", "home"}));
  panel.picture("cannot_be_ground");
}

TEST_F(OnStage, WhatLimitsTheFeedIsShown) {
  Panel panel("cell/stage", kPaper);
  stage.be(GrinderState::READY, "ready");
  FeedLimit limit;
  limit.cause = "axis_a velocity";
  limit.from_x = 0.003;
  limit.to_x = 0.0052;
  stage.change([&] {
    stage.plan.valid = 1;
    stage.plan.duration = 725;
    stage.plan.statistics.min_feed = 0.4 / 60;
    stage.plan.statistics.max_feed = 0.6 / 60;
    stage.plan.statistics.feed_limits = {limit};
  });
  WAIT_FOR(panel.enabled("plan"));
  panel.click("plan");
  WAIT_FOR(panel.enabled("start"));
  EXPECT_EQ(panel.text("verdict"),
            "Takes 12:05 min.\nFeed 400.0 to 600.0 mm/min, limited by\naxis A velocity, X 3.000 to 5.200 mm");
}

TEST_F(OnStage, AJobFileThatChangedSinceThePlanIsNotStarted) {
  const QTemporaryDir folder;
  const QString path = folder.filePath("job.yaml");
  ASSERT_TRUE(QFile::copy(kPaper, path));
  Panel panel("cell/stage", path);
  stage.be(GrinderState::READY, "ready");
  stage.change([&] { stage.plan.valid = 1; });
  WAIT_FOR(panel.enabled("plan"));
  panel.click("plan");
  WAIT_FOR(panel.enabled("start"));
  QFile file(path);
  ASSERT_TRUE(file.setPermissions(QFile::ReadOwner | QFile::WriteOwner) && file.open(QFile::ReadWrite));
  QByteArray text = file.readAll();
  ASSERT_TRUE(text.contains("depth_mm: 0.5"));
  text.replace("depth_mm: 0.5", "depth_mm: 0.4");
  ASSERT_TRUE(file.seek(0) && file.write(text) == text.size());
  file.close();
  panel.click("start");
  EXPECT_NE(panel.text("verdict").find("Plan it again"), std::string::npos) << panel.text("verdict");
  WAIT_FOR(!panel.enabled("start"));
  // A goal that was sent after all would have come before this.
  panel.click("dry_run");
  WAIT_FOR(stage.get([&] { return stage.goals.size(); }) == 1);
  EXPECT_TRUE(stage.get([&] { return stage.goals[0].goal.dry_run; }));
  EXPECT_DOUBLE_EQ(stage.get([&] { return stage.goals[0].goal.process.depth; }), 0.4e-3);
}

TEST_F(OnStage, ConfigurationIsSavedAndLoaded) {
  Panel panel("/cell/stage", kPaper);
  rviz::Config config;
  panel.widget().save(config);
  QString node, job;
  EXPECT_TRUE(config.mapGetString("Node", &node) && config.mapGetString("Job", &job));
  EXPECT_EQ(node, "/cell/stage");
  EXPECT_EQ(job, kPaper);
  EXPECT_EQ(panel.label("job_file"), "paper.yaml");
}

TEST_F(OnStage, TheNodeCanBeChosen) {
  Panel panel("nobody");
  stage.be(GrinderState::DISABLED, "disabled");
  WAIT_FOR(panel.state() == "No answer");
  EXPECT_NE(panel.label("meaning").find("/nobody"), std::string::npos);
  auto& node = panel.the<QLineEdit>("node");
  for (const char* wrong : {"no name", ""}) {
    node.clear();
    QTest::keyClicks(&node, wrong);
    QTest::keyClick(&node, Qt::Key_Return);
    EXPECT_NE(panel.text("messages").find("Grinder's node: "), std::string::npos) << wrong;
    EXPECT_EQ(panel.enabledRequests(), Names());
    panel.the<QPlainTextEdit>("messages").clear();
  }
  QTest::keyClicks(&node, "cell/stage");
  QTest::keyClick(&node, Qt::Key_Return);
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_EQ(panel.enabledRequests(), (Names{"enable", "disable", "reset"}));
}

TEST_F(OnStage, WhatHeldTheJobIsToldInPlainWords) {
  Panel panel("cell/stage");
  stage.change([&] { stage.state.hold_reason = "the spindle is not at speed"; });
  stage.be(GrinderState::RETRACTED, "retracted");
  WAIT_FOR(panel.label("meaning").find("Held because the spindle is not at speed") == 0);
  panel.picture("held_by_itself");
}

TEST_F(OnStage, PositionsAreThoseOfTheGrindersNamespace) {
  Panel panel("cell/stage");
  stage.change([&] {
    stage.joints.name = {"door", "axis_a", "axis_z", "axis_y", "axis_x"};
    stage.joints.position = {1, -21 * M_PI, 0.0000004, 0.0123456, -0.1};
  });
  WAIT_FOR(panel.label("position_x") == "X  -100.000 mm");
  EXPECT_EQ(panel.label("position_y"), "Y    12.346 mm");
  EXPECT_EQ(panel.label("position_z"), "Z     0.000 mm");
  EXPECT_EQ(panel.label("position_a"), "A -3780.000 deg");
  stage.change([&] { stage.joints.name.pop_back(); });
  WAIT_FOR(panel.label("position_x") == "X         - mm");
}

TEST_F(OnStage, AxesThatAreNotHomedAreTold) {
  Panel panel("cell/stage");
  stage.change([&] { stage.state.homed = 0; });
  stage.be(GrinderState::READY, "ready");
  WAIT_FOR(panel.label("meaning").find("not homed") != std::string::npos);
}

}  // namespace
}  // namespace flute_grinder

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_panel");
  const QApplication application(argc, argv);
  const ros::NodeHandle keeps_ros_up;
  ros::AsyncSpinner spinner(4);
  spinner.start();
  return RUN_ALL_TESTS();
}
