// The panel while ROS master and grinder are killed and started again. Both are the test's own: the master on a port
// that was free, the grinder another process of this program.

#include "flute_grinder/network/master_watch.h"
#include "stage.h"

#include <ros/master.h>
#include <QApplication>
#include <QProcess>

#include <csignal>
#include <cstring>

namespace grinder::test_panel_without_master {

constexpr const char* kGrinder = "--grinder";  ///< argument of the grinder's process

/// A grinder that does what `~stop` and `~resume` ask for, and begins as running.
int runGrinder() {
  Stage stage;
  const MasterWatch master_watch({"/cell/stage/resume"});
  stage.be("running");
  std::size_t done = 0;
  int resumed = 0;
  for (ros::WallRate rate(100); ros::ok(); rate.sleep()) {
    for (const int resumes = stage.get(&Stage::resumes); resumed < resumes; ++resumed) {
      stage.be("running");
    }
    const auto stops = stage.get(&Stage::stops);
    for (; done < stops.size(); ++done) {
      if (stops[done] == flute_grinder::Stop::HOLD) stage.be("held");
      if (stops[done] == flute_grinder::Stop::CANCEL) stage.be("ready");
      if (stops[done] == flute_grinder::Stop::DISABLE) stage.be("disabled");
    }
  }
  return 0;
}

QString freePort() {
  QProcess chooser;
  chooser.start(kPackage + "/test/free_port.py", QStringList());
  EXPECT_TRUE(chooser.waitForFinished(kPatience));
  return QString::fromLocal8Bit(chooser.readAllStandardOutput()).trimmed();
}

/// A process that can be killed and started again; killed at the end.
class Mortal {
 public:
  Mortal(QString program, QStringList arguments) : program_(std::move(program)), arguments_(std::move(arguments)) {
    process_.setProcessChannelMode(QProcess::ForwardedErrorChannel);
    process_.setStandardOutputFile(QProcess::nullDevice());
  }
  ~Mortal() { kill(); }
  void start() {
    process_.start(program_, arguments_);
    ASSERT_TRUE(process_.waitForStarted());
  }
  bool runs() const { return process_.state() != QProcess::NotRunning; }
  void kill() {
    process_.kill();
    process_.waitForFinished();
  }
  /// @param number SIGSTOP or SIGCONT.
  void signal(int number) {
    if (process_.processId() > 0) ::kill(static_cast<pid_t>(process_.processId()), number);
  }

 private:
  QString program_;
  QStringList arguments_;
  QProcess process_;
};

Mortal& master() {
  static Mortal the("rosmaster", {"--core", "-p", QString::fromLocal8Bit(qgetenv("ROS_MASTER_URI")).section(':', 2)});
  return the;
}

/// Starts the master, again where it could not have its port, until it answers.
void startMaster() {
  WAIT_FOR([] {
    if (!master().runs()) master().start();
    return ros::master::check();
  }());
}

class WithoutMaster : public ::testing::Test {
 protected:
  void SetUp() override {
    grinder.start();
    WAIT_FOR(panel.state() == "Running");
    WAIT_FOR(panel.enabledRequests() == (Names{"disable", "hold", "cancel"}));
  }
  void TearDown() override {
    grinder.kill();
    master().signal(SIGCONT);
    startMaster();
    WAIT_FOR(panel.label("meaning") == kNoGrinder);
  }
  void loseMaster() {
    master().kill();
    WAIT_FOR(panel.label("meaning").find("No ROS master answers; Hold, Cancel and Disable work without.") == 0);
  }
  void findBoth() {
    WAIT_FOR(panel.enabled("hold"));
    WAIT_FOR(panel.label("meaning") == "The job moves the axes.");
    panel.click("hold");
    WAIT_FOR(panel.enabled("resume"));
    panel.click("resume");  // by a service, which only the master can find
    WAIT_FOR(panel.state() == "Running");
    WAIT_FOR(panel.says("messages", "Resume: the job continues"));
  }

  const std::string kNoGrinder = "No grinder answers as /cell/stage. Does its node run?";
  Mortal grinder{QCoreApplication::applicationFilePath(), {kGrinder}};
  Panel panel{"cell/stage"};
};

TEST_F(WithoutMaster, StopsReachTheGrinder) {
  loseMaster();
  EXPECT_EQ(panel.label("grinder"), "/cell/stage");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "cancel"}));
  EXPECT_FALSE(panel.enabled("override"));
  panel.picture("no_master");
  panel.click("hold");
  WAIT_FOR(panel.state() == "Held");
  EXPECT_EQ(panel.enabledRequests(), (Names{"disable", "hold", "cancel"})) << "resume and retract want a master";
  panel.click("cancel");
  WAIT_FOR(panel.state() == "Ready");
  EXPECT_EQ(panel.enabledRequests(), Names{"disable"});
  panel.click("disable");
  WAIT_FOR(panel.state() == "Disabled");
  EXPECT_TRUE(panel.says("messages", "Disable was sent"));
  startMaster();
  WAIT_FOR(panel.label("meaning").find("master") == std::string::npos);
  EXPECT_EQ(panel.state(), "Disabled") << "the connections are the old ones";
}

TEST_F(WithoutMaster, AMasterThatHangsIsMissing) {
  master().signal(SIGSTOP);
  WAIT_FOR(panel.label("meaning").find("No ROS master answers; ") == 0);
  panel.click("hold");
  WAIT_FOR(panel.state() == "Held");
  master().signal(SIGCONT);
  WAIT_FOR(panel.enabled("resume"));
}

TEST_F(WithoutMaster, BothAreFoundAfterBothWereLost) {
  loseMaster();
  grinder.kill();
  WAIT_FOR(panel.label("meaning") == "No ROS master answers, and nothing comes from the grinder /cell/stage.");
  EXPECT_EQ(panel.state(), "No answer");
  EXPECT_EQ(panel.enabledRequests(), Names());
  panel.picture("no_master_no_grinder");
  // The next grinder is found by the panel only if the new master knows the panel.
  startMaster();
  WAIT_FOR(panel.label("meaning") == kNoGrinder);
  grinder.start();
  findBoth();
}

TEST_F(WithoutMaster, AnotherNameIsTakenUpWhenTheMasterIsBack) {
  loseMaster();
  panel.click("cancel");  // while the job runs it is not to be changed
  WAIT_FOR(panel.state() == "Ready");
  for (const char* name : {"nobody", "/cell/stage"}) {
    panel.enterNode(name);  // it would wait here for ever
    EXPECT_EQ(panel.state(), "No answer");
  }
  EXPECT_EQ(panel.label("grinder"), "/cell/stage");
  startMaster();
  WAIT_FOR(panel.state() == "Ready" && panel.enabled("disable"));
  panel.click("disable");
  WAIT_FOR(panel.state() == "Disabled");
}

}  // namespace grinder::test_panel_without_master

int main(int argc, char** argv) {
  using namespace grinder::test_panel_without_master;
  const bool is_grinder = argc > 1 && std::strcmp(argv[1], kGrinder) == 0;
  ::testing::InitGoogleTest(&argc, argv);
  const QApplication application(argc, argv);
  if (!is_grinder) qputenv("ROS_MASTER_URI", ("http://127.0.0.1:" + freePort()).toLocal8Bit());
  ros::init(argc, argv, is_grinder ? "stage" : "test_panel_without_master");
  if (!is_grinder) startMaster();
  const ros::NodeHandle keeps_ros_up;
  return is_grinder ? runGrinder() : RUN_ALL_TESTS();
}
